/* test_render_images.c: PNG, memory and files; hostile bytes give one line and no crash. */
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
    static const char radiance[] = "#?RADIANCE\n\n-Y 1 +X 2\n\200\200\200\201\200\200\200\201";
    write_file(path, radiance, sizeof radiance - 1);
    assert_int_equal(render_image_read(path, NULL, &image, &error), HNBRDF_OK);
    assert_int_equal(image.width, 2);
    render_image_free(&image);
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
        cmocka_unit_test(absurd_images_are_refused),
        cmocka_unit_test(files_are_recognised_by_content),
        cmocka_unit_test(failed_writing_leaves_the_old_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
