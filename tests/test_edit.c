/* test_edit.c: editing and mixing do to a fitted hybrid what an artist expects of the words. */
#include "hnbrdf/fit.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { DIRECTIONS = 400 };

/* Glossy ones: two that GGX alone cannot follow, two that it nearly can. */
static const char *const fitted[] = {"gold-two-lobe", "haze-aluminium", "metallic-paint-blue",
                                     "glossy-plastic-green"};
enum { FITTED = sizeof fitted / sizeof fitted[0] };

static hnbrdf_model *hybrid;

static int fit_once(void **state)
{
    (void)state;
    hnbrdf_measured *data[FITTED];
    hnbrdf_fit_options options = {.hidden = 16, .layers = 2, .steps = 400, .pool = 8192, .seed = 1};
    hnbrdf_error error;
    for (int k = 0; k < FITTED; k++) {
        int index = 0;
        while (strcmp(hnbrdf_measured_builtin_name(index), fitted[k]) != 0)
            index++;
        if (hnbrdf_measured_open_builtin(index, &data[k], NULL) != HNBRDF_OK)
            return -1;
    }
    hnbrdf_result result =
        hnbrdf_fit((const hnbrdf_measured *const *)data, FITTED, &options, &hybrid, NULL, &error);
    for (int k = 0; k < FITTED; k++)
        hnbrdf_measured_close(data[k]);
    return result == HNBRDF_OK ? 0 : -1;
}

static int free_model(void **state)
{
    (void)state;
    hnbrdf_model_free(hybrid);
    return 0;
}

/* ---- Looking --------------------------------------------------------------------------------- */

typedef void (*eval_fn)(const hnbrdf_model *, const hnbrdf_material *, const float *, const float *,
                        float *);

static void towards(double theta, double phi, float w[3])
{
    w[0] = (float)(sin(theta) * cos(phi));
    w[1] = (float)(sin(theta) * sin(phi));
    w[2] = (float)cos(theta);
}

/* Green, light and viewer together at theta: the half vector is there too. */
static double retro(eval_fn eval, const hnbrdf_material *material, double theta, double phi)
{
    float w[3], f[3];
    towards(theta, phi, w);
    eval(hybrid, material, w, w, f);
    return (double)f[1];
}

/* Angle from the normal where the highlight has fallen to half its height. */
static double half_width(eval_fn eval, const hnbrdf_material *material, double phi)
{
    double half = 0.5 * retro(eval, material, 0.0, phi), step = 1e-3, theta = 0.0;
    while (theta < 1.5 && retro(eval, material, theta, phi) > half)
        theta += step;
    return theta;
}

/* Pairs of the grid sampler, the same every time. */
static void draw(int count, float (*wi)[3], float (*wo)[3])
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 11, 0);
    for (int k = 0; k < count; k++)
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_GRID, &rng, wi[k], wo[k]);
}

static void set_alpha(hnbrdf_material *material, float x, float y)
{
    material->alpha[0] = x;
    material->alpha[1] = y;
}

/* ---- Editing --------------------------------------------------------------------------------- */

/* What the gate lets through of the analytic part at the normal, as a share of the whole: an edit
 * of kd shows the gate. */
static double analytic_share(const hnbrdf_material *material)
{
    hnbrdf_material brighter = *material;
    brighter.kd[1] += 0.5f;
    double whole = retro(hnbrdf_eval, material, 0.0, 0.0);
    double gate = (retro(hnbrdf_eval, &brighter, 0.0, 0.0) - whole) * (3.14159265358979 / 0.5);
    return gate * retro(hnbrdf_eval_analytic, material, 0.0, 0.0) / whole;
}

/* Of the light that comes back within 60 degrees of the normal, viewer and light together. */
static double mean_angle(eval_fn eval, const hnbrdf_material *material)
{
    double sum = 0.0, weighted = 0.0, step = 1e-3;
    for (double theta = 0.5 * step; theta < 1.05; theta += step) {
        double energy = retro(eval, material, theta, 0.0) * sin(theta) * cos(theta);
        sum += energy;
        weighted += energy * theta;
    }
    return weighted / sum;
}

/* The network's own correction keeps its shape, so the half width can only follow alpha while GGX
 * makes most of the peak; the mean angle follows it always. Past 0.3 a lobe has no half height to
 * speak of. */
