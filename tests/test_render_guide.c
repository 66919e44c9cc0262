/* test_render_guide.c: guides are densities that their samples follow, and take noise away, not
 * light. */
#include "render/render.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;
static hnbrdf_model *ggx;
static render_environment sky;

static int open_all(void **state)
{
    (void)state;
    return render_guide_model(&ggx, NULL) || render_environment_open("sky", 0.0, NULL, &sky, NULL);
}

static int close_all(void **state)
{
    (void)state;
    hnbrdf_model_free(ggx);
    render_environment_free(&sky);
    return 0;
}

static hnbrdf_measured *open_builtin(int index)
{
    hnbrdf_measured *measured;
    assert_int_equal(hnbrdf_measured_open_builtin(index, &measured, NULL), HNBRDF_OK);
    return measured;
}

static render_surface guided(const hnbrdf_measured *measured)
{
    render_surface surface = render_surface_measured(measured);
    const render_surface *one = &surface;
    render_guide guide = render_guide_fit(&one, 1, ggx);
    render_surface_guide(&surface, &guide);
    return surface;
}

static void shares_sum_to_one_and_keep_a_broad_lobe(void **state)
{
    (void)state;
    for (int i = 0; i < hnbrdf_measured_builtin_count(); i++) {
        hnbrdf_measured *measured = open_builtin(i);
        render_surface surface = guided(measured);
        const render_guide *guide = &surface.guide;
        double sum = 0.0, broad = 0.0;
        assert_in_range(guide->count, 1, RENDER_LOBES);
        for (int k = 0; k < guide->count; k++) {
            sum += (double)guide->lobes[k].share;
            if (guide->lobes[k].material.alpha[0] == 1.0f)
                broad += (double)guide->lobes[k].share;
        }
        assert_true(fabs(sum - 1.0) < 1e-6);
        assert_true(broad > 0.05);
        hnbrdf_measured_close(measured);
    }
}

/* Frequencies in 12 x 8 cells of the projected hemisphere against the density, integrated there
 * on a grid of midpoints; lobes of alpha 0.1 and more are wide enough for it. A chi-squared test.
 */
static void samples_follow_the_density(void **state)
{
    (void)state;
    enum { RINGS = 8, SECTORS = 12, GRID = 60, DRAWS = 200000 };
    render_surface surface = {.guide = {.model = ggx, .count = 3}};
    static const float alphas[3] = {1.0f, 0.25f, 0.35f}, shares[3] = {0.2f, 0.3f, 0.5f};
    for (int k = 0; k < 3; k++) {
        hnbrdf_material_init(&surface.guide.lobes[k].material);
        surface.guide.lobes[k].material.alpha[0] = alphas[k];
        surface.guide.lobes[k].material.alpha[1] = k == 2 ? 0.1f : alphas[k];
        surface.guide.lobes[k].retro = k == 1;
        surface.guide.lobes[k].share = shares[k];
    }
    render_guide guide = surface.guide;
    render_surface_guide(&surface, &guide);
    const float wo[3] = {0.48f, -0.36f, 0.8f};
    int counts[RINGS * SECTORS] = {0}, lost = 0;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 1);
    for (int i = 0; i < DRAWS; i++) {
        float u[3] = {hnbrdf_rng_float(&rng), hnbrdf_rng_float(&rng), hnbrdf_rng_float(&rng)},
              wi[3];
        float pdf = surface.sample(&surface, wo, u, wi);
        if (!(pdf > 0.0f)) {
            lost++;
            continue;
        }
        assert_true(pdf == surface.pdf(&surface, wi, wo)); /* one density, to the bit */
        double r2 = 1.0 - (double)wi[2] * (double)wi[2];
        int ring = (int)(r2 * RINGS),
            sector = (int)((atan2((double)wi[1], (double)wi[0]) / pi + 1.0) * SECTORS / 2);
        counts[(ring < RINGS ? ring : RINGS - 1) * SECTORS +
               (sector < SECTORS ? sector : SECTORS - 1)]++;
    }
    double chi2 = 0.0, total = 0.0;
    for (int cell = 0; cell < RINGS * SECTORS; cell++) {
        double integral = 0.0;
        for (int i = 0; i < GRID * GRID; i++) {
            double r2 = (cell / SECTORS + (i / GRID + 0.5) / GRID) / RINGS, z = sqrt(1.0 - r2),
                   r = sqrt(r2);
            double phi = ((cell % SECTORS + (i % GRID + 0.5) / GRID) * 2.0 / SECTORS - 1.0) * pi;
            float wi[3] = {(float)(r * cos(phi)), (float)(r * sin(phi)), (float)z};
            /* solid angle: d phi d(r^2) / (2 z) */
            integral += (double)surface.pdf(&surface, wi, wo) * (pi / SECTORS) / (RINGS * z) /
                        (GRID * GRID);
        }
        total += integral;
        double expected = integral * DRAWS;
        assert_true(expected > 20.0);
        chi2 += pow(counts[cell] - expected, 2.0) / expected;
    }
    /* 5 standard deviations of chi squared, and 1 % of room for the midpoint rule where z goes to
     * 0. */
    assert_true(chi2 < 1.01 * (RINGS * SECTORS + 5.0 * sqrt(2.0 * RINGS * SECTORS)));
    assert_true(fabs(total + (double)lost / DRAWS - 1.0) < 0.01);
}

