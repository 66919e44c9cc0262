/* test_core_network.c: encodings and network against their definitions in double and long double,
 * and the one canonical order of summation. */
#include "core_support.h"

#include "core/encoding.h"
#include "core/network.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

/* Every shape that is special to the code: rows that are no multiple of four, the limits, no
 * latent. */
static const struct {
    int hidden, layers, latent;
} shapes[] = {{1, 1, 1},   {2, 1, 0},  {3, 2, 4},   {5, 4, 7},  {8, 2, 4},
              {13, 3, 16}, {16, 3, 8}, {17, 1, 4},  {31, 2, 5}, {32, 2, 4},
              {32, 3, 12}, {33, 2, 4}, {63, 4, 15}, {64, 4, 16}};
enum { SHAPES = sizeof shapes / sizeof shapes[0] };

/* A value and a bound on how far a float evaluation may be from it. */
typedef struct bounded {
    double value, error;
} bounded;

static double hard_gelu(double x)
{
    if (x <= -1.5)
        return 0.0;
    return x >= 1.5 ? x : x / 3.0 * (x + 1.5); /* the paper's three branches */
}

/* sums[r] = bias[r] + W x in double. Running error bound, u = 2^-24: what the inputs bring, |W|
 * e, and (n + 1) u (|bias| + |W| |x|) for n products and n additions, 1 % for the second order. */
static void layer(const float *weights, const float *biases, int rows, int columns,
                  const bounded *x, bounded *sums)
{
    for (int r = 0; r < rows; r++) {
        double sum = (double)biases[r], size = fabs(sum), brought = 0.0;
        for (int i = 0; i < columns; i++) {
            double w = (double)weights[r * columns + i];
            sum += w * x[i].value;
            size += fabs(w) * (fabs(x[i].value) + x[i].error);
            brought += fabs(w) * x[i].error;
        }
        sums[r].value = sum;
        sums[r].error = brought + 1.01 * (columns + 1) * UNIT * size;
    }
}

/* |HardGELU'| <= 1.5. Its own rounding: x/3 2u, + 1/2 another u, of size at most 1 where the
 * clamp is open (|x| <= 1.5): 2u, times |x| <= 1.5, and the product's u: 4 u + u |y|. */
static bounded activate(bounded x)
{
    bounded y;
    y.value = hard_gelu(x.value);
    y.error = 1.5 * x.error + (4.0 + fabs(y.value)) * UNIT;
    return y;
}

static void network_in_double(const hnbrdf_model_desc *desc, const float *latent, const float *x,
                              bounded *out)
{
    bounded a[HNBRDF_MAX_HIDDEN], b[HNBRDF_MAX_HIDDEN];
    for (int i = 0; i < 6; i++)
        a[i] = (bounded){(double)x[i], 0.0};
    for (int i = 0; i < desc->latent; i++)
        a[6 + i] = (bounded){(double)latent[i], 0.0};
    int columns = 6 + desc->latent, outputs = desc->kind == HNBRDF_KIND_HYBRID ? 6 : 3;
    for (int k = 0; k < desc->layers; k++) {
        layer(desc->weights[k], desc->biases[k], desc->hidden, columns, a, b);
        for (int i = 0; i < desc->hidden; i++)
            a[i] = activate(b[i]);
        columns = desc->hidden;
    }
    layer(desc->weights[desc->layers], desc->biases[desc->layers], outputs, columns, a, out);
}

static void random_input(rng *r, float x[6])
{
    for (int i = 0; i < 6; i++)
        x[i] = rng_range(r, -1.0f, 1.0f);
}