static void larger_alpha_widens_the_highlight(void **state)
{
    static const float sweep[] = {0.01f, 0.02f, 0.04f, 0.07f, 0.1f, 0.15f, 0.2f, 0.3f};
    int tried = 0;
    (void)state;
    for (int m = 0; m < FITTED; m++) {
        hnbrdf_material material = *hnbrdf_model_material(hybrid, m);
        double width_a = 0.0, width = 0.0, mean = 0.0;
        for (int c = 0; c < 3; c++)
            material.kd[c] = 0.0f;
        for (size_t k = 0; k < sizeof sweep / sizeof sweep[0]; k++) {
            double before_a = width_a, before = width, mean_before = mean;
            set_alpha(&material, sweep[k], sweep[k]);
            width_a = half_width(hnbrdf_eval_analytic, &material, 0.0);
            width = half_width(hnbrdf_eval, &material, 0.0);
            mean = mean_angle(hnbrdf_eval, &material);
            assert_true(width_a > before_a);
            assert_true(mean > mean_before);
            if (analytic_share(&material) > 0.7) {
                assert_true(width > before);
                tried++;
            }
        }
    }
    assert_true(tried >= 12);
}

/* Of a material fitted with kd0, f is linear in kd up to 4 kd0, where kd carries the correction
 * along, and grows by dkd/pi from there on. Rounding: a few ulp of f and of the exponential, below
 * 16 ulp of their sum. */
static void kd_shifts_the_diffuse_level_linearly(void **state)
{
    float wi[DIRECTIONS][3], wo[DIRECTIONS][3];
    int tried = 0;
    (void)state;
    draw(DIRECTIONS, wi, wo);
    for (int m = 0; m < FITTED; m++)
        for (int k = 0; k < DIRECTIONS; k++) {
            hnbrdf_material material = *hnbrdf_model_material(hybrid, m);
            const float most = 4.0f * material.fitted.kd[1];
            const float steps[5] = {0.0f, 0.5f * most, most, most + 0.125f, most + 0.25f};
            float f[5][3];
            for (int n = 0; n < 5; n++) {
                material.kd[1] = steps[n];
                hnbrdf_eval(hybrid, &material, wi[k], wo[k], f[n]);
            }
            if (f[0][1] <= 0.0f)
                continue;
            double v[5], rounding;
            for (int n = 0; n < 5; n++)
                v[n] = (double)f[n][1];
            rounding = 16.0 * FLT_EPSILON * (v[0] + v[4] + 1.0);
            assert_true(fabs((v[2] - v[1]) - (v[1] - v[0])) <= 2.0 * rounding);
            for (int n = 3; n < 5; n++)
                assert_true(fabs(v[n] - v[n - 1] - 0.125 / 3.14159265358979) <= rounding);
            for (int other = 0; other < 3; other += 2)
                assert_true(f[0][other] == f[4][other]);
            tried++;
        }
    assert_true(tried > DIRECTIONS / 2);
}

/* Up to 45 degrees of incidence on the facet; towards grazing the reflectances of all dielectrics
 * meet at 1 and cross. */
static void larger_eta_reflects_more(void **state)
{
    static const float sweep[] = {1.05f, 1.3f, 1.5f, 2.0f, 4.0f, 20.0f, 1000.0f};
    float wi[DIRECTIONS][3], wo[DIRECTIONS][3];
    (void)state;
    draw(DIRECTIONS, wi, wo);
    for (int m = 0; m < FITTED; m++)
        for (int k = 0; k < DIRECTIONS; k++) {
            hnbrdf_material material = *hnbrdf_model_material(hybrid, m);
            float before = 0.0f, before_a = 0.0f, f[3], f_a[3];
            float cosine = wi[k][0] * wo[k][0] + wi[k][1] * wo[k][1] + wi[k][2] * wo[k][2];
            if (cosine < 0.0f) /* the difference angle is half of theirs */
                continue;
            for (size_t n = 0; n < sizeof sweep / sizeof sweep[0]; n++) {
                material.eta[1] = sweep[n];
                hnbrdf_eval(hybrid, &material, wi[k], wo[k], f);
                hnbrdf_eval_analytic(hybrid, &material, wi[k], wo[k], f_a);
                assert_true(f[1] >= before);
                assert_true(f_a[1] > before_a);
                before = f[1];
                before_a = f_a[1];
            }
        }
}

