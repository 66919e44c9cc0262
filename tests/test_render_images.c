/* test_render_images.c: PNG and Radiance, memory and files; hostile bytes give one line and no
 * crash. */
#include "image/image.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#include <stb_image.h>

static void assert_one_line(const hnbrdf_error *error)
{
    assert_true(strlen(error->text) > 10);
    for (const char *c = error->text; *c; c++)
        assert_true((unsigned char)*c >= ' ');
}

/* ---- PNG ------------------------------------------------------------------------------------- */

static unsigned char *decode_png(const render_bytes *bytes, int *width, int *height, int *channels)
{
    unsigned char *pixels =
        stbi_load_from_memory(bytes->data, (int)bytes->size, width, height, channels, 0);
    assert_non_null(pixels);
    return pixels;
}

static double srgb_to_linear(double s)
{
    return s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
}

/* Every one of the 256 codes comes back from the linear value that it stands for. */
static void png_holds_the_srgb_curve_of_the_exposed_value(void **state)
{
    (void)state;
    for (int stops = -2; stops <= 2; stops += 2) {
        render_image image;
        assert_int_equal(render_image_create(16, 16, 0, &image, NULL), HNBRDF_OK);
        for (int i = 0; i < 256; i++)
            for (int k = 0; k < 3; k++)
                image.rgb[3 * i + k] = (float)(srgb_to_linear((i + k) % 256 / 255.0) / exp2(stops));
        render_bytes bytes = {0};
        assert_int_equal(render_png_encode(&image, stops, &bytes, NULL), HNBRDF_OK);
        int width, height, channels;
        unsigned char *pixels = decode_png(&bytes, &width, &height, &channels);
        assert_int_equal(width * height * channels, 16 * 16 * 3);
        for (int i = 0; i < 256; i++)
            for (int k = 0; k < 3; k++)
                assert_int_equal(pixels[3 * i + k], (i + k) % 256);
        free(pixels);
        free(bytes.data);
        render_image_free(&image);
    }
}

static void png_clamps_and_makes_nan_black(void **state)
{
    (void)state;
    static const float values[6] = {-1.0f, 2.0f, 1e30f, NAN, INFINITY, -INFINITY};
    static const int expected[6] = {0, 255, 255, 0, 255, 0};
    render_image image;
    assert_int_equal(render_image_create(2, 1, 0, &image, NULL), HNBRDF_OK);
    memcpy(image.rgb, values, sizeof values);
    render_bytes bytes = {0};
    assert_int_equal(render_png_encode(&image, 0.0, &bytes, NULL), HNBRDF_OK);
    int width, height, channels;
    unsigned char *pixels = decode_png(&bytes, &width, &height, &channels);
    for (int i = 0; i < 6; i++)
        assert_int_equal(pixels[i], expected[i]);
    free(pixels);
    free(bytes.data);
    render_image_free(&image);
}

static void png_divides_colour_by_alpha(void **state)
{
    (void)state;
    render_image image;
    assert_int_equal(render_image_create(2, 1, 1, &image, NULL), HNBRDF_OK);
    image.alpha[0] = 0.25f;
    image.rgb[0] = 0.25f * (float)srgb_to_linear(100.0 / 255.0);
    image.rgb[3] = 5.0f; /* light without coverage: nothing that PNG could say */
    render_bytes bytes = {0};
    assert_int_equal(render_png_encode(&image, 0.0, &bytes, NULL), HNBRDF_OK);
    int width, height, channels;
    unsigned char *pixels = decode_png(&bytes, &width, &height, &channels);
    assert_int_equal(channels, 4);
    assert_int_equal(pixels[0], 100);
    assert_int_equal(pixels[3], 64);
    assert_int_equal(pixels[4], 0);
    assert_int_equal(pixels[7], 0);
    free(pixels);
    free(bytes.data);
    render_image_free(&image);
}

/* ---- Radiance -------------------------------------------------------------------------------- */

