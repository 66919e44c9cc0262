/* test_mix_path.c: a path between two materials reaches both, does not leap, and shows on its way
 * nothing brighter or darker than its ends; on the shipped model, whose straight lines do. */
#include "hnbrdf/edit.h"
#include "hnbrdf/metrics.h"
#include "model_support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { LAST = HNBRDF_MIX_KNOTS - 1, PAIRS = 2, DIRECTIONS = 600 };

typedef hnbrdf_material knots[HNBRDF_MIX_KNOTS];

/* On the straight line between these an albedo is beyond those of both ends by a factor of 2.3, and
 * of 2.4. */
static const char *const names[PAIRS][2] = {{"chm_mint", "paper_white"},
                                            {"irid_flake_paint1", "vch_silk_blue"}};

static struct shipped {
    hnbrdf_model *model;
    const hnbrdf_material *ends[PAIRS][2];
    knots paths[PAIRS];
    float wi[DIRECTIONS][3], wo[DIRECTIONS][3];
} s;

static hnbrdf_model *load(hnbrdf_variant variant, const hnbrdf_allocator *allocator)
{
    hnbrdf_load_options options = {.variant = variant};
    hnbrdf_model *model;
    hnbrdf_error error;
    if (allocator)
        options.allocator = *allocator;
    if (hnbrdf_model_load(HNBRDF_EXAMPLE_MODEL, &options, &model, &error))
        fail_msg("%s", error.text);
    return model;
}

static void fit(const hnbrdf_model *model, const hnbrdf_material *a, const hnbrdf_material *b,
                knots path)
{
    hnbrdf_error error;
    if (hnbrdf_mix_path_fit(model, a, b, path, &error))
        fail_msg("%s", error.text);
}

static int begin(void **state)
{
    hnbrdf_rng draws;
    (void)state;
    s.model = load(HNBRDF_VARIANT_AUTO, NULL);
    for (int p = 0; p < PAIRS; p++) {
        for (int e = 0; e < 2; e++) {
            s.ends[p][e] = hnbrdf_model_material(s.model, hnbrdf_model_find(s.model, names[p][e]));
            assert_non_null(s.ends[p][e]);
        }
        fit(s.model, s.ends[p][0], s.ends[p][1], s.paths[p]);
    }
    hnbrdf_rng_seed(&draws, 11, 0);
    for (int n = 0; n < DIRECTIONS; n++)
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_GRID, &draws, s.wi[n], s.wo[n]);
    return 0;
}

static int end(void **state)
{
    (void)state;
    hnbrdf_model_free(s.model);
    return 0;
}

/* SMAPE of one against the other. */
static double difference(const hnbrdf_model *model, const hnbrdf_material *a,
                         const hnbrdf_material *b)
{
    static float f[2][DIRECTIONS][3];
    double sum = 0.0;
    hnbrdf_eval_batch(model, a, DIRECTIONS, s.wi[0], 0, s.wo[0], 0, f[0][0], 0);
    hnbrdf_eval_batch(model, b, DIRECTIONS, s.wi[0], 0, s.wo[0], 0, f[1][0], 0);
    for (int n = 0; n < DIRECTIONS; n++)
        for (int c = 0; c < 3; c++)
            sum += hnbrdf_smape((double)f[0][n][c], (double)f[1][n][c]);
    return sum / (3 * DIRECTIONS);
}

/* ---- Ends and fields ------------------------------------------------------------------------- */

static void both_ends_are_reached_to_the_bit(void **state)
{
    const float low[] = {0.0f, -0.0f, -3.0f, -INFINITY, NAN}, high[] = {1.0f, 7.0f, INFINITY};
    (void)state;
    for (int p = 0; p < PAIRS; p++) {
        hnbrdf_material m;
        for (int k = 0; k < 5; k++) {
            hnbrdf_mix_path_at(s.paths[p], low[k], &m);
            assert_memory_equal(&m, s.ends[p][0], sizeof m);
        }
        for (int k = 0; k < 3; k++) {
            hnbrdf_mix_path_at(s.paths[p], high[k], &m);
            assert_memory_equal(&m, s.ends[p][1], sizeof m);
        }
        for (int k = 0; k <= LAST; k++) { /* and so is every knot */
            hnbrdf_mix_path_at(s.paths[p], (float)k / LAST, &m);
            assert_memory_equal(&m, &s.paths[p][k], sizeof m);
        }
    }
}

static void every_material_is_legal(void **state)
{
    (void)state;
    for (int p = 0; p < PAIRS; p++)
        for (int k = 0; k <= 4 * LAST; k++) {
            hnbrdf_material m;
            hnbrdf_error error;
            hnbrdf_mix_path_at(s.paths[p], (float)k / (4 * LAST), &m);
            if (hnbrdf_material_check(&m, &error))
                fail_msg("%s to %s: %s", names[p][0], names[p][1], error.text);
        }
}

