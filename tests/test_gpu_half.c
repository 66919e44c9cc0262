/* test_gpu_half.c: the half-precision variant of the exported network, in C: its rounding, its
 * limits, what it costs. That devices compute the same is test_gpu_verify.c's. */
#include "gpu_support.h"

#include "core/network.h"
#include "check/half.h"
#include "check/pairs.h"
#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"
#include "glsl/half.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const scene_shape SHAPE = {
    .encoding = HNBRDF_ENCODING_ANGLES_DIRECTED, .hidden = 16, .layers = 3, .latent = 4};

/* The model with every weight and bias of its network times `factor`. */
static hnbrdf_model *scaled(const hnbrdf_model *model, float factor)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    float *copies[2 * (HNBRDF_MAX_LAYERS + 1)] = {0};
    for (int k = 0; k <= desc.layers; k++) {
        int rows = hnbrdf_layer_outputs(&desc, k), size = rows * hnbrdf_layer_inputs(&desc, k);
        float *w = copies[2 * k] = malloc((size_t)size * sizeof *w);
        float *b = copies[2 * k + 1] = malloc((size_t)rows * sizeof *b);
        assert_true(w && b);
        for (int i = 0; i < size; i++)
            w[i] = factor * desc.weights[k][i];
        for (int i = 0; i < rows; i++)
            b[i] = factor * desc.biases[k][i];
        desc.weights[k] = w;
        desc.biases[k] = b;
    }
    hnbrdf_model *made = NULL;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &made, NULL), HNBRDF_OK);
    for (int i = 0; i < 2 * (desc.layers + 1); i++)
        free(copies[i]);
    return made;
}

/* ---- Nothing overflows ----------------------------------------------------------------------- */

/* Inputs at the limit with the sign of each weight make the largest sum there can be: it is still
 * finite, and so is every sum on the way, here with every rounding upwards, which hardware may
 * do. */
static void no_sum_of_a_layer_passes_the_largest_half(void **state)
{
    (void)state;
    static const float factors[] = {1e-3f, 1.0f, 100.0f, 1e4f, 1e30f};
    hnbrdf_model *model = scene_model(&SHAPE);
    for (size_t f = 0; f < sizeof factors / sizeof factors[0]; f++) {
        hnbrdf_model *large = scaled(model, factors[f]);
        const hnbrdf_model_desc *desc = &large->desc;
        for (int k = 0; k < desc->layers; k++) {
            double limit = (double)hnbrdf_half_limit(desc, k);
            int columns = hnbrdf_layer_inputs(desc, k);
            assert_true(limit >= 0.1875 && limit <= 60000.0); /* HardGELU's minimum is never cut */
            for (int row = 0; row < desc->hidden; row++) {
                double sum = fabs((double)hnbrdf_half_bias(desc, k, desc->biases[k][row]));
                for (int i = 0; i < columns; i++) {
                    double w = fabs(
                        (double)hnbrdf_half_weight(desc, k, desc->weights[k][row * columns + i]));
                    sum = (sum + w * limit * (1.0 + 0x1p-10)) * (1.0 + 0x1p-10);
                }
                assert_true(sum <= 65504.0);
            }
        }
        hnbrdf_model_free(large);
    }
    hnbrdf_model_free(model);
}

static void every_value_is_finite_whatever_weights_and_directions(void **state)
{
    (void)state;
    static const float factors[] = {1.0f, 100.0f, 1e4f, 1e30f};
    hnbrdf_model *model = scene_model(&SHAPE);
    for (size_t k = 0; k < sizeof factors / sizeof factors[0]; k++) {
        hnbrdf_model *large = scaled(model, factors[k]);
        hnbrdf_material material = *hnbrdf_model_material(large, 1);
        float pair[6] = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f}, f[3];
        hnbrdf_rng rng;
        hnbrdf_rng_seed(&rng, 5, k);
        for (size_t i = 0; i < 4096; i++) {
            material.latent[i % 4] = i % 3 == 0 ? 1e30f : i % 3 == 1 ? NAN : -2.0f;
            check_pair_draw(&rng, i, pair);
            check_half_eval(large, &material, pair, pair + 3, f);
            for (int c = 0; c < 3; c++)
                assert_true(f[c] >= 0.0f && f[c] <= HNBRDF_MAX_VALUE);
        }
        hnbrdf_model_free(large);
    }
    hnbrdf_model_free(model);
}

/* ---- Bounds ---------------------------------------------------------------------------------- */

/* A device that does not round as half.h does: single precision everywhere, with the same
 * weights. */
