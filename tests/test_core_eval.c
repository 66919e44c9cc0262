/* test_core_eval.c: f(wi, wo) of whole models: composition, batches, reciprocity, frames, and
 * what comes out of directions and materials that nobody should pass. */
#include "core_support.h"

#include "core/compose.h"
#include "core/encoding.h"
#include "core/network.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static const hnbrdf_kind kinds[] = {HNBRDF_KIND_HYBRID, HNBRDF_KIND_NEURAL, HNBRDF_KIND_GGX};
static const hnbrdf_encoding encodings[] = {
    HNBRDF_ENCODING_DIRECTIONS,         HNBRDF_ENCODING_HALF_DIFFERENCE,
    HNBRDF_ENCODING_ANGLES_DIRECTED,    HNBRDF_ENCODING_ANGLES,
    HNBRDF_ENCODING_ANGLES_ANISOTROPIC, HNBRDF_ENCODING_ANGLES_AZIMUTHS};

typedef void visit(rng *r, const hnbrdf_model *model);

/* Every kind and encoding, with a few network shapes. */
static void for_each_model(uint64_t seed, visit *visitor)
{
    static const int shapes[][3] = {{32, 2, 4}, {7, 3, 0}, {33, 1, 16}};
    rng r = rng_make(seed);
    for (size_t k = 0; k < 3; k++)
        for (size_t e = 0; e < sizeof encodings / sizeof encodings[0]; e++)
            for (size_t s = 0; s < sizeof shapes / sizeof shapes[0]; s++) {
                hnbrdf_model *model = random_model(&r, kinds[k], encodings[e], shapes[s][0],
                                                   shapes[s][1], shapes[s][2]);
                visitor(&r, model);
                hnbrdf_model_free(model);
            }
}

static hnbrdf_model_desc describe(const hnbrdf_model *model)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    return desc;
}

/* max(0, exp(s c + m) + sigmoid(g) f_a - b) in double, from the network's own outputs. Errors:
 * exp 1 ulp = 2 u, its argument u |s c + m| twice; the gate 4 u and u |g|; their product and two
 * sums u each. */
static void check_composition(rng *r, const hnbrdf_model *model)
{
    hnbrdf_model_desc desc = describe(model);
    if (desc.kind == HNBRDF_KIND_GGX)
        return;
    for (int k = 0; k < 1000; k++) {
        hnbrdf_material m = random_material(r, 1);
        float wi[3], wo[3], f[3], f_a[3], x[6], out[6];
        direction_uniform(r, wi);
        direction_uniform(r, wo);
        hnbrdf_pair pair = hnbrdf_pair_make(wi, wo);
        hnbrdf_encode(desc.encoding, &pair, x);
        hnbrdf_network(&desc, m.latent, x, out);
        hnbrdf_eval(model, &m, wi, wo, f);
        hnbrdf_eval_analytic(model, &m, wi, wo, f_a);
        for (int c = 0; c < 3; c++) {
            double argument = (double)desc.scale * (double)out[c] + (double)desc.shift;
            double sum = exp(fmax(-80.0, fmin(80.0, argument)));
            double error = (2 + 2 * fabs(argument)) * sum;
            if (desc.kind == HNBRDF_KIND_HYBRID) {
                double gated = (double)f_a[c] / (1.0 + exp(-(double)out[c + 3]));
                error += 5 * gated;
                sum += gated;
            }
            error = 1.01 * UNIT * (error + 2 * sum + (double)desc.floor);
            assert_true(fabs((double)f[c] - fmax(0.0, sum - (double)desc.floor)) <= error);
        }
    }
}

static void value_is_composed_as_the_paper_says(void **state)
{
    (void)state;
    for_each_model(21, check_composition);
}

static void scale_and_shift_act_on_the_correction(void **state)
{
    (void)state;
    rng r = rng_make(22);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_NEURAL, HNBRDF_ENCODING_DIRECTIONS, 8, 1, 4);
    hnbrdf_model_desc desc = describe(model);
    hnbrdf_model *scaled = NULL;
    desc.floor = 0.0f;
    desc.scale = 0.5f;
    desc.shift = -1.25f;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &scaled, NULL), HNBRDF_OK);
    for (int k = 0; k < 1000; k++) {
        hnbrdf_material m = random_material(&r, 1);
        float wi[3], wo[3], x[6], out[6], f[3];
        direction_uniform(&r, wi);
        direction_uniform(&r, wo);
        hnbrdf_pair pair = hnbrdf_pair_make(wi, wo);
        hnbrdf_encode_directions(&pair, x);
        hnbrdf_network(&desc, m.latent, x, out);
        hnbrdf_eval(scaled, &m, wi, wo, f);
        for (int c = 0; c < 3; c++) {
            double argument = 0.5 * (double)out[c] - 1.25, expected = exp(argument);
            assert_true(fabs((double)f[c] - expected) <=
                        (3 + 2 * fabs(argument)) * UNIT * expected);
        }
    }
    hnbrdf_model_free(scaled);
    hnbrdf_model_free(model);
}

