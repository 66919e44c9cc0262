/* test_core_analytic.c: the analytic part, compared with the formulas written out in long
 * double, and what must hold for any direction: conventions, symmetry, the horizon, bad numbers. */
#include "core_support.h"

#include "core/microfacet.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

typedef long double real;

static const real pi = 3.14159265358979323846264338327950288L;

/* f_a of one channel by the formulas as they are printed (Walter 2007; Heitz 2014), without a
 * rewrite. The difference angle is taken as c = |wi + wo|/2, which is wi.h for unit vectors:
 * float vectors are not quite unit, and this is the definition the library documents. */
static real g1(const real w[3], real ax, real ay)
{
    return 2 * w[2] / (w[2] + sqrtl(w[2] * w[2] + ax * ax * w[0] * w[0] + ay * ay * w[1] * w[1]));
}

static real fresnel(real eta, real c)
{
    real g = sqrtl(eta * eta - 1 + c * c);
    real a = (g - c) / (g + c), b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return a * a * (1 + b * b) / 2;
}

static real ggx_d(const real h[3], real ax, real ay)
{
    real t = h[0] * h[0] / (ax * ax) + h[1] * h[1] / (ay * ay) + h[2] * h[2];
    return 1 / (pi * ax * ay * t * t);
}

static real analytic(const hnbrdf_material *m, int channel, const float wi[3], const float wo[3])
{
    real ax = m->alpha[0], ay = m->alpha[1];
    real i[3] = {wi[0], wi[1], wi[2]}, o[3] = {wo[0], wo[1], wo[2]};
    real s[3] = {i[0] + o[0], i[1] + o[1], i[2] + o[2]};
    real length = sqrtl(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
    real h[3] = {s[0] / length, s[1] / length, s[2] / length};
    return m->kd[channel] / pi + fresnel(m->eta[channel], length / 2) * ggx_d(h, ax, ay) *
                                     g1(i, ax, ay) * g1(o, ax, ay) / (4 * i[2] * o[2]);
}

/* Worst-case relative error of hnbrdf_eval_analytic(), in units u = 2^-24, first order, every sum
 * being one of positive terms (k.5: a constant that is itself rounded counts half):
 *   s: 1    s.s: 1+1+1+2 = 5    c = |s|/2: 5/2+1 = 3.5    t = dot(s/a)/(s.s): (2*2+1+2)+5+1 = 13
 *   D = 1/(pi ax ay t^2): 0.5+2 + 2*13+1 + 1+1 = 31.5         V: 1/(z + sqrt(5/2+1)+1)+1: 5.5 each
 *   D V V: 31.5 + 2*5.5+1 + 1 = 44.5
 *   e = eta^2-1: 3    g: (max(3, 2*3.5+1)+1)/2+1 = 5.5    g+c: 6.5    g-c: 3+6.5+1 = 10.5
 *   a = (g-c)/(g+c): 10.5+6.5+1 = 18, a^2: 37
 *   b: |b| <= 1, so c(g+c) <= 2 (c(g-c)+1) and the cancelling numerator adds at most 2*(3.5+6.5+1);
 *      with the denominator's 3.5+10.5+1+1 and two roundings: 40 absolute; 1+b^2: (2*40+1)/2+1 =
 *      41.5
 *   F = a^2/2 (1+b^2): 37+41.5+1 = 79.5;  F D V V: 79.5+44.5+1 = 125;  + kd/pi: 126.
 * 128 leaves room for the second order. */
static const double worst_case = 128 * UNIT;

static double worst;

static void compare_pair(const hnbrdf_model *model, const hnbrdf_material *m, const float wi[3],
                         const float wo[3])
{
    float f[3];
    hnbrdf_eval_analytic(model, m, wi, wo, f);
    for (int c = 0; c < 3; c++) {
        double reference = (double)analytic(m, c, wi, wo);
        double relative = fabs((double)f[c] - reference) / reference;
        worst = fmax(worst, relative);
        if (!(relative <= worst_case))
            fail_msg(
                "relative error %.3g, bound %.3g; got %.9g, expected %.9g; alpha %g %g, eta %.9g\n"
                "wi %.9g %.9g %.9g wo %.9g %.9g %.9g",
                relative, worst_case, (double)f[c], reference, (double)m->alpha[0],
                (double)m->alpha[1], (double)m->eta[c], (double)wi[0], (double)wi[1], (double)wi[2],
                (double)wo[0], (double)wo[1], (double)wo[2]);
    }
}

static hnbrdf_model *ggx_model(rng *r)
{
    return random_model(r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
}

/* Random, grazing and near-mirror pairs of one material, in its own tangent frame (rotation 0: the
 * rotation's rounding is another test's subject). */
static void compare_material(const hnbrdf_model *model, hnbrdf_material m, rng *r, int pairs)
{
    float wi[3], wo[3];
    m.rotation = 0.0f;
    for (int k = 0; k < pairs; k++) {
        direction_uniform(r, wi);
        direction_uniform(r, wo);
        compare_pair(model, &m, wi, wo);
        direction_grazing(r, wi);
        compare_pair(model, &m, wi, wo);
        direction_grazing(r, wo);
        compare_pair(model, &m, wi, wo);
        if (direction_near_mirror(r, m.alpha, wo, wi))
            compare_pair(model, &m, wi, wo);
        direction_uniform(r, wo);
        if (direction_near_mirror(r, m.alpha, wo, wi))
            compare_pair(model, &m, wi, wo);
    }
}

static void analytic_equals_the_printed_formulas(void **state)
{
    (void)state;
    rng r = rng_make(1);
    hnbrdf_model *model = ggx_model(&r);
    worst = 0.0;
    for (int k = 0; k < 400; k++)
        compare_material(model, random_material(&r, k & 1), &r, 100);
    print_message("    random materials: worst relative error %.3g, bound %.3g\n", worst,
                  worst_case);
    hnbrdf_model_free(model);
}

static void analytic_is_right_at_the_ends_of_the_parameter_ranges(void **state)
{
    (void)state;
    static const float alphas[][2] = {{1e-4f, 1e-4f}, {1.0f, 1.0f}, {1.0f, 1e-4f}, {1e-4f, 1.0f}};
    static const float etas[] = {1.00000012f, 1.000001f, 1.0001f, 1.001f, 3.0f, HNBRDF_MAX_ETA};
    rng r = rng_make(2);
    hnbrdf_model *model = ggx_model(&r);
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    worst = 0.0;
    for (size_t a = 0; a < sizeof alphas / sizeof alphas[0]; a++)
        for (size_t e = 0; e < sizeof etas / sizeof etas[0]; e++)
            for (int k = 0; k < 2; k++) {
                m.alpha[0] = fmaxf(alphas[a][0], HNBRDF_MIN_ALPHA);
                m.alpha[1] = fmaxf(alphas[a][1], HNBRDF_MIN_ALPHA);
                m.eta[0] = m.eta[1] = m.eta[2] = etas[e];
                m.kd[0] = m.kd[1] = m.kd[2] = (float)k;
                assert_int_equal(hnbrdf_material_check(&m, NULL), HNBRDF_OK);
                compare_material(model, m, &r, 500);
            }
    print_message("    range ends: worst relative error %.3g, bound %.3g\n", worst, worst_case);
    hnbrdf_model_free(model);
}

/* Normal incidence, written out by hand: f = kd/pi + ((eta-1)/(eta+1))^2 / (4 pi alpha^2). */
static void normal_incidence_has_its_closed_form(void **state)
{
    (void)state;
    rng r = rng_make(3);
    hnbrdf_model *model = ggx_model(&r);
    const float n[3] = {0.0f, 0.0f, 1.0f};
    for (int k = 0; k < 1000; k++) {
        hnbrdf_material m = random_material(&r, 0);
        float f[3];
        hnbrdf_eval_analytic(model, &m, n, n, f);
        for (int c = 0; c < 3; c++) {
            double eta = (double)m.eta[c], r0 = (eta - 1) / (eta + 1);
            double expected = (double)m.kd[c] / (double)pi +
                              r0 * r0 / (4 * (double)pi * (double)m.alpha[0] * (double)m.alpha[1]);
            assert_true(fabs((double)f[c] - expected) <= worst_case * expected);
        }
    }
    hnbrdf_model_free(model);
}

/* c = |s|/2 stands for wi.h. With float directions, off unit length by up to 2^-24 each, the two
 * differ by (|wi|^2 - |wo|^2) / (2 |s|), at most 4 * 2^-24 / (2 |s|); float rounding of c adds
 * 3.5 * 2^-24. */
static void cosine_of_the_difference_angle_is_wi_dot_h(void **state)
{
    (void)state;
    rng r = rng_make(4);
    for (int k = 0; k < 100000; k++) {
        float wi[3], wo[3];
        direction_uniform(&r, wi);
        direction_uniform(&r, wo);
        hnbrdf_pair p = hnbrdf_pair_make(wi, wo);
        double s[3], length = 0, dot = 0;
        for (int i = 0; i < 3; i++) {
            s[i] = (double)wi[i] + (double)wo[i];
            length += s[i] * s[i];
            dot += (double)wi[i] * s[i];
        }
        length = sqrt(length);
        assert_true(fabs((double)p.c - dot / length) <= (4.0 / (2 * length) + 3.5) * UNIT);
    }
}

static void analytic_is_reciprocal_to_the_bit(void **state)
{
    (void)state;
    rng r = rng_make(5);
    hnbrdf_model *model = ggx_model(&r);
    for (int k = 0; k < 100000; k++) {
        hnbrdf_material m = random_material(&r, k & 1);
        float wi[3], wo[3], f[3], g[3];
        direction_uniform(&r, wi);
        if (k % 3)
            direction_uniform(&r, wo);
        else
            direction_grazing(&r, wo);
        hnbrdf_eval(model, &m, wi, wo, f);
        hnbrdf_eval(model, &m, wo, wi, g);
        assert_same_bits(f, g, 3);
    }
    hnbrdf_model_free(model);
}

/* A material turned by r, seen from directions turned by r, is the material itself. The turned
 * directions are rounded (3 u each component: product, sum, and the input of unit size), h moves
 * by 2*3u/|s|, and ln f by 4 |d ln t^(1/2)/dh| |dh| <= 4/(2 alpha) |dh| for D and less than
 * 2/alpha' for the rest: 4/alpha * 6u/|s| covers both, |s| >= 0.2, next to twice the evaluation
 * error itself. */
static void rotation_turns_the_tangent_frame_counter_clockwise(void **state)
{
    (void)state;
    rng r = rng_make(6);
    hnbrdf_model *model = ggx_model(&r);
    for (int k = 0; k < 20000; k++) {
        hnbrdf_material m = random_material(&r, 0);
        m.alpha[0] = fmaxf(m.alpha[0], 0.02f);
        m.alpha[1] = fmaxf(m.alpha[1], 0.02f);
        double angle = (double)m.rotation;
        double ti = 6.3 * (double)rng_float(&r), to = 6.3 * (double)rng_float(&r);
        double ci = 0.1 + 0.9 * (double)rng_float(&r), co = 0.1 + 0.9 * (double)rng_float(&r);
        float wi[3], wo[3], wi_turned[3], wo_turned[3], f[3], turned[3];
        direction(ci, ti, wi);
        direction(co, to, wo);
        direction(ci, ti + angle, wi_turned);
        direction(co, to + angle, wo_turned);
        hnbrdf_eval(model, &m, wi_turned, wo_turned, turned);
        m.rotation = 0.0f;
        hnbrdf_eval(model, &m, wi, wo, f);
        double alpha = (double)fminf(m.alpha[0], m.alpha[1]);
        double tolerance = 4.0 / alpha * 6 * UNIT / 0.2 + 2 * worst_case;
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)f[c] - (double)turned[c]) <= tolerance * (double)f[c]);
    }
    hnbrdf_model_free(model);
}

