/* test_measured_builtin.c: the built-in materials are what a measurement could be: reciprocal,
 * never negative, never reflecting more than arrives, and beyond Lambert plus one GGX lobe. */
#include "measured_support.h"
#include "measured/builtin_relief.h"

static hnbrdf_measured *open_builtin(int index)
{
    hnbrdf_measured *measured = NULL;
    assert_int_equal(hnbrdf_measured_open_builtin(index, &measured, NULL), HNBRDF_OK);
    return measured;
}

static int count(void)
{
    return hnbrdf_measured_builtin_count() + hnbrdf_measured_builtin_anisotropic_count();
}

static void names_are_short_unique_and_plain(void **state)
{
    (void)state;
    assert_int_equal(hnbrdf_measured_builtin_count(), 16); /* figures in examples/ are of these */
    assert_true(hnbrdf_measured_builtin_anisotropic_count() >= 12);
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
        assert_reciprocal(measured, (uint64_t)i, 20000);
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
        const builtin_material *material = hnbrdf_builtin_at(m);
        film_table film = {{{0}}};
        if (material->film)
            hnbrdf_film_fill(&film, material->film);
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

/* Against a 16 times finer quadrature these albedos are off by less than 0.001, for retro-tape
 * (whose lobe is not around n) by 0.04; the largest is 0.87. Anisotropic ones from three sides. */
static void no_material_reflects_more_than_arrives(void **state)
{
    static const double degrees[] = {0, 30, 60, 75, 85, 89};
    (void)state;
    for (int m = 0; m < count(); m++) {
        hnbrdf_measured *measured = open_builtin(m);
        double least = 1.0;
        const int angles = sizeof degrees / sizeof degrees[0];
        const int sides = hnbrdf_measured_is_isotropic(measured) ? 1 : 3;
        for (int k = 0; k < angles * sides; k++) {
            double albedo[3], azimuth = k < angles ? 0.4 : k < 2 * angles ? 0.0 : PI / 2;
            directional_albedo(measured, 240, degrees[k % angles] * PI / 180, azimuth, albedo);
            for (int c = 0; c < 3; c++) {
                if (!(albedo[c] >= 0.0 && albedo[c] <= 1.0))
                    fail_msg("%s: albedo %.3f at %.0f degrees", hnbrdf_measured_name(measured),
                             albedo[c], degrees[k % angles]);
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

/* Turning rounds h by 1e-7; at alpha = 0.006 the lobe's logarithm changes by up to 4 / alpha =
 * 700 per radian, so 1e-3 holds everywhere (the absolute part is for channels that are clipped). */
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

/* Colours outside the gamut: some materials hold exact zeros in one channel while another
 * reflects. */
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

/* ---- Reliefs --------------------------------------------------------------------------------- */

static void grey_facet(const pair *p, double weight, double f[3])
{
    f[0] += weight * (0.3 / PI + 0.5 * ggx(p, 0.2, 0.4));
}

/* White and diffuse: what a relief of it loses is what its facets would reflect once more. */
static void white_facet(const pair *p, double weight, double f[3])
{
    (void)p;
    f[0] += weight / PI;
}

static void a_flat_relief_is_its_facet(void **state)
{
    static const strand flat[] = {{0.3, -0.3, 0.6, 0.0, 0.0, 3, grey_facet},
                                  {1.7, -1.7, 0.4, 0.0, 0.0, 1, grey_facet}};
    hnbrdf_rng rng;
    (void)state;
    hnbrdf_rng_seed(&rng, 5, 0);
    for (int k = 0; k < 2000; k++) {
        float wi[3], wo[3];
        double i[3], o[3], f[3] = {0}, g[3] = {0};
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        for (int c = 0; c < 3; c++) {
            i[c] = (double)wi[c];
            o[c] = (double)wo[c];
        }
        pair p = make_pair(i, o);
        grey_facet(&p, 1.0, f);
        add_relief(&p, flat, 2, 1.0, g);
        assert_true(fabs(f[0] - g[0]) <= 1e-9 * f[0]);
    }
}

/* Light from straight above meets every facet: a relief of white facets then reflects all that does
 * not meet another one, at most 1, and the steeper it is the less. */
static void a_relief_gains_no_energy(void **state)
{
    static const double steepest[] = {0.0, 0.3, 0.6, 0.9};
    enum { RINGS = 60, TURNS = 120 };
    double before = 1.0 + 1e-9;
    (void)state;
    for (size_t s = 0; s < sizeof steepest / sizeof steepest[0]; s++) {
        const strand waves = {0.0, 0.0, 1.0, -steepest[s], steepest[s], 16, white_facet};
        double sum = 0.0, up[3] = {0.0, 0.0, 1.0};
        for (int k = 0; k < RINGS * TURNS; k++) {
            double sine2 = (k / TURNS + 0.5) / RINGS, phi = 2 * PI * (k % TURNS + 0.5) / TURNS;
            double wo[3] = {sqrt(sine2) * cos(phi), sqrt(sine2) * sin(phi), sqrt(1.0 - sine2)};
            double f[3] = {0};
            pair p = make_pair(up, wo);
            add_relief(&p, &waves, 1, PI / (RINGS * TURNS), f);
            sum += f[0];
        }
        if (!(sum <= before && sum > 0.6))
            fail_msg("steepest %.1f: albedo %.4f after %.4f", steepest[s], sum, before);
        before = sum;
    }
}

/* ---- Beyond one lobe ------------------------------------------------------------------------- */

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

/* Lambert plus one GGX lobe, channel by channel: x = (ln(eta - 1), sqrt(kd)). */
typedef struct fit {
    const samples *s;
    int channel;
    double lobe[PAIRS];
} fit;

static double smape_of_channel(const double x[2], void *context)
{
    const fit *t = context;
    double eta = 1.0 + exp(x[0]), diffuse = fmin(x[1] * x[1], 1.0) / PI, sum = 0.0;
    for (int k = 0; k < PAIRS; k++) {
        double f = diffuse + fresnel_dielectric(eta, t->s->pairs[k].c) * t->lobe[k];
        double reference = (double)t->s->f[k][t->channel];
        sum += fabs(f - reference) / (f + reference);
    }
    return 2 * sum / PAIRS;
}

/* Pattern search: steps along each axis while that helps, then half the step. */
static double descend(double *x, int n, const double *steps, double (*cost)(const double *, void *),
                      void *context)
{
    double best = cost(x, context);
    for (double scale = 1.0; scale > 0.002;) {
        int better = 0;
        for (int axis = 0; axis < 2 * n; axis++) {
            double old = x[axis / 2];
            x[axis / 2] += (axis % 2 ? -scale : scale) * steps[axis / 2];
            double found = cost(x, context);
            better |= found < best;
            if (found < best)
                best = found;
            else
                x[axis / 2] = old;
        }
        if (!better)
            scale /= 2;
    }
    return best;
}

static double best_of_channel(fit *t)
{
    const double steps[2] = {0.32, 0.055};
    double best = 2.0, at[2] = {0.0, 0.0};
    for (int e = 0; e < ETAS; e++)
        for (int d = 0; d < KDS; d++) {
            /* eta from 1.1 to 33 */
            const double x[2] = {log(0.1) + 0.64 * e, d / (double)(KDS - 1)};
            double found = smape_of_channel(x, t);
            if (found < best) {
                best = found;
                memcpy(at, x, sizeof at);
            }
        }
    return descend(at, 2, steps, smape_of_channel, t);
}

/* x = ln alpha, or (ln alpha_x, ln alpha_y): the mean of the best of each channel. */
typedef struct lobe_search {
    const samples *s;
    int isotropic;
} lobe_search;

static double smape_of_lobe(const double *x, void *context)
{
    const lobe_search *search = context;
    fit t = {.s = search->s};
    double sum = 0.0, ax = exp(fmin(x[0], 0.0)), ay = search->isotropic ? ax : exp(fmin(x[1], 0.0));
    for (int k = 0; k < PAIRS; k++)
        t.lobe[k] = ggx(&t.s->pairs[k], ax, ay);
    for (t.channel = 0; t.channel < 3; t.channel++)
        sum += best_of_channel(&t);
    return sum / 3;
}

static double best_single_lobe(const samples *s, int isotropic)
{
    lobe_search search = {s, isotropic};
    const double steps[2] = {0.25, 0.25};
    double best = 2.0, at[2] = {0.0, 0.0};
    for (int i = 0; i < ALPHAS; i++)
        for (int j = 0; j < (isotropic ? 1 : ALPHAS); j++) {
            const double x[2] = {log(0.004) + 0.5 * i, log(0.004) + 0.5 * j}; /* to 0.98 */
            double found = smape_of_lobe(x, &search);
            if (found < best) {
                best = found;
                memcpy(at, x, sizeof at);
            }
        }
    return descend(at, isotropic ? 1 : 2, steps, smape_of_lobe, &search);
}

/* The yardstick works: materials that are one lobe, of any width, are found to about a per cent. */
static void the_search_finds_single_lobes(void **state)
{
    static samples s;
    static const double lobes[][3] = {
        {0.011, 1.3, 0.01}, {0.03, 1.9, 0.2}, {0.09, 1.5, 0.4}, {0.3, 2.7, 0.05}, {0.7, 1.4, 0.7}};
    hnbrdf_measured *measured = open_builtin(0);
    (void)state;
    draw_samples(measured, 0.0, &s);
    hnbrdf_measured_close(measured);
    for (size_t i = 0; i < sizeof lobes / sizeof lobes[0]; i++) {
        for (int k = 0; k < PAIRS; k++) {
            double specular = fresnel_dielectric(lobes[i][1], s.pairs[k].c);
            double f = lobes[i][2] / PI + specular * ggx(&s.pairs[k], lobes[i][0], lobes[i][0]);
            s.f[k][0] = s.f[k][1] = s.f[k][2] = (float)f;
        }
        double smape = best_single_lobe(&s, 1);
        if (smape > 0.015)
            fail_msg("alpha %.3f: found only to %.3f", lobes[i][0], smape);
    }
}

/* Lambert plus one GGX lobe, each channel with the kd and eta that suit it best, stays away from
 * every material by far more than the search itself misses. */
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
        assert_true(smape > 0.1);
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
        cmocka_unit_test(a_flat_relief_is_its_facet),
        cmocka_unit_test(a_relief_gains_no_energy),
        cmocka_unit_test(the_search_finds_single_lobes),
        cmocka_unit_test(no_single_lobe_follows_any_of_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