static void variants_and_repetitions_give_the_same_bits(void **state)
{
    hnbrdf_model *model = example_model(3, HNBRDF_KIND_HYBRID, 8, 1, 2, 2, 0), *plain;
    hnbrdf_model_desc desc;
    knots path, same;
    (void)state;
    hnbrdf_model_describe(model, &desc);
    desc.variant = HNBRDF_VARIANT_PLAIN;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &plain, NULL), HNBRDF_OK);
    fit(model, hnbrdf_model_material(model, 0), hnbrdf_model_material(model, 1), path);
    same[4] = *hnbrdf_model_material(plain, 0); /* which the path overwrites */
    fit(plain, &same[4], hnbrdf_model_material(plain, 1), same);
    assert_memory_equal(path, same, sizeof path);
    hnbrdf_model_free(plain);
    hnbrdf_model_free(model);
}

/* ---- What it looks like ---------------------------------------------------------------------- */

/* The largest factor by which an albedo is beyond those of the ends, as `report editing` has it. */
static double beyond(int pair, const hnbrdf_material *m)
{
    static const double dark = 1e-3;
    double worst = 0.0;
    for (int view = 0; view < 3; view++) {
        double theta = view * 3.14159265358979323846 / 6, a[3], b[3], x[3];
        const float wo[3] = {(float)sin(theta), 0.0f, (float)cos(theta)};
        hnbrdf_albedo(s.model, s.ends[pair][0], wo, a);
        hnbrdf_albedo(s.model, s.ends[pair][1], wo, b);
        hnbrdf_albedo(s.model, m, wo, x);
        for (int c = 0; c < 3; c++) {
            double value = fmax(x[c], dark);
            worst = fmax(worst, fmax(value / fmax(fmax(a[c], b[c]), dark),
                                     fmax(fmin(a[c], b[c]), dark) / value));
        }
    }
    return worst;
}

/* The documented few per cent: 3 that the fit allows, and what its coarse sums are off: in all less
 * than the tenth that `report editing` allows; the straight line is out by more. Places at and
 * between knots. */
static void albedo_stays_between_the_ends(void **state)
{
    enum { STEPS = 10 };
    (void)state;
    for (int p = 0; p < PAIRS; p++) {
        double straight = 0.0, path = 0.0;
        for (int k = 1; k < STEPS; k++) {
            hnbrdf_material m;
            float t = (float)k / STEPS;
            hnbrdf_material_mix(s.ends[p][0], s.ends[p][1], t, &m);
            straight = fmax(straight, beyond(p, &m));
            hnbrdf_mix_path_at(s.paths[p], t, &m);
            path = fmax(path, beyond(p, &m));
        }
        print_message("    %s to %s: straight %.3f, path %.3f\n", names[p][0], names[p][1],
                      straight, path);
        assert_true(path < 1.1 && straight > 1.1);
    }
}

/* From one region of the latent space to another it would be about as far as from end to end: no
 * step is half as far. (A quarter is where the largest is.) */
static void the_path_does_not_leap(void **state)
{
    enum { STEPS = 2 * LAST };
    (void)state;
    for (int p = 0; p < PAIRS; p++) {
        double most = 0.0;
        hnbrdf_material from = *s.ends[p][0], to;
        for (int k = 1; k <= STEPS; k++) {
            hnbrdf_mix_path_at(s.paths[p], (float)k / STEPS, &to);
            most = fmax(most, difference(s.model, &from, &to));
            from = to;
        }
        assert_true(most < 0.5 * difference(s.model, s.ends[p][0], s.ends[p][1]));
    }
}

/* A material and its own edit differ in alpha alone: between them lie its other edits, where those
 * have albedos between those of the ends. */
static void the_way_to_an_edit_is_made_of_edits(void **state)
{
    const hnbrdf_material *a = s.ends[1][0];
    hnbrdf_material b = *a, half = *a, m;
    knots path;
    (void)state;
    for (int k = 0; k < 2; k++) {
        b.alpha[k] = a->alpha[k] * 2.0f;
        half.alpha[k] = a->alpha[k] * sqrtf(2.0f);
    }
    fit(s.model, a, &b, path);
    hnbrdf_mix_path_at(path, 0.5f, &m);
    assert_true(difference(s.model, &m, &half) < 1e-3);
    fit(s.model, a, a, path);
    for (int k = 0; k <= LAST; k++)
        assert_true(difference(s.model, &path[k], a) < 1e-6);
}

/* ---- Other kinds ----------------------------------------------------------------------------- */

static void a_ggx_model_goes_straight(void **state)
{
    hnbrdf_model *model = example_model(5, HNBRDF_KIND_GGX, 0, 0, 0, 2, 0);
    const hnbrdf_material *a = hnbrdf_model_material(model, 0),
                          *b = hnbrdf_model_material(model, 1);
    knots path;
    (void)state;
    fit(model, a, b, path);
    for (int k = 0; k <= LAST; k++) {
        hnbrdf_material m;
        hnbrdf_material_mix(a, b, (float)k / LAST, &m);
        assert_memory_equal(&path[k], &m, sizeof m);
    }
    hnbrdf_model_free(model);
}