/* Pairs of all sorts, some below the horizon and some that are no directions at all. */
static void mixed_pair(rng *r, const hnbrdf_material *m, float wi[3], float wo[3])
{
    direction_uniform(r, wi);
    direction_uniform(r, wo);
    switch (rng_u32(r) % 8) {
    case 0:
        wi[2] = -wi[2];
        break;
    case 1:
        direction_grazing(r, wo);
        break;
    case 2:
        wo[2] = 0.0f;
        break;
    case 3:
        direction_near_mirror(r, m->alpha, wo, wi);
        break;
    case 4:
        wi[rng_u32(r) % 3] = NAN;
        break;
    default:
        break;
    }
}

enum { BATCH = 70 };

static void check_batch(rng *r, const hnbrdf_model *model)
{
    static const size_t counts[] = {0, 1, 2, 3, 15, 16, 17, 31, 33, 48, BATCH};
    static const size_t strides[] = {0, 12, 16, 20, 28}; /* bytes */
    for (size_t n = 0; n < sizeof counts / sizeof counts[0]; n++)
        for (size_t s = 0; s < sizeof strides / sizeof strides[0]; s++) {
            hnbrdf_material m = random_material(r, s & 1);
            size_t step_i = strides[s], step_o = strides[(s + 1) % 5],
                   step_f = strides[(s + 2) % 5];
            size_t i = (step_i ? step_i : 12) / 4, o = (step_o ? step_o : 12) / 4;
            size_t v = (step_f ? step_f : 12) / 4;
            float wi[BATCH * 7], wo[BATCH * 7], f[BATCH * 7 + 7], single[3];
            for (size_t k = 0; k < BATCH * 7 + 7; k++)
                f[k] = -77.0f;
            for (size_t k = 0; k < counts[n]; k++)
                mixed_pair(r, &m, wi + k * i, wo + k * o);
            hnbrdf_eval_batch(model, &m, counts[n], wi, step_i, wo, step_o, f, step_f);
            for (size_t k = 0; k < counts[n]; k++) {
                hnbrdf_eval(model, &m, wi + k * i, wo + k * o, single);
                assert_same_bits(f + k * v, single, 3);
                for (size_t gap = 3; gap < v; gap++)
                    /* nothing between the values is touched */
                    assert_true(f[k * v + gap] == -77.0f);
            }
            for (size_t k = counts[n] * v; k < BATCH * 7 + 7; k++)
                assert_true(f[k] == -77.0f);
        }
}

static void batch_has_the_bits_of_single_evaluations(void **state)
{
    (void)state;
    for_each_model(23, check_batch);
}

static void check_reciprocity(rng *r, const hnbrdf_model *model)
{
    hnbrdf_model_desc desc = describe(model);
    int reciprocal =
        desc.kind == HNBRDF_KIND_GGX || (desc.encoding != HNBRDF_ENCODING_DIRECTIONS &&
                                         desc.encoding != HNBRDF_ENCODING_ANGLES_DIRECTED);
    int differences = 0;
    for (int k = 0; k < 1000; k++) {
        hnbrdf_material m = random_material(r, k & 1);
        float wi[3], wo[3], f[3], g[3];
        mixed_pair(r, &m, wi, wo);
        hnbrdf_eval(model, &m, wi, wo, f);
        hnbrdf_eval(model, &m, wo, wi, g);
        if (reciprocal)
            assert_same_bits(f, g, 3);
        differences += memcmp(f, g, sizeof f) != 0;
    }
    if (!reciprocal) /* or this test would not see a lost direction */
        assert_true(differences > 300);
}

static void reciprocity_is_exact_for_ggx_and_every_encoding_that_says_so(void **state)
{
    (void)state;
    for_each_model(24, check_reciprocity);
}

/* A quarter turn moves components without rounding. Only `directions`, `angles-anisotropic` and
 * `angles-azimuths` may see the azimuth. */
