/* test_fit_soap.c: the step of a layer's weights: bases are orthonormal whatever the gradients, a
 * unit without a gradient stays where it is, and where inputs are nearly alike it finds what Adam
 * takes far longer for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "fit/adam.h"
#include "fit/soap.h"
#include "hnbrdf/measured.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HIDDEN = 19, LAYERS = 2, LATENT = 3, INPUTS = FIT_INPUTS + LATENT };

typedef struct problem {
    fit_layout layout;
    fit_soap soap;
    float *parameters, *gradient, *moments;
    hnbrdf_rng rng;
} problem;

static void make(problem *p)
{
    memset(p, 0, sizeof *p);
    hnbrdf_fit_layout_make(&p->layout, HNBRDF_KIND_HYBRID, HIDDEN, LAYERS, LATENT, 1, 0, 0.0f);
    p->parameters = calloc(4 * p->layout.count, sizeof(float));
    assert_non_null(p->parameters);
    p->gradient = p->parameters + p->layout.count;
    p->moments = p->gradient + p->layout.count;
    assert_true(hnbrdf_fit_soap_make(&p->soap, &p->layout, hnbrdf_fit_kernel_choose()));
    hnbrdf_rng_seed(&p->rng, 3, 4);
}

static void drop(problem *p)
{
    hnbrdf_fit_soap_free(&p->soap);
    free(p->parameters);
}

static float around_zero(problem *p)
{
    return 2.0f * hnbrdf_rng_float(&p->rng) - 1.0f;
}

static void step(problem *p, int k, long number, double rate)
{
    hnbrdf_fit_soap_step(&p->soap, k, p->parameters, p->gradient, p->moments,
                         p->moments + p->layout.count, number, rate);
}

/* ---- Bases ----------------------------------------------------------------------------------- */

static void check_orthonormal(const float *rows, int n)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            double sum = 0.0;
            for (int k = 0; k < n; k++)
                sum += (double)rows[i * n + k] * (double)rows[j * n + k];
            assert_true(fabs(sum - (i == j)) < 1e-4);
        }
}

/* A gradient of rank `rank`, all of it times `scale`. Unit 4 of every layer has none. */
static void draw_gradient(problem *p, int rank, float scale)
{
    memset(p->gradient, 0, p->layout.count * sizeof(float));
    for (int k = 0; k <= LAYERS; k++)
        for (int r = 0; r < rank; r++) {
            int outputs, inputs;
            float left[HIDDEN + 1], right[HIDDEN];
            hnbrdf_fit_layer_size(&p->layout, k, &outputs, &inputs);
            for (int i = 0; i <= inputs; i++)
                left[i] = k > 0 && i == 4 ? 0.0f : around_zero(p) * scale;
            for (int o = 0; o < outputs; o++)
                right[o] = k < LAYERS && o == 4 ? 0.0f : around_zero(p);
            for (int o = 0; o < outputs; o++) {
                for (int i = 0; i < inputs; i++)
                    p->gradient[hnbrdf_fit_weight_at(&p->layout, k, o, i)] += left[i] * right[o];
                p->gradient[p->layout.bias[k] + (size_t)o] += left[inputs] * right[o];
            }
        }
}

static void bases_stay_orthonormal(void **state)
{
    (void)state;
    const int ranks[] = {0, 1, 3, HIDDEN};
    const float scales[] = {1e-20f, 1e-6f, 1.0f, 1e16f};
    for (size_t c = 0; c < 16; c++) {
        problem p;
        make(&p);
        for (long s = 1; s <= 60; s++) {
            draw_gradient(&p, ranks[c % 4], scales[c / 4]);
            for (int k = 0; k <= LAYERS; k++)
                step(&p, k, s, 1e-3);
        }
        for (int k = 0; k < p.soap.count; k++) {
            const fit_soap_layer *l = &p.soap.layers[k];
            check_orthonormal(p.soap.state + l->left_basis, l->inputs);
            check_orthonormal(p.soap.state + l->right_basis, l->outputs);
        }
        for (size_t i = 0; i < p.layout.count; i++)
            assert_true(isfinite(p.parameters[i]));
        for (int k = 0; k <= LAYERS; k++) { /* exactly: the switch relies on it */
            int outputs, inputs;
            hnbrdf_fit_layer_size(&p.layout, k, &outputs, &inputs);
            for (int i = 0; i < inputs && k < LAYERS; i++)
                assert_true(p.parameters[hnbrdf_fit_weight_at(&p.layout, k, 4, i)] == 0.0f);
            for (int o = 0; o < outputs && k > 0; o++)
                assert_true(p.parameters[hnbrdf_fit_weight_at(&p.layout, k, o, 4)] == 0.0f);
        }
        drop(&p);
    }
}

