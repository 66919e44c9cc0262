/* test_render_light.c: environments: density, sampling, orientation, the built-in sky. */
#include "render/environment.h"

#include "hnbrdf/measured.h"
#include "render/turn.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

/* Values over four decades, every seventh texel and one whole row black. */
static render_environment random_environment(int width, int height, double rotation, uint64_t seed)
{
    hnbrdf_rng rng;
    render_image image;
    render_environment environment;
    hnbrdf_rng_seed(&rng, seed, 1);
    assert_int_equal(render_image_create(width, height, 0, &image, NULL), HNBRDF_OK);
    for (int i = 0; i < width * height; i++)
        for (int k = 0; k < 3; k++)
            image.rgb[3 * i + k] = i % 7 == 3 || i / width == height / 2
                                       ? 0.0f
                                       : powf(10.0f, 4.0f * hnbrdf_rng_float(&rng) - 2.0f);
    assert_int_equal(render_environment_create(&image, rotation, "random", &environment, NULL),
                     HNBRDF_OK);
    assert_null(image.rgb);
    return environment;
}

static void texel_direction(const render_environment *environment, double column, double row,
                            float d[3])
{
    double theta = pi * row / environment->height;
    double phi = 2.0 * pi * (column / environment->width - 0.5) - environment->rotation;
    d[0] = (float)(sin(theta) * sin(phi));
    d[1] = (float)cos(theta);
    d[2] = (float)(-sin(theta) * cos(phi));
}

static double texel_angle(const render_environment *environment, int row)
{
    return 2.0 * pi / environment->width *
           (cos(pi * row / environment->height) - cos(pi * (row + 1) / environment->height));
}

/* The errors that turn.h states, over all directions and magnitudes; ends and axes are exact. */
static void turn_is_within_its_error(void **state)
{
    (void)state;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 4, 0);
    for (int i = 0; i < 2000000; i++) {
        float length = exp2f(120.0f * hnbrdf_rng_float(&rng) - 60.0f);
        double angle = i % 4 == 0 ? pow(10.0, -8.0 * (double)hnbrdf_rng_float(&rng)) * pi / 4.0
                                  : 2.0 * pi * (double)hnbrdf_rng_float(&rng);
        float y = length * (float)sin(angle), x = length * (float)cos(angle);
        double turn = atan2((double)y, (double)x) / (2.0 * pi), found = (double)render_turn(y, x);
        turn += turn < 0.0;
        assert_true(fabs(found - turn) <= 8e-8);
        if (turn < 0.125)
            assert_true(fabs(found - turn) <= 3e-7 * turn);
    }
    assert_true(render_turn(0.0f, 0.0f) == 0.0f && render_turn(0.0f, 1.0f) == 0.0f);
    assert_true(render_turn(1.0f, 0.0f) == 0.25f && render_turn(2.0f, 2.0f) == 0.125f);
    assert_true(render_turn(0.0f, -1.0f) == 0.5f && render_turn(-1.0f, 0.0f) == 0.75f);
}

static const int sizes[][2] = {{1, 1}, {7, 5}, {64, 32}, {128, 1}, {3, 100}};
enum { SIZES = sizeof sizes / sizeof *sizes };

/* The density is constant in a texel, so the sum over texels is the integral; doubles throughout.
 * */
static void density_integrates_to_one(void **state)
{
    (void)state;
    for (int s = 1; s < SIZES; s++)
        for (int turned = 0; turned < 2; turned++) {
            if (sizes[s][1] == 1)
                continue; /* its only row is the black one */
            render_environment environment =
                random_environment(sizes[s][0], sizes[s][1], turned * 1.3, 1);
            double sum = 0.0;
            for (int y = 0; y < environment.height; y++)
                for (int x = 0; x < environment.width; x++) {
                    float d[3], radiance[3];
                    texel_direction(&environment, x + 0.5, y + 0.5, d);
                    sum += render_environment_lookup(&environment, d, radiance) *
                           texel_angle(&environment, y);
                }
            assert_true(fabs(sum - 1.0) < 1e-9);
            render_environment_free(&environment);
        }
}