static void other_device(const hnbrdf_model_desc *desc, const float *latent, const float x[6],
                         float out[6])
{
    float a[HNBRDF_MAX_HIDDEN], b[HNBRDF_MAX_HIDDEN], first = hnbrdf_half_limit(desc, 0);
    for (int i = 0; i < 6 + desc->latent; i++)
        a[i] = fminf(fmaxf(i < 6 ? x[i] : latent[i - 6], -first), first);
    for (int k = 0; k <= desc->layers; k++) {
        int columns = hnbrdf_layer_inputs(desc, k);
        float limit = k < desc->layers ? hnbrdf_half_limit(desc, k + 1) : 0.0f;
        for (int row = 0; row < hnbrdf_layer_outputs(desc, k); row++) {
            float sum = hnbrdf_half_bias(desc, k, desc->biases[k][row]);
            for (int i = 0; i < columns; i++)
                sum += hnbrdf_half_weight(desc, k, desc->weights[k][row * columns + i]) * a[i];
            b[row] = k < desc->layers ? fminf(hnbrdf_hard_gelu(sum), limit) : sum;
        }
        memcpy(a, b, sizeof a);
    }
    memcpy(out, a, 6 * sizeof *out);
}

static void bounds_hold_for_a_device_that_rounds_otherwise(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&SHAPE);
    const hnbrdf_material *material = hnbrdf_model_material(model, 0);
    const check_arithmetic nothing = {0};
    check_rules rules = check_rules_fast(&nothing, 0);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 9, 0);
    int differ = 0;
    for (int k = 0; k < 500; k++) {
        float wi[3], wo[3], x[6], out[6];
        check_bounds bounds;
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        check_bounds_make(&rules, &model->desc, HNBRDF_GLSL_HALF, material, wi, wo, 0.0, &bounds);
        for (int i = 0; i < 6; i++)
            x[i] = bounds.encoding[i].v;
        other_device(&model->desc, material->latent, x, out);
        for (int i = 0; i < 6; i++) {
            assert_true(fabs((double)out[i] - (double)bounds.fed[i].v) <= bounds.fed[i].e);
            differ += out[i] != bounds.fed[i].v;
        }
    }
    assert_true(differ > 2000); /* of 3000: it is another device */
    hnbrdf_model_free(model);
}

/* The half next to x above it or below it; Vulkan lets every operation give either. */
static float rounded_towards(int up, float x)
{
    float nearest = hnbrdf_round_to_half(x);
    if (up ? nearest >= x : nearest <= x)
        return nearest;
    uint16_t bits = hnbrdf_half_of(nearest);
    return hnbrdf_float_of_half((uint16_t)(up == !(bits >> 15) ? bits + 1 : bits - 1));
}

/* A unit of the first layer with every rounding on the way making it larger, or smaller. */
static float pushed_unit(const hnbrdf_model_desc *desc, const float *latent, const float x[6],
                         int row, int up)
{
    int columns = hnbrdf_layer_inputs(desc, 0);
    float first = hnbrdf_half_limit(desc, 0), sum = hnbrdf_half_bias(desc, 0, desc->biases[0][row]);
    for (int i = 0; i < columns; i++) {
        int column = i < desc->latent ? 6 + i : i - desc->latent;
        float w = hnbrdf_half_weight(desc, 0, desc->weights[0][row * columns + column]);
        float input = fminf(fmaxf(column < 6 ? x[column] : latent[column - 6], -first), first);
        float product = w * rounded_towards(up == (w > 0.0f), input);
        sum = rounded_towards(up, sum + rounded_towards(up, product));
    }
    float third = hnbrdf_round_to_half(0.333251953f);
    float t = rounded_towards(up, rounded_towards(up, sum * third) + 0.5f);
    float unit = rounded_towards(up, sum * fminf(fmaxf(t, 0.0f), 1.0f));
    return fminf(unit, hnbrdf_half_limit(desc, 1));
}

/* One hidden layer, each of its units pushed to where an output grows: every rounding adds up,
 * and the bounds hold. Errors reach a twentieth of them, so bounds twenty times too small would
 * not. */