/* alpha_x is the roughness along the tangent: a half vector tilted along x sees it, along y it
 * does not; a quarter turn counter-clockwise brings the tangent to +y. */
static void alpha_x_acts_along_the_tangent(void **state)
{
    (void)state;
    rng r = rng_make(7);
    hnbrdf_model *model = ggx_model(&r);
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    m.alpha[0] = 0.5f;
    m.alpha[1] = 0.05f;
    const float n[3] = {0.0f, 0.0f, 1.0f};
    float along_x[3], along_y[3], fx[3], fy[3], turned_x[3], turned_y[3];
    direction(0.8, 0.0, along_x);
    direction(0.8, (double)pi / 2, along_y);
    hnbrdf_eval(model, &m, along_x, n, fx);
    hnbrdf_eval(model, &m, along_y, n, fy);
    m.rotation = (float)(pi / 2);
    hnbrdf_eval(model, &m, along_x, n, turned_x);
    hnbrdf_eval(model, &m, along_y, n, turned_y);
    for (int c = 0; c < 3; c++) {
        assert_true(fx[c] > 1.2f * fy[c]);
        assert_true(fabsf(turned_y[c] - fx[c]) <= 1e-5f * fx[c]);
        assert_true(fabsf(turned_x[c] - fy[c]) <= 1e-5f * fy[c]);
    }
    hnbrdf_model_free(model);
}