static void sampling_frequencies_match_the_density(void **state)
{
    (void)state;
    enum { DRAWS = 400000 };
    render_environment environment = random_environment(16, 12, 0.7, 5);
    int counts[16 * 12] = {0};
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 9, 9);
    for (int i = 0; i < DRAWS; i++) {
        double u[2] = {hnbrdf_rng_u32(&rng) * 0x1p-32, hnbrdf_rng_u32(&rng) * 0x1p-32};
        float d[3], radiance[3];
        double density = render_environment_sample(&environment, u, d, radiance);
        assert_true(density > 0.0);
        double phi = atan2((double)d[0], -(double)d[2]) + environment.rotation;
        double turn = phi / (2.0 * pi) + 0.5;
        int column = (int)((turn - floor(turn)) * 16.0),
            row = (int)(acos((double)d[1]) / pi * 12.0);
        counts[16 * (row < 12 ? row : 11) + (column < 16 ? column : 15)]++;
    }
    double chi2 = 0.0;
    int freedom = -1;
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 16; x++) {
            float d[3], radiance[3];
            texel_direction(&environment, x + 0.5, y + 0.5, d);
            double expected = DRAWS * texel_angle(&environment, y) *
                              render_environment_lookup(&environment, d, radiance);
            int count = counts[16 * y + x];
            if (expected == 0.0)
                assert_true(count <= 2); /* a direction on the border, rounded across it */
            if (expected < 10.0)
                continue;
            chi2 += (count - expected) * (count - expected) / expected;
            freedom++;
        }
    /* 5 standard deviations of chi squared; the seed is fixed. */
    assert_true(chi2 < freedom + 5.0 * sqrt(2.0 * freedom));
    render_environment_free(&environment);
}

/* Rounding of the direction to float crosses a texel's border for about 1 of 1e5 draws. */
static void lookup_agrees_with_sampling(void **state)
{
    (void)state;
    enum { DRAWS = 100000 };
    render_environment environment = random_environment(64, 32, -2.0, 6);
    hnbrdf_rng rng;
    int differ = 0;
    hnbrdf_rng_seed(&rng, 2, 2);
    for (int i = 0; i < DRAWS; i++) {
        double u[2] = {hnbrdf_rng_u32(&rng) * 0x1p-32, hnbrdf_rng_u32(&rng) * 0x1p-32};
        float d[3], drawn[3], seen[3];
        double density = render_environment_sample(&environment, u, d, drawn);
        differ += render_environment_lookup(&environment, d, seen) != density ||
                  memcmp(drawn, seen, sizeof drawn) != 0;
        double length2 = 0.0;
        for (int k = 0; k < 3; k++)
            length2 += (double)d[k] * (double)d[k];
        assert_true(fabs(length2 - 1.0) < 1e-6);
    }
    assert_true(differ <= 10);
    render_environment_free(&environment);
}

/* A sphere of one texel, and of two rows: the height is uniform in [-1, 1], also at the poles. */
static void directions_are_uniform_in_solid_angle_inside_a_texel(void **state)
{
    (void)state;
    enum { DRAWS = 100000, BINS = 50 };
    for (int height = 1; height <= 2; height++) {
        render_image image;
        render_environment environment;
        hnbrdf_rng rng;
        int counts[BINS] = {0};
        assert_int_equal(render_image_create(1, height, 0, &image, NULL), HNBRDF_OK);
        for (int i = 0; i < 3 * height; i++)
            image.rgb[i] = 2.0f;
        assert_int_equal(render_environment_create(&image, 0.0, "white", &environment, NULL),
                         HNBRDF_OK);
        hnbrdf_rng_seed(&rng, 3, 3);
        for (int i = 0; i < DRAWS; i++) {
            double u[2] = {hnbrdf_rng_u32(&rng) * 0x1p-32, hnbrdf_rng_u32(&rng) * 0x1p-32};
            float d[3], radiance[3];
            double density = render_environment_sample(&environment, u, d, radiance);
            assert_true(fabs(density - 0.25 / pi) < 1e-9);
            int bin = (int)(((double)d[1] + 1.0) * 0.5 * BINS);
            counts[bin < BINS ? bin : BINS - 1]++;
        }
        double chi2 = 0.0, expected = (double)DRAWS / BINS;
        for (int i = 0; i < BINS; i++)
            chi2 += (counts[i] - expected) * (counts[i] - expected) / expected;
        assert_true(chi2 < BINS - 1 + 5.0 * sqrt(2.0 * (BINS - 1)));
        render_environment_free(&environment);
    }
}

static void extreme_random_numbers_and_directions_are_harmless(void **state)
{
    (void)state;
    static const double ends[2] = {0.0, 1.0 - 0x1p-32};
    static const float odd[][3] = {{0, 1, 0},       {0, -1, 0},          {0, 0, 0},
                                   {0, 0, 1},       {-0.0f, 0, 1},       {0, 1.001f, 0},
                                   {NAN, NAN, NAN}, {INFINITY, 0, 0},    {0, -2, 0},
                                   {1e-30f, 1, 0},  {0, INFINITY, -0.0f}};
    for (int s = 1; s < SIZES - 2; s++) {
        render_environment environment = random_environment(sizes[s][0], sizes[s][1], 100.0, 4);
        for (int i = 0; i < 4; i++) {
            double u[2] = {ends[i & 1], ends[i >> 1]};
            float d[3], radiance[3];
            assert_true(render_environment_sample(&environment, u, d, radiance) > 0.0);
            assert_true(isfinite(d[0]) && isfinite(d[1]) && isfinite(d[2]));
        }
        for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
            float radiance[3];
            assert_true(isfinite(render_environment_lookup(&environment, odd[i], radiance)));
        }
        render_environment_free(&environment);
    }
}

