/* test_image_exr_matrix.c: every compression with every set of channels, layout and window, written
 * by OpenEXR itself, is read with the right values. */
#include "exr_writer.h"
#include "sanitized.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

/* ---- What is written ------------------------------------------------------------------------- */

/* Grows by the same share from pixel to pixel, so that an error of a few per cent is a mistake of
 * place anywhere; every channel has another size. */
static float smooth(int channel, int x, int y)
{
    return (float)(channel + 1) * exp2f((float)x / 8.0f + (float)y / 6.0f - 3.0f);
}

/* RY and BY: constant, as the filter between them has tests of its own. */
static float value(const void *user, int channel, int x, int y)
{
    const exr_channel_set *set = user;
    const int is_chroma = set->kind == EXR_KIND_CHROMA || set->kind == EXR_KIND_CHROMA_ALPHA;
    return is_chroma && channel == 1   ? 0.5f
           : is_chroma && channel == 2 ? -0.25f
                                       : smooth(channel, x, y);
}

/* What the picture must hold at a pixel of the data window. */
static void expected(const exr_channel_set *set, int x, int y, float rgba[4])
{
    static const float of_xyz[3][3] = {{3.2409699f, -1.5373832f, -0.4986108f},
                                       {-0.9692436f, 1.8759675f, 0.0415551f},
                                       {0.0556301f, -0.2039770f, 1.0569715f}};
    const float v[4] = {value(set, 0, x, y), value(set, 1, x, y), value(set, 2, x, y),
                        value(set, 3, x, y)};
    memcpy(rgba, v, sizeof v);
    if (set->kind == EXR_KIND_GREY || set->kind == EXR_KIND_GREY_ALPHA) {
        rgba[1] = rgba[2] = v[0];
        rgba[3] = v[1];
    } else if (set->kind == EXR_KIND_CHROMA || set->kind == EXR_KIND_CHROMA_ALPHA) {
        rgba[0] = 1.5f * v[0];
        rgba[2] = 0.75f * v[0];
        rgba[1] = (v[0] - 0.2126390f * rgba[0] - 0.0721923f * rgba[2]) / 0.7151687f;
    } else if (set->kind == EXR_KIND_XYZ) {
        for (int k = 0; k < 3; k++)
            rgba[k] = of_xyz[k][0] * v[0] + of_xyz[k][1] * v[1] + of_xyz[k][2] * v[2];
    }
}

static const struct windows {
    int data[4], display[4];
} windows[] = {
    {{0, 0, 18, 14}, {0, 0, 18, 14}},   {{4, 6, 12, 10}, {0, 0, 20, 18}}, /* a crop */
    {{-6, -4, 18, 12}, {0, 0, 20, 18}},                                   /* starts before it */
    {{-2, -4, 18, 14}, {3, 1, 8, 7}},                                     /* larger on all sides */
    {{2, 4, 3, 1}, {2, 4, 3, 1}}, /* blocks that do not get smaller are stored as they are */
};

/* Relative to the largest value of the pixel: halves, what PXR24 drops, and the two that lose
 * more. */
static float tolerance(int compression)
{
    return compression < 5 ? 1e-3f : compression == 5 ? 1.1e-3f : 0.04f;
}

/* ---- What is read ---------------------------------------------------------------------------- */

static const char *doing(const exr_part_description *part)
{
    static char text[200];
    snprintf(text, sizeof text, "%s, layout %d, channels %s, window %d %d %d %d",
             exr_compression_name(part->compression), (int)part->layout, part->channels,
             part->data[0], part->data[1], part->data[2], part->data[3]);
    return text;
}

