/* test_render_draw.c: the colour scale, resizing, and difference pages. */
#include "image/difference.h"
#include "image/draw.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static render_image make(int width, int height, int alpha)
{
    render_image image;
    assert_int_equal(render_image_create(width, height, alpha, &image, NULL), HNBRDF_OK);
    return image;
}

/* CIE 1976 lightness of a linear colour. */
static double lightness(const float rgb[3])
{
    double y = 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
    return y > 216.0 / 24389.0 ? 116.0 * cbrt(y) - 16.0 : y * 24389.0 / 27.0;
}

static void the_colour_scale_rises_evenly_in_lightness(void **state)
{
    (void)state;
    float rgb[3];
    render_colour_map(0.0, rgb);
    double first = lightness(rgb), last = first;
    render_colour_map(1.0, rgb);
    double mean = (lightness(rgb) - first) / 64.0;
    for (int k = 1; k <= 64; k++) {
        render_colour_map(k / 64.0, rgb);
        double step = lightness(rgb) - last;
        /* Steps of viridis' five colours joined in sRGB lie within 0.63 and 1.38 of their mean. */
        assert_true(step > 0.5 * mean && step < 1.5 * mean);
        last += step;
    }
    float beyond[3];
    render_colour_map(7.0, beyond);
    assert_memory_equal(beyond, rgb, sizeof rgb);
    render_colour_map(0.0, rgb);
    render_colour_map(-1.0, beyond);
    assert_memory_equal(beyond, rgb, sizeof rgb);
    render_colour_map((double)NAN, beyond);
    assert_memory_equal(beyond, rgb, sizeof rgb);
}

static void resizing_keeps_the_mean(void **state)
{
    (void)state;
    static const int sizes[] = {1, 5, 12, 17, 24, 31, 60};
    render_image image = make(24, 24, 1);
    double mean = 0.0;
    for (int i = 0; i < 24 * 24; i++) {
        for (int k = 0; k < 3; k++)
            image.rgb[3 * i + k] = (float)((i * 7 + k * 5) % 31);
        image.alpha[i] = (float)(i % 3) / 2.0f;
        mean += (double)image.rgb[3 * i + 1] / (24 * 24);
    }
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        render_image out;
        int pixels = sizes[s] * sizes[s];
        double sum = 0.0, alpha = 0.0;
        assert_int_equal(render_resize(&image, sizes[s], 2.0, &out, NULL), HNBRDF_OK);
        for (int i = 0; i < pixels; i++) {
            sum += (double)out.rgb[3 * i + 1] / pixels;
            alpha += (double)out.alpha[i] / pixels;
        }
        assert_true(fabs(sum - 2.0 * mean) < 1e-5 * mean); /* rounding to float, 6e-8 a pixel */
        assert_true(fabs(alpha - 0.5) < 1e-5);
        render_image_free(&out);
    }
    render_image same;
    assert_int_equal(render_resize(&image, 24, 1.0, &same, NULL), HNBRDF_OK);
    assert_memory_equal(same.rgb, image.rgb, 3 * 24 * 24 * sizeof(float));
    render_image_free(&same);
    render_image_free(&image);
}

static void what_is_drawn_outside_is_clipped(void **state)
{
    (void)state;
    static const float white[3] = {1, 1, 1};
    render_image image = make(9, 7, 0), part = make(5, 5, 0);
    for (int x = -20; x < 20; x += 3)
        for (int y = -20; y < 20; y += 3) { /* ASan sees a step outside */
            render_fill(&image, x, y, 11, 4, white);
            render_paste(&image, x, y, &part);
            render_colour_bar(&image, x, y, 4, 9);
            render_text_at(&image, x, y, 0.5, "Wg", 8.0, white);
        }
    render_image_free(&image);
    render_image_free(&part);
}

