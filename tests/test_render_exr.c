/* test_render_exr.c: OpenEXR there and back, every compression and tiles; hostile bytes give one
 * line. */
#include "image/image.h"

#include "hnbrdf/measured.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <openexr.h>

static void assert_one_line(const hnbrdf_error *error)
{
    assert_true(strlen(error->text) > 10);
    for (const char *c = error->text; *c; c++)
        assert_true((unsigned char)*c >= ' ');
}

/* Finite floats over the whole range of half and beyond, both signs. */
static float random_value(hnbrdf_rng *rng)
{
    float value = ldexpf(hnbrdf_rng_float(rng) + 0.5f, (int)(hnbrdf_rng_u32(rng) % 60) - 35);
    return hnbrdf_rng_u32(rng) & 1 ? value : -value;
}

static render_image random_image(int width, int height, int alpha, uint64_t seed)
{
    hnbrdf_rng rng;
    render_image image;
    hnbrdf_rng_seed(&rng, seed, 0);
    assert_int_equal(render_image_create(width, height, alpha, &image, NULL), HNBRDF_OK);
    for (int i = 0; i < 3 * width * height; i++)
        image.rgb[i] = random_value(&rng);
    for (int i = 0; i < width * height && alpha; i++)
        image.alpha[i] = hnbrdf_rng_float(&rng);
    return image;
}

static render_bytes encode(const render_image *image, int half)
{
    render_bytes bytes = {0};
    render_write_options options = {.half = half, .comments = "a test"};
    assert_int_equal(render_exr_encode(image, &options, &bytes, NULL), HNBRDF_OK);
    return bytes;
}

static render_image decode(const render_bytes *bytes)
{
    render_image image;
    hnbrdf_error error;
    if (render_exr_decode(bytes->data, bytes->size, "x.exr", NULL, &image, &error) != HNBRDF_OK)
        fail_msg("%s", error.text);
    return image;
}

static void float_round_trip_is_exact(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {7, 16}, {33, 17}, {64, 40}, {300, 3}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int alpha = 0; alpha < 2; alpha++) {
            render_image image = random_image(sizes[i][0], sizes[i][1], alpha, i);
            render_bytes bytes = encode(&image, 0);
            render_image back = decode(&bytes);
            size_t pixels = (size_t)image.width * (size_t)image.height;
            assert_int_equal(back.width, image.width);
            assert_int_equal(back.height, image.height);
            assert_memory_equal(back.rgb, image.rgb, 12 * pixels);
            assert_int_equal(back.alpha != NULL, alpha);
            if (alpha)
                assert_memory_equal(back.alpha, image.alpha, 4 * pixels);
            render_image_free(&back);
            render_image_free(&image);
            free(bytes.data);
        }
}

/* Nearest multiple of the spacing of halves there, ties to even (nearbyint's default), clamped. */
static float nearest_half(float value)
{
    double x = fabs((double)value);
    int exponent = x < 0x1p-14 ? -14 : (int)floor(log2(x));
    double spacing = exp2(exponent - 10);
    double rounded = fmin(65504.0, nearbyint(x / spacing) * spacing);
    return (float)copysign(rounded, (double)value);
}

static void half_rounds_to_nearest_even_and_clamps(void **state)
{
    (void)state;
    render_image image = random_image(128, 128, 0, 3);
    /* Ties, the borders of the range, and values that plain conversion would make infinite. */
    static const float special[] = {1.0f + 0x1p-11f, 1.0f + 3 * 0x1p-11f,
                                    65504.0f,        65519.0f,
                                    65520.0f,        1e9f,
                                    -1e30f,          0x1p-24f,
                                    0x1p-25f,        3 * 0x1p-26f,
                                    0x1p-14f,        1023 * 0x1p-24f,
                                    -0x1.8p-24f,     0.0f};
    memcpy(image.rgb, special, sizeof special);
    render_bytes bytes = encode(&image, 1);
    render_image back = decode(&bytes);
    for (int i = 0; i < 3 * 128 * 128; i++)
        if (back.rgb[i] != nearest_half(image.rgb[i]))
            fail_msg("%.9g became %.9g, not %.9g", (double)image.rgb[i], (double)back.rgb[i],
                     (double)nearest_half(image.rgb[i]));
    render_image_free(&back);
    render_image_free(&image);
    free(bytes.data);
}

