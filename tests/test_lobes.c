/* test_lobes.c: hnbrdf_lobes_fit() makes lobes that sample with less variance, and nothing else
 * of a material changes; what it does with materials that are black, extreme or neural. */
#include "core_support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Relative variance of one sample under even light, mean over views, from draws of the sampler
 * itself. */
static double variance(const hnbrdf_model *model, const hnbrdf_material *m, uint64_t seed)
{
    enum { VIEWS = 16, DRAWS = 4000 };
    rng r = rng_make(seed);
    double sum = 0.0;
    for (int v = 0; v < VIEWS; v++) {
        double mean = 0.0, square = 0.0;
        float wo[3];
        direction(sqrt((v + 0.5) / VIEWS), 2.4 * v, wo);
        for (int k = 0; k < DRAWS; k++) {
            const float u[2] = {rng_float(&r), rng_float(&r)};
            hnbrdf_sample_result s;
            hnbrdf_sample(model, m, wo, u, &s);
            for (int c = 0; c < 3; c++) {
                mean += (double)s.weight[c] / DRAWS / 3;
                square += (double)s.weight[c] * (double)s.weight[c] / DRAWS / 3;
            }
        }
        sum += (square / (mean * mean) - 1.0) / VIEWS;
    }
    return sum;
}

static hnbrdf_lobes fit(const hnbrdf_model *model, const hnbrdf_material *material)
{
    hnbrdf_lobes lobes;
    hnbrdf_error error = {""};
    if (hnbrdf_lobes_fit(model, material, &lobes, &error))
        fail_msg("%s", error.text);
    hnbrdf_material m = *material;
    m.lobes = lobes;
    if (hnbrdf_material_check(&m, &error))
        fail_msg("%s", error.text);
    return lobes;
}

static hnbrdf_material ggx(float alpha_x, float alpha_y, float kd, float eta)
{
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    for (int c = 0; c < 3; c++) {
        m.kd[c] = kd;
        m.eta[c] = eta;
    }
    m.alpha[0] = alpha_x;
    m.alpha[1] = alpha_y;
    return m;
}

/* 64,000 draws know a variance to some per cent; the guess is off by factors where it is bad. */
static void fitted_lobes_sample_better_than_the_guess(void **state)
{
    (void)state;
    static const struct {
        float alpha[2], kd, eta;
        double most; /* of the guess's variance */
    } cases[] = {{{0.05f, 0.05f}, 0.3f, 1.5f, 0.9},
                 {{0.3f, 0.3f}, 0.02f, 1.3f, 0.7},
                 {{0.4f, 0.05f}, 0.1f, 1.5f, 0.9},
                 {{0.001f, 0.001f}, 0.0f, 5.0f, 0.6},
                 {{1.0f, 1.0f}, 0.5f, 1.5f, 1.02}};
    rng r = rng_make(60);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        hnbrdf_material m = ggx(cases[k].alpha[0], cases[k].alpha[1], cases[k].kd, cases[k].eta);
        double before = variance(model, &m, 61);
        m.lobes = fit(model, &m);
        double after = variance(model, &m, 61);
        print_message("    alpha %g %g: %.3g, guessed %.3g\n", (double)m.alpha[0],
                      (double)m.alpha[1], after, before);
        assert_true(after <= cases[k].most * before);
    }
    hnbrdf_model_free(model);
}

/* A network whose correction glares where GGX is dark: f = exp(c), c falling with the angle
 * between normal and half vector. The material's own lobe is a mirror and misses it. */
static void lobes_follow_the_correction(void **state)
{
    (void)state;
    float weights0[1][10] = {{-6.0f, 0, 0, 0, 0, 0, 0, 0, 0, 0}}, bias0[1] = {6.0f};
    float weights1[6][1] = {{1.0f}, {1.0f}, {1.0f}, {0}, {0}, {0}},
          bias1[6] = {-5.0f, -5.0f, -5.0f, 0, 0, 0};
    hnbrdf_material m = ggx(0.002f, 0.002f, 0.05f, 1.5f);
    const char *name = "glare";
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_HYBRID,
                              .encoding = HNBRDF_ENCODING_ANGLES,
                              .hidden = 1,
                              .layers = 1,
                              .latent = 4,
                              .material_count = 1,
                              .materials = &m,
                              .names = &name,
                              .weights = {weights0[0], weights1[0]},
                              .biases = {bias0, bias1}};
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_model_create(&desc, NULL, &model, &error))
        fail_msg("%s", error.text);
    double before = variance(model, &m, 62);
    m.lobes = fit(model, &m);
    double after = variance(model, &m, 62);
    print_message("    %.3g, guessed %.3g; roughness %.3g and %.3g\n", after, before,
                  (double)(m.lobes.scale[0] * m.alpha[0]), (double)(m.lobes.scale[1] * m.alpha[0]));
    assert_true(after < 0.5 * before);
    hnbrdf_model_free(model);
}

/* Widths between those of the grid: three materials of the shipped model whose lobes lie there have
 * a geometric mean variance of 0.381, and of 0.412 with the nearest of the grid. */
static void widths_are_refined_between_those_of_the_grid(void **state)
{
    (void)state;
    static const char *const names[] = {"chm_light_blue", "vch_golden_yellow", "chm_mint"};
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    double sum = 0.0;
    if (hnbrdf_model_load(HNBRDF_EXAMPLE_MODEL, NULL, &model, &error))
        fail_msg("%s", error.text);
    for (int k = 0; k < 3; k++) {
        int found = hnbrdf_model_find(model, names[k]);
        hnbrdf_material m = *hnbrdf_model_material(model, found);
        m.lobes = fit(model, &m);
        sum += log(variance(model, &m, 67)) / 3.0;
    }
    print_message("    %.4f\n", exp(sum));
    assert_true(exp(sum) < 0.396);
    hnbrdf_model_free(model);
}