static void a_pixel_counts_if_either_picture_covers_it(void **state)
{
    (void)state;
    render_image a = make(2, 1, 1), b = make(2, 1, 1), opaque = make(2, 1, 0);
    assert_false(render_covered(&a, &b, 0));
    a.alpha[0] = 0.1f;
    b.alpha[1] = 0.1f;
    assert_true(render_covered(&a, &b, 0) && render_covered(&a, &b, 1));
    a.alpha[0] = 0.0f;
    assert_false(render_covered(&a, &b, 0));
    assert_true(render_covered(&a, &opaque, 0) && render_covered(&opaque, &a, 0));
    render_image_free(&a);
    render_image_free(&b);
    render_image_free(&opaque);
}

static void the_scale_ends_at_the_next_round_number(void **state)
{
    (void)state;
    static const struct {
        float difference;
        double top;
    } cases[] = {{0.0f, 1.0},  {1.0f, 1.0},   {1.5f, 2.0},    {2.0f, 2.0},    {3.0f, 5.0},
                 {7.0f, 10.0}, {0.03f, 0.05}, {0.011f, 0.02}, {1.9e-7f, 2e-7}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        render_image a = make(20, 10, 0), b = make(20, 10, 0);
        for (int k = 0; k < 3 * 200; k++)
            a.rgb[k] = cases[c].difference;
        assert_true(fabs(render_difference_top(&a, &b) / cases[c].top - 1.0) < 1e-6);
        for (int k = 0; k < 3; k++) /* one of 200 pixels may be beyond */
            a.rgb[k] = 1e6f;
        if (cases[c].difference > 0.0f)
            assert_true(fabs(render_difference_top(&a, &b) / cases[c].top - 1.0) < 1e-6);
        render_image_free(&a);
        render_image_free(&b);
    }
}

static void a_difference_page_holds_the_map_and_its_scale(void **state)
{
    (void)state;
    static const char *const lines[RENDER_DIFFERENCE_LINES] = {"a against b", "figures", NULL};
    render_image a = make(150, 130, 1), b = make(150, 130, 1), page, map;
    for (int i = 0; i < 150 * 130; i++)
        if (i % 150 > 10) {
            a.alpha[i] = 1.0f;
            a.rgb[3 * i] = 3.0f * (float)(i % 7); /* a third of it is the difference */
        }
    assert_int_equal(render_difference_map(&a, &b, 6.0, &map, NULL), HNBRDF_OK);
    for (int i = 0; i < 150 * 130; i++) {
        float rgb[3] = {0, 0, 0};
        if (i % 150 > 10)
            render_colour_map(i % 7 / 6.0, rgb);
        for (int k = 0; k < 3; k++)
            assert_true(fabsf(map.rgb[3 * i + k] - rgb[k]) < 1e-6f);
        assert_true(map.alpha[i] == (i % 150 > 10 ? 1.0f : 0.0f));
    }
    assert_int_equal(render_difference_page(&a, &b, 6.0, lines, &page, NULL), HNBRDF_OK);
    assert_true(page.width >= 150 && page.height >= 130);
    /* Every colour of the map as often as there, and once more in each of the bar's columns at
     * most. */
    int top = 0;
    float yellow[3];
    render_colour_map(1.0, yellow);
    for (int i = 0; i < page.width * page.height; i++)
        top += memcmp(page.rgb + 3 * i, yellow, sizeof yellow) == 0;
    int expected = 0;
    for (int i = 0; i < 150 * 130; i++)
        expected += i % 150 > 10 && i % 7 == 6;
    assert_int_equal(top, expected);
    render_image_free(&a);
    render_image_free(&b);
    render_image_free(&map);
    render_image_free(&page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_colour_scale_rises_evenly_in_lightness),
        cmocka_unit_test(resizing_keeps_the_mean),
        cmocka_unit_test(what_is_drawn_outside_is_clipped),
        cmocka_unit_test(a_pixel_counts_if_either_picture_covers_it),
        cmocka_unit_test(the_scale_ends_at_the_next_round_number),
        cmocka_unit_test(a_difference_page_holds_the_map_and_its_scale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