static double mean(const render_surface *surface, render_strategy strategy, int spp, uint64_t seed,
                   double *noise)
{
    enum { SIZE = 32 };
    render_options options = {.size = SIZE, .spp = spp, .strategy = strategy};
    render_image images[2];
    double sum = 0.0, squares = 0.0, covered = 0.0;
    for (int i = 0; i < 2; i++) {
        options.seed = seed + (uint64_t)i;
        assert_int_equal(render_sphere(surface, &sky, &options, &images[i], NULL), HNBRDF_OK);
    }
    for (int i = 0; i < SIZE * SIZE; i++) {
        double a = (double)images[0].rgb[3 * i + 1], b = (double)images[1].rgb[3 * i + 1];
        sum += 0.5 * (a + b);
        squares += 0.25 * (a - b) * (a - b);
        covered += (double)images[0].alpha[i];
    }
    render_image_free(&images[0]);
    render_image_free(&images[1]);
    *noise = sqrt(squares) / covered;
    return sum / covered;
}

/* Every built-in material, retroreflecting and anisotropic ones too: with its guide the joint
 * estimate agrees with light sampling alone, which knows nothing of guides, within 5 standard
 * errors. */
static void guides_do_not_bias(void **state)
{
    (void)state;
    for (int i = 0; i < hnbrdf_measured_builtin_count(); i++) {
        hnbrdf_measured *measured = open_builtin(i);
        render_surface surface = guided(measured);
        double noise_mis, noise_light;
        double mis = mean(&surface, RENDER_MIS, 32, 1, &noise_mis);
        double light = mean(&surface, RENDER_LIGHT, 256, 3, &noise_light);
        if (fabs(mis - light) > 5.0 * hypot(noise_mis, noise_light))
            fail_msg("%s: %g +- %g, light alone %g +- %g", hnbrdf_measured_name(measured), mis,
                     noise_mis, light, noise_light);
        hnbrdf_measured_close(measured);
    }
}

static double noise_of(const render_surface *surface)
{
    enum { SEEDS = 8 }; /* of the few bright samples that make it, one rendering sees too few */
    double square = 0.0, noise;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        mean(surface, RENDER_MIS, 32, 5 + 2 * seed, &noise);
        square += noise * noise / SEEDS;
    }
    return sqrt(square);
}

/* Where a material reflects back to the viewer or has a narrow lobe, a cosine lobe alone is much
 * noisier. */
static void guides_take_noise_away(void **state)
{
    (void)state;
    static const char *const names[] = {"near-mirror-chrome", "haze-aluminium", "retro-tape"};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++)
        for (int i = 0; i < hnbrdf_measured_builtin_count(); i++) {
            if (strcmp(hnbrdf_measured_builtin_name(i), names[n]) != 0)
                continue;
            hnbrdf_measured *measured = open_builtin(i);
            render_surface surface = guided(measured);
            double with = noise_of(&surface);
            render_guide cosine = surface.guide;
            cosine.count = 1;
            cosine.lobes[0].share = 1.0f;
            render_surface_guide(&surface, &cosine);
            double without = noise_of(&surface);
            print_message("    %s: %.3g, cosine alone %.3g\n", names[n], with, without);
            assert_true(with < 0.5 * without);
            hnbrdf_measured_close(measured);
        }
}

static void black_eval(const render_surface *surface, size_t count, const float *wi,
                       const float *wo, float *f)
{
    (void)surface, (void)wi, (void)wo;
    memset(f, 0, 3 * count * sizeof *f);
}

static void black_surfaces_get_a_cosine_lobe(void **state)
{
    (void)state;
    render_surface surface = {.eval = black_eval};
    const render_surface *one = &surface;
    render_guide guide = render_guide_fit(&one, 1, ggx);
    render_surface_guide(&surface, &guide);
    double noise;
    assert_true(mean(&surface, RENDER_MIS, 4, 1, &noise) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_sum_to_one_and_keep_a_broad_lobe),
        cmocka_unit_test(samples_follow_the_density),
        cmocka_unit_test(guides_do_not_bias),
        cmocka_unit_test(guides_take_noise_away),
        cmocka_unit_test(black_surfaces_get_a_cosine_lobe),
    };
    return cmocka_run_group_tests(tests, open_all, close_all);
}