static void network_equals_its_definition_in_double(void **state)
{
    (void)state;
    rng r = rng_make(11);
    double worst = 0.0, share = 0.0;
    for (int s = 0; s < SHAPES; s++)
        for (int kind = HNBRDF_KIND_HYBRID; kind <= HNBRDF_KIND_NEURAL; kind++) {
            hnbrdf_model *model =
                random_model(&r, (hnbrdf_kind)kind, HNBRDF_ENCODING_DIRECTIONS, shapes[s].hidden,
                             shapes[s].layers, shapes[s].latent);
            hnbrdf_model_desc desc;
            hnbrdf_model_describe(model, &desc);
            for (int k = 0; k < 50; k++) {
                const int outputs = kind == HNBRDF_KIND_HYBRID ? 6 : 3;
                float x[6], out[7];
                bounded expected[6];
                hnbrdf_material m = random_material(&r, 0);
                random_input(&r, x);
                out[outputs] = -77.0f;
                hnbrdf_network(&desc, m.latent, x, out);
                assert_true(out[outputs] == -77.0f); /* nothing beyond is written */
                network_in_double(&desc, m.latent, x, expected);
                for (int i = 0; i < outputs; i++) {
                    double error = fabs((double)out[i] - expected[i].value);
                    worst = fmax(worst, error);
                    share = fmax(share, error / expected[i].error);
                    if (!(error <= expected[i].error))
                        fail_msg("%dx%d l=%d output %d: %.9g, expected %.9g +- %.3g",
                                 shapes[s].hidden, shapes[s].layers, shapes[s].latent, i,
                                 (double)out[i], expected[i].value, expected[i].error);
                }
            }
            hnbrdf_model_free(model);
        }
    print_message("    network: worst %.3g absolute, at most %.2f of its running bound\n", worst,
                  share);
}

/* To the bit: the bias, the latent inputs, the directions, each in index order. */
static void network_sums_in_the_canonical_order(void **state)
{
    (void)state;
    rng r = rng_make(12);
    for (int s = 0; s < SHAPES; s++) {
        hnbrdf_model *model = random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_DIRECTIONS,
                                           shapes[s].hidden, shapes[s].layers, shapes[s].latent);
        hnbrdf_model_desc desc;
        hnbrdf_model_describe(model, &desc);
        for (int k = 0; k < 20; k++) {
            float x[6], out[6], a[HNBRDF_MAX_HIDDEN], b[HNBRDF_MAX_HIDDEN];
            hnbrdf_material m = random_material(&r, 0);
            random_input(&r, x);
            for (int row = 0; row < desc.hidden; row++) {
                const float *w = desc.weights[0] + row * (6 + desc.latent);
                b[row] = desc.biases[0][row];
                for (int i = 0; i < desc.latent; i++)
                    b[row] += w[6 + i] * m.latent[i];
                for (int i = 0; i < 6; i++)
                    b[row] += w[i] * x[i];
            }
            for (int n = 1; n <= desc.layers; n++) {
                int rows = n < desc.layers ? desc.hidden : 6;
                for (int i = 0; i < desc.hidden; i++)
                    a[i] = hnbrdf_hard_gelu(b[i]);
                for (int row = 0; row < rows; row++) {
                    b[row] = desc.biases[n][row];
                    for (int i = 0; i < desc.hidden; i++)
                        b[row] += desc.weights[n][row * desc.hidden + i] * a[i];
                }
            }
            hnbrdf_network(&desc, m.latent, x, out);
            assert_same_bits(out, b, 6);
        }
        hnbrdf_model_free(model);
    }
}

static void block_has_the_bits_of_single_evaluations(void **state)
{
    (void)state;
    rng r = rng_make(13);
    for (int s = 0; s < SHAPES; s++) {
        hnbrdf_model *model = random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_DIRECTIONS,
                                           shapes[s].hidden, shapes[s].layers, shapes[s].latent);
        hnbrdf_model_desc desc;
        hnbrdf_model_describe(model, &desc);
        hnbrdf_material m = random_material(&r, 0);
        float x[HNBRDF_ENCODING_SIZE][HNBRDF_LANES], out[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES];
        for (int l = 0; l < HNBRDF_LANES; l++)
            for (int i = 0; i < 6; i++)
                x[i][l] = rng_range(&r, -1.0f, 1.0f);
        hnbrdf_prepared prepared;
        hnbrdf_prepare(model, &m, &prepared);
        hnbrdf_network_block(&prepared, x, out);
        for (int l = 0; l < HNBRDF_LANES; l++) {
            float single_x[6], single[6], lane[6];
            for (int i = 0; i < 6; i++)
                single_x[i] = x[i][l];
            hnbrdf_network(&desc, m.latent, single_x, single);
            for (int i = 0; i < 6; i++)
                lane[i] = out[i][l];
            assert_same_bits(lane, single, 6);
        }
        hnbrdf_model_free(model);
    }
}

