/* test_measured_builtin.c: the built-in materials are what a measurement could be: reciprocal, never
 * negative, never reflecting more than arrives, and beyond Lambert plus one GGX lobe. */
#include "measured_support.h"
#include "measured/builtin.h"

static const double PI = 3.14159265358979323846;

static hnbrdf_measured *open_builtin(int index)
{
    hnbrdf_measured *measured = NULL;
    assert_int_equal(hnbrdf_measured_open_builtin(index, &measured, NULL), HNBRDF_OK);
    return measured;
}

static int count(void)
{
    return hnbrdf_measured_builtin_count();
}

static void names_are_short_unique_and_plain(void **state)
{
    (void)state;
    assert_true(count() >= 12);
    for (int i = 0; i < count(); i++) {
        const char *name = hnbrdf_measured_builtin_name(i);
        hnbrdf_measured *measured = open_builtin(i);
        assert_in_range(strlen(name), 3, 31);
        assert_int_equal(strspn(name, "abcdefghijklmnopqrstuvwxyz-"), strlen(name));
        assert_string_equal(hnbrdf_measured_name(measured), name);
        assert_int_equal(hnbrdf_measured_format_of(measured), HNBRDF_MEASURED_BUILTIN);
        assert_true(strlen(hnbrdf_measured_summary(measured)) > strlen("built-in: "));
        hnbrdf_measured_close(measured);
        for (int j = 0; j < i; j++)
            assert_string_not_equal(name, hnbrdf_measured_builtin_name(j));
    }
    assert_null(hnbrdf_measured_builtin_name(-1));
    assert_null(hnbrdf_measured_builtin_name(count()));
}

static void values_are_reciprocal_to_the_last_bit(void **state)
{
    (void)state;
    for (int i = 0; i < count(); i++) {
        hnbrdf_measured *measured = open_builtin(i);
        hnbrdf_rng rng;
        hnbrdf_rng_seed(&rng, 1, (uint64_t)i);
        for (int k = 0; k < 20000; k++) {
            float wi[3], wo[3], f[3], g[3];
            hnbrdf_sampler_draw((hnbrdf_sampler)(k % 3), &rng, wi, wo);
            assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
            assert_int_equal(hnbrdf_measured_eval(measured, wo, wi, g), 1);
            assert_memory_equal(f, g, sizeof f);
        }
        hnbrdf_measured_close(measured);
    }
}

/* The formulas themselves, before measured.c clamps: directions at the pole, equal, opposite in
 * azimuth, and within 1e-12 of the horizon. */
static void formulas_are_finite_up_to_the_horizon(void **state)
{
    static const double heights[] = {1.0, 0.999999999999, 0.7, 1e-2, 1e-4, 1e-8, 1e-12};
    static const double azimuths[] = {0.0, 1e-9, 0.5, 1.5707963267948966, 3.1415926535897931};
    (void)state;
    for (int m = 0; m < count(); m++) {
        const builtin_material *material = &hnbrdf_builtin_materials[m];
        film_table film = {{{0}}};
        if (material->film)
            film_fill(&film, material->film);
        for (size_t a = 0; a < 7; a++)
            for (size_t b = 0; b < 7; b++)
                for (size_t c = 0; c < 5; c++) {
                    double zi = heights[a], zo = heights[b], si = sqrt(1 - zi * zi),
                           so = sqrt(1 - zo * zo);
                    double wi[3] = {si, 0, zi};
                    double wo[3] = {so * cos(azimuths[c]), so * sin(azimuths[c]), zo}, f[3] = {0};
                    pair p = make_pair(wi, wo);
                    p.film = &film;
                    material->eval(&p, f);
                    if (!isfinite(f[0]) || !isfinite(f[1]) || !isfinite(f[2]))
                        fail_msg("%s: %g %g %g at z %g, %g, azimuth %g", material->name, f[0], f[1],
                                 f[2], zi, zo, azimuths[c]);
                }
    }
}

/* Integral of f wi.z over wi, by midpoints over the half vector: dwi = 4 (wo.h) dh, with theta_h =
 * pi/2 u^4, which resolves lobes down to alpha 0.005. */