static void check_quarter_turn(rng *r, const hnbrdf_model *model)
{
    hnbrdf_model_desc desc = describe(model);
    if (desc.kind != HNBRDF_KIND_GGX && (desc.encoding == HNBRDF_ENCODING_DIRECTIONS ||
                                         desc.encoding == HNBRDF_ENCODING_ANGLES_ANISOTROPIC ||
                                         desc.encoding == HNBRDF_ENCODING_ANGLES_AZIMUTHS))
        return;
    for (int k = 0; k < 1000; k++) {
        hnbrdf_material m = random_material(r, 1);
        float wi[3], wo[3], f[3], g[3];
        direction_uniform(r, wi);
        direction_uniform(r, wo);
        const float turned_i[3] = {-wi[1], wi[0], wi[2]}, turned_o[3] = {-wo[1], wo[0], wo[2]};
        hnbrdf_eval(model, &m, wi, wo, f);
        hnbrdf_eval(model, &m, turned_i, turned_o, g);
        assert_same_bits(f, g, 3);
    }
}

static void isotropic_materials_do_not_see_the_azimuth(void **state)
{
    (void)state;
    for_each_model(25, check_quarter_turn);
}

/* Turning the material by its rotation equals turning both directions back, to the bit when the
 * turned directions are made the same way. The angle's own sign and sense is tested with the
 * analytic part. */
static void check_rotation(rng *r, const hnbrdf_model *model)
{
    for (int k = 0; k < 1000; k++) {
        hnbrdf_material m = random_material(r, 0);
        float wi[3], wo[3], f[3], g[3], i[3], o[3];
        direction_uniform(r, wi);
        direction_uniform(r, wo);
        hnbrdf_eval(model, &m, wi, wo, f);
        float cosine = (float)cos((double)m.rotation), sine = (float)sin((double)m.rotation);
        i[0] = cosine * wi[0] + sine * wi[1];
        i[1] = cosine * wi[1] - sine * wi[0];
        o[0] = cosine * wo[0] + sine * wo[1];
        o[1] = cosine * wo[1] - sine * wo[0];
        i[2] = wi[2];
        o[2] = wo[2];
        m.rotation = 0.0f;
        hnbrdf_eval(model, &m, i, o, g);
        assert_same_bits(f, g, 3);
    }
}

static void rotation_reaches_network_and_analytic_part_alike(void **state)
{
    (void)state;
    for_each_model(26, check_rotation);
}

static void check_horizon(rng *r, const hnbrdf_model *model)
{
    static const float below[] = {0.0f, -0.0f, -1e-30f, -0.5f, -INFINITY, NAN};
    for (size_t k = 0; k < sizeof below / sizeof below[0]; k++)
        for (int which = 1; which < 4; which++) {
            hnbrdf_material m = random_material(r, 0);
            float w[2][3], f[3] = {7, 7, 7}, f_a[3] = {7, 7, 7};
            static const float zero[3] = {0.0f, 0.0f, 0.0f};
            direction_uniform(r, w[0]);
            direction_uniform(r, w[1]);
            if (which & 1)
                w[0][2] = below[k];
            if (which & 2)
                w[1][2] = below[k];
            hnbrdf_eval(model, &m, w[0], w[1], f);
            hnbrdf_eval_analytic(model, &m, w[0], w[1], f_a);
            assert_same_bits(f, zero, 3);
            assert_same_bits(f_a, zero, 3);
        }
}

static void value_is_zero_at_and_below_the_horizon(void **state)
{
    (void)state;
    for_each_model(27, check_horizon);
}

static void assert_value(const float f[3])
{
    for (int c = 0; c < 3; c++)
        assert_true(f[c] >= 0.0f && f[c] <= HNBRDF_MAX_VALUE);
}