static const char hdr_header[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1\n\n";

static void append(render_bytes *bytes, const void *data, size_t size)
{
    assert_int_equal(render_bytes_put(bytes, bytes->size, data, size), 0);
}

/* Mantissas count up, exponents walk from 120 to 136. */
static void rgbe_at(int x, int y, unsigned char rgbe[4])
{
    rgbe[0] = (unsigned char)(128 + (x + 3 * y) % 128);
    rgbe[1] = (unsigned char)(x * 7 % 256);
    rgbe[2] = (unsigned char)(x < 6 ? 9 : 200);
    rgbe[3] = (unsigned char)(120 + y % 17);
}

static render_bytes make_hdr(int width, int height, int coded, const char *sign)
{
    render_bytes bytes = {0};
    char line[64];
    append(&bytes, hdr_header, sizeof hdr_header - 1);
    int length = snprintf(line, sizeof line, "%sY %d +X %d\n", sign, height, width);
    append(&bytes, line, (size_t)length);
    for (int y = 0; y < height; y++) {
        if (coded) {
            unsigned char start[4] = {2, 2, (unsigned char)(width >> 8),
                                      (unsigned char)(width & 255)};
            append(&bytes, start, 4);
        }
        for (int k = 0; k < (coded ? 4 : 1); k++)
            for (int x = 0; x < width;) {
                unsigned char rgbe[4];
                rgbe_at(x, y, rgbe);
                if (!coded) {
                    append(&bytes, rgbe, 4);
                    x++;
                } else if (k >= 2) { /* runs: 6 and the rest in blue, all in the exponent */
                    int run = k == 2 && x < 6 ? 6 : width - x;
                    run = run > 127 ? 127 : run;
                    unsigned char code[2] = {(unsigned char)(128 + run), rgbe[k]};
                    append(&bytes, code, 2);
                    x += run;
                } else {
                    unsigned char code[2] = {1, rgbe[k]};
                    append(&bytes, code, 2);
                    x++;
                }
            }
    }
    return bytes;
}

static void radiance_decodes_flat_and_coded_scanlines(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        int coded = kind & 1, bottom_up = kind & 2, width = coded ? 300 : 5, height = 19;
        render_bytes bytes = make_hdr(width, height, coded, bottom_up ? "+" : "-");
        render_image image;
        assert_int_equal(
            render_radiance_decode(bytes.data, bytes.size, "x.hdr", NULL, &image, NULL), HNBRDF_OK);
        assert_int_equal(image.width, width);
        assert_int_equal(image.height, height);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                unsigned char rgbe[4];
                rgbe_at(x, bottom_up ? height - 1 - y : y, rgbe);
                for (int k = 0; k < 3; k++)
                    assert_true(image.rgb[3 * (y * width + x) + k] ==
                                (float)(rgbe[k] / 256.0 * exp2(rgbe[3] - 128)));
            }
        render_image_free(&image);
        free(bytes.data);
    }
}

/* From a block of exactly this size, so that ASan sees the first byte beyond. */
static hnbrdf_result decode_copy(const unsigned char *data, size_t size, hnbrdf_error *error)
{
    unsigned char *copy = malloc(size ? size : 1);
    render_image image = {0};
    memcpy(copy, data, size);
    hnbrdf_result result = render_radiance_decode(copy, size, "x.hdr", NULL, &image, error);
    render_image_free(&image);
    free(copy);
    return result;
}

static void truncated_radiance_is_refused(void **state)
{
    (void)state;
    for (int coded = 0; coded < 2; coded++) {
        render_bytes bytes = make_hdr(13, 4, coded, "-");
        for (size_t size = 0; size < bytes.size; size++) {
            hnbrdf_error error;
            assert_int_not_equal(decode_copy(bytes.data, size, &error), HNBRDF_OK);
            assert_one_line(&error);
        }
        free(bytes.data);
    }
}