static void directional_albedo(const hnbrdf_measured *measured, double theta, double phi,
                               double albedo[3])
{
    enum { RINGS = 240, STEPS = 180 };
    double wo[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
    float to[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
    albedo[0] = albedo[1] = albedo[2] = 0.0;
    for (int r = 0; r < RINGS; r++)
        for (int s = 0; s < STEPS; s++) {
            double u = (r + 0.5) / RINGS, theta_h = PI / 2 * u * u * u * u,
                   phi_h = 2 * PI * (s + 0.5) / STEPS;
            double h[3] = {sin(theta_h) * cos(phi_h), sin(theta_h) * sin(phi_h), cos(theta_h)};
            double c = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2],
                   weight = PI / 2 * 4 * u * u * u / RINGS;
            float wi[3], f[3];
            for (int i = 0; i < 3; i++)
                wi[i] = (float)(2 * c * h[i] - wo[i]);
            if (c <= 0.0 || !hnbrdf_measured_eval(measured, wi, to, f))
                continue;
            for (int i = 0; i < 3; i++)
                albedo[i] +=
                    (double)f[i] * (double)wi[2] * 4 * c * sin(theta_h) * weight * 2 * PI / STEPS;
        }
}

/* Doubling the quadrature moves no albedo by more than 0.004; the largest is 0.87. */
static void no_material_reflects_more_than_arrives(void **state)
{
    static const double degrees[] = {0, 30, 60, 75, 85, 89};
    (void)state;
    for (int m = 0; m < count(); m++) {
        hnbrdf_measured *measured = open_builtin(m);
        double least = 1.0;
        for (size_t k = 0; k < sizeof degrees / sizeof degrees[0]; k++) {
            double albedo[3];
            directional_albedo(measured, degrees[k] * PI / 180, 0.4, albedo);
            for (int c = 0; c < 3; c++) {
                if (!(albedo[c] >= 0.0 && albedo[c] <= 1.0))
                    fail_msg("%s: albedo %.3f at %.0f degrees", hnbrdf_measured_name(measured),
                             albedo[c], degrees[k]);
            }
            least = fmin(least, fmax(albedo[0], fmax(albedo[1], albedo[2])));
        }
        if (least < 0.05)
            fail_msg("%s: black", hnbrdf_measured_name(measured));
        hnbrdf_measured_close(measured);
    }
}

static void turn_about_n(const float w[3], double angle, float turned[3])
{
    double c = cos(angle), s = sin(angle), x = (double)w[0], y = (double)w[1];
    turned[0] = (float)(c * x - s * y);
    turned[1] = (float)(s * x + c * y);
    turned[2] = w[2];
}

/* Turning rounds h by 1e-7; at alpha = 0.006 the lobe's logarithm changes by up to 4 / alpha = 700 per
 * radian, so 1e-3 holds everywhere (the absolute part is for channels that are clipped). */
static void isotropic_materials_and_no_others_ignore_a_turn(void **state)
{
    (void)state;
    for (int m = 0; m < count(); m++) {
        hnbrdf_measured *measured = open_builtin(m);
        hnbrdf_rng rng;
        int changed = 0;
        hnbrdf_rng_seed(&rng, 9, (uint64_t)m);
        for (int k = 0; k < 2000; k++) {
            float wi[3], wo[3], f[3], g[3], ti[3], to[3];
            double angle = 6.28 * (double)hnbrdf_rng_float(&rng);
            hnbrdf_sampler_draw(HNBRDF_SAMPLER_COSINE, &rng, wi, wo);
            turn_about_n(wi, angle, ti);
            turn_about_n(wo, angle, to);
            hnbrdf_measured_eval(measured, wi, wo, f);
            hnbrdf_measured_eval(measured, ti, to, g);
            for (int c = 0; c < 3; c++)
                changed += fabs((double)f[c] - (double)g[c]) > 1e-3 * (double)f[c] + 1e-7;
        }
        if (hnbrdf_measured_is_isotropic(measured) ? changed > 0 : changed < 3000)
            fail_msg("%s: %d of 6000 values changed", hnbrdf_measured_name(measured), changed);
        hnbrdf_measured_close(measured);
    }
}

/* Colours outside the gamut: some materials hold exact zeros in one channel while another reflects. */
static void some_materials_hold_exact_zeros(void **state)
{
    int with_zeros = 0;
    (void)state;
    for (int m = 0; m < count(); m++) {
        hnbrdf_measured *measured = open_builtin(m);
        hnbrdf_rng rng;
        int zeros = 0;
        hnbrdf_rng_seed(&rng, 3, 3);
        for (int k = 0; k < 1000; k++) {
            float wi[3], wo[3], f[3];
            hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
            hnbrdf_measured_eval(measured, wi, wo, f);
            assert_true(f[0] + f[1] + f[2] > 0.0f);
            zeros += f[0] == 0.0f || f[1] == 0.0f || f[2] == 0.0f;
        }
        with_zeros += zeros > 100 && zeros < 990;
        hnbrdf_measured_close(measured);
    }
    assert_in_range(with_zeros, 2, 6);
}

/* ---- Beyond one lobe ----------------------------------------------------------------------------- */

enum { PAIRS = 400, ALPHAS = 12, ETAS = 10, KDS = 10 };

typedef struct samples {
    pair pairs[PAIRS];
    float f[PAIRS][3];
} samples;

static void draw_samples(const hnbrdf_measured *measured, double tangent, samples *s)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 21, 0);
    for (int k = 0; k < PAIRS; k++) {
        float wi[3], wo[3];
        double i[3], o[3];
        hnbrdf_sampler_draw((hnbrdf_sampler)(k % 3), &rng, wi, wo);
        hnbrdf_measured_eval(measured, wi, wo, s->f[k]);
        for (int c = 0; c < 3; c++) {
            i[c] = (double)wi[c];
            o[c] = (double)wo[c];
        }
        pair p = make_pair(i, o);
        s->pairs[k] = turned_pair(&p, tangent);
    }
}

