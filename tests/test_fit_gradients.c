/* test_fit_gradients.c: the hand-written gradients against finite differences in double
 * precision, for every kind of parameter, and the float kernels of every instruction set against
 * the double one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "fit/kernel.h"
#include "hnbrdf/measured.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct problem {
    fit_layout layout;
    float x[FIT_TILE * FIT_INPUTS], wi[3 * FIT_TILE], wo[3 * FIT_TILE], target[3 * FIT_TILE];
    float frozen[3 * FIT_TILE];
    fit_tile tile;
    double *parameters, *gradient, *derived, *scratch;
} problem;

static void problem_make(problem *p, hnbrdf_kind kind, int hidden, int layers, int latent,
                         int train_analytic, float floor)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 7, (uint64_t)(hidden * 100 + layers * 10 + (int)kind));
    memset(p, 0, sizeof *p);
    hnbrdf_fit_layout_make(&p->layout, kind, hidden, layers, latent, 2, train_analytic, floor);
    p->parameters = calloc(p->layout.count, sizeof(double));
    p->gradient = calloc(p->layout.count, sizeof(double));
    p->derived = calloc(p->layout.derived_count + 1, sizeof(double));
    p->scratch = calloc(p->layout.scratch_count + 1, sizeof(double));
    for (size_t i = 0; i < p->layout.count; i++) {
        int weight = i < p->layout.last; /* padding must stay zero */
        if (!weight || i % (size_t)p->layout.padded < (size_t)hidden)
            p->parameters[i] = ((double)hnbrdf_rng_float(&rng) - 0.5) * 0.8;
    }
    for (size_t o = 0; o < (size_t)p->layout.outputs && kind != HNBRDF_KIND_GGX; o++)
        for (size_t u = (size_t)hidden; u < (size_t)p->layout.padded; u++)
            p->parameters[p->layout.last + o * (size_t)p->layout.padded + u] = 0.0;
    for (int m = 0; m < 2; m++) {
        double *a = p->parameters + p->layout.analytic + (size_t)m * FIT_ANALYTIC;
        for (int c = 0; c < 3; c++) {
            a[FIT_KD + c] = 0.1 + 0.2 * c;
            a[FIT_ETA + c] = log(0.2 + 0.5 * c);
        }
        a[FIT_ALPHA] = log(0.3);
        a[FIT_ALPHA + 1] = log(0.12);
        a[FIT_ROTATION] = 0.4;
    }
    for (int b = 0; b < FIT_TILE; b++) {
        float wi[3], wo[3];
        hnbrdf_sampler_draw(b % 2 ? HNBRDF_SAMPLER_GRID : HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        for (int c = 0; c < 3; c++) {
            p->wi[c * FIT_TILE + b] = wi[c];
            p->wo[c * FIT_TILE + b] = wo[c];
            p->target[c * FIT_TILE + b] = b % 5 ? 0.01f + hnbrdf_rng_float(&rng) : 0.0f;
            p->frozen[c * FIT_TILE + b] = 0.2f * hnbrdf_rng_float(&rng);
        }
        for (int i = 0; i < FIT_INPUTS; i++)
            p->x[b * FIT_INPUTS + i] = 2.0f * hnbrdf_rng_float(&rng) - 1.0f;
    }
    fit_tile tile = {p->x, p->frozen, p->wi, p->wo, p->target};
    p->tile = tile;
}

static void problem_free(problem *p)
{
    free(p->parameters);
    free(p->gradient);
    free(p->derived);
    free(p->scratch);
}