static void check_pixel(const exr_part_description *part, const render_image *image, int x, int y)
{
    const exr_channel_set *set = part->user;
    const int u = x + part->display[0] - part->data[0], v = y + part->display[1] - part->data[1];
    const float *rgb = image->rgb + 3 * (y * image->width + x);
    float want[4] = {0, 0, 0, 0};
    if (u >= 0 && v >= 0 && u < part->data[2] && v < part->data[3])
        expected(set, u, v, want);
    /* XYZ is a difference of larger numbers. */
    const float most = fmaxf(fabsf(want[0]), fmaxf(fabsf(want[1]), fabsf(want[2]))) *
                       (set->kind == EXR_KIND_XYZ ? 3.0f : 1.0f);
    for (int k = 0; k < 3; k++)
        if (!(fabsf(rgb[k] - want[k]) <= tolerance(part->compression) * most))
            fail_msg("%s: (%d, %d) channel %d is %g, not %g", doing(part), x, y, k, (double)rgb[k],
                     (double)want[k]);
    if (image->alpha) {
        const float alpha = image->alpha[y * image->width + x];
        if (!(fabsf(alpha - want[3]) <= tolerance(part->compression) * want[3]))
            fail_msg("%s: (%d, %d) alpha is %g, not %g", doing(part), x, y, (double)alpha,
                     (double)want[3]);
    }
}

static void check_file(const exr_part_description *part)
{
    const exr_channel_set *set = part->user;
    const int has_alpha = set->kind == EXR_KIND_RGBA || set->kind == EXR_KIND_GREY_ALPHA ||
                          set->kind == EXR_KIND_CHROMA_ALPHA;
    render_bytes bytes = exr_write_parts(part, 1);
    render_image image = {0};
    hnbrdf_error error;
    if (bytes.size == 0)
        fail_msg("%s: not written", doing(part));
    if (render_exr_decode(bytes.data, bytes.size, "x.exr", NULL, &image, &error) != HNBRDF_OK)
        fail_msg("%s: %s", doing(part), error.text);
    assert_int_equal(image.width, part->display[2]);
    assert_int_equal(image.height, part->display[3]);
    assert_int_equal(image.alpha != NULL, has_alpha);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++)
            check_pixel(part, &image, x, y);
    render_image_free(&image);
    free(bytes.data);
}

/* With AddressSanitizer the megabytes of a block of PIZ and DWAB are new ones each time. Files of
 * few blocks stand for the others there. */
static int is_too_slow(const exr_part_description *part)
{
    return SANITIZED && (part->compression == 4 || part->compression == 9) &&
           ((part->layout != EXR_LINES && part->layout != EXR_TILES) || part->data[2] > 12);
}

/* Subsampled channels are not in tiles, and not of odd sides. */
static int is_written(const exr_part_description *part)
{
    const exr_channel_set *set = part->user;
    return !set->is_subsampled ||
           (part->layout <= EXR_LINES_DOWN && part->data[2] % 2 + part->data[3] % 2 == 0);
}

static void check_compression(int compression)
{
    for (const exr_channel_set *set = exr_channel_sets; set->channels; set++)
        for (exr_layout layout = EXR_LINES; layout <= EXR_RIPMAP; layout++)
            for (size_t w = 0; w < sizeof windows / sizeof *windows; w++) {
                exr_part_description part = {.compression = compression,
                                             .layout = layout,
                                             .channels = set->channels,
                                             .value = value,
                                             .user = set};
                memcpy(part.data, windows[w].data, sizeof part.data);
                memcpy(part.display, windows[w].display, sizeof part.display);
                if (is_written(&part) && !is_too_slow(&part))
                    check_file(&part);
            }
}

static void every_combination_is_read(void **state)
{
    check_compression(*(const int *)*state);
}

int main(void)
{
#if defined(__GLIBC__)
    /* Writing PIZ and DWAB takes megabytes a block: keep them, as fresh pages take 20 times as
     * long as the rest. */
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_TOP_PAD, 1 << 24);
#endif
    static int compressions[EXR_COMPRESSIONS];
    struct CMUnitTest tests[EXR_COMPRESSIONS];
    for (int i = 0; i < EXR_COMPRESSIONS; i++) {
        compressions[i] = i;
        tests[i] = (struct CMUnitTest){exr_compression_name(i), every_combination_is_read, NULL,
                                       NULL, &compressions[i]};
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