/* A quarter turn and a mirror image move components without rounding: the same bits. */
static void isotropic_analytic_does_not_see_the_azimuth(void **state)
{
    (void)state;
    rng r = rng_make(8);
    hnbrdf_model *model = ggx_model(&r);
    for (int k = 0; k < 20000; k++) {
        hnbrdf_material m = random_material(&r, 1);
        float wi[3], wo[3], f[3], g[3];
        direction_uniform(&r, wi);
        direction_uniform(&r, wo);
        hnbrdf_eval(model, &m, wi, wo, f);
        const float turned_i[3] = {-wi[1], wi[0], wi[2]}, turned_o[3] = {-wo[1], wo[0], wo[2]};
        hnbrdf_eval(model, &m, turned_i, turned_o, g);
        assert_same_bits(f, g, 3);
        const float mirror_i[3] = {wi[0], -wi[1], wi[2]}, mirror_o[3] = {wo[0], -wo[1], wo[2]};
        hnbrdf_eval(model, &m, mirror_i, mirror_o, g);
        assert_same_bits(f, g, 3);
    }
    hnbrdf_model_free(model);
}

/* alpha, kd and eta each do what their name says. */
static void editing_moves_the_value_the_way_ggx_moves(void **state)
{
    (void)state;
    rng r = rng_make(9);
    hnbrdf_model *model = ggx_model(&r);
    hnbrdf_material m;
    hnbrdf_material_init(&m);
    float w[3], mirror[3], base[3], edited[3];
    direction(0.7, 0.3, w);
    mirror[0] = -w[0];
    mirror[1] = -w[1];
    mirror[2] = w[2];
    hnbrdf_eval(model, &m, w, mirror, base);
    m.kd[1] += 0.25f;
    hnbrdf_eval(model, &m, w, mirror, edited);
    assert_true(edited[0] == base[0] && edited[2] == base[2]);
    assert_true(fabsf(edited[1] - base[1] - 0.25f * 0.318309886f) < 1e-6f);
    m.kd[1] -= 0.25f;
    m.eta[2] = 2.0f;
    hnbrdf_eval(model, &m, w, mirror, edited);
    assert_true(edited[0] == base[0] && edited[1] == base[1] && edited[2] > base[2]);
    m.eta[2] = 1.5f;
    m.alpha[0] = m.alpha[1] = 0.25f;
    hnbrdf_eval(model, &m, w, mirror, edited);
    assert_true(edited[0] > base[0]);
    hnbrdf_model_free(model);
}