static double loss_at(problem *p, double *gradient, double mix)
{
    if (p->layout.kind == HNBRDF_KIND_GGX)
        return hnbrdf_fit_kernel_double.analytic(p->parameters + p->layout.analytic + FIT_ANALYTIC,
                                                 &p->tile, mix, p->scratch,
                                                 gradient + p->layout.analytic + FIT_ANALYTIC);
    hnbrdf_fit_kernel_double.derive(&p->layout, p->parameters, p->derived);
    double own[HNBRDF_MAX_LATENT + FIT_ANALYTIC] = {0};
    double loss = hnbrdf_fit_kernel_double.network(&p->layout, p->parameters, p->derived, &p->tile,
                                                   1, mix, p->scratch, gradient, own);
    const size_t latent = (size_t)p->layout.latent_size;
    for (size_t i = 0; i < latent; i++)
        gradient[p->layout.codes + latent + i] += own[i];
    for (size_t i = 0; i < FIT_ANALYTIC; i++)
        gradient[p->layout.analytic + FIT_ANALYTIC + i] += own[latent + i];
    return loss;
}

/* Central differences with h = 1e-6: truncation h^2 f''' and rounding 1e-16 |f|/h leave about
 * 1e-8 of the loss. The loss has kinks (HardGELU, |.|, the floor); a parameter whose two
 * one-sided slopes differ sits on one within h, and is counted instead of compared: at most 1 in
 * 50. */
static void check_all(problem *p, double mix)
{
    /* A large network repeats itself: every 23rd of its numbers will do. */
    const size_t stride = p->layout.network_count > 2000 ? 23 : 1;
    double *unused = calloc(p->layout.count, sizeof(double));
    memset(p->gradient, 0, sizeof(double) * p->layout.count);
    double loss = loss_at(p, p->gradient, mix);
    size_t kinks = 0, moved = 0, checked = 0;
    for (size_t i = 0; i < p->layout.count; i += i < p->layout.codes ? stride : 1) {
        checked++;
        const double h = 1e-6, keep = p->parameters[i];
        p->parameters[i] = keep + h;
        double above = loss_at(p, unused, mix);
        p->parameters[i] = keep - h;
        double below = loss_at(p, unused, mix);
        p->parameters[i] = keep;
        double right = (above - loss) / h, left = (loss - below) / h,
               central = (above - below) / (2 * h);
        double scale = 1.0 + fabs(central);
        moved += fabs(central) > 1e-3;
        if (fabs(right - left) > 1e-3 * scale) {
            kinks++;
            continue;
        }
        if (fabs(p->gradient[i] - central) > 2e-6 * scale + 0.5 * fabs(right - left)) {
            print_error("parameter %zu: gradient %.9g, difference quotient %.9g (mix %g)\n", i,
                        p->gradient[i], central, mix);
            fail();
        }
    }
    assert_true(kinks * 50 <= checked);
    assert_true(moved > checked / 4 || p->layout.kind == HNBRDF_KIND_GGX);
    free(unused);
}

