/* test_flip.c: FLIP against a second implementation, written here straight from the equations of
 * Andersson et al. (2020, 2021): filters over the whole square, one pixel at a time; and against
 * what follows from them by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hnbrdf/metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
enum { WIDTH = 31, HEIGHT = 23, PIXELS = WIDTH * HEIGHT };

/* The map is float: half of its last place below 1. */
static const double rounding = 6.0e-8;

/* ---- The equations --------------------------------------------------------------------------- */

/* The matrix of the authors, and its inverse, which they print too. */
static const double rgb_to_xyz[9] = {
    0.41238656325299172,  0.35759149092062537, 0.18045049120356368,
    0.21263682167732384,  0.71518298184125073, 0.072180196481425471,
    0.019330620152483987, 0.11919716364020845, 0.95037258700543537};
static const double xyz_to_rgb[9] = {
    3.2410032329763587,   -1.5373989694887855,  -0.49861588199636292,
    -0.96922425220251662, 1.8759299836951759,   0.041554226340084724,
    0.055639419851975444, -0.20401120612390997, 1.0571489771875335};

typedef struct colour {
    double at[3];
} colour;

static colour times(const double m[9], colour v)
{
    colour out;
    for (int k = 0; k < 3; k++)
        out.at[k] = m[3 * k] * v.at[0] + m[3 * k + 1] * v.at[1] + m[3 * k + 2] * v.at[2];
    return out;
}

static colour white(void)
{
    return times(rgb_to_xyz, (colour){{1, 1, 1}});
}

static colour opponent_of(colour rgb)
{
    const colour n = white(), xyz = times(rgb_to_xyz, rgb);
    const double x = xyz.at[0] / n.at[0], y = xyz.at[1] / n.at[1], z = xyz.at[2] / n.at[2];
    return (colour){{116 * y - 16, 500 * (x - y), 200 * (y - z)}};
}

static double f(double t)
{
    return t > 216.0 / 24389.0 ? cbrt(t) : t * 841.0 / 108.0 + 4.0 / 29.0;
}

static colour hunt_lab_of(colour rgb)
{
    const colour n = white(), xyz = times(rgb_to_xyz, rgb);
    const double x = f(xyz.at[0] / n.at[0]), y = f(xyz.at[1] / n.at[1]), z = f(xyz.at[2] / n.at[2]);
    const double l = 116 * y - 16;
    return (colour){{l, 0.01 * l * 500 * (x - y), 0.01 * l * 200 * (y - z)}};
}

static colour displayed(colour opponent)
{
    const colour n = white();
    const double y = (opponent.at[0] + 16) / 116, x = opponent.at[1] / 500 + y,
                 z = y - opponent.at[2] / 200;
    colour rgb = times(xyz_to_rgb, (colour){{x * n.at[0], y * n.at[1], z * n.at[2]}});
    for (int c = 0; c < 3; c++)
        rgb.at[c] = fmin(fmax(rgb.at[c], 0), 1);
    return rgb;
}

static double hyab(colour a, colour b)
{
    return fabs(a.at[0] - b.at[0]) + hypot(a.at[1] - b.at[1], a.at[2] - b.at[2]);
}

/* Pixels of opponent colours, and what lies beyond the rim. */
typedef struct picture {
    colour pixels[PIXELS];
} picture;

static colour at(const picture *p, int x, int y)
{
    x = x < 0 ? 0 : x < WIDTH ? x : WIDTH - 1;
    y = y < 0 ? 0 : y < HEIGHT ? y : HEIGHT - 1;
    return p->pixels[y * WIDTH + x];
}

static double sensitivity(int channel, double degrees)
{
    static const double a1[3] = {1, 1, 34.1}, b1[3] = {0.0047, 0.0053, 0.04}, a2[3] = {0, 0, 13.5},
                        b2[3] = {1e-5, 1e-5, 0.025};
    const double x2 = degrees * degrees;
    return a1[channel] * sqrt(PI / b1[channel]) * exp(-PI * PI * x2 / b1[channel]) +
           a2[channel] * sqrt(PI / b2[channel]) * exp(-PI * PI * x2 / b2[channel]);
}

static colour seen(const picture *p, int x, int y, double ppd)
{
    colour out;
    const int r = (int)ceil(3 * sqrt(0.04 / (2 * PI * PI)) * ppd);
    for (int c = 0; c < 3; c++) {
        double sum = 0, weights = 0;
        for (int dy = -r; dy <= r; dy++)
            for (int dx = -r; dx <= r; dx++) {
                const double w = sensitivity(c, sqrt(dx * dx + dy * dy) / ppd);
                sum += w * at(p, x + dx, y + dy).at[c];
                weights += w;
            }
        out.at[c] = sum / weights;
    }
    return out;
}