/* One bright texel in each place that environment.h names. */
static void map_lies_in_the_world_as_documented(void **state)
{
    (void)state;
    static const struct {
        double column, row, rotation; /* column and row as shares of the map */
        float direction[3];
    } cases[] = {
        {0.5, 0.5, 0.0, {0, 0, -1}},       {0.75, 0.5, 0.0, {1, 0, 0}},
        {0.25, 0.5, 0.0, {-1, 0, 0}},      {0.0, 0.5, 0.0, {0, 0, 1}},
        {0.5, 0.0, 0.0, {0, 1, 0}},        {0.5, 1.0, 0.0, {0, -1, 0}},
        {0.5, 0.5, pi / 2.0, {-1, 0, 0}},  {0.5, 0.5, pi, {0, 0, 1}},
        {0.75, 0.5, pi / 2.0, {0, 0, -1}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        enum { WIDTH = 101, HEIGHT = 51 };
        render_image image;
        render_environment environment;
        assert_int_equal(render_image_create(WIDTH, HEIGHT, 0, &image, NULL), HNBRDF_OK);
        int x = (int)(cases[i].column * WIDTH) % WIDTH, y = (int)(cases[i].row * (HEIGHT - 0.5));
        image.rgb[3 * (y * WIDTH + x)] = 1.0f;
        assert_int_equal(
            render_environment_create(&image, cases[i].rotation, "x", &environment, NULL),
            HNBRDF_OK);
        double u[2] = {0.5, 0.5}, along = 0.0;
        float d[3], radiance[3];
        render_environment_sample(&environment, u, d, radiance);
        for (int k = 0; k < 3; k++)
            along += (double)d[k] * (double)cases[i].direction[k];
        assert_true(along > cos(1.5 * 2.0 * pi / WIDTH)); /* within a texel and a half */
        render_environment_free(&environment);
    }
}

static void maps_that_are_no_light_are_refused(void **state)
{
    (void)state;
    static const float values[] = {0.0f, -1.0f, NAN, INFINITY};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        render_image image;
        render_environment environment;
        hnbrdf_error error;
        assert_int_equal(render_image_create(4, 2, 0, &image, NULL), HNBRDF_OK);
        image.rgb[10] = values[i];
        assert_int_equal(render_environment_create(&image, 0.0, "x", &environment, &error),
                         HNBRDF_ERROR_FORMAT);
        assert_true(strlen(error.text) > 10);
        render_image_free(&image);
    }
}

/* What render.h and environment.h promise of the sky, by numerical integration over its texels. */
static void white_diffuse_sphere_under_the_sky_is_near_one(void **state)
{
    (void)state;
    render_environment sky;
    assert_int_equal(render_environment_open("sky", 0.0, NULL, &sky, NULL), HNBRDF_OK);
    double facing = 0.0, peak = 0.0;
    for (int y = 0; y < sky.height; y++)
        for (int x = 0; x < sky.width; x++) {
            float d[3], radiance[3];
            texel_direction(&sky, x + 0.5, y + 0.5, d);
            render_environment_lookup(&sky, d, radiance);
            facing += fmax(0.0, (double)d[2]) * (double)radiance[1] * texel_angle(&sky, y) / pi;
            peak = fmax(peak, (double)radiance[0]);
        }
    assert_true(facing > 0.7 && facing < 1.3);
    assert_true(peak < 500.0);
    assert_true(fabs(render_environment_level(&sky) - 0.56) < 0.01); /* what picture.c relies on */
    render_environment_free(&sky);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turn_is_within_its_error),
        cmocka_unit_test(density_integrates_to_one),
        cmocka_unit_test(sampling_frequencies_match_the_density),
        cmocka_unit_test(lookup_agrees_with_sampling),
        cmocka_unit_test(directions_are_uniform_in_solid_angle_inside_a_texel),
        cmocka_unit_test(extreme_random_numbers_and_directions_are_harmless),
        cmocka_unit_test(map_lies_in_the_world_as_documented),
        cmocka_unit_test(maps_that_are_no_light_are_refused),
        cmocka_unit_test(white_diffuse_sphere_under_the_sky_is_near_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
