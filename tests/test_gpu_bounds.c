/* test_gpu_bounds.c: the bounds that verify holds devices to, against a device that rounds
 * nothing. */
#include "gpu_support.h"

#include "core/frame.h"
#include "core/model.h"
#include "check/bounds.h"
#include "check/oracle.h"
#include "check/pairs.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <string.h>

enum { PAIRS = 4096 };

static const check_arithmetic NOTHING_EXACT = {0};
static const check_arithmetic ALL_EXACT = {
    .exact_basic = 1, .exact_divide = 1, .exact_sqrt = 1, .keeps_denormals = 1};

/* ---- The same formulas in double, from the same float inputs --------------------------------- */

typedef struct exact_result {
    double encoding[6], analytic[3], value[3];
} exact_result;

static double clamp_to(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

static double smith(const double w[3], double ax, double ay)
{
    return 1.0 / (w[2] + sqrt(ax * ax * w[0] * w[0] + ay * ay * w[1] * w[1] + w[2] * w[2]));
}

static double fresnel(double eta, double c)
{
    double g = sqrt(eta * eta - 1.0 + c * c), a = (eta * eta - 1.0) / ((g + c) * (g + c));
    double b = (c * (g + c) - 1.0) / (c * (eta * eta - 1.0) / (g + c) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

static void network(const hnbrdf_model_desc *desc, const float *latent, const double *x,
                    double *out)
{
    double a[64], b[64];
    for (int layer = 0; layer <= desc->layers; layer++) {
        int in = layer ? desc->hidden : 6 + desc->latent;
        int rows = layer < desc->layers ? desc->hidden : desc->kind == HNBRDF_KIND_HYBRID ? 6 : 3;
        for (int r = 0; r < rows; r++) {
            double sum = (double)desc->biases[layer][r];
            for (int i = 0; i < in; i++)
                sum += (double)desc->weights[layer][r * in + i] * (layer   ? a[i]
                                                                   : i < 6 ? x[i]
                                                                           : (double)latent[i - 6]);
            b[r] = layer < desc->layers ? sum * clamp_to(sum * (double)0.333333333f + 0.5, 0.0, 1.0)
                                        : sum;
        }
        memcpy(layer < desc->layers ? a : out, b, (size_t)rows * sizeof *b);
    }
}

static exact_result evaluate(const hnbrdf_model_desc *desc, const hnbrdf_material *m,
                             const float pair[6])
{
    exact_result r = {{0}, {0}, {0}};
    hnbrdf_frame frame = hnbrdf_frame_of(m);
    double w[2][3], s[3], out[6], d2 = 0.0, pi = (double)3.14159265f;
    for (int k = 0; k < 2; k++) {
        double x = (double)pair[3 * k], y = (double)pair[3 * k + 1];
        w[k][0] = (double)frame.cosine * x + (double)frame.sine * y;
        w[k][1] = (double)frame.cosine * y - (double)frame.sine * x;
        w[k][2] = (double)pair[3 * k + 2];
    }
    for (int i = 0; i < 3; i++) {
        s[i] = w[0][i] + w[1][i];
        d2 += (w[0][i] - w[1][i]) * (w[0][i] - w[1][i]);
    }
    double r2 = s[0] * s[0] + s[1] * s[1], length2 = r2 + s[2] * s[2], c = 0.5 * sqrt(length2);
    double ax = (double)m->alpha[0], ay = (double)m->alpha[1];
    double t = (s[0] * s[0] / (ax * ax) + s[1] * s[1] / (ay * ay) + s[2] * s[2]) / length2;
    double specular = smith(w[0], ax, ay) * smith(w[1], ax, ay) / (pi * ax * ay * t * t);
    const double x[6] = {1.0 + 0.25 * log((double)1e-5f + r2 / (s[2] * s[2])),
                         sqrt(sqrt(r2 / length2)),
                         c,
                         sqrt(0.25 * d2 / (1.0 + c)),
                         w[0][2] * w[1][2],
                         s[2]};
    memcpy(r.encoding, x, sizeof x);
    network(desc, m->latent, x, out);
    for (int k = 0; k < 3; k++) {
        r.analytic[k] =
            (double)m->kd[k] * (double)0.318309886f + fresnel((double)m->eta[k], c) * specular;
        double e = exp(clamp_to((double)desc->scale * out[k] + (double)desc->shift, -80.0, 80.0));
        double gate = 1.0 / (1.0 + exp(clamp_to(-out[3 + k], -80.0, 80.0)));
        r.value[k] = clamp_to(e + gate * r.analytic[k] - (double)desc->floor, 0.0, (double)3.0e38f);
        r.analytic[k] = clamp_to(r.analytic[k], 0.0, (double)3.0e38f);
    }
    return r;
}

/* ---- Properties ------------------------------------------------------------------------------ */

static const scene_shape SHAPE = {.encoding = HNBRDF_ENCODING_HALF_DIFFERENCE,
                                  .hidden = 16,
                                  .layers = 2,
                                  .latent = 4,
                                  .anisotropic = 1,
                                  .rotated = 1,
                                  .scale = 1.5f,
                                  .shift = 0.5f,
                                  .floor = 0.003f};

static int is_usual(check_pair_class class_of_pair)
{
    return class_of_pair != CHECK_PAIR_EXTREME && class_of_pair != CHECK_PAIR_NOT_FINITE;
}

static void covered(const char *what, const check_tracked *bound, const double *exact, int count)
{
    for (int i = 0; i < count; i++)
        if (!(fabs(exact[i] - (double)bound[i].v) <= bound[i].e))
            fail_msg("%s[%d]: %.17g, C %.9g, bound %g", what, i, exact[i], (double)bound[i].v,
                     bound[i].e);
}

/* Real arithmetic is a device whose every error is below its limit, so it must lie within the
 * bounds, of Vulkan's rules and of those of a device that rounds correctly but not where C does. */
static void bounds_cover_a_device_without_rounding(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&SHAPE);
    check_rules rules = check_rules_fast(&NOTHING_EXACT, 0);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 11, 0);
    float pair[6] = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f};
    for (size_t k = 0; k < PAIRS; k++) {
        const hnbrdf_material *material = hnbrdf_model_material(model, (int)(k % SCENE_MATERIALS));
        check_bounds bounds;
        if (!is_usual(check_pair_draw(&rng, k, pair)))
            continue;
        check_bounds_make(&rules, &model->desc, HNBRDF_GLSL_FLOAT, material, pair, pair + 3, 0.0,
                          &bounds);
        exact_result exact = evaluate(&model->desc, material, pair);
        covered("encoding", bounds.encoding, exact.encoding, 6);
        covered("analytic", bounds.analytic, exact.analytic, 3);
        covered("value", bounds.value, exact.value, 3);
    }
    hnbrdf_model_free(model);
}

