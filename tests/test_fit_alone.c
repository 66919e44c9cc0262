/* test_fit_alone.c: a code that turns a network off leaves GGX as it is; materials that a network
 * makes no better get it, in fits and on frozen networks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fit/switch.h"
#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- The switch ------------------------------------------------------------------------------ */

typedef struct network {
    fit_layout layout;
    float *parameters, *derived, *scratch, *gradient;
    float x[FIT_TILE * FIT_INPUTS], analytic[3 * FIT_TILE], target[3 * FIT_TILE];
} network;

enum { MATERIALS = 3 };

static void make(network *n, int hidden, int layers, int latent, float floor)
{
    hnbrdf_rng rng;
    memset(n, 0, sizeof *n);
    hnbrdf_fit_layout_make(&n->layout, HNBRDF_KIND_HYBRID, hidden, layers, latent, MATERIALS, 0,
                           floor);
    const fit_layout *l = &n->layout;
    n->parameters = calloc(l->count, sizeof(float));
    n->derived = calloc(l->derived_count + 1, sizeof(float));
    n->scratch = calloc(l->scratch_count + 1, sizeof(float));
    n->gradient = calloc(l->count, sizeof(float));
    hnbrdf_rng_seed(&rng, 2, (uint64_t)(hidden + layers));
    for (int k = 0; k <= layers; k++) {
        int rows, columns;
        hnbrdf_fit_layer_size(l, k, &rows, &columns);
        for (int o = 0; o < rows; o++) {
            n->parameters[l->bias[k] + (size_t)o] = 4.0f * hnbrdf_rng_float(&rng) - 2.0f;
            for (int i = 0; i < columns; i++)
                n->parameters[hnbrdf_fit_weight_at(l, k, o, i)] =
                    2.0f * hnbrdf_rng_float(&rng) - 1.0f;
        }
    }
    for (int i = 0; i < MATERIALS * latent; i++)
        n->parameters[l->codes + (size_t)i] = 6.0f * hnbrdf_rng_float(&rng) - 3.0f;
    for (int i = 0; i < FIT_TILE * FIT_INPUTS; i++)
        n->x[i] = 10.0f * hnbrdf_rng_float(&rng) - 5.0f;
    for (int i = 0; i < 3 * FIT_TILE; i++) {
        n->analytic[i] = expf(8.0f * hnbrdf_rng_float(&rng) - 4.0f);
        n->target[i] = hnbrdf_rng_float(&rng);
    }
}

/* Loss of a material, SMAPE alone, against target. */
static double loss(network *n, int material, const float *target)
{
    const fit_tile tile = {n->x, n->analytic, NULL, NULL, target};
    float own[HNBRDF_MAX_LATENT + FIT_ANALYTIC] = {0};
    hnbrdf_fit_kernel_plain.derive(&n->layout, n->parameters, n->derived);
    return hnbrdf_fit_kernel_plain.network(&n->layout, n->parameters, n->derived, &tile, material,
                                           1.0f, n->scratch, n->gradient, own);
}

/* The first layer as a model has it: what hnbrdf_fit_switch_code() looks at. */
static void find_code(const network *n, float *code)
{
    const fit_layout *l = &n->layout;
    float weights[HNBRDF_MAX_HIDDEN * (FIT_INPUTS + HNBRDF_MAX_LATENT)], *w = weights;
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_HYBRID,
                              .hidden = l->hidden_size,
                              .layers = l->layers,
                              .latent = l->latent_size};
    for (int o = 0; o < l->hidden_size; o++)
        for (int i = 0; i < FIT_INPUTS + l->latent_size; i++)
            *w++ = n->parameters[hnbrdf_fit_weight_at(l, 0, o, i)];
    desc.weights[0] = weights;
    desc.biases[0] = n->parameters + l->bias[0];
    assert_true(hnbrdf_fit_switch_code(&desc, code));
    assert_true(hnbrdf_fit_switch_is_on(&desc, code));
    for (int m = 1; m < MATERIALS; m++)
        assert_false(hnbrdf_fit_switch_is_on(&desc, n->parameters + l->codes +
                                                        (size_t)(m * l->latent_size)));
}