static void damaged_radiance_never_crashes(void **state)
{
    (void)state;
    static const unsigned char values[] = {0, 1, 2, 10, 32, 127, 128, 129, 255};
    for (int coded = 0; coded < 2; coded++) {
        render_bytes bytes = make_hdr(13, 4, coded, "-");
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

static void absurd_radiance_is_refused(void **state)
{
    (void)state;
    static const char *const headers[] = {
        "",
        "#?",
        "#?RADIANCE\n\n",
        "#?RADIANCE\n\n-Y 0 +X 5\n",
        "#?RADIANCE\n\n-Y 65536 +X 65536\n",
        "#?RADIANCE\n\n-Y 99999999999999999999 +X 1\n",
        "#?RADIANCE\n\n-Y 4096 +X 4096\n",
        "#?RADIANCE\n\n-Y -5 +X 5\n",
        "#?RADIANCE\n\n+X 5 -Y 5\n",
        "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd",
    };
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++) {
        hnbrdf_error error;
        assert_int_not_equal(
            decode_copy((const unsigned char *)headers[i], strlen(headers[i]), &error), HNBRDF_OK);
        assert_one_line(&error);
    }
}

/* ---- Memory and files ------------------------------------------------------------------------ */

static void absurd_images_are_refused(void **state)
{
    (void)state;
    static const int sizes[][2] = {{0, 1},     {1, 0},         {-1, 5},
                                   {65537, 1}, {65536, 65536}, {8193, 8193}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        hnbrdf_error error;
        render_image image;
        assert_int_equal(render_image_create(sizes[i][0], sizes[i][1], 1, &image, &error),
                         HNBRDF_ERROR_LIMIT);
        assert_one_line(&error);
    }
}

static void write_file(const char *path, const void *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void files_are_recognised_by_content(void **state)
{
    (void)state;
    const char *path = "test_render_images.png"; /* a wrong name on purpose */
    hnbrdf_error error;
    render_image image;
    render_bytes bytes = make_hdr(20, 3, 1, "-");
    write_file(path, bytes.data, bytes.size);
    assert_int_equal(render_image_read(path, NULL, &image, &error), HNBRDF_OK);
    assert_int_equal(image.width, 20);
    render_image_free(&image);
    free(bytes.data);
    for (size_t size = 0; size < 5; size++) {
        write_file(path, "GIF89", size);
        assert_int_equal(render_image_read(path, NULL, &image, &error), HNBRDF_ERROR_FORMAT);
        assert_non_null(strstr(error.text, path));
        assert_one_line(&error);
    }
    remove(path);
    assert_int_equal(render_image_read(path, NULL, &image, &error), HNBRDF_ERROR_IO);
    assert_one_line(&error);
}

static void failed_writing_leaves_the_old_file(void **state)
{
    (void)state;
    const char *path = "test_render_images.tga";
    hnbrdf_error error;
    render_image image;
    assert_int_equal(render_image_create(2, 2, 0, &image, NULL), HNBRDF_OK);
    write_file(path, "old", 3);
    assert_int_equal(render_image_write(&image, path, NULL, &error), HNBRDF_ERROR_ARGUMENT);
    assert_one_line(&error);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fgetc(file), 'o');
    fclose(file);
    remove(path);
    assert_int_equal(render_image_write(&image, "no/such/folder/a.png", NULL, &error),
                     HNBRDF_ERROR_IO);
    assert_non_null(strstr(error.text, "no/such/folder/a.png"));
    assert_int_equal(render_image_write(&image, "test_render_images.PNG", NULL, &error), HNBRDF_OK);
    assert_int_equal(remove("test_render_images.PNG"), 0);
    render_image_free(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(png_holds_the_srgb_curve_of_the_exposed_value),
        cmocka_unit_test(png_clamps_and_makes_nan_black),
        cmocka_unit_test(png_divides_colour_by_alpha),
        cmocka_unit_test(radiance_decodes_flat_and_coded_scanlines),
        cmocka_unit_test(truncated_radiance_is_refused),
        cmocka_unit_test(damaged_radiance_never_crashes),
        cmocka_unit_test(absurd_radiance_is_refused),
        cmocka_unit_test(absurd_images_are_refused),
        cmocka_unit_test(files_are_recognised_by_content),
        cmocka_unit_test(failed_writing_leaves_the_old_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