/* The same of edited materials of every encoding, the true values from the oracle. */
static void bounds_cover_edited_materials(void **state)
{
    (void)state;
    scene_shape shape = SHAPE;
    shape.edited = 1;
    for (int encoding = 0; encoding <= HNBRDF_ENCODING_ANGLES_AZIMUTHS; encoding++) {
        shape.encoding = (hnbrdf_encoding)encoding;
        hnbrdf_model *model = scene_model(&shape);
        check_rules rules = check_rules_fast(&NOTHING_EXACT, 0);
        hnbrdf_rng rng;
        hnbrdf_rng_seed(&rng, 15, 0);
        float pair[6] = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f}, value[3];
        size_t tight = 0, seen = 0;
        for (size_t k = 0; k < PAIRS / 2; k++) {
            const hnbrdf_material *material = hnbrdf_model_material(model, 1 + (int)(k % 2));
            check_bounds bounds;
            oracle_point exact;
            if (!is_usual(check_pair_draw(&rng, k, pair)))
                continue;
            check_bounds_make(&rules, &model->desc, HNBRDF_GLSL_FLOAT, material, pair, pair + 3,
                              0.0, &bounds);
            hnbrdf_eval(model, material, pair, pair + 3, value);
            for (int c = 0; c < 3; c++)
                assert_memory_equal(&bounds.value[c].v, &value[c], sizeof value[c]);
            oracle_evaluate(&model->desc, material, pair, pair + 3, &exact);
            covered("encoding", bounds.encoding, exact.encoded, 6);
            covered("value", bounds.value, exact.value, 3);
            tight += bounds.value[0].e <= 0.1 * exact.scale[0];
            seen++;
        }
        assert_true(tight > seen / 2);
        hnbrdf_model_free(model);
    }
}

