/* test_pairs.c: the random numbers and the three samplers draw what measured.h says. Seeds are
 * fixed; bounds are five standard deviations of the statistic. */
#include "measured_support.h"

static const double PI = 3.14159265358979323846;
enum { DRAWS = 200000, BINS = 16 };

/* Pearson's statistic against equal counts stays within 5 sigma of its mean: sigma^2 = 2 (bins -
 * 1). */
static void expect_flat(const size_t *counts, size_t bins, const char *what)
{
    double total = 0.0, chi2 = 0.0, freedom = (double)(bins - 1);
    for (size_t i = 0; i < bins; i++)
        total += (double)counts[i];
    for (size_t i = 0; i < bins; i++) {
        double expected = total / (double)bins, off = (double)counts[i] - expected;
        chi2 += off * off / expected;
    }
    if (fabs(chi2 - freedom) > 5 * sqrt(2 * freedom))
        fail_msg("%s: chi2 %.1f for %.0f degrees of freedom", what, chi2, freedom);
}

static size_t bin_of(double share, size_t bins)
{
    size_t bin = (size_t)(share * (double)bins);
    return bin < bins ? bin : bins - 1;
}

static void pcg32_gives_the_published_numbers(void **state)
{
    static const uint32_t published[] = {0xa15c02b7, 0x7b47f409, 0xba1d3330,
                                         0x83d2f293, 0xbfa4784b, 0xcbed606e};
    hnbrdf_rng rng;
    (void)state;
    hnbrdf_rng_seed(&rng, 42, 54); /* O'Neill's pcg32-demo, first round */
    for (size_t i = 0; i < sizeof published / sizeof published[0]; i++)
        assert_int_equal(hnbrdf_rng_u32(&rng), published[i]);
}

static void floats_are_flat_and_in_the_unit_interval(void **state)
{
    hnbrdf_rng rng;
    size_t counts[BINS] = {0};
    (void)state;
    hnbrdf_rng_seed(&rng, 1, 2);
    for (int i = 0; i < DRAWS; i++) {
        float u = hnbrdf_rng_float(&rng);
        assert_true(u >= 0.0f && u < 1.0f);
        counts[bin_of((double)u, BINS)]++;
    }
    expect_flat(counts, BINS, "floats");
}

/* Correlation of n pairs of independent numbers has standard deviation 1/sqrt(n). */
static void neighbouring_streams_are_uncorrelated(void **state)
{
    static const uint64_t other[][2] = {{5, 1}, {6, 0}, {6, 1}};
    (void)state;
    for (size_t k = 0; k < 3; k++) {
        hnbrdf_rng a, b;
        hnbrdf_rng_seed(&a, 5, 0);
        hnbrdf_rng_seed(&b, other[k][0], other[k][1]);
        double sum = 0.0;
        for (int i = 0; i < DRAWS; i++)
            sum += ((double)hnbrdf_rng_float(&a) - 0.5) * ((double)hnbrdf_rng_float(&b) - 0.5);
        assert_true(fabs(sum * 12 / DRAWS) < 5 / sqrt(DRAWS));
    }
}

static void a_zero_generator_still_draws(void **state)
{
    hnbrdf_rng rng = {0, 0};
    float wi[3], wo[3];
    (void)state;
    for (int i = 0; i < 100; i++)
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
    assert_true(wi[2] >= 0.01f);
}

static void directions_are_unit_and_above_one_hundredth(void **state)
{
    (void)state;
    for (int sampler = 0; sampler < 3; sampler++) {
        hnbrdf_rng rng;
        hnbrdf_rng_seed(&rng, 3, (uint64_t)sampler);
        for (int i = 0; i < DRAWS; i++) {
            float w[2][3];
            hnbrdf_sampler_draw((hnbrdf_sampler)sampler, &rng, w[0], w[1]);
            for (int k = 0; k < 2; k++) {
                double x = (double)w[k][0], y = (double)w[k][1], z = (double)w[k][2];
                assert_true(w[k][2] >= 0.01f);
                /* each component is rounded to a float: at most 2^-24 off in length */
                assert_true(fabs(sqrt(x * x + y * y + z * z) - 1.0) < 0x1p-24);
            }
        }
    }
}

/* z (uniform) or z^2 (cosine) is flat over what is left above 0.01, the azimuth over the circle,
 * for wi and wo alike. */
static void expect_hemisphere(hnbrdf_sampler sampler, int power)
{
    size_t heights[2][BINS] = {{0}}, azimuths[2][BINS] = {{0}}, joint[BINS * BINS] = {0};
    double low = pow(0.01, power);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 11, 0);
    for (int i = 0; i < DRAWS; i++) {
        float w[2][3];
        size_t height[2];
        hnbrdf_sampler_draw(sampler, &rng, w[0], w[1]);
        for (int k = 0; k < 2; k++) {
            height[k] = bin_of((pow((double)w[k][2], power) - low) / (1 - low), BINS);
            heights[k][height[k]]++;
            azimuths[k][bin_of((atan2((double)w[k][1], (double)w[k][0]) + PI) / (2 * PI), BINS)]++;
        }
        joint[height[0] * BINS + height[1]]++;
    }
    for (int k = 0; k < 2; k++) {
        expect_flat(heights[k], BINS, "height");
        expect_flat(azimuths[k], BINS, "azimuth");
    }
    expect_flat(joint, BINS * BINS, "heights of wi and wo together");
}