/* Along x the lobe is that of alpha_x, along y that of alpha_y, turned with the rotation. */
static void isotropic_made_anisotropic_has_both_lobes(void **state)
{
    const float x = 0.05f, y = 0.2f;
    const double turn = 0.5, quarter = 1.5707963267949;
    (void)state;
    for (int m = 2; m < FITTED; m++) {
        hnbrdf_material round = *hnbrdf_model_material(hybrid, m), both;
        for (int c = 0; c < 3; c++)
            round.kd[c] = 0.0f;
        assert_true(round.alpha[0] == round.alpha[1]);
        both = round;
        set_alpha(&both, x, y);
        both.rotation = (float)turn;
        assert_int_equal(hnbrdf_material_check(&both, NULL), HNBRDF_OK);
        for (int axis = 0; axis < 2; axis++) {
            double phi = turn + axis * quarter;
            set_alpha(&round, axis ? y : x, axis ? y : x);
            for (double theta = 0.02; theta < 0.5; theta += 0.02) {
                double wanted = retro(hnbrdf_eval_analytic, &round, theta, phi) /
                                retro(hnbrdf_eval_analytic, &round, 0.0, phi);
                double found = retro(hnbrdf_eval_analytic, &both, theta, phi) /
                               retro(hnbrdf_eval_analytic, &both, 0.0, phi);
                /* The axis is known to an ulp of a direction, 1e-7, and alpha_y/alpha_x magnifies
                 * it. */
                assert_true(fabs(found - wanted) <= 1e-5 * wanted);
                /* A half turn changes nothing. */
                found = retro(hnbrdf_eval, &both, theta, phi);
                assert_true(fabs(retro(hnbrdf_eval, &both, theta, phi + 2.0 * quarter) - found) <=
                            1e-4 * found + 1e-6);
            }
        }
        assert_true(half_width(hnbrdf_eval, &both, turn) <
                    0.8 * half_width(hnbrdf_eval, &both, turn + quarter));
        assert_true(retro(hnbrdf_eval, &both, 0.2, turn + quarter) >
                    1.2 * retro(hnbrdf_eval, &both, 0.2, turn));
    }
}

/* ---- Mixing ---------------------------------------------------------------------------------- */

static double reflectance(float eta)
{
    double r = ((double)eta - 1.0) / ((double)eta + 1.0);
    return r * r;
}

static void both_ends_are_reached_to_the_bit(void **state)
{
    (void)state;
    for (int a = 0; a < FITTED; a++)
        for (int b = 0; b < FITTED; b++) {
            const hnbrdf_material *from = hnbrdf_model_material(hybrid, a),
                                  *to = hnbrdf_model_material(hybrid, b);
            const float low[] = {0.0f, -0.0f, -3.0f, -INFINITY, NAN},
                        high[] = {1.0f, 7.0f, INFINITY};
            hnbrdf_material mixed;
            for (int k = 0; k < 5; k++) {
                hnbrdf_material_mix(from, to, low[k], &mixed);
                assert_memory_equal(&mixed, from, sizeof mixed);
            }
            for (int k = 0; k < 3; k++) {
                hnbrdf_material_mix(from, to, high[k], &mixed);
                assert_memory_equal(&mixed, to, sizeof mixed);
            }
            mixed = *from; /* out may be an end */
            hnbrdf_material other;
            hnbrdf_material_mix(from, to, 0.3f, &other);
            hnbrdf_material_mix(&mixed, to, 0.3f, &mixed);
            assert_memory_equal(&mixed, &other, sizeof mixed);
        }
}

static int is_between(float x, float a, float b)
{
    return x >= fminf(a, b) && x <= fmaxf(a, b);
}

/* The rounding of a float or two: 1e-6 relative to the larger end. */
static void every_field_goes_the_documented_way(void **state)
{
    hnbrdf_rng rng;
    (void)state;
    hnbrdf_rng_seed(&rng, 5, 0);
    for (int n = 0; n < 20000; n++) {
        hnbrdf_material end[2], mixed;
        for (int e = 0; e < 2; e++) {
            hnbrdf_material *m = &end[e];
            memset(m, 0, sizeof *m);
            for (int c = 0; c < 3; c++) {
                m->kd[c] = hnbrdf_rng_float(&rng);
                m->eta[c] = 1.0f + (float)exp(-7.0 + 13.9 * (double)hnbrdf_rng_float(&rng));
            }
            set_alpha(m, (float)exp(-9.21 * (double)hnbrdf_rng_float(&rng)),
                      (float)exp(-9.21 * (double)hnbrdf_rng_float(&rng)));
            m->latent[2] = 1e3f * (hnbrdf_rng_float(&rng) - 0.5f);
            assert_int_equal(hnbrdf_material_check(m, NULL), HNBRDF_OK);
        }
        const hnbrdf_material *a = &end[0], *b = &end[1];
        float t = 0.001f + 0.998f * hnbrdf_rng_float(&rng);
        double s = (double)t;
        hnbrdf_material_mix(a, b, t, &mixed);
        assert_int_equal(hnbrdf_material_check(&mixed, NULL), HNBRDF_OK);
        for (int c = 0; c < 3; c++) {
            assert_true(is_between(mixed.kd[c], a->kd[c], b->kd[c]));
            assert_true(is_between(mixed.eta[c], a->eta[c], b->eta[c]));
            double kd = (1.0 - s) * (double)a->kd[c] + s * (double)b->kd[c];
            assert_true(fabs((double)mixed.kd[c] - kd) <= 1e-6);
            double f0 = (1.0 - s) * reflectance(a->eta[c]) + s * reflectance(b->eta[c]);
            assert_true(fabs(reflectance(mixed.eta[c]) - f0) <= 2e-6 * sqrt(f0));
        }
        for (int c = 0; c < 2; c++) {
            double alpha = pow((double)a->alpha[c], 1.0 - s) * pow((double)b->alpha[c], s);
            assert_true(is_between(mixed.alpha[c], a->alpha[c], b->alpha[c]));
            assert_true(fabs((double)mixed.alpha[c] - alpha) <= 3e-6 * alpha);
        }
        assert_true(is_between(mixed.latent[2], a->latent[2], b->latent[2]));
        hnbrdf_material_mix(a, a, t, &mixed);
        assert_memory_equal(&mixed, a, sizeof mixed);
    }
}