static void lobes_depend_on_the_material_alone(void **state)
{
    (void)state;
    rng r = rng_make(63);
    for (int n = 0; n < 3; n++) {
        hnbrdf_model *model = random_model(
            &r, n == 0 ? HNBRDF_KIND_NEURAL : HNBRDF_KIND_HYBRID,
            n == 2 ? HNBRDF_ENCODING_ANGLES_ANISOTROPIC : HNBRDF_ENCODING_ANGLES, 8, 2, 4);
        hnbrdf_material m = random_material(&r, n != 2), turned = m;
        turned.rotation = 1.0f;
        random_lobes(&r, &turned.lobes);
        hnbrdf_lobes a = fit(model, &m), b = fit(model, &m), c = fit(model, &turned);
        assert_memory_equal(&a, &b, sizeof a);
        assert_memory_equal(&a, &c, sizeof a);
        for (int k = 0; k < HNBRDF_LOBES; k++)
            /* promised, but for the rounding to float */
            for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
                assert_true(a.share[k][j] >= 0x1p-6f &&
                            a.share[0][j] + a.share[1][j] <= 1.0f - 0.99f * 0x1p-6f);
        hnbrdf_model_free(model);
    }
}

static void a_black_material_gets_no_lobes(void **state)
{
    (void)state;
    static const hnbrdf_lobes none = {{0.0f, 0.0f}, {{0.0f}}};
    float weights0[1][6] = {{0}}, bias0[1] = {0}, weights1[3][1] = {{0}},
          bias1[3] = {-60.0f, -60.0f, -60.0f};
    hnbrdf_material m = ggx(0.5f, 0.5f, 0.0f, 1.5f);
    const char *name = "black";
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_NEURAL,
                              .encoding = HNBRDF_ENCODING_ANGLES,
                              .hidden = 1,
                              .layers = 1,
                              .material_count = 1,
                              .materials = &m,
                              .names = &name,
                              .floor = 0.003f,
                              .weights = {weights0[0], weights1[0]},
                              .biases = {bias0, bias1}};
    hnbrdf_model *model = NULL;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
    hnbrdf_lobes lobes = fit(model, &m);
    assert_memory_equal(&lobes, &none, sizeof none);
    hnbrdf_model_free(model);
}

static void extreme_materials_get_legal_lobes(void **state)
{
    (void)state;
    static const float alphas[] = {HNBRDF_MIN_ALPHA, 1e-3f, 1.0f},
                       etas[] = {1.0f + 0x1p-23f, 1.5f, HNBRDF_MAX_ETA};
    rng r = rng_make(64);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES, 8, 1, 4);
    for (int k = 0; k < 27; k++) {
        hnbrdf_material m = ggx(alphas[k % 3], alphas[k / 3 % 3], k % 2 ? 1.0f : 0.0f, etas[k / 9]);
        fit(model, &m);
    }
    hnbrdf_model_free(model);
}

static void bad_arguments_are_refused(void **state)
{
    (void)state;
    rng r = rng_make(65);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    hnbrdf_material m = ggx(0.5f, 0.5f, 0.5f, 1.5f);
    hnbrdf_lobes lobes = {{7.0f, 7.0f}, {{0.0f}}}, before = lobes;
    hnbrdf_error error = {""};
    assert_int_equal(hnbrdf_lobes_fit(NULL, &m, &lobes, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_lobes_fit(model, NULL, &lobes, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_lobes_fit(model, &m, NULL, &error), HNBRDF_ERROR_ARGUMENT);
    m.alpha[1] = NAN;
    assert_int_equal(hnbrdf_lobes_fit(model, &m, &lobes, &error), HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "alpha[1]"));
    assert_memory_equal(&lobes, &before, sizeof lobes);
    hnbrdf_model_free(model);
}

/* Between two fitted materials shares stay shares, whatever rounding does. */
static void mixed_lobes_stay_legal(void **state)
{
    (void)state;
    rng r = rng_make(66);
    for (int k = 0; k < 20000; k++) {
        hnbrdf_material a = random_material(&r, 1), b = random_material(&r, 1), m;
        hnbrdf_error error = {""};
        random_lobes(&r, &a.lobes);
        random_lobes(&r, &b.lobes);
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
            b.lobes.share[0][j] = 1.0f - (b.lobes.share[1][j] = rng_float(&r));
        hnbrdf_material_mix(&a, &b, rng_float(&r), &m);
        if (hnbrdf_material_check(&m, &error))
            fail_msg("%s", error.text);
        int same = (a.lobes.scale[0] < 0) == (b.lobes.scale[0] < 0) &&
                   (a.lobes.scale[1] < 0) == (b.lobes.scale[1] < 0);
        assert_int_equal(same, m.lobes.scale[0] != 0.0f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fitted_lobes_sample_better_than_the_guess),
        cmocka_unit_test(lobes_follow_the_correction),
        cmocka_unit_test(widths_are_refined_between_those_of_the_grid),
        cmocka_unit_test(lobes_depend_on_the_material_alone),
        cmocka_unit_test(a_black_material_gets_no_lobes),
        cmocka_unit_test(extreme_materials_get_legal_lobes),
        cmocka_unit_test(bad_arguments_are_refused),
        cmocka_unit_test(mixed_lobes_stay_legal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