static void channels_are_named_and_sorted(void **state)
{
    (void)state;
    render_image image = random_image(4, 4, 1, 1);
    float *layer = calloc(48, sizeof *layer);
    assert_int_equal(render_image_add_layer(&image, "analytic", layer, NULL), HNBRDF_OK);
    render_bytes bytes = encode(&image, 0);
    static const char *const names[] = {"A",          "B",          "G",         "R",
                                        "analytic.B", "analytic.G", "analytic.R"};
    const unsigned char *at = bytes.data, *end = bytes.data + bytes.size;
    for (size_t i = 0; i < sizeof names / sizeof *names;
         i++) { /* name, NUL, type 2 (float), in this order */
        size_t length = strlen(names[i]) + 1;
        while (at + length + 1 < end && (memcmp(at, names[i], length) != 0 || at[length] != 2))
            at++;
        assert_true(at + length + 1 < end);
        at += length;
    }
    render_image back = decode(&bytes);
    assert_int_equal(back.layer_count, 0);
    render_image_free(&back);
    render_image_free(&image);
    free(bytes.data);
}

static void identical_images_give_identical_bytes(void **state)
{
    (void)state;
    render_image image = random_image(40, 40, 1, 8);
    render_bytes a = encode(&image, 1), b = encode(&image, 1);
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.data, b.data, a.size);
    free(a.data);
    free(b.data);
    render_image_free(&image);
}

/* ---- Files of other programs ----------------------------------------------------------------- */

static int64_t put(exr_const_context_t context, void *user, const void *data, uint64_t size,
                   uint64_t offset, exr_stream_error_func_ptr_t error)
{
    (void)context, (void)error;
    return render_bytes_put(user, offset, data, size) ? -1 : (int64_t)size;
}

#define EXR(call) assert_int_equal(call, EXR_ERR_SUCCESS)

typedef struct foreign {
    exr_compression_t compression;
    int tile; /* side, 0: scanlines */
    const char *channels;
    exr_pixel_type_t type;
    exr_attr_box2i_t window;
} foreign;

static float foreign_value(int channel, int x, int y)
{
    return (float)(channel * 400 + (y * 30 + x) % 400); /* exact in half */
}

static void write_chunk(exr_context_t context, const foreign *file, const exr_chunk_info_t *chunk,
                        int x, int y)
{
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    EXR(exr_encoding_initialize(context, 0, chunk, &pipe));
    float *values =
        malloc(sizeof(float) * (size_t)(chunk->width * chunk->height * pipe.channel_count));
    for (int c = 0; c < pipe.channel_count; c++) {
        float *plane = values + c * chunk->width * chunk->height;
        int channel =
            (int)(strchr(file->channels, pipe.channels[c].channel_name[0]) - file->channels);
        for (int i = 0; i < chunk->width * chunk->height; i++)
            plane[i] = foreign_value(channel, x + i % chunk->width, y + i / chunk->width);
        pipe.channels[c].user_data_type = EXR_PIXEL_FLOAT;
        pipe.channels[c].user_bytes_per_element = 4;
        pipe.channels[c].user_pixel_stride = 4;
        pipe.channels[c].user_line_stride = 4 * chunk->width;
        pipe.channels[c].encode_from_ptr = (const uint8_t *)plane;
    }
    EXR(exr_encoding_choose_default_routines(context, 0, &pipe));
    EXR(exr_encoding_run(context, 0, &pipe));
    EXR(exr_encoding_destroy(context, &pipe));
    free(values);
}