static void check_bad_numbers(rng *r, const hnbrdf_model *model)
{
    static const float bad[] = {0.0f,   -0.0f, 1e-45f,   -1e-38f,   1e-20f, 1.0f,  -1.0f,   1e18f,
                                -3e38f, 3e38f, INFINITY, -INFINITY, NAN,    1e-6f, 0.99999f};
    const uint32_t n = sizeof bad / sizeof bad[0];
    for (int k = 0; k < 2000; k++) {
        hnbrdf_material m = random_material(r, 0);
        float wi[3], wo[3], f[3], g[3], all[3];
        direction_uniform(r, wi);
        direction_uniform(r, wo);
        for (uint32_t times = 1 + rng_u32(r) % 3; times > 0; times--) {
            float *place = rng_u32(r) & 1 ? wi : wo;
            if (k % 4 == 0) /* any field of the material, out of its range too */
                place = (float *)&m + rng_u32(r) % 23;
            place[rng_u32(r) % 3] = bad[rng_u32(r) % n];
        }
        hnbrdf_eval(model, &m, wi, wo, f);
        assert_value(f);
        hnbrdf_eval_analytic(model, &m, wi, wo, g);
        assert_value(g);
        hnbrdf_eval_batch(model, &m, 1, wi, 0, wo, 0, all, 0);
        assert_same_bits(all, f, 3);
    }
}

static void value_is_finite_and_not_negative_whatever_is_passed(void **state)
{
    (void)state;
    for_each_model(28, check_bad_numbers);
}

/* Float normals of a renderer are off unit length by a few ulp. ln f moves by less than 8/alpha
 * times the change of h where the network is left out. */
static void value_is_stable_for_directions_that_are_nearly_unit(void **state)
{
    (void)state;
    rng r = rng_make(29);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    for (int k = 0; k < 20000; k++) {
        hnbrdf_material m = random_material(&r, 1);
        m.alpha[0] = m.alpha[1] = fmaxf(m.alpha[0], 0.05f);
        float wi[3], wo[3], scaled[3], f[3], g[3];
        direction(0.1 + 0.9 * (double)rng_float(&r), 6.0 * (double)rng_float(&r), wi);
        direction(0.1 + 0.9 * (double)rng_float(&r), 6.0 * (double)rng_float(&r), wo);
        for (int i = 0; i < 3; i++)
            scaled[i] = wi[i] * (1.0f + 4e-6f);
        hnbrdf_eval(model, &m, wi, wo, f);
        hnbrdf_eval(model, &m, scaled, wo, g);
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(f[c] - g[c]) <= 8.0f / 0.05f * 2 * 4e-6f / 0.2f * f[c]);
    }
    hnbrdf_model_free(model);
}

static void neural_models_have_no_analytic_part(void **state)
{
    (void)state;
    rng r = rng_make(30);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_NEURAL, HNBRDF_ENCODING_DIRECTIONS, 8, 2, 4);
    hnbrdf_material m = random_material(&r, 1), edited = m;
    const float w[3] = {0.0f, 0.6f, 0.8f}, zero[3] = {0.0f, 0.0f, 0.0f};
    float f[3], g[3];
    hnbrdf_eval_analytic(model, &m, w, w, f);
    assert_same_bits(f, zero, 3);
    edited.kd[0] = 0.9f;
    edited.alpha[0] = edited.alpha[1] = 0.9f;
    hnbrdf_eval(model, &m, w, w, f);
    hnbrdf_eval(model, &edited, w, w, g);
    assert_same_bits(f, g, 3);
    hnbrdf_model_free(model);
}

static void latent_code_changes_the_value(void **state)
{
    (void)state;
    rng r = rng_make(31);
    hnbrdf_model *model =
        random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_HALF_DIFFERENCE, 16, 2, 4);
    const float w[3] = {0.0f, 0.6f, 0.8f};
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++) {
        hnbrdf_material m = random_material(&r, 1), edited = m;
        float f[3], g[3];
        edited.latent[i] += 1.0f;
        hnbrdf_eval(model, &m, w, w, f);
        hnbrdf_eval(model, &edited, w, w, g);
        /* the first l count, the rest do not */
        assert_int_equal(memcmp(f, g, sizeof f) != 0, i < 4);
    }
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(value_is_composed_as_the_paper_says),
        cmocka_unit_test(scale_and_shift_act_on_the_correction),
        cmocka_unit_test(batch_has_the_bits_of_single_evaluations),
        cmocka_unit_test(reciprocity_is_exact_for_ggx_and_every_encoding_that_says_so),
        cmocka_unit_test(isotropic_materials_do_not_see_the_azimuth),
        cmocka_unit_test(rotation_reaches_network_and_analytic_part_alike),
        cmocka_unit_test(value_is_zero_at_and_below_the_horizon),
        cmocka_unit_test(value_is_finite_and_not_negative_whatever_is_passed),
        cmocka_unit_test(value_is_stable_for_directions_that_are_nearly_unit),
        cmocka_unit_test(neural_models_have_no_analytic_part),
        cmocka_unit_test(latent_code_changes_the_value),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