static void hard_gelu_is_the_three_branch_form(void **state)
{
    (void)state;
    for (int k = -100000; k <= 100000; k++) {
        float x = (float)k * 5e-5f;
        assert_true(fabs((double)hnbrdf_hard_gelu(x) - hard_gelu((double)x)) <=
                    (4.0 + fabs((double)x)) * UNIT); /* as in activate() */
    }
    assert_true(hnbrdf_hard_gelu(2.0f) == 2.0f && hnbrdf_hard_gelu(-2.0f) == 0.0f);
}

static void directions_are_encoded_as_they_are(void **state)
{
    (void)state;
    const float wi[3] = {0.1f, 0.2f, 0.3f}, wo[3] = {-0.4f, -0.5f, 0.6f};
    const float expected[6] = {0.1f, 0.2f, 0.3f, -0.4f, -0.5f, 0.6f};
    float x[6];
    hnbrdf_pair p = hnbrdf_pair_make(wi, wo);
    hnbrdf_encode_directions(&p, x);
    assert_same_bits(x, expected, 6);
}

/* The half-difference inputs from angles, in long double. Errors in u = 2^-24, first order, from
 * the operations (sums of positive terms): r2 = sx^2+sy^2 4, s.s 5, c 3.5, d.d 5;
 *   ln: argument r2/sz^2 4+3+1 and + 1e-5 rounded, + 1: at most 9; log itself 1.05 ulp = 2.1 u of
 *   at
 * most |ln| and 5e-8 < 1 u; times 1/4, + 1: (9 + 2.1 |ln| + 1)/4 + |1/4 ln| + |x0| sqrt(sin th):
 * (4+5+1)/4+1/2+1 = 4;  c: 3.5;  sqrt(1-c) = sqrt(d.d/4/(1+c)): (5+(3.5+1)+1)/2+1 = 6.25 wi.z
 *                       wo.z: 1;
 * wi.z + wo.z: 1.  Inputs 1, 3, 4, 5 are at most 2. Rounded up. */
static void half_difference_encoding_has_its_definition(void **state)
{
    (void)state;
    rng r = rng_make(14);
    double worst[6] = {0};
    for (int k = 0; k < 300000; k++) {
        float wi[3], wo[3], x[6];
        hnbrdf_material m = random_material(&r, 1);
        direction_uniform(&r, wo);
        if (k % 4 == 1)
            direction_grazing(&r, wo);
        direction_uniform(&r, wi);
        if (k % 4 == 2 && !direction_near_mirror(&r, m.alpha, wo, wi))
            continue;
        if (k % 4 == 3) /* near retroreflection */
            for (int i = 0; i < 3; i++)
                wi[i] = wo[i] + rng_range(&r, -1e-4f, 1e-4f) * (wo[2] < 1e-3f ? 0.0f : 1.0f);
        hnbrdf_pair p = hnbrdf_pair_make(wi, wo);
        hnbrdf_encode_half_difference(&p, x);

        long double s[3], d[3], s2 = 0, d2 = 0;
        for (int i = 0; i < 3; i++) {
            s[i] = (long double)wi[i] + (long double)wo[i];
            d[i] = (long double)wi[i] - (long double)wo[i];
            s2 += s[i] * s[i];
            d2 += d[i] * d[i];
        }
        long double theta_h = atan2l(hypotl(s[0], s[1]), s[2]), c = sqrtl(s2) / 2;
        long double t = tanl(theta_h), ln = logl(1e-5L + t * t);
        /* For unit vectors 1 - c = d2/4/(1 + c); float vectors are unit to 1e-7 only. */
        const long double expected[6] = {1 + ln / 4,
                                         sqrtl(sinl(theta_h)),
                                         c,
                                         sqrtl(d2 / 4 / (1 + c)),
                                         (long double)wi[2] * (long double)wo[2],
                                         (long double)wi[2] + (long double)wo[2]};
        const double bound[6] = {(2.5 + 0.78 * fabs((double)ln) + fabs((double)expected[0])) * UNIT,
                                 4 * (double)expected[1] * UNIT,
                                 4 * (double)expected[2] * UNIT,
                                 7 * (double)expected[3] * UNIT,
                                 1 * (double)expected[4] * UNIT,
                                 1 * (double)expected[5] * UNIT};
        for (int i = 0; i < 6; i++) {
            double error = fabs((double)(x[i] - expected[i]));
            worst[i] = fmax(worst[i], error);
            if (!(error <= bound[i] * (1 + 1e-6)))
                fail_msg("input %d: %.9g, expected %.9g +- %.3g", i, (double)x[i],
                         (double)expected[i], bound[i]);
        }
    }
    print_message("    half-difference: worst absolute %.2g %.2g %.2g %.2g %.2g %.2g\n", worst[0],
                  worst[1], worst[2], worst[3], worst[4], worst[5]);
}