/* The best SMAPE of kd/pi + F D G / (4 wi.z wo.z) in one channel, over kd and eta, for given lobes. */
static double best_of_channel(const samples *s, int channel, const double lobe[PAIRS])
{
    double best = 2.0;
    for (int e = 0; e < ETAS; e++) {
        double eta = 1.0 + 0.1 * pow(1.9, e), specular[PAIRS]; /* 1.1 to 33 */
        for (int k = 0; k < PAIRS; k++)
            specular[k] = fresnel_dielectric(eta, s->pairs[k].c) * lobe[k];
        for (int d = 0; d < KDS; d++) {
            double kd = d * d / (double)((KDS - 1) * (KDS - 1)), sum = 0.0;
            for (int k = 0; k < PAIRS; k++) {
                double f = kd / PI + specular[k], reference = (double)s->f[k][channel];
                sum += fabs(f - reference) / (f + reference);
            }
            best = fmin(best, 2 * sum / PAIRS);
        }
    }
    return best;
}

static double best_single_lobe(const samples *s, int isotropic)
{
    double best = 2.0;
    for (int x = 0; x < ALPHAS; x++)
        for (int y = isotropic ? x : 0; y < (isotropic ? x + 1 : ALPHAS); y++) {
            double ax = 0.004 * pow(1.65, x), ay = 0.004 * pow(1.65, y), lobe[PAIRS],
                   sum = 0.0; /* to 0.98 */
            for (int k = 0; k < PAIRS; k++)
                lobe[k] = ggx(&s->pairs[k], ax, ay);
            for (int c = 0; c < 3; c++)
                sum += best_of_channel(s, c, lobe);
            best = fmin(best, sum / 3);
        }
    return best;
}

/* The yardstick works: a material of one lobe on the search grid is found with (almost) no error. */
static void the_search_finds_a_single_lobe(void **state)
{
    static samples s;
    hnbrdf_measured *measured = open_builtin(0);
    (void)state;
    draw_samples(measured, 0.0, &s);
    for (int k = 0; k < PAIRS; k++)
        for (int c = 0; c < 3; c++)
            s.f[k][c] = (float)(16.0 / 81.0 / PI +
                                fresnel_dielectric(1.361, s.pairs[k].c) *
                                    ggx(&s.pairs[k], 0.004 * pow(1.65, 8), 0.004 * pow(1.65, 8)));
    assert_true(best_single_lobe(&s, 1) < 1e-6);
    hnbrdf_measured_close(measured);
}

/* Lambert plus one GGX lobe with the best parameters of a grid, each channel with its own kd and eta,
 * stays at least 0.08 SMAPE away; the grid's own coarseness is worth about half of that. */
static void no_single_lobe_follows_any_of_them(void **state)
{
    static samples s;
    (void)state;
    for (int m = 0; m < count(); m++) {
        hnbrdf_measured *measured = open_builtin(m);
        const char *name = hnbrdf_measured_name(measured);
        draw_samples(measured, strcmp(name, "brushed-steel") == 0 ? PI / 6 : 0.0, &s);
        double smape = best_single_lobe(&s, hnbrdf_measured_is_isotropic(measured));
        print_message("    %-24s %.3f\n", name, smape);
        assert_true(smape > 0.08);
        hnbrdf_measured_close(measured);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_short_unique_and_plain),
        cmocka_unit_test(values_are_reciprocal_to_the_last_bit),
        cmocka_unit_test(formulas_are_finite_up_to_the_horizon),
        cmocka_unit_test(no_material_reflects_more_than_arrives),
        cmocka_unit_test(isotropic_materials_and_no_others_ignore_a_turn),
        cmocka_unit_test(some_materials_hold_exact_zeros),
        cmocka_unit_test(the_search_finds_a_single_lobe),
        cmocka_unit_test(no_single_lobe_follows_any_of_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