/* Otherwise a bound would be about another function than the one that is compared. */
static void bounds_reproduce_the_bits_of_c(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&SHAPE);
    check_rules rules = check_rules_fast(&NOTHING_EXACT, 0);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 12, 0);
    float pair[6] = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f}, value[3], analytic[3];
    for (size_t k = 0; k < PAIRS; k++) {
        const hnbrdf_material *material = hnbrdf_model_material(model, (int)(k % SCENE_MATERIALS));
        check_bounds bounds;
        check_pair_class drawn = check_pair_draw(&rng, k, pair);
        if (drawn == CHECK_PAIR_NOT_FINITE || !(pair[2] > 0.0f && pair[5] > 0.0f))
            continue;
        check_bounds_make(&rules, &model->desc, HNBRDF_GLSL_FLOAT, material, pair, pair + 3, 0.0,
                          &bounds);
        hnbrdf_eval(model, material, pair, pair + 3, value);
        hnbrdf_eval_analytic(model, material, pair, pair + 3, analytic);
        for (int c = 0; c < 3; c++) {
            assert_memory_equal(&bounds.value[c].v, &value[c], sizeof value[c]);
            assert_memory_equal(&bounds.analytic[c].v, &analytic[c], sizeof analytic[c]);
        }
    }
    hnbrdf_model_free(model);
}

/* On a device that rounds as IEEE 754 says, the exact build may not differ by a bit. */
static void bounds_are_zero_where_every_operation_is_exact(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&SHAPE);
    check_rules rules = check_rules_exact(&ALL_EXACT);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 13, 0);
    float pair[6] = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f};
    for (size_t k = 0; k < PAIRS; k++) {
        check_bounds bounds;
        if (!is_usual(check_pair_draw(&rng, k, pair)))
            continue;
        check_bounds_make(&rules, &model->desc, HNBRDF_GLSL_FLOAT, hnbrdf_model_material(model, 0),
                          pair, pair + 3, 0.0, &bounds);
        for (int c = 0; c < 3; c++)
            assert_true(bounds.value[c].e == 0.0 && bounds.analytic[c].e == 0.0);
        for (int c = 0; c < 6; c++)
            assert_true(bounds.encoding[c].e == 0.0 && bounds.fed[c].e == 0.0);
    }
    hnbrdf_model_free(model);
}

/* Where only division and root are inexact, as on most GPUs, the network still has no excuse. */
static void the_network_alone_is_exact_without_division(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&SHAPE);
    const check_arithmetic usual_gpu = {.exact_basic = 1, .keeps_denormals = 1};
    check_rules rules = check_rules_exact(&usual_gpu);
    const float wi[3] = {0.6f, 0.0f, 0.8f}, wo[3] = {-0.36f, 0.48f, 0.8f};
    check_bounds bounds;
    check_bounds_make(&rules, &model->desc, HNBRDF_GLSL_FLOAT, hnbrdf_model_material(model, 0), wi,
                      wo, 0.0, &bounds);
    for (int c = 0; c < 6; c++)
        assert_true(bounds.fed[c].e == 0.0);
    for (int c = 0; c < 3; c++)
        assert_true(bounds.value[c].e > 0.0);
    hnbrdf_model_free(model);
}

/* A bound that allowed everything would prove nothing: at ordinary pairs, for Vulkan's rules, the
 * median stays below 2 % of the value (10 layers of worst cases), of f_a below 1e-4. */
static void bounds_say_something(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&SHAPE);
    check_rules rules = check_rules_fast(&NOTHING_EXACT, 0);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 14, 0);
    int tight_values = 0, tight_analytic = 0, total = 1000;
    for (int k = 0; k < total; k++) {
        float wi[3], wo[3];
        check_bounds bounds;
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        check_bounds_make(&rules, &model->desc, HNBRDF_GLSL_FLOAT, hnbrdf_model_material(model, 0),
                          wi, wo, 0.0, &bounds);
        tight_values += bounds.value[0].e <= 0.02 * (double)bounds.value[0].v;
        tight_analytic += bounds.analytic[0].e <= 1e-4 * (double)bounds.analytic[0].v;
    }
    assert_true(tight_values > total / 2);
    assert_true(tight_analytic > total / 2);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_cover_a_device_without_rounding),
        cmocka_unit_test(bounds_cover_edited_materials),
        cmocka_unit_test(bounds_reproduce_the_bits_of_c),
        cmocka_unit_test(bounds_are_zero_where_every_operation_is_exact),
        cmocka_unit_test(the_network_alone_is_exact_without_division),
        cmocka_unit_test(bounds_say_something),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