static render_bytes write_foreign(const foreign *file)
{
    render_bytes bytes = {0};
    exr_context_t context;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_attr_v2f_t centre = {{{0.0f, 0.0f}}};
    exr_chunk_info_t chunk;
    int part, width = file->window.max.x - file->window.min.x + 1;
    int height = file->window.max.y - file->window.min.y + 1;
    init.user_data = &bytes;
    init.write_fn = put;
    EXR(exr_start_write(&context, "x", EXR_WRITE_FILE_DIRECTLY, &init));
    EXR(exr_add_part(context, "p", file->tile ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part));
    EXR(exr_initialize_required_attr(context, part, &file->window, &file->window, 1.0f, &centre,
                                     1.0f, EXR_LINEORDER_INCREASING_Y, file->compression));
    if (file->tile)
        EXR(exr_set_tile_descriptor(context, part, (uint32_t)file->tile, (uint32_t)file->tile,
                                    EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN));
    for (const char *c = file->channels; *c; c++) {
        char name[2] = {*c, 0};
        EXR(exr_add_channel(context, part, name, file->type, EXR_PERCEPTUALLY_LINEAR, 1, 1));
    }
    EXR(exr_write_header(context));
    if (file->tile) {
        for (int y = 0; y * file->tile < height; y++)
            for (int x = 0; x * file->tile < width; x++) {
                EXR(exr_write_tile_chunk_info(context, 0, x, y, 0, 0, &chunk));
                write_chunk(context, file, &chunk, x * file->tile, y * file->tile);
            }
    } else {
        int32_t step;
        EXR(exr_get_scanlines_per_chunk(context, 0, &step));
        for (int y = 0; y < height; y += step) {
            EXR(exr_write_scanline_chunk_info(context, 0, y + file->window.min.y, &chunk));
            write_chunk(context, file, &chunk, 0, y);
        }
    }
    EXR(exr_finish(&context));
    return bytes;
}

static exr_attr_box2i_t box(int x0, int y0, int width, int height)
{
    exr_attr_box2i_t window;
    window.min.x = x0;
    window.min.y = y0;
    window.max.x = x0 + width - 1;
    window.max.y = y0 + height - 1;
    return window;
}

static void every_lossless_compression_and_tiles_are_read(void **state)
{
    (void)state;
    static const exr_compression_t compressions[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                                     EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                                     EXR_COMPRESSION_PIZ};
    for (size_t c = 0; c < sizeof compressions / sizeof *compressions; c++)
        for (int tile = 0; tile <= 16; tile += 16)
            for (int type = EXR_PIXEL_HALF; type <= EXR_PIXEL_FLOAT; type++) {
                foreign file = {compressions[c], tile, "RGBAZ", (exr_pixel_type_t)type,
                                box(-3, 5, 30, 37)};
                render_bytes bytes = write_foreign(&file);
                render_image image = decode(&bytes);
                assert_int_equal(image.width, 30);
                assert_int_equal(image.height, 37);
                for (int i = 0; i < 30 * 37; i++) {
                    for (int k = 0; k < 3; k++)
                        assert_true(image.rgb[3 * i + k] == foreign_value(k, i % 30, i / 30));
                    assert_true(image.alpha[i] == foreign_value(3, i % 30, i / 30));
                }
                render_image_free(&image);
                free(bytes.data);
            }
}

static void grey_files_become_rgb(void **state)
{
    (void)state;
    foreign file = {EXR_COMPRESSION_ZIP, 0, "Y", EXR_PIXEL_HALF, box(0, 0, 9, 9)};
    render_bytes bytes = write_foreign(&file);
    render_image image = decode(&bytes);
    for (int i = 0; i < 3 * 81; i++)
        assert_true(image.rgb[i] == foreign_value(0, i / 3 % 9, i / 3 / 9));
    render_image_free(&image);
    free(bytes.data);
}

/* ---- Hostile bytes --------------------------------------------------------------------------- */

static hnbrdf_result decode_copy(const unsigned char *data, size_t size, hnbrdf_error *error)
{
    unsigned char *copy = malloc(size ? size : 1);
    render_image image = {0};
    memcpy(copy, data, size);
    hnbrdf_result result = render_exr_decode(copy, size, "x.exr", NULL, &image, error);
    render_image_free(&image);
    free(copy);
    return result;
}

static unsigned char *find(render_bytes *bytes, const char *name, size_t size)
{
    for (size_t i = 0; i + size + 16 < bytes->size; i++)
        if (memcmp(bytes->data + i, name, size) == 0)
            return bytes->data + i + size;
    fail_msg("%s is not in the file", name);
    return NULL;
}

static void truncated_files_are_refused(void **state)
{
    (void)state;
    render_image image = random_image(6, 20, 0, 1);
    render_bytes bytes = encode(&image, 1);
    for (size_t size = 0; size < bytes.size; size++) {
        hnbrdf_error error;
        assert_int_not_equal(decode_copy(bytes.data, size, &error), HNBRDF_OK);
        assert_one_line(&error);
    }
    free(bytes.data);
    render_image_free(&image);
}