static void materials_out_of_range_are_refused(void **state)
{
    (void)state;
    hnbrdf_material good, m;
    hnbrdf_material_init(&good);
    assert_int_equal(hnbrdf_material_check(&good, NULL), HNBRDF_OK);
    assert_int_equal(sizeof good, 45 * sizeof(float));
    static const struct {
        size_t field;
        float bad[4];
        const char *name;
    } cases[] = {
        {offsetof(hnbrdf_material, kd[0]), {-1e-6f, 1.0001f, INFINITY, NAN}, "kd[0]"},
        {offsetof(hnbrdf_material, kd[2]), {-1.0f, 2.0f, -INFINITY, NAN}, "kd[2]"},
        {offsetof(hnbrdf_material, eta[0]), {1.0f, 0.5f, 1001.0f, NAN}, "eta[0]"},
        {offsetof(hnbrdf_material, eta[2]), {0.0f, -2.0f, INFINITY, NAN}, "eta[2]"},
        {offsetof(hnbrdf_material, alpha[0]), {0.0f, 9.9e-5f, 1.0001f, NAN}, "alpha[0]"},
        {offsetof(hnbrdf_material, alpha[1]), {-0.5f, 9.9e-5f, INFINITY, NAN}, "alpha[1]"},
        {offsetof(hnbrdf_material, rotation), {INFINITY, -INFINITY, NAN, NAN}, "rotation"},
        {offsetof(hnbrdf_material, latent[0]), {INFINITY, -INFINITY, NAN, NAN}, "latent[0]"},
        {offsetof(hnbrdf_material, lobes.scale[0]),
         {9.9e-5f, -1.1e4f, INFINITY, NAN},
         "lobes.scale[0]"},
        {offsetof(hnbrdf_material, lobes.share[0][3]),
         {-1e-6f, 1.0001f, INFINITY, NAN},
         "lobes.share[0][3]"},
        {offsetof(hnbrdf_material, lobes.share[1][0]),
         {-1e-6f, 1.0001f, INFINITY, NAN},
         "lobes.share[1][0]"},
        {offsetof(hnbrdf_material, latent[15]), {INFINITY, -INFINITY, NAN, NAN}, "latent[15]"},
        {offsetof(hnbrdf_material, fitted.kd[1]), {-1e-6f, 1.0001f, INFINITY, NAN}, "fitted.kd[1]"},
        {offsetof(hnbrdf_material, fitted.eta[2]), {1.0f, 0.5f, 1001.0f, NAN}, "fitted.eta[2]"},
        {offsetof(hnbrdf_material, fitted.alpha[0]),
         {0.0f, 9.9e-5f, 1.0001f, NAN},
         "fitted.alpha[0]"},
        {offsetof(hnbrdf_material, energy.horizon), {-1e-6f, 1.0001f, INFINITY, NAN}, "energy.h"},
        {offsetof(hnbrdf_material, energy.slope), {-1e-6f, 1.1e4f, INFINITY, NAN}, "energy.s"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
        for (int b = 0; b < 4; b++) {
            hnbrdf_error error = {""};
            m = as_fitted(good);
            memcpy((char *)&m + cases[k].field, &cases[k].bad[b], sizeof(float));
            assert_int_equal(hnbrdf_material_check(&m, &error), HNBRDF_ERROR_ARGUMENT);
            assert_memory_equal(error.text, cases[k].name, strlen(cases[k].name));
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(analytic_equals_the_printed_formulas),
        cmocka_unit_test(analytic_is_right_at_the_ends_of_the_parameter_ranges),
        cmocka_unit_test(normal_incidence_has_its_closed_form),
        cmocka_unit_test(cosine_of_the_difference_angle_is_wi_dot_h),
        cmocka_unit_test(analytic_is_reciprocal_to_the_bit),
        cmocka_unit_test(rotation_turns_the_tangent_frame_counter_clockwise),
        cmocka_unit_test(alpha_x_acts_along_the_tangent),
        cmocka_unit_test(isotropic_analytic_does_not_see_the_azimuth),
        cmocka_unit_test(editing_moves_the_value_the_way_ggx_moves),
        cmocka_unit_test(materials_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