static void gradient_matches_finite_differences(void **state)
{
    (void)state;
    static const struct {
        hnbrdf_kind kind;
        int hidden, layers, latent, train_analytic;
        float floor;
    } cases[] = {
        {HNBRDF_KIND_HYBRID, 16, 2, 4, 1, 0.003f},  {HNBRDF_KIND_HYBRID, 20, 3, 8, 0, 0.0f},
        {HNBRDF_KIND_HYBRID, 8, 1, 2, 1, 0.05f},    {HNBRDF_KIND_HYBRID, 33, 4, 16, 1, 0.0f},
        {HNBRDF_KIND_NEURAL, 16, 2, 12, 0, 0.003f}, {HNBRDF_KIND_GGX, 0, 0, 0, 0, 0.0f}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        for (int m = 0; m <= 2; m++) {
            problem p;
            problem_make(&p, cases[k].kind, cases[k].hidden, cases[k].layers, cases[k].latent,
                         cases[k].train_analytic, cases[k].floor);
            check_all(&p, 0.5 * m);
            problem_free(&p);
        }
}

/* Where the value is clipped to 0 below a positive target, the gradient still pulls it up. */
static void clipped_value_is_pulled_up(void **state)
{
    (void)state;
    problem p;
    problem_make(&p, HNBRDF_KIND_NEURAL, 16, 1, 4, 0, 0.9f);
    memset(p.parameters, 0, sizeof(double) * p.layout.count);
    p.parameters[p.layout.bias[1]] = -5.0; /* f = exp(-5) - 0.9 < 0 everywhere */
    for (int b = 0; b < FIT_TILE; b++)
        p.target[b] = 0.3f;
    loss_at(&p, p.gradient, 1.0);
    assert_true(p.gradient[p.layout.bias[1]] < 0.0);
    problem_free(&p);
}

/* Where the value is below the target by more than a factor of 1.25 and exp(c) is small beside the
 * gated GGX, the derivative by c is that of `lift` of the gated GGX; elsewhere it is the true
 * one. All weights are 0, so that c and g are the last biases: exp(c) = 1e-4, the gate 1/2. */
static void a_small_correction_is_lifted_where_ggx_is_too_low(void **state)
{
    (void)state;
    static const struct {
        float target; /* f is 1.0001 everywhere */
        int lifted;
    } cases[] = {{9.0f, 1}, {1.26f, 1}, {1.24f, 0}, {0.5f, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        problem p;
        problem_make(&p, HNBRDF_KIND_HYBRID, 16, 2, 4, 0, 0.0f);
        memset(p.parameters, 0, sizeof(double) * p.layout.count);
        double *bias = p.parameters + p.layout.bias[2], by_c[2];
        for (int c = 0; c < 3; c++)
            bias[c] = log(1e-4);
        for (int b = 0; b < 3 * FIT_TILE; b++) {
            p.target[b] = cases[k].target;
            p.frozen[b] = 2.0f;
        }
        for (int lift = 0; lift < 2; lift++) {
            memset(p.gradient, 0, sizeof(double) * p.layout.count);
            p.layout.lift = 0.5f * (float)lift;
            loss_at(&p, p.gradient, 0.5);
            by_c[lift] = p.gradient[p.layout.bias[2]];
        }
        assert_true(by_c[0] != 0.0);
        /* exp(c) is 1e-4, half of the gated GGX 0.5; both to 1e-5 in single precision */
        assert_true(fabs(by_c[1] / by_c[0] - (cases[k].lifted ? 5000.0 : 1.0)) < 0.1);
        problem_free(&p);
    }
}

/* ---- One material's own numbers -------------------------------------------------------------- */

enum { OWN_SUMS = (FIT_OWN + 1) * FIT_OWN };

/* The own numbers of material 1, as kernel.own() wants them; rows of the network. */
static void own_make(problem *p, double own[FIT_OWN], double *rows)
{
    const size_t latent = (size_t)p->layout.latent_size;
    memset(own, 0, FIT_OWN * sizeof own[0]);
    memcpy(own, p->parameters + p->layout.codes + latent, latent * sizeof own[0]);
    memcpy(own + FIT_LANES, p->parameters + p->layout.analytic + FIT_ANALYTIC,
           FIT_ANALYTIC * sizeof own[0]);
    hnbrdf_fit_kernel_double.derive(&p->layout, p->parameters, p->derived);
    hnbrdf_fit_kernel_double.own_rows(&p->layout, p->parameters, rows);
}

/* The gradient of kernel.own() is that of kernel.network(), which is held to difference quotients
 * above: the same derivatives in another order. The matrix is symmetric. */
static void own_gradients_are_those_of_training(void **state)
{
    (void)state;
    static const struct {
        hnbrdf_kind kind;
        int hidden, layers, latent, joint;
    } cases[] = {{HNBRDF_KIND_HYBRID, 16, 2, 4, 1},
                 {HNBRDF_KIND_HYBRID, 20, 3, 16, 0},
                 {HNBRDF_KIND_HYBRID, 8, 1, 2, 1},
                 {HNBRDF_KIND_NEURAL, 33, 2, 12, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        problem p;
        double own[FIT_OWN], rows[HNBRDF_MAX_HIDDEN * FIT_LANES], sums[OWN_SUMS] = {0};
        double by_training[HNBRDF_MAX_LATENT + FIT_ANALYTIC] = {0};
        problem_make(&p, cases[k].kind, cases[k].hidden, cases[k].layers, cases[k].latent,
                     cases[k].joint, 0.003f);
        own_make(&p, own, rows);
        const double wanted =
            hnbrdf_fit_kernel_double.network(&p.layout, p.parameters, p.derived, &p.tile, 1, 0.3,
                                             p.scratch, p.gradient, by_training);
        const double loss =
            hnbrdf_fit_kernel_double.own(&p.layout, p.parameters, p.derived, rows, &p.tile, own,
                                         0.3, 0.1, p.scratch, sums, NULL);
        assert_true(fabs(loss - wanted) <= 1e-12 * wanted);
        const int stride = hnbrdf_fit_own_stride(&p.layout);
        assert_int_equal(stride, cases[k].joint ? FIT_OWN : FIT_LANES);
        for (int i = 0; i < stride; i++) {
            const int is_code = i < cases[k].latent;
            const int is_analytic =
                cases[k].joint && i >= FIT_LANES && i < FIT_LANES + FIT_ROTATION;
            const double g = is_code       ? by_training[i]
                             : is_analytic ? by_training[cases[k].latent + i - FIT_LANES]
                                           : 0.0;
            assert_true(fabs(sums[i] - g) <= 1e-10 * (1.0 + fabs(g)));
            for (int j = 0; j < stride && (is_code || is_analytic); j++)
                if (j < cases[k].latent || (j >= FIT_LANES && j < FIT_LANES + FIT_ROTATION))
                    assert_true(fabs(sums[(i + 1) * stride + j] - sums[(j + 1) * stride + i]) <=
                                1e-10 * (1.0 + fabs(sums[(i + 1) * stride + j])));
        }
        problem_free(&p);
    }
}

/* What is told of the analytic part alone is its loss, SMAPE, and the gradient of that. */
static void the_analytic_part_alone_is_told_too(void **state)
{
    (void)state;
    problem p;
    double own[FIT_OWN], rows[HNBRDF_MAX_HIDDEN * FIT_LANES];
    double sums[2 * OWN_SUMS] = {0}, gradient[FIT_ANALYTIC] = {0}, alone = 0.0;
    problem_make(&p, HNBRDF_KIND_HYBRID, 16, 2, 4, 1, 0.003f);
    own_make(&p, own, rows);
    hnbrdf_fit_kernel_double.own(&p.layout, p.parameters, p.derived, rows, &p.tile, own, 0.3, 0.1,
                                 p.scratch, sums, &alone);
    const double wanted =
        hnbrdf_fit_kernel_double.analytic(own + FIT_LANES, &p.tile, 1.0, NULL, gradient);
    assert_true(fabs(alone - wanted) <= 1e-12 * wanted);
    for (int i = 0; i < FIT_ROTATION; i++)
        assert_true(fabs(sums[OWN_SUMS + FIT_LANES + i] - gradient[i]) <=
                    1e-10 * (1.0 + fabs(gradient[i])));
    problem_free(&p);
}

static double pixel_at(problem *p, const double *rows, const double *own, double *sums,
                       const float *lights, const float *weights)
{
    double squares[FIT_LIGHTS] = {0}, all = 0.0;
    hnbrdf_fit_kernel_double.pixel(&p->layout, p->parameters, p->derived, rows, &p->tile, lights,
                                   weights, own, p->scratch, sums, squares);
    for (int s = 0; s < FIT_LIGHTS; s++)
        all += (double)weights[s] * squares[s];
    return all;
}

/* Gradients of a pixel against difference quotients, and the matrix against second ones where the
 * error is nothing: f itself, found by two targets, is then the target. */
static void pixel_derivatives_match_finite_differences(void **state)
{
    (void)state;
    problem p;
    double own[FIT_OWN], rows[HNBRDF_MAX_HIDDEN * FIT_LANES];
    float lights[FIT_LIGHTS * FIT_TILE];
    const float weights[FIT_LIGHTS] = {0.5f, 2.0f, 1.0f};
    problem_make(&p, HNBRDF_KIND_HYBRID, 16, 2, 5, 1, 0.003f);
    own_make(&p, own, rows);
    for (int b = 0; b < FIT_LIGHTS * FIT_TILE; b++)
        lights[b] = 0.01f * (float)(b * 7 % 31);
    double sums[OWN_SUMS] = {0}, unused[OWN_SUMS];
    pixel_at(&p, rows, own, sums, lights, weights);
    for (int i = 0; i < FIT_LANES + FIT_ROTATION; i += i == 4 ? FIT_LANES - 4 : 1) {
        const double h = 1e-5, keep = own[i];
        own[i] = keep + h;
        const double above = pixel_at(&p, rows, own, unused, lights, weights);
        own[i] = keep - h;
        const double below = pixel_at(&p, rows, own, unused, lights, weights);
        own[i] = keep;
        /* truncation and rounding as above; HardGELU's kinks are in its second derivative */
        assert_true(fabs(sums[i] - (above - below) / (2 * h)) <= 1e-4 * (1e-2 + fabs(sums[i])));
    }
    float found[3 * FIT_TILE];
    for (int c = 0; c < 3; c++)
        for (int b = 0; b < FIT_TILE; b++) {
            float one[FIT_LIGHTS * FIT_TILE] = {0};
            const float only[FIT_LIGHTS] = {1.0f, 0.0f, 0.0f};
            one[b] = 1.0f;
            memset(p.target, 0, sizeof p.target);
            const double zero = pixel_at(&p, rows, own, unused, one, only);
            p.target[c * FIT_TILE + b] = 1.0f;
            found[c * FIT_TILE + b] =
                (float)(0.5 * (zero - pixel_at(&p, rows, own, unused, one, only) + 1.0));
        }
    memcpy(p.target, found, sizeof found);
    memset(sums, 0, sizeof sums);
    assert_true(pixel_at(&p, rows, own, sums, lights, weights) < 1e-10);
    for (int i = 0; i < FIT_LANES + FIT_ROTATION; i += i == 4 ? FIT_LANES - 4 : 1)
        for (int j = 0; j <= i; j += j == 4 ? FIT_LANES - 4 : 1) {
            const double h = 1e-3, keep_i = own[i], keep_j = own[j];
            const double *m = sums + FIT_OWN;
            own[i] += h;
            own[j] += h;
            const double both = pixel_at(&p, rows, own, unused, lights, weights);
            own[i] = keep_i;
            own[j] = keep_j;
            const double wanted =
                i == j ? 2.0 * h * h * m[i * FIT_OWN + i]
                       : 0.5 * h * h *
                             (m[i * FIT_OWN + i] + m[j * FIT_OWN + j] + 2.0 * m[i * FIT_OWN + j]);
            /* of the next order is h times second over first derivatives */
            assert_true(fabs(both - wanted) <=
                        0.02 * h * h * (m[i * FIT_OWN + i] + m[j * FIT_OWN + j] + 1e-3));
        }
    problem_free(&p);
}

static const fit_kernel *kernel_number(int k)
{
    switch (k) {
    case 0:
        return &hnbrdf_fit_kernel_plain;
#ifdef FIT_KERNEL_X86
    case 1:
        return __builtin_cpu_supports("avx2") ? &hnbrdf_fit_kernel_avx2 : NULL;
    case 2:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")
                   ? &hnbrdf_fit_kernel_avx512
                   : NULL;
#endif
    default:
        return NULL;
    }
}

/* Float against double: sums of at most 64 products and a chain of at most 4 layers; 1e-4 of the
 * largest entry is some 800 ulp of it, what cancellation in 64-term sums of mixed sign may take.
 * Among themselves the float kernels must agree to the bit. */
static void instruction_sets_agree_to_the_bit(void **state)
{
    (void)state;
    static const int sizes[][3] = {{8, 1, 2}, {16, 2, 4}, {32, 2, 4}, {40, 3, 8}, {64, 4, 16}};
    for (size_t s = 0; s < 5; s++) {
        problem p;
        problem_make(&p, HNBRDF_KIND_HYBRID, sizes[s][0], sizes[s][1], sizes[s][2], 1, 0.003f);
        p.layout.lift = 1.0f;
        double wanted_loss = loss_at(&p, p.gradient, 0.4), largest = 0.0;
        size_t count = p.layout.count;
        float *parameters = malloc(sizeof(float) * count), *first = calloc(count, sizeof(float));
        float *gradient = malloc(sizeof(float) * count),
              *derived = malloc(sizeof(float) * p.layout.derived_count);
        float *scratch = malloc(sizeof(float) * p.layout.scratch_count);
        for (size_t i = 0; i < count; i++) {
            parameters[i] = (float)p.parameters[i];
            largest = fmax(largest, fabs(p.gradient[i]));
        }
        double first_loss = 0.0;
        for (int k = 0; k < 3; k++) {
            const fit_kernel *kernel = kernel_number(k);
            if (!kernel)
                continue;
            memset(gradient, 0, sizeof(float) * count);
            kernel->derive(&p.layout, parameters, derived);
            float own[HNBRDF_MAX_LATENT + FIT_ANALYTIC] = {0};
            double loss = kernel->network(&p.layout, parameters, derived, &p.tile, 1, 0.4f, scratch,
                                          gradient, own);
            const size_t latent = (size_t)p.layout.latent_size;
            memcpy(gradient + p.layout.codes + latent, own, latent * sizeof(float));
            memcpy(gradient + p.layout.analytic + FIT_ANALYTIC, own + latent,
                   FIT_ANALYTIC * sizeof(float));
            if (k == 0) {
                first_loss = loss;
                memcpy(first, gradient, sizeof(float) * count);
                assert_true(fabs(loss - wanted_loss) <= 1e-5 * wanted_loss);
                for (size_t i = 0; i < count; i++)
                    assert_true(fabs((double)gradient[i] - p.gradient[i]) <= 1e-4 * largest);
            }
            assert_true(loss == first_loss);
            assert_memory_equal(gradient, first, sizeof(float) * count);
        }
        free(parameters);
        free(first);
        free(gradient);
        free(derived);
        free(scratch);
        problem_free(&p);
    }
}

/* Products of every shape against a plain loop, whose order of sums is that of the kernels. */
static void matrices_agree_to_the_bit(void **state)
{
    static const int sides[] = {1, 3, 6, 7, 8, 9, 15, 16, 17, 23, 64, FIT_MATRIX};
    enum { SIDES = 12, MOST = FIT_MATRIX * FIT_MATRIX };
    static float a[MOST], c[MOST + 1], wanted[MOST];
    (void)state;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 5, 6);
    for (int i = 0; i < MOST; i++)
        a[i] = hnbrdf_rng_float(&rng) - 0.5f;
    for (int s = 0; s < SIDES * SIDES * SIDES; s++) {
        const int rows = sides[s % SIDES], depth = sides[s / SIDES % SIDES];
        const int columns = sides[s / (SIDES * SIDES)];
        for (int i = 0; i < rows * columns; i++) {
            float sum = 0.0f;
            for (int k = 0; k < depth; k++)
                sum += a[i / columns * depth + k] * a[k * columns + i % columns];
            wanted[i] = sum;
        }
        for (int k = 0; k < 3 && kernel_number(k); k++) {
            memset(c, 0, sizeof c);
            kernel_number(k)->matrix(a, a, c, rows, depth, columns);
            assert_memory_equal(c, wanted, sizeof(float) * (size_t)(rows * columns));
            assert_true(c[rows * columns] == 0.0f);
        }
    }
}

/* The sums of kernel.own() and kernel.pixel() by every instruction set. */
static void own_sums_agree_to_the_bit(void **state)
{
    (void)state;
    for (int joint = 0; joint < 2; joint++) {
        problem p;
        double own[FIT_OWN], rows[HNBRDF_MAX_HIDDEN * FIT_LANES];
        float lights[FIT_LIGHTS * FIT_TILE], weights[FIT_LIGHTS] = {1.0f, 0.5f, 0.1f};
        problem_make(&p, HNBRDF_KIND_HYBRID, 33, 3, 7, joint, 0.003f);
        own_make(&p, own, rows);
        for (int b = 0; b < FIT_LIGHTS * FIT_TILE; b++)
            lights[b] = 0.01f * (float)(b * 7 % 31);
        static float parameters[1 << 14], derived[1 << 14], scratch[1 << 16];
        float own_float[FIT_OWN], rows_float[HNBRDF_MAX_HIDDEN * FIT_LANES];
        float sums[2][2 * OWN_SUMS];
        double results[2][2 + FIT_LIGHTS];
        assert_true(p.layout.count < 1 << 14 && p.layout.scratch_count < 1 << 16);
        for (size_t i = 0; i < p.layout.count; i++)
            parameters[i] = (float)p.parameters[i];
        for (int i = 0; i < FIT_OWN; i++)
            own_float[i] = (float)own[i];
        for (int k = 0; k < 3; k++) {
            const fit_kernel *kernel = kernel_number(k);
            if (!kernel)
                continue;
            const int to = k > 0;
            memset(sums[to], 0, sizeof sums[to]);
            memset(results[to], 0, sizeof results[to]);
            kernel->derive(&p.layout, parameters, derived);
            kernel->own_rows(&p.layout, parameters, rows_float);
            results[to][0] =
                kernel->own(&p.layout, parameters, derived, rows_float, &p.tile, own_float, 0.4f,
                            0.1f, scratch, sums[to], results[to] + 1 + FIT_LIGHTS);
            kernel->pixel(&p.layout, parameters, derived, rows_float, &p.tile, lights, weights,
                          own_float, scratch, sums[to], results[to] + 1);
            if (k > 0) {
                assert_memory_equal(sums[1], sums[0], sizeof sums[0]);
                assert_memory_equal(results[1], results[0], sizeof results[0]);
            }
        }
        problem_free(&p);
    }
}

/* Mirror-like roughness and eta near 1: every gradient stays finite. */
static void gradients_stay_finite_at_the_limits(void **state)
{
    (void)state;
    problem p;
    problem_make(&p, HNBRDF_KIND_GGX, 0, 0, 0, 0, 0.0f);
    static const float alphas[] = {1e-4f, 1e-2f, 1.0f}, above[] = {1e-3f, 0.5f, 999.0f};
    for (int i = 0; i < 9; i++) {
        float a[FIT_ANALYTIC] = {0.5f,
                                 0.0f,
                                 1.0f,
                                 logf(above[i % 3]),
                                 logf(above[i % 3]),
                                 logf(above[i % 3]),
                                 logf(alphas[i / 3]),
                                 logf(alphas[(i / 3 + 1) % 3]),
                                 1.0f};
        float g[FIT_ANALYTIC] = {0};
        for (int b = 0; b < FIT_TILE; b += 4) /* exact mirror pairs among them */
            for (int c = 0; c < 3; c++)
                p.wo[c * FIT_TILE + b] = c < 2 ? -p.wi[c * FIT_TILE + b] : p.wi[c * FIT_TILE + b];
        double loss = hnbrdf_fit_kernel_choose()->analytic(a, &p.tile, 0.5f, NULL, g);
        assert_true(isfinite(loss));
        for (int k = 0; k < FIT_ANALYTIC; k++)
            assert_true(isfinite(g[k]));
    }
    problem_free(&p);
}

/* Bounds of the gradient over one tile of N pairs, whatever the target. |dL/df| f is at most 1 in
 * both losses, and the lobe is a part of f. d ln(D V V)/d ln alpha lies in [-3, 3]: 4t - 1 with t
 * in [0, 1] from D, at most 1 from each V. d ln F/d ln(eta - 1) is at most 2, as F goes with (eta
 * - 1)^2 near 1. d ln(D V V)/d rotation is at most 3 times the ratio of the alphas: 2 from D, 1/2
 * from each V. dL/dkd is |dL/df|/pi, largest for SMAPE at f = t = 0: 2/1e-4; the logarithm has
 * 1/1e-3. Rounding may add a thousandth: floats of 24 bits through at most a few dozen
 * operations, and sums of 64. */
static void gradients_are_bounded_near_the_alpha_floor_and_eta_1(void **state)
{
    (void)state;
    /* 1e-4, the floor, to 1 */
    static const float ln_alphas[] = {-9.2103f, -6.9f, -2.3f, 0.0f};
    /* eta - 1: 2e-9 to 99 */
    static const float ln_aboves[] = {-20.0f, -15.9f, -6.9f, 0.0f, 4.595f};
    static const float targets[] = {0.0f, 1e-6f, 0.3f, 1e6f, 1e15f};
    const double slack = 1.001, pairs = FIT_TILE;
    problem p;
    problem_make(&p, HNBRDF_KIND_GGX, 0, 0, 0, 0, 0.0f);
    /* mirror pairs, one of them off by the width of the lobe */
    for (int b = 0; b < FIT_TILE; b += 4) {
        for (int c = 0; c < 3; c++)
            p.wo[c * FIT_TILE + b] = c < 2 ? -p.wi[c * FIT_TILE + b] : p.wi[c * FIT_TILE + b];
        p.wo[b] += b % 8 ? 0.0f : 2e-4f;
    }
    for (int i = 0; i < 4 * 4 * 5 * 5 * 3; i++) {
        const float x = ln_alphas[i % 4], y = ln_alphas[i / 4 % 4], above = ln_aboves[i / 16 % 5];
        const float target = targets[i / 80 % 5], mix = 0.5f * (float)(i / 400);
        const double ratio = exp(fabs((double)x - (double)y));
        const float a[FIT_ANALYTIC] = {0.0f, 0.5f, 1.0f, above, above, above, x, y, 0.7f};
        for (int b = 0; b < 3 * FIT_TILE; b++)
            p.target[b] = target;
        for (int k = 0; k < 3; k++) {
            const fit_kernel *kernel = kernel_number(k);
            float g[FIT_ANALYTIC] = {0};
            if (!kernel)
                continue;
            assert_true(isfinite(kernel->analytic(a, &p.tile, mix, NULL, g)));
            for (int c = 0; c < 3; c++) {
                assert_true(fabs((double)g[FIT_KD + c]) <=
                            slack * pairs * 2.0e4 / 3.14159265358979);
                assert_true(fabs((double)g[FIT_ETA + c]) <= slack * pairs * 2.0);
            }
            for (int axis = 0; axis < 2; axis++)
                assert_true(fabs((double)g[FIT_ALPHA + axis]) <= slack * 3.0 * pairs * 3.0);
            assert_true(fabs((double)g[FIT_ROTATION]) <= slack * 3.0 * pairs * 3.0 * ratio);
        }
    }
    problem_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradient_matches_finite_differences),
        cmocka_unit_test(clipped_value_is_pulled_up),
        cmocka_unit_test(a_small_correction_is_lifted_where_ggx_is_too_low),
        cmocka_unit_test(own_gradients_are_those_of_training),
        cmocka_unit_test(the_analytic_part_alone_is_told_too),
        cmocka_unit_test(pixel_derivatives_match_finite_differences),
        cmocka_unit_test(instruction_sets_agree_to_the_bit),
        cmocka_unit_test(matrices_agree_to_the_bit),
        cmocka_unit_test(own_sums_agree_to_the_bit),
        cmocka_unit_test(gradients_stay_finite_at_the_limits),
        cmocka_unit_test(gradients_are_bounded_near_the_alpha_floor_and_eta_1),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