static void uniform_is_uniform_in_solid_angle(void **state)
{
    (void)state;
    expect_hemisphere(HNBRDF_SAMPLER_UNIFORM, 1);
}

static void cosine_is_cosine_distributed(void **state)
{
    (void)state;
    expect_hemisphere(HNBRDF_SAMPLER_COSINE, 2);
}

/* Half and difference coordinates of a pair as shares of their ranges: sqrt(theta_h / (pi/2)),
 * theta_d / (pi/2), phi_d / 2 pi, phi_h / 2 pi. */
static void grid_shares(const float wi[3], const float wo[3], double share[4])
{
    double h[3], d[3], length = 0.0;
    for (int i = 0; i < 3; i++) {
        h[i] = (double)wi[i] + (double)wo[i];
        length += h[i] * h[i];
    }
    for (int i = 0; i < 3; i++)
        h[i] /= sqrt(length);
    double th = atan2(hypot(h[0], h[1]), h[2]), ph = atan2(h[1], h[0]);
    double t[3] = {cos(th) * cos(ph), cos(th) * sin(ph), -sin(th)}, b[3] = {-sin(ph), cos(ph), 0.0};
    d[0] = d[1] = d[2] = 0.0;
    for (int i = 0; i < 3; i++) {
        d[0] += (double)wi[i] * t[i];
        d[1] += (double)wi[i] * b[i];
        d[2] += (double)wi[i] * h[i];
    }
    share[0] = sqrt(th / (PI / 2));
    share[1] = atan2(hypot(d[0], d[1]), d[2]) / (PI / 2);
    share[2] = (atan2(d[1], d[0]) + PI) / (2 * PI);
    share[3] = (ph + PI) / (2 * PI);
}

/* With theta_h < 45 and theta_d < 44 degrees (both shares known) nothing is ever below z = 0.01, so
 * there the four coordinates must be flat, singly and together. */
static void grid_is_flat_in_the_bins_of_merl(void **state)
{
    enum { SIDE = 4 };
    const double top[4] = {sqrt(0.5), 44.0 / 90.0, 1.0, 1.0};
    size_t single[4][BINS] = {{0}}, joint[SIDE * SIDE * SIDE * SIDE] = {0};
    hnbrdf_rng rng;
    (void)state;
    hnbrdf_rng_seed(&rng, 13, 0);
    for (int i = 0; i < 2 * DRAWS; i++) {
        float wi[3], wo[3];
        double share[4];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_GRID, &rng, wi, wo);
        grid_shares(wi, wo, share);
        if (share[0] >= top[0] || share[1] >= top[1])
            continue;
        size_t cell = 0;
        for (int k = 0; k < 4; k++) {
            single[k][bin_of(share[k] / top[k], BINS)]++;
            cell = cell * SIDE + bin_of(share[k] / top[k], SIDE);
        }
        joint[cell]++;
    }
    for (int k = 0; k < 4; k++)
        expect_flat(single[k], BINS, "one coordinate of the grid");
    expect_flat(joint, SIDE * SIDE * SIDE * SIDE, "the four coordinates together");
}

static void grid_draws_both_swaps_alike(void **state)
{
    size_t higher[2] = {0};
    hnbrdf_rng rng;
    (void)state;
    hnbrdf_rng_seed(&rng, 17, 0);
    for (int i = 0; i < DRAWS; i++) {
        float wi[3], wo[3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_GRID, &rng, wi, wo);
        higher[wi[2] > wo[2]]++;
    }
    expect_flat(higher, 2, "wi above wo");
}

static void names_are_those_of_the_command_line(void **state)
{
    (void)state;
    assert_string_equal(hnbrdf_sampler_name(HNBRDF_SAMPLER_UNIFORM), "uniform");
    assert_string_equal(hnbrdf_sampler_name(HNBRDF_SAMPLER_COSINE), "cosine");
    assert_string_equal(hnbrdf_sampler_name(HNBRDF_SAMPLER_GRID), "grid");
    assert_null(hnbrdf_sampler_name((hnbrdf_sampler)3));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pcg32_gives_the_published_numbers),
        cmocka_unit_test(floats_are_flat_and_in_the_unit_interval),
        cmocka_unit_test(neighbouring_streams_are_uncorrelated),
        cmocka_unit_test(a_zero_generator_still_draws),
        cmocka_unit_test(directions_are_unit_and_above_one_hundredth),
        cmocka_unit_test(uniform_is_uniform_in_solid_angle),
        cmocka_unit_test(cosine_is_cosine_distributed),
        cmocka_unit_test(grid_is_flat_in_the_bins_of_merl),
        cmocka_unit_test(grid_draws_both_swaps_alike),
        cmocka_unit_test(names_are_those_of_the_command_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