static void a_gradient_that_is_none_moves_nothing(void **state)
{
    (void)state;
    problem p;
    make(&p);
    const float bad[] = {NAN, INFINITY, -1e18f};
    for (size_t c = 0; c < 3; c++) {
        draw_gradient(&p, 2, 1.0f);
        p.gradient[p.layout.bias[1]] = bad[c];
        step(&p, 1, 1, 0.1);
        for (size_t i = 0; i < p.layout.count; i++)
            assert_true(p.parameters[i] == 0.0f);
    }
    drop(&p);
}

static void check_no_denormals(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        assert_true(fpclassify(values[i]) != FP_SUBNORMAL);
}

/* A unit that gets gradients for a while and then none: what is kept of it ends at 0. */
static void what_dies_out_is_zero(void **state)
{
    (void)state;
    problem p;
    make(&p);
    for (long s = 1; s <= 6000; s++) {
        if (s < 40)
            draw_gradient(&p, 2, 1.0f);
        else
            memset(p.gradient, 0, p.layout.count * sizeof(float));
        p.gradient[p.layout.bias[1]] = 0.1f;
        step(&p, 1, s, 1e-3);
        if (s % 100 == 0) {
            check_no_denormals(p.soap.state, p.soap.state_count);
            check_no_denormals(p.moments, 2 * p.layout.count);
        }
    }
    drop(&p);
}

/* ---- Inputs that are nearly alike ------------------------------------------------------------ */

enum { PAIRS = 256 };

/* Mean square error of the first layer against `wanted`, and its gradient. The inputs differ by a
 * hundredth. */
static double linear_loss(problem *p, const float *wanted)
{
    const fit_layout *l = &p->layout;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 1);
    double loss = 0.0;
    memset(p->gradient, 0, l->count * sizeof(float));
    for (int b = 0; b < PAIRS; b++) {
        float x[INPUTS], shared = hnbrdf_rng_float(&rng) + 0.5f;
        for (int i = 0; i < INPUTS; i++)
            x[i] = shared + 0.01f * hnbrdf_rng_float(&rng);
        for (int o = 0; o < HIDDEN; o++) {
            float error = p->parameters[l->bias[0] + (size_t)o];
            for (int i = 0; i < INPUTS; i++) {
                const size_t at = hnbrdf_fit_weight_at(l, 0, o, i);
                error += (p->parameters[at] - wanted[at]) * x[i];
            }
            loss += (double)(error * error) / (PAIRS * HIDDEN);
            const float slope = 2.0f * error / (PAIRS * HIDDEN);
            for (int i = 0; i < INPUTS; i++)
                p->gradient[hnbrdf_fit_weight_at(l, 0, o, i)] += slope * x[i];
            p->gradient[l->bias[0] + (size_t)o] += slope;
        }
    }
    return loss;
}

/* What is left of the loss after `steps` steps, the rate falling to 0. */
static double train(int steps, int by_soap)
{
    problem p;
    make(&p);
    float *wanted = calloc(p.layout.count, sizeof(float));
    assert_non_null(wanted);
    for (int o = 0; o < HIDDEN; o++)
        for (int i = 0; i < INPUTS; i++)
            wanted[hnbrdf_fit_weight_at(&p.layout, 0, o, i)] = around_zero(&p);
    for (long s = 1; s <= steps; s++) {
        const double rate = 0.03 * (1.0 - (double)s / steps);
        linear_loss(&p, wanted);
        if (by_soap)
            step(&p, 0, s, rate);
        else
            hnbrdf_fit_adam(p.parameters, p.gradient, p.moments, p.moments + p.layout.count,
                            p.layout.network_count, s, rate);
    }
    const double loss = linear_loss(&p, wanted);
    free(wanted);
    drop(&p);
    return loss;
}

static void inputs_nearly_alike_are_told_apart(void **state)
{
    (void)state;
    const double adam = train(400, 0), soap = train(400, 1);
    print_message("mean square error: Adam %.3g, SOAP %.3g\n", adam, soap);
    assert_true(soap < 0.1 * adam);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bases_stay_orthonormal),
                                       cmocka_unit_test(a_gradient_that_is_none_moves_nothing),
                                       cmocka_unit_test(what_dies_out_is_zero),
                                       cmocka_unit_test(inputs_nearly_alike_are_told_apart)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