static void damaged_files_never_crash(void **state)
{
    (void)state;
    static const unsigned char values[] = {0, 1, 127, 128, 255};
    for (int tile = 0; tile <= 8; tile += 8) {
        foreign file = {EXR_COMPRESSION_ZIP, tile, "RGB", EXR_PIXEL_HALF, box(0, 0, 6, 20)};
        render_bytes bytes = write_foreign(&file);
        for (size_t at = 0; at < bytes.size; at++)
            for (size_t v = 0; v < sizeof values; v++) {
                hnbrdf_error error;
                unsigned char kept = bytes.data[at];
                bytes.data[at] = values[v];
                if (decode_copy(bytes.data, bytes.size, &error) != HNBRDF_OK)
                    assert_one_line(&error);
                bytes.data[at] = kept;
            }
        free(bytes.data);
    }
}

static void absurd_windows_are_refused_before_allocation(void **state)
{
    (void)state;
    static const int32_t windows[][4] = {{0, 0, 0x7ffffffe, 0x7ffffffe},
                                         {0, 0, 65535, 65535},
                                         {0, 0, 1 << 20, 0},
                                         {5, 5, 4, 4},
                                         {-2147483647 - 1, 0, 2147483647, 3}};
    render_image image = random_image(6, 20, 0, 1);
    render_bytes bytes = encode(&image, 1);
    unsigned char *window = find(&bytes, "dataWindow\0box2i", 17) + 4;
    for (size_t i = 0; i < sizeof windows / sizeof *windows; i++) {
        hnbrdf_error error;
        memcpy(window, windows[i], 16);
        assert_int_not_equal(decode_copy(bytes.data, bytes.size, &error), HNBRDF_OK);
        assert_one_line(&error);
    }
    free(bytes.data);
    render_image_free(&image);
}

/* (Where the C++ library is built in they are read: test_image_exr_matrix.) */
static void dwa_is_refused_with_advice(void **state)
{
    (void)state;
#ifdef HNBRDF_WITH_OPENEXR_CXX
    skip();
#endif
    render_image image = random_image(6, 20, 0, 1);
    render_bytes bytes = encode(&image, 1);
    unsigned char *compression = find(&bytes, "compression\0compression", 24) + 4;
    for (int dwa = 8; dwa <= 9; dwa++) {
        hnbrdf_error error;
        *compression = (unsigned char)dwa;
        assert_int_equal(decode_copy(bytes.data, bytes.size, &error), HNBRDF_ERROR_UNSUPPORTED);
        assert_non_null(strstr(error.text, dwa == 8 ? "DWAA" : "DWAB"));
        assert_non_null(strstr(error.text, "ZIP"));
        assert_one_line(&error);
    }
    free(bytes.data);
    render_image_free(&image);
}

static void files_without_colour_are_refused(void **state)
{
    (void)state;
    static const char *const channels[] = {"Z", "RY", "UV"};
    for (size_t i = 0; i < sizeof channels / sizeof *channels; i++) {
        hnbrdf_error error;
        foreign file = {EXR_COMPRESSION_ZIP, 0, channels[i], EXR_PIXEL_HALF, box(0, 0, 4, 4)};
        render_bytes bytes = write_foreign(&file);
        assert_int_equal(decode_copy(bytes.data, bytes.size, &error), HNBRDF_ERROR_UNSUPPORTED);
        assert_one_line(&error);
        free(bytes.data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(float_round_trip_is_exact),
        cmocka_unit_test(half_rounds_to_nearest_even_and_clamps),
        cmocka_unit_test(channels_are_named_and_sorted),
        cmocka_unit_test(identical_images_give_identical_bytes),
        cmocka_unit_test(every_lossless_compression_and_tiles_are_read),
        cmocka_unit_test(grey_files_become_rgb),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(damaged_files_never_crash),
        cmocka_unit_test(absurd_windows_are_refused_before_allocation),
        cmocka_unit_test(dwa_is_refused_with_advice),
        cmocka_unit_test(files_without_colour_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