/* A feature's weight along x before it is balanced: the first or second derivative. */
static double feature_weight(int order, int x, int y, double sd)
{
    const double g = exp(-(x * x + y * y) / (2 * sd * sd));
    return order == 1 ? -x * g : (x * x / (sd * sd) - 1) * g;
}

static double feature(const picture *p, int x, int y, int order, double ppd)
{
    const double sd = 0.5 * 0.082 * ppd;
    const int r = (int)ceil(3 * sd);
    double above = 0, below = 0, along[2] = {0, 0};
    for (int dy = -r; dy <= r; dy++)
        for (int dx = -r; dx <= r; dx++) {
            const double w = feature_weight(order, dx, dy, sd);
            above += w > 0 ? w : 0;
            below += w < 0 ? -w : 0;
        }
    for (int dy = -r; dy <= r; dy++)
        for (int dx = -r; dx <= r; dx++) {
            const double value = (at(p, x + dx, y + dy).at[0] + 16) / 116;
            for (int k = 0; k < 2; k++) {
                const double w = feature_weight(order, k ? dy : dx, k ? dx : dy, sd);
                along[k] += w / (w > 0 ? above : below) * value;
            }
        }
    return hypot(along[0], along[1]);
}

static double flip_at(const picture *a, const picture *b, int x, int y, double ppd)
{
    const colour green = hunt_lab_of((colour){{0, 1, 0}}), blue = hunt_lab_of((colour){{0, 0, 1}});
    const double most = pow(hyab(green, blue), 0.7), knee = 0.4 * most;
    const double d = pow(hyab(hunt_lab_of(displayed(seen(a, x, y, ppd))),
                              hunt_lab_of(displayed(seen(b, x, y, ppd)))),
                         0.7);
    const double spread = d < knee ? 0.95 / knee * d : 0.95 + (d - knee) / (most - knee) * 0.05;
    const double edge = fabs(feature(a, x, y, 1, ppd) - feature(b, x, y, 1, ppd)),
                 point = fabs(feature(a, x, y, 2, ppd) - feature(b, x, y, 2, ppd));
    return pow(spread, 1 - sqrt(fmax(edge, point) / sqrt(2)));
}

static void prepare(const float *rgb, picture *p)
{
    for (int i = 0; i < PIXELS; i++) {
        colour c;
        for (int k = 0; k < 3; k++)
            c.at[k] = fmin(fmax((double)rgb[3 * i + k], 0), 1);
        p->pixels[i] = opponent_of(c);
    }
}

/* ---- Pictures -------------------------------------------------------------------------------- */

static void fill(float *rgb, float r, float g, float b)
{
    for (int i = 0; i < PIXELS; i++) {
        rgb[3 * i] = r;
        rgb[3 * i + 1] = g;
        rgb[3 * i + 2] = b;
    }
}

/* Some values below 0, some above 1. */
static void fill_random(float *rgb, uint64_t seed, float most)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, seed, 7);
    for (int i = 0; i < 3 * PIXELS; i++)
        rgb[i] = most * (1.2f * hnbrdf_rng_float(&rng) - 0.1f);
}

static void flip(const float *a, const float *b, double ppd, float *map)
{
    hnbrdf_error error;
    if (hnbrdf_flip(a, b, WIDTH, HEIGHT, ppd, map, &error) != HNBRDF_OK)
        fail_msg("%s", error.text);
}

static float image[3 * PIXELS], other[3 * PIXELS], map[PIXELS], map_back[PIXELS];
static picture first, second;

static void expect_equations(double ppd, double resolved)
{
    flip(image, other, ppd, map);
    prepare(image, &first);
    prepare(other, &second);
    for (int y = 0; y < HEIGHT; y += 2)
        for (int x = 0; x < WIDTH; x += 3) {
            const double expected = flip_at(&first, &second, x, y, resolved);
            assert_true(fabs((double)map[y * WIDTH + x] - expected) <= rounding);
        }
    for (int x = 0; x < WIDTH; x += WIDTH - 1) /* corners */
        for (int y = 0; y < HEIGHT; y += HEIGHT - 1)
            assert_true(fabs((double)map[y * WIDTH + x] -
                             flip_at(&first, &second, x, y, resolved)) <= rounding);
}

/* ---- Tests ----------------------------------------------------------------------------------- */