/* Rotated, anisotropic, any encoding: legal, and of a neural model the latent code alone moves. */
static void random_models_have_paths(void **state)
{
    (void)state;
    for (int kind = HNBRDF_KIND_HYBRID; kind <= HNBRDF_KIND_NEURAL; kind++) {
        hnbrdf_model *model = example_model(7, (hnbrdf_kind)kind, 8, 1, 3, 2, 1);
        const hnbrdf_material *a = hnbrdf_model_material(model, 0),
                              *b = hnbrdf_model_material(model, 1);
        knots path;
        fit(model, a, b, path);
        for (int k = 0; k <= LAST; k++) {
            hnbrdf_material m;
            hnbrdf_material_mix(a, b, (float)k / LAST, &m);
            assert_int_equal(hnbrdf_material_check(&path[k], NULL), HNBRDF_OK);
            assert_true(path[k].rotation == m.rotation);
            memcpy(m.latent, path[k].latent, sizeof m.latent);
            if (kind == HNBRDF_KIND_NEURAL)
                assert_memory_equal(&path[k], &m, sizeof m);
        }
        hnbrdf_model_free(model);
    }
}

/* Two materials of a fit, between whose codes the network's exponent is beyond what is computed:
 * where the path began there, nothing had a slope, and it stayed, with an albedo of 1e35. */
static void a_path_does_not_stay_where_nothing_has_a_slope(void **state)
{
    hnbrdf_model *model;
    hnbrdf_error error;
    knots path;
    (void)state;
    if (hnbrdf_model_load(HNBRDF_TEST_DATA "/mix_lost.safetensors", NULL, &model, &error))
        fail_msg("%s", error.text);
    fit(model, hnbrdf_model_material(model, 0), hnbrdf_model_material(model, 1), path);
    for (int k = 0; k <= LAST; k++)
        for (int view = 0; view < 3; view++) {
            const double theta = view * 3.14159265358979323846 / 6;
            const float wo[3] = {(float)sin(theta), 0.0f, (float)cos(theta)};
            double albedo[3];
            hnbrdf_albedo(model, &path[k], wo, albedo);
            for (int c = 0; c < 3; c++)
                assert_true(albedo[c] < 1.0);
        }
    hnbrdf_model_free(model);
}

/* ---- Refusals -------------------------------------------------------------------------------- */

static void what_is_wrong_is_refused(void **state)
{
    const hnbrdf_material *a = s.ends[0][0];
    hnbrdf_material wrong = *a;
    hnbrdf_error error;
    counting count = {.fail_at = -1};
    hnbrdf_allocator allocator = counting_allocator(&count);
    hnbrdf_model *model = load(HNBRDF_VARIANT_AUTO, &allocator);
    knots path, before;
    (void)state;
    memset(path, 7, sizeof path);
    memcpy(before, path, sizeof path);
    wrong.kd[1] = 2.0f;
    assert_int_equal(hnbrdf_mix_path_fit(NULL, a, a, path, &error), HNBRDF_ERROR_ARGUMENT);
    assert_string_equal(error.text, "model is NULL");
    assert_int_equal(hnbrdf_mix_path_fit(model, a, NULL, path, &error), HNBRDF_ERROR_ARGUMENT);
    assert_string_equal(error.text, "b is NULL");
    assert_int_equal(hnbrdf_mix_path_fit(model, a, a, NULL, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_mix_path_fit(model, a, &wrong, path, &error), HNBRDF_ERROR_ARGUMENT);
    assert_string_equal(error.text, "material b: kd[1] is 2, expected 0 to 1");
    const long alive = count.alive;
    count.fail_at = count.calls;
    assert_int_equal(hnbrdf_mix_path_fit(model, a, a, path, &error), HNBRDF_ERROR_MEMORY);
    assert_memory_equal(path, before, sizeof path);
    count.fail_at = -1;
    fit(model, a, a, path);
    assert_int_equal(count.alive, alive);
    hnbrdf_model_free(model);
    assert_int_equal(count.alive, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_ends_are_reached_to_the_bit),
        cmocka_unit_test(every_material_is_legal),
        cmocka_unit_test(variants_and_repetitions_give_the_same_bits),
        cmocka_unit_test(albedo_stays_between_the_ends),
        cmocka_unit_test(the_path_does_not_leap),
        cmocka_unit_test(the_way_to_an_edit_is_made_of_edits),
        cmocka_unit_test(a_ggx_model_goes_straight),
        cmocka_unit_test(random_models_have_paths),
        cmocka_unit_test(a_path_does_not_stay_where_nothing_has_a_slope),
        cmocka_unit_test(what_is_wrong_is_refused),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