/* The inputs by angles in long double. Errors in u = 2^-24 as above: q = 1 - c from d.d/4/(1+c)
 *   11.5;
 *   ln(1e-5 + tan^2): as above;  sin th: (4+5+1)/2+1 = 6;  ln(1e-3 + q)/4: the argument 12.5 + 1,
 *                                log
 * itself 2.1 u of |ln| and 1 u, all by 1/4, + 1 u of the result;  |h.x|: 1 + (5/2+1) + 1 = 5.5.
 * Rounded up. */
static void angle_encodings_have_their_definition(void **state)
{
    (void)state;
    rng r = rng_make(15);
    for (int k = 0; k < 200000; k++) {
        float wi[3], wo[3], x[6], directed[6], turned[6], azimuths[6];
        direction_uniform(&r, wo);
        direction_uniform(&r, wi);
        if (k % 4 == 1)
            direction_grazing(&r, wo);
        if (k % 4 == 3)
            for (int i = 0; i < 3; i++)
                wi[i] = wo[i] + rng_range(&r, -1e-4f, 1e-4f) * (wo[2] < 1e-3f ? 0.0f : 1.0f);
        hnbrdf_pair p = hnbrdf_pair_make(wi, wo);
        hnbrdf_encode_angles(&p, x);
        hnbrdf_encode_angles_directed(&p, directed);
        hnbrdf_encode_angles_anisotropic(&p, turned);
        hnbrdf_encode_angles_azimuths(&p, azimuths);
        long double s[3], s2 = 0, d2 = 0;
        for (int i = 0; i < 3; i++) {
            long double d = (long double)wi[i] - (long double)wo[i];
            s[i] = (long double)wi[i] + (long double)wo[i];
            s2 += s[i] * s[i];
            d2 += d * d;
        }
        long double theta_h = atan2l(hypotl(s[0], s[1]), s[2]), q = d2 / 4 / (1 + sqrtl(s2) / 2);
        long double ln_h = logl(1e-5L + tanl(theta_h) * tanl(theta_h)), ln_d = logl(1e-3L + q);
        const long double expected[6] = {1 + ln_h / 4,        sinl(theta_h),      ln_d / 4, q,
                                         fminf(wi[2], wo[2]), fmaxf(wi[2], wo[2])};
        const double bound[6] = {(2.5 + 0.78 * fabs((double)ln_h) + fabs((double)expected[0])) *
                                     UNIT,
                                 6 * (double)expected[1] * UNIT,
                                 (3.7 + 0.78 * fabs((double)ln_d)) * UNIT,
                                 12 * (double)q * UNIT,
                                 0,
                                 0};
        for (int i = 0; i < 6; i++)
            if (!(fabs((double)(x[i] - expected[i])) <= bound[i] * (1 + 1e-6)))
                fail_msg("input %d: %.9g, expected %.9g +- %.3g", i, (double)x[i],
                         (double)expected[i], bound[i]);
        assert_memory_equal(x, directed, 4 * sizeof(float));
        assert_true(directed[4] == wi[2] && directed[5] == wo[2]);
        for (int i = 0; i < 2; i++) {
            double h = fabs((double)(s[i] / sqrtl(s2)));
            assert_true(fabs((double)turned[1 + 2 * i] - h) <= 6 * h * UNIT);
        }
        assert_true(turned[0] == x[0] && turned[2] == x[2] && turned[4] == x[4] &&
                    turned[5] == x[5]);
        assert_true(azimuths[1] == turned[1] && azimuths[5] == fabsf(wi[0] - wo[0]) / 2);
        azimuths[1] = x[1];
        assert_memory_equal(azimuths, x, 5 * sizeof(float));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(network_equals_its_definition_in_double),
        cmocka_unit_test(network_sums_in_the_canonical_order),
        cmocka_unit_test(block_has_the_bits_of_single_evaluations),
        cmocka_unit_test(hard_gelu_is_the_three_branch_form),
        cmocka_unit_test(directions_are_encoded_as_they_are),
        cmocka_unit_test(half_difference_encoding_has_its_definition),
        cmocka_unit_test(angle_encodings_have_their_definition),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