/* A half turn of a GGX lobe is the lobe itself: from 170 to 20 degrees there are 30, not 150. */
static void rotation_goes_the_short_way(void **state)
{
    static const float cases[][3] = {
        {170, 20, 185}, {20, 170, 5}, {0, 60, 30}, {10, 190, 10}, {-80, 80, -90}};
    const double degree = 3.14159265358979 / 180.0;
    hnbrdf_material a, b, mixed;
    (void)state;
    hnbrdf_material_init(&a);
    hnbrdf_material_init(&b);
    set_alpha(&a, 0.1f, 0.2f);
    set_alpha(&b, 0.1f, 0.2f);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        a.rotation = (float)((double)cases[k][0] * degree);
        b.rotation = (float)((double)cases[k][1] * degree);
        hnbrdf_material_mix(&a, &b, 0.5f, &mixed);
        assert_true(fabs((double)mixed.rotation - (double)cases[k][2] * degree) < 1e-6);
    }
    set_alpha(&a, 0.1f, 0.1f); /* isotropic: what comes has the direction of b, at once */
    hnbrdf_material_mix(&a, &b, 0.01f, &mixed);
    assert_true(mixed.rotation == b.rotation);
    hnbrdf_material_mix(&b, &a, 0.99f, &mixed);
    assert_true(mixed.rotation == b.rotation);
    a.rotation = FLT_MAX;
    set_alpha(&a, 0.1f, 0.3f);
    hnbrdf_material_mix(&a, &b, 0.5f, &mixed);
    assert_int_equal(hnbrdf_material_check(&mixed, NULL), HNBRDF_OK);
}

static void mixtures_are_finite_and_never_negative(void **state)
{
    float wi[DIRECTIONS][3], wo[DIRECTIONS][3], f[DIRECTIONS][3];
    (void)state;
    draw(DIRECTIONS, wi, wo);
    for (int a = 0; a < FITTED; a++)
        for (int b = 0; b < FITTED; b++)
            for (int n = 0; n <= 8; n++) {
                hnbrdf_material mixed;
                hnbrdf_material_mix(hnbrdf_model_material(hybrid, a),
                                    hnbrdf_model_material(hybrid, b), (float)n / 8.0f, &mixed);
                assert_int_equal(hnbrdf_material_check(&mixed, NULL), HNBRDF_OK);
                hnbrdf_eval_batch(hybrid, &mixed, DIRECTIONS, wi[0], 0, wo[0], 0, f[0], 0);
                for (int k = 0; k < DIRECTIONS; k++)
                    for (int c = 0; c < 3; c++)
                        assert_true(isfinite(f[k][c]) && f[k][c] >= 0.0f);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(larger_alpha_widens_the_highlight),
        cmocka_unit_test(kd_shifts_the_diffuse_level_linearly),
        cmocka_unit_test(larger_eta_reflects_more),
        cmocka_unit_test(isotropic_made_anisotropic_has_both_lobes),
        cmocka_unit_test(both_ends_are_reached_to_the_bit),
        cmocka_unit_test(every_field_goes_the_documented_way),
        cmocka_unit_test(rotation_goes_the_short_way),
        cmocka_unit_test(mixtures_are_finite_and_never_negative),
    };
    return cmocka_run_group_tests(tests, fit_once, free_model);
}