static void test_is_the_equations(void **state)
{
    (void)state;
    fill_random(image, 1, 1.0f);
    fill_random(other, 2, 1.0f);
    expect_equations(30.0, 30.0);
    memcpy(other, image, sizeof other); /* one pixel: brighter, darker, of another hue */
    other[3 * (11 * WIDTH + 15)] += 0.4f;
    expect_equations(0.0, 3840 * PI / 180);
    fill(image, 0.5f, 0.5f, 0.5f);
    fill(other, 0.5f, 0.5f, 0.5f);
    other[3 * (11 * WIDTH + 15) + 1] = 1.0f;
    expect_equations(40.0, 40.0);
    fill(other, 0.5f, 0.5f, 0.5f);
    other[3 * WIDTH * 2 + 2] = 0.0f; /* near a corner: what is beyond the rim counts */
    expect_equations(67.0, 67.0);
    expect_equations(5.0, 5.0);
}

/* Without features and with filters that change nothing, by hand: L* of black and white are 0 and
 * 100, so that the difference is 100^0.7 = 25.119; green and blue differ by 41.279. */
static void test_by_hand(void **state)
{
    (void)state;
    fill(image, 0, 0, 0);
    fill(other, 1, 1, 1);
    flip(image, other, 0.0, map);
    for (int i = 0; i < PIXELS; i++)
        assert_true(fabs((double)map[i] - 0.9674) < 1e-4);
    fill(image, 0, 1, 0); /* the largest there is */
    fill(other, 0, 0, 1);
    flip(image, other, 0.0, map);
    assert_true(fabs((double)map[0] - 1.0) <= rounding);
    fill(image, 0.5f, 0.2f, 0.7f);
    flip(image, image, 0.0, map);
    for (int i = 0; i < PIXELS; i++)
        assert_true(map[i] == 0.0f);
    fill(image, -3, 2, 5); /* as displayed: 0, 1, 1 */
    fill(other, 0, 1, 1);
    flip(image, other, 0.0, map);
    assert_true(map[0] == 0.0f);
}

static void test_is_symmetric_and_grows(void **state)
{
    (void)state;
    fill_random(image, 3, 1.0f);
    fill_random(other, 4, 1.0f);
    flip(image, other, 0.0, map);
    flip(other, image, 0.0, map_back);
    assert_memory_equal(map, map_back, sizeof map);
    for (int i = 0; i < PIXELS; i++)
        assert_true(map[i] > 0.0f && map[i] <= 1.0f);
    double last = 0.0;
    for (int k = 1; k <= 10; k++) { /* grey against lighter grey; a point that gets lighter */
        fill(image, 0.2f, 0.2f, 0.2f);
        fill(other, 0.2f, 0.2f, 0.2f);
        for (int c = 0; c < 3; c++)
            other[3 * (11 * WIDTH + 15) + c] = 0.2f + 0.08f * (float)k;
        flip(image, other, 0.0, map);
        assert_true((double)map[11 * WIDTH + 15] > last);
        last = (double)map[11 * WIDTH + 15];
    }
    last = 0.0;
    for (int k = 1; k <= 10; k++) {
        const float grey = 0.2f + 0.08f * (float)k;
        fill(other, grey, grey, grey);
        flip(image, other, 0.0, map);
        assert_true((double)map[0] > last);
        last = (double)map[0];
    }
}

/* A strip of rows at a time gives what is one row after the other of a narrow picture. */
static void test_has_no_seams(void **state)
{
    enum { WIDE = 16384, ROWS = 24 };
    (void)state;
    float *a = calloc(3 * WIDE * ROWS, sizeof *a), *b = calloc(3 * WIDE * ROWS, sizeof *b),
          *out = malloc(WIDE * ROWS * sizeof *out);
    assert_true(a && b && out);
    fill_random(image, 5, 1.0f);
    fill_random(other, 6, 1.0f);
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < WIDE; x++) {
            const int from =
                3 * ((y < HEIGHT ? y : HEIGHT - 1) * WIDTH + (x < WIDTH ? x : WIDTH - 1));
            memcpy(a + 3 * (y * WIDE + x), image + from, 3 * sizeof *a);
            memcpy(b + 3 * (y * WIDE + x), other + from, 3 * sizeof *b);
        }
    flip(image, other, 0.0, map);
    assert_int_equal(hnbrdf_flip(a, b, WIDE, ROWS, 0.0, out, NULL), HNBRDF_OK);
    for (int y = 0; y < HEIGHT; y++)
        assert_memory_equal(out + (ptrdiff_t)y * WIDE, map + (ptrdiff_t)y * WIDTH,
                            WIDTH * sizeof *map);
    free(a);
    free(b);
    free(out);
}