/* Against f_a itself the loss is that of rounding: up to 4 units of f_a + b, where f_a is at least
 * exp(-4) and b at most 0.05. */
static void a_code_turns_the_network_off_and_no_other_sees_it(void **state)
{
    (void)state;
    static const struct {
        int hidden, layers, latent;
        float floor;
    } cases[] = {{16, 2, 1, 0.003f}, {32, 2, 4, 0.003f}, {20, 3, 8, 0.0f}, {64, 4, 16, 0.05f}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        network n;
        double before[MATERIALS];
        make(&n, cases[k].hidden, cases[k].layers, cases[k].latent, cases[k].floor);
        assert_true(hnbrdf_fit_switch_fits(&n.layout));
        hnbrdf_fit_switch_reserve(&n.layout, n.parameters);
        for (int m = 0; m < MATERIALS; m++)
            before[m] = loss(&n, m, n.target);
        hnbrdf_fit_switch_install(&n.layout, n.parameters);
        for (int m = 0; m < MATERIALS; m++)
            assert_true(loss(&n, m, n.target) == before[m]);
        find_code(&n, n.parameters + n.layout.codes);
        assert_true(loss(&n, 0, n.analytic) < 3 * FIT_TILE * 4 * 0x1p-23 * (1.0 + 0.05 / 0.018));
        free(n.parameters);
        free(n.derived);
        free(n.scratch);
        free(n.gradient);
    }
}

/* The units kept for it stay as they are in training: nothing leads there. */
static void training_leaves_the_units_kept_alone(void **state)
{
    (void)state;
    network n;
    make(&n, 20, 3, 4, 0.003f);
    hnbrdf_fit_switch_reserve(&n.layout, n.parameters);
    loss(&n, 1, n.target);
    for (int k = 0; k <= 3; k++) {
        int rows, columns;
        hnbrdf_fit_layer_size(&n.layout, k, &rows, &columns);
        for (int o = 0; o < rows; o++)
            for (int i = 0; i < columns; i++)
                if ((k < 3 && o == 19) || (k > 0 && i == 19))
                    assert_true(n.gradient[hnbrdf_fit_weight_at(&n.layout, k, o, i)] == 0.0f);
    }
    free(n.parameters);
    free(n.derived);
    free(n.scratch);
    free(n.gradient);
}

/* ---- Fits ------------------------------------------------------------------------------------ */

/* The last is what GGX alone can say, to the bit: no network makes it better. */
enum { COUNT = 4, EXACT = COUNT - 1 };
static hnbrdf_measured *data[COUNT];
static hnbrdf_material found[COUNT]; /* once */
static hnbrdf_model *ggx;

static int eval_exact(const void *user, const float wi[3], const float wo[3], float f[3])
{
    (void)user;
    hnbrdf_eval(ggx, &found[EXACT], wi, wo, f);
    return 1;
}

static int open_data(void **state)
{
    (void)state;
    const hnbrdf_measured_custom exact = {.name = "exact", .isotropic = 1, .eval = eval_exact};
    const hnbrdf_fit_options o = {.kind = HNBRDF_KIND_GGX, .pool = 4096, .seed = 1};
    for (int m = 0; m < EXACT; m++)
        assert_int_equal(hnbrdf_measured_open_builtin(m, &data[m], NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_measured_create_custom(&exact, &data[EXACT], NULL), HNBRDF_OK);
    assert_int_equal(hnbrdf_fit((const hnbrdf_measured *const *)data, EXACT, &o, &ggx, NULL, NULL),
                     HNBRDF_OK);
    for (int m = 0; m < COUNT; m++)
        found[m] = *hnbrdf_model_material(ggx, m % EXACT);
    return 0;
}

static int close_data(void **state)
{
    (void)state;
    for (int m = 0; m < COUNT; m++)
        hnbrdf_measured_close(data[m]);
    hnbrdf_model_free(ggx);
    return 0;
}

static hnbrdf_model *fit(int first, int count, const hnbrdf_fit_options *options,
                         hnbrdf_fit_report *report)
{
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    hnbrdf_fit_options o = *options;
    o.materials = found + first;
    if (hnbrdf_fit((const hnbrdf_measured *const *)data + first, count, &o, &model, report, &error))
        fail_msg("%s", error.text);
    return model;
}

/* Its values are those of its GGX, but for rounding: b (1 + 1e-6) - b with b = 0.003. */
static void assert_is_ggx(const hnbrdf_model *model, int m)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 1);
    for (int k = 0; k < 2000; k++) {
        float wi[3], wo[3], f[3], analytic[3];
        hnbrdf_sampler_draw(k % 2 ? HNBRDF_SAMPLER_GRID : HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        hnbrdf_eval(model, hnbrdf_model_material(model, m), wi, wo, f);
        hnbrdf_eval_analytic(model, hnbrdf_model_material(model, m), wi, wo, analytic);
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(f[c] - analytic[c]) <= 1e-6f * analytic[c] + 1e-8f);
    }
}