static void bounds_hold_where_every_rounding_pushes_one_way(void **state)
{
    (void)state;
    scene_shape shape = SHAPE;
    shape.layers = 1;
    hnbrdf_model *model = scene_model(&shape);
    const hnbrdf_model_desc *desc = &model->desc;
    const hnbrdf_material *material = hnbrdf_model_material(model, 0);
    const check_arithmetic nothing = {0};
    check_rules rules = check_rules_fast(&nothing, 0);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 10, 0);
    double share = 0.0;
    for (int k = 0; k < 500; k++) {
        float wi[3], wo[3], x[6];
        check_bounds bounds;
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        check_bounds_make(&rules, desc, HNBRDF_GLSL_HALF, material, wi, wo, 0.0, &bounds);
        for (int i = 0; i < 6; i++)
            x[i] = bounds.encoding[i].v;
        for (int row = 0; row < hnbrdf_layer_outputs(desc, 1); row++) {
            const float *w = desc->weights[1] + row * desc->hidden;
            float out = desc->biases[1][row];
            for (int i = 0; i < desc->hidden; i++)
                out += w[i] * pushed_unit(desc, material->latent, x, i, w[i] > 0.0f);
            double error = fabs((double)out - (double)bounds.fed[row].v);
            assert_true(error <= bounds.fed[row].e);
            share = fmax(share, error / bounds.fed[row].e);
        }
    }
    print_message("largest error: %.3f of its bound\n", share);
    assert_true(share >= 0.05);
    hnbrdf_model_free(model);
}

/* ---- What it costs --------------------------------------------------------------------------- */

enum { COST_PAIRS = 4000 };

/* SMAPE of the half variant less that of hnbrdf_eval(), on the same pairs. */
static double cost(const hnbrdf_model *model, const hnbrdf_measured *measured, int index)
{
    const hnbrdf_material *material = hnbrdf_model_material(model, index);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, (uint64_t)index);
    double sum = 0.0;
    for (int k = 0; k < COST_PAIRS;) {
        float wi[3], wo[3], truth[3], single[3], half[3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        if (!hnbrdf_measured_eval(measured, wi, wo, truth))
            continue;
        hnbrdf_eval(model, material, wi, wo, single);
        check_half_eval(model, material, wi, wo, half);
        for (int c = 0; c < 3; c++)
            sum += hnbrdf_smape(half[c], truth[c]) - hnbrdf_smape(single[c], truth[c]);
        k++;
    }
    return sum / (3.0 * COST_PAIRS);
}

/* The bar of the project: SMAPE worse by at most 0.002. */
static void a_fit_loses_at_most_two_thousandths(void **state)
{
    (void)state;
    enum { FITTED = 3 };
    hnbrdf_measured *data[FITTED];
    hnbrdf_model *model = NULL;
    const hnbrdf_fit_options options = {
        .hidden = 16, .layers = 2, .latent = 4, .steps = 300, .pool = 8192};
    double mean = 0.0;
    for (int k = 0; k < FITTED; k++)
        assert_int_equal(hnbrdf_measured_open_builtin(3 * k, &data[k], NULL), HNBRDF_OK);
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)data, FITTED, &options, &model, NULL, NULL),
        HNBRDF_OK);
    for (int k = 0; k < FITTED; k++) {
        mean += cost(model, data[k], k) / FITTED;
        hnbrdf_measured_close(data[k]);
    }
    print_message("builtin: %+.5f\n", mean);
    assert_true(mean <= 0.002);
    hnbrdf_model_free(model);
}

static void the_shipped_model_loses_at_most_two_thousandths(void **state)
{
    (void)state;
    const char *given = getenv("HNBRDF_DATA_DIR"), *root = given ? given : HNBRDF_SHARED_DEFAULT;
    const char *model_path = HNBRDF_TEST_DATA "/../../examples/models/rgl_32x2.safetensors";
    hnbrdf_model *model = NULL;
    double mean = 0.0;
    assert_int_equal(hnbrdf_model_load(model_path, NULL, &model, NULL), HNBRDF_OK);
    int count = hnbrdf_model_material_count(model);
    for (int k = 0; k < count; k++) {
        char path[1024];
        hnbrdf_measured *measured = NULL;
        snprintf(path, sizeof path, "%s/data/rgl/%s_rgb.bsdf", root,
                 hnbrdf_model_material_name(model, k));
        if (hnbrdf_measured_open(path, NULL, &measured, NULL)) {
            hnbrdf_model_free(model);
            skip();
        }
        mean += cost(model, measured, k) / count;
        hnbrdf_measured_close(measured);
    }
    print_message("shipped: %+.5f\n", mean);
    assert_true(mean <= 0.002);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_sum_of_a_layer_passes_the_largest_half),
        cmocka_unit_test(every_value_is_finite_whatever_weights_and_directions),
        cmocka_unit_test(bounds_hold_for_a_device_that_rounds_otherwise),
        cmocka_unit_test(bounds_hold_where_every_rounding_pushes_one_way),
        cmocka_unit_test(a_fit_loses_at_most_two_thousandths),
        cmocka_unit_test(the_shipped_model_loses_at_most_two_thousandths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