static double film(double x)
{
    x *= 0.6;
    return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
}

static void test_exposures(void **state)
{
    (void)state;
    hnbrdf_flip_exposures e;
    fill_random(other, 8, 40.0f);
    for (int i = 0; i < 3 * PIXELS; i++)
        other[i] = fabsf(other[i]);
    assert_int_equal(hnbrdf_flip_exposures_of(other, PIXELS, &e, NULL), HNBRDF_OK);
    double most = 0.0;
    int below = 0;
    const double middle = 1.0 / exp2(e.stop), largest = 1.0 / exp2(e.start);
    double shown = 1.0; /* what the curve takes to 0.85 */
    for (int k = 0; k < 200; k++)
        shown -= (film(shown) - 0.85) / ((film(shown + 1e-6) - film(shown - 1e-6)) / 2e-6);
    for (int i = 0; i < PIXELS; i++) {
        const double y = 0.2126 * (double)other[3 * i] + 0.7152 * (double)other[3 * i + 1] +
                         0.0722 * (double)other[3 * i + 2];
        most = fmax(most, y);
        below += y < middle * shown * (1 - 1e-6);
    }
    assert_true(fabs(largest * shown / most - 1.0) < 1e-6);
    assert_int_equal(below, PIXELS / 2);
    assert_int_equal(e.count, (int)fmax(2.0, ceil(e.stop - e.start)));

    /* the largest over the exposures, of what the curve makes of both */
    fill_random(image, 9, 40.0f);
    e.count = 3;
    memset(map_back, 0, sizeof map_back);
    for (int k = 0; k < 3; k++) {
        static float a[3 * PIXELS], b[3 * PIXELS];
        const double gain = exp2(e.start + (e.stop - e.start) * k / 2);
        for (int i = 0; i < 3 * PIXELS; i++) {
            a[i] = (float)film(gain * fmax((double)image[i], 0.0));
            b[i] = (float)film(gain * (double)other[i]);
        }
        flip(a, b, 0.0, map);
        for (int i = 0; i < PIXELS; i++)
            map_back[i] = fmaxf(map_back[i], map[i]);
    }
    assert_int_equal(hnbrdf_flip_hdr(image, other, WIDTH, HEIGHT, 0.0, &e, map, NULL), HNBRDF_OK);
    for (int i = 0; i < PIXELS; i++) /* the pictures above were rounded to float */
        assert_true(fabsf(map[i] - map_back[i]) < 1e-4f);

    fill(other, 0, 0, 0);
    assert_int_equal(hnbrdf_flip_exposures_of(other, PIXELS, &e, NULL), HNBRDF_OK);
    assert_true(e.start == 0.0 && e.stop == 0.0);
    other[0] = 7.0f; /* a median of 0 */
    assert_int_equal(hnbrdf_flip_exposures_of(other, PIXELS, &e, NULL), HNBRDF_OK);
    assert_true(fabs(e.stop - e.start - 16.0) < 1e-12 && e.count == 16);
    assert_int_equal(hnbrdf_flip_hdr(other, other, WIDTH, HEIGHT, 0.0, NULL, map, NULL), HNBRDF_OK);
    for (int i = 0; i < PIXELS; i++)
        assert_true(map[i] == 0.0f);
}

static void test_what_is_refused(void **state)
{
    (void)state;
    hnbrdf_error error;
    const hnbrdf_flip_exposures none = {0.0, 0.0, 0};
    assert_int_equal(hnbrdf_flip(image, other, WIDTH, HEIGHT, 0.5, map, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "0.5 pixels per degree"));
    assert_int_equal(hnbrdf_flip(image, other, WIDTH, HEIGHT, (double)NAN, map, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_flip(image, other, 0, HEIGHT, 0.0, map, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_flip(image, NULL, WIDTH, HEIGHT, 0.0, map, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_flip_exposures_of(image, 0, &(hnbrdf_flip_exposures){0}, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_flip_hdr(image, other, WIDTH, HEIGHT, 0.0, &none, map, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "found 0 exposures"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_is_the_equations),
        cmocka_unit_test(test_by_hand),
        cmocka_unit_test(test_is_symmetric_and_grows),
        cmocka_unit_test(test_has_no_seams),
        cmocka_unit_test(test_exposures),
        cmocka_unit_test(test_what_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