/* 100 steps make some of the others better. */
static void materials_that_gain_nothing_are_left_to_ggx(void **state)
{
    (void)state;
    for (int joint = 0; joint < 2; joint++) {
        hnbrdf_fit_worth worth[COUNT];
        hnbrdf_fit_report report;
        hnbrdf_fit_options o = {.steps = 100, .pool = 16384, .seed = 1, .worth = worth};
        o.analytic = joint ? HNBRDF_FIT_JOINT : HNBRDF_FIT_FAITHFUL;
        hnbrdf_model *model = fit(0, COUNT, &o, &report);
        int alone = 0;
        assert_false(report.ggx_alone);
        assert_int_equal(worth[EXACT].alone, 1);
        for (int m = 0; m < COUNT; m++) {
            assert_true(worth[m].smape > 0.0 && worth[m].picture > 0.0);
            assert_true((worth[m].ggx_smape > 1e-6) == (m != EXACT));
            assert_int_equal(worth[m].worse, worth[m].alone);
            const int unseen =
                worth[m].picture <= worth[m].unseen && 2.0 * worth[m].smape <= worth[m].ggx_smape;
            assert_int_equal(worth[m].worse,
                             worth[m].smape > worth[m].ggx_smape ||
                                 (worth[m].picture > worth[m].ggx_picture && !unseen));
            alone += worth[m].alone;
            if (worth[m].alone)
                assert_is_ggx(model, m);
        }
        assert_int_equal(report.left_alone, alone);
        assert_int_equal(report.worse, 0);
        assert_true(alone < COUNT);
        hnbrdf_model_free(model);
    }
}

/* On a network with the switch the exact material gets its code, without one it is told. */
static void a_frozen_network_leaves_materials_alone_too(void **state)
{
    (void)state;
    for (int layers = 1; layers <= 2; layers++) {
        hnbrdf_fit_worth worth;
        hnbrdf_fit_report report;
        hnbrdf_fit_options o = {.layers = layers, .steps = 100, .pool = 16384, .seed = 1};
        hnbrdf_model *known = fit(0, 2, &o, NULL);
        hnbrdf_fit_options frozen = {.freeze = known, .steps = 20, .pool = 16384, .worth = &worth};
        hnbrdf_model *more = fit(EXACT, 1, &frozen, &report);
        assert_int_equal(worth.worse, 1);
        assert_int_equal(worth.alone, layers - 1);
        assert_int_equal(report.left_alone, layers - 1);
        assert_int_equal(report.worse, 2 - layers);
        if (layers == 2)
            assert_is_ggx(more, 0);
        hnbrdf_model_free(more);
        hnbrdf_model_free(known);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_code_turns_the_network_off_and_no_other_sees_it),
        cmocka_unit_test(training_leaves_the_units_kept_alone),
        cmocka_unit_test(materials_that_gain_nothing_are_left_to_ggx),
        cmocka_unit_test(a_frozen_network_leaves_materials_alone_too),
    };
    return cmocka_run_group_tests(tests, open_data, close_data);
}
