/* test_sampling.c: hnbrdf_sample() against hnbrdf_pdf(): chi-squared, totals, weights, the edges of u.
 *
 * The sphere of wi is charted by the normal h that mirrors wo to wi: by its slopes in units of the roughness
 * on a logarithmic scale, x = asinh(h.x/(h.z ax)), y = asinh(h.y/(h.z ay)). The chart resolves a narrow lobe
 * and the wide one together; it is a grid to integrate over and to count in. */
#include "core_support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

/* Draws per configuration, cells along each side of the chart, points of integration in a cell's side. */
enum { DRAWS = 200000, SIDE = 30, CELLS = SIDE * SIDE, FINE = 16 };

typedef struct chart {
    double cosine, sine; /* rotation of the tangent frame */
    double a[2];         /* roughness */
    double wo[3];        /* in the tangent frame */
    double end[2];       /* |x| and |y| stay below, or wi is below the horizon */
} chart;

static chart chart_make(const hnbrdf_material *m, const float wo[3])
{
    chart c;
    c.cosine = cos((double)m->rotation);
    c.sine = sin((double)m->rotation);
    c.wo[0] = c.cosine * (double)wo[0] + c.sine * (double)wo[1];
    c.wo[1] = c.cosine * (double)wo[1] - c.sine * (double)wo[0];
    c.wo[2] = (double)wo[2];
    for (int k = 0; k < 2; k++) { /* wi.z > 0 leaves h.z >= wo.z/2, a slope of at most 2/wo.z */
        c.a[k] = (double)m->alpha[k];
        c.end[k] = asinh(2.0 / (c.wo[2] * c.a[k]));
    }
    return c;
}

/* wi at a point of the chart and the solid angle per dx dy; 0 where wi is below the horizon. */
static double chart_direction(const chart *c, double x, double y, float wi[3])
{
    double h[3] = {c->a[0] * sinh(x), c->a[1] * sinh(y), 1.0}, i[3];
    double length = sqrt(h[0] * h[0] + h[1] * h[1] + 1.0);
    double dot = (c->wo[0] * h[0] + c->wo[1] * h[1] + c->wo[2]) / length;
    for (int k = 0; k < 3; k++)
        i[k] = 2.0 * dot * h[k] / length - c->wo[k];
    if (!(dot > 0.0 && i[2] > 0.0))
        return 0.0;
    wi[0] = (float)(c->cosine * i[0] - c->sine * i[1]);
    wi[1] = (float)(c->cosine * i[1] + c->sine * i[0]);
    wi[2] = (float)i[2];
    /* d(wi) = 4 (wo.h) d(h), d(h) = h.z^3 d(slopes), d(slope) = a cosh dx. */
    return 4.0 * dot * c->a[0] * c->a[1] * cosh(x) * cosh(y) / (length * length * length);
}

static int chart_cell(const chart *c, const float wi[3])
{
    double s[3] = {c->cosine * (double)wi[0] + c->sine * (double)wi[1] + c->wo[0],
                   c->cosine * (double)wi[1] - c->sine * (double)wi[0] + c->wo[1],
                   (double)wi[2] + c->wo[2]};
    int cell[2];
    for (int k = 0; k < 2; k++) {
        double x = asinh(s[k] / (s[2] * c->a[k]));
        cell[k] = (int)((x / c->end[k] + 1.0) * (0.5 * SIDE));
        cell[k] = cell[k] < 0 ? 0 : cell[k] >= SIDE ? SIDE - 1 : cell[k];
    }
    return cell[0] * SIDE + cell[1];
}

/* Integrals over each cell, midpoint rule: of the density, and of f cos for the three channels. */
typedef struct integrals {
    double pdf[CELLS], total, albedo[3];
} integrals;

static void integrate(const hnbrdf_model *model, const hnbrdf_material *m, const float wo[3],
                      const chart *c, integrals *sum)
{
    enum { POINTS = SIDE * FINE };
    double dx = 2.0 * c->end[0] / POINTS, dy = 2.0 * c->end[1] / POINTS;
    memset(sum, 0, sizeof *sum);
    for (int a = 0; a < POINTS; a++)
        for (int b = 0; b < POINTS; b++) {
            float wi[3], f[3];
            double x = (a + 0.5) * dx - c->end[0], y = (b + 0.5) * dy - c->end[1];
            double area = chart_direction(c, x, y, wi) * dx * dy;
            if (area == 0.0)
                continue;
            double p = (double)hnbrdf_pdf(model, m, wi, wo) * area;
            sum->pdf[a / FINE * SIDE + b / FINE] += p;
            sum->total += p;
            hnbrdf_eval(model, m, wi, wo, f);
            for (int k = 0; k < 3; k++)
                sum->albedo[k] += (double)f[k] * (double)wi[2] * area;
        }
}

/* One material seen from one direction, and what a fixed number of draws gave. */
typedef struct experiment {
    double counts[CELLS], rejected;
    double weight[3], weight2[3]; /* sums of the weights and of their squares */
} experiment;

static void draw(const hnbrdf_model *model, const hnbrdf_material *m, const float wo[3], const chart *c,
                 rng *r, experiment *e)
{
    memset(e, 0, sizeof *e);
    for (int k = 0; k < DRAWS; k++) {
        const float u[3] = {rng_float(r), rng_float(r), rng_float(r)};
        hnbrdf_sample_result s;
        hnbrdf_sample(model, m, wo, u, &s);
        if (!(s.pdf > 0.0f)) {
            e->rejected++;
            continue;
        }
        e->counts[chart_cell(c, s.wi)]++;
        for (int i = 0; i < 3; i++) {
            e->weight[i] += (double)s.weight[i];
            e->weight2[i] += (double)s.weight[i] * (double)s.weight[i];
        }
    }
}

/* The configurations: alpha from the smallest to 1, both anisotropies, dielectric and almost metallic,
 * from normal to grazing incidence. */
enum { GUESSED, FITTED, PAPER }; /* lobes */
static const struct {
    float alpha[2], eta, kd, rotation;
    int lobes;
} materials[] = {{{1.0f, 1.0f}, 1.5f, 0.5f, 0.0f, GUESSED},    {{0.5f, 0.5f}, 30.0f, 0.0f, 0.0f, GUESSED},
                 {{0.1f, 0.1f}, 1.5f, 0.8f, 0.0f, GUESSED},    {{0.01f, 0.01f}, 2.0f, 0.2f, 0.0f, GUESSED},
                 {{1e-3f, 1e-3f}, 3.0f, 0.1f, 0.0f, GUESSED},  {{1e-4f, 1e-4f}, 1.5f, 0.5f, 0.0f, GUESSED},
                 {{0.4f, 0.05f}, 10.0f, 0.1f, 0.7f, GUESSED},  {{1.0f, 0.001f}, 2.5f, 0.3f, -2.0f, GUESSED},
                 {{0.02f, 0.9f}, 1.2f, 0.5f, 0.0f, GUESSED},   {{0.1f, 0.1f}, 1.5f, 0.8f, 0.0f, FITTED},
                 {{0.4f, 0.05f}, 10.0f, 0.1f, 0.7f, FITTED}, {{0.001f, 0.001f}, 2.0f, 0.2f, 0.0f, FITTED},
                 {{0.8f, 0.8f}, 1.5f, 0.5f, 0.0f, PAPER}, {{0.4f, 0.05f}, 10.0f, 0.1f, 0.7f, PAPER}};
/* As hnbrdf_lobes_fit() could give them: shares that change with the view, one lobe wider than alpha. */
static const hnbrdf_lobes fitted = {{0.7f, 3.0f}, {{0.1f, 0.5f, 0.3f, 0.6f}, {0.8f, 0.25f, 0.6f, 0.02f}}};
static const double views[][2] = {{1.0, 0.0}, {0.8, 1.0}, {0.3, 4.0}, {0.05, 2.5}}; /* cos theta, phi */
enum {
    MATERIALS = sizeof materials / sizeof materials[0],
    VIEWS = sizeof views / sizeof views[0],
    CONFIGURATIONS = MATERIALS * VIEWS
};

static void configuration(int number, hnbrdf_material *m, float wo[3])
{
    int k = number / VIEWS, v = number % VIEWS;
    hnbrdf_material_init(m);
    for (int c = 0; c < 3; c++) {
        m->kd[c] = materials[k].kd;
        m->eta[c] = materials[k].eta;
    }
    m->alpha[0] = fmaxf(materials[k].alpha[0], HNBRDF_MIN_ALPHA);
    m->alpha[1] = fmaxf(materials[k].alpha[1], HNBRDF_MIN_ALPHA);
    m->rotation = materials[k].rotation;
    if (materials[k].lobes == FITTED)
        m->lobes = fitted;
    if (materials[k].lobes == PAPER)
        hnbrdf_lobes_paper(&m->lobes);
    direction(views[v][0], views[v][1], wo);
}

/* Pearson's statistic as a standard normal deviate (Wilson and Hilferty 1931). Cells that expect fewer
 * than 10 draws are pooled; the rejected draws are one more cell. */
static double chi_squared_deviate(const integrals *expected, const experiment *e)
{
    double statistic = 0, pooled_expected = DRAWS * fmax(0.0, 1.0 - expected->total);
    double pooled = e->rejected;
    int cells = 0;
    for (int k = 0; k < CELLS; k++) {
        double mean = DRAWS * expected->pdf[k];
        if (mean < 10.0) {
            pooled_expected += mean;
            pooled += e->counts[k];
            continue;
        }
        statistic += (e->counts[k] - mean) * (e->counts[k] - mean) / mean;
        cells++;
    }
    if (pooled_expected >= 10.0) {
        statistic += (pooled - pooled_expected) * (pooled - pooled_expected) / pooled_expected;
        cells++;
    }
    assert_true(cells >= 10);
    double n = cells - 1, v = 2.0 / (9.0 * n);
    return (cbrt(statistic / n) - (1.0 - v)) / sqrt(v);
}

/* Every statistic below is a standard normal deviate if sample() and pdf() agree. Seeds are fixed, so the
 * threshold only has to be one that a correct sampler meets: 80 configurations with five deviates each stay
 * below 4.5 with probability 0.997. A density wrong by 2 % in half of the cells gives more than 10. */
static const double deviates = 4.5;

/* Error of the midpoint rule, from halving its step: the density of a GGX lobe ends abruptly at the
 * horizon, inside cells. */
static const double quadrature = 1.5e-4;

/* The density integrates to 1 minus the rejected share. */
static double rejection_deviate(const integrals *expected, const experiment *e)
{
    double share = fmin(1.0, fmax(0.0, 1.0 - expected->total));
    double variance = share * (1.0 - share) / DRAWS + quadrature * quadrature;
    return fabs(e->rejected / DRAWS - share) / sqrt(variance);
}

/* The mean weight is the integral of f cos. */
static double albedo_deviate(const integrals *expected, const experiment *e, int channel)
{
    double mean = e->weight[channel] / DRAWS, square = e->weight2[channel] / DRAWS;
    double error = quadrature * expected->albedo[channel];
    double variance = fmax(0.0, square - mean * mean) / DRAWS + error * error;
    return fabs(mean - expected->albedo[channel]) / sqrt(variance);
}

static void run_configuration(const hnbrdf_model *model, int number, rng *r, double worst[3])
{
    static integrals expected;
    static experiment e;
    hnbrdf_material m;
    float wo[3];
    configuration(number, &m, wo);
    chart c = chart_make(&m, wo);
    integrate(model, &m, wo, &c, &expected);
    draw(model, &m, wo, &c, r, &e);
    assert_true(expected.total <= 1.0 + quadrature);
    double deviate[3] = {chi_squared_deviate(&expected, &e), rejection_deviate(&expected, &e), 0};
    for (int k = 0; k < 3; k++)
        deviate[2] = fmax(deviate[2], albedo_deviate(&expected, &e, k));
    for (int k = 0; k < 3; k++) {
        worst[k] = fmax(worst[k], deviate[k]);
        if (!(deviate[k] < deviates))
            fail_msg("alpha %g %g, cos %.2f: %s is off by %.1f standard deviations", (double)m.alpha[0],
                     (double)m.alpha[1], (double)wo[2],
                     k == 0 ? "chi-squared" : k == 1 ? "the rejected share" : "the albedo", deviate[k]);
    }
}

static void run_kind(hnbrdf_kind kind, int step, uint64_t seed)
{
    rng r = rng_make(seed);
    double worst[3] = {-99, -99, -99};
    hnbrdf_model *model = random_model(&r, kind, HNBRDF_ENCODING_HALF_DIFFERENCE, 8, 1, 4);
    for (int k = 0; k < CONFIGURATIONS; k += step)
        run_configuration(model, k, &r, worst);
    print_message("    worst deviates: chi-squared %.2f, rejected share %.2f, albedo %.2f\n", worst[0],
                  worst[1], worst[2]);
    hnbrdf_model_free(model);
}

static void samples_follow_the_density_and_weights_are_unbiased(void **state)
{
    (void)state;
    run_kind(HNBRDF_KIND_GGX, 1, 42);
}

static void hybrid_samples_follow_the_density_and_weights_are_unbiased(void **state)
{
    (void)state;
    run_kind(HNBRDF_KIND_HYBRID, 5, 43);
}

static void neural_samples_follow_the_density_and_weights_are_unbiased(void **state)
{
    (void)state;
    run_kind(HNBRDF_KIND_NEURAL, 5, 44);
}

/* What hnbrdf.h promises of every result, whatever u and wo: one place for all tests below. */
static void check_result(const hnbrdf_model *model, const hnbrdf_material *m, const float wo[3],
                         const hnbrdf_sample_result *s)
{
    float f[3], pdf = hnbrdf_pdf(model, m, s->wi, wo);
    assert_true(s->pdf >= 0.0f && s->pdf <= HNBRDF_MAX_VALUE);
    if (s->pdf == 0.0f) {
        const hnbrdf_sample_result nothing = {{0.0f, 0.0f, 1.0f}, 0.0f, {0.0f, 0.0f, 0.0f}};
        assert_same_bits(&s->wi[0], &nothing.wi[0], 3);
        assert_same_bits(&s->weight[0], &nothing.weight[0], 3);
        return;
    }
    assert_same_bits(&s->pdf, &pdf, 1);
    assert_true(s->wi[2] > 0.0f);
    hnbrdf_eval(model, m, s->wi, wo, f);
    for (int c = 0; c < 3; c++) {
        double weight = (double)f[c] * (double)s->wi[2] / (double)s->pdf;
        assert_true(s->weight[c] >= 0.0f && s->weight[c] <= HNBRDF_MAX_VALUE);
        if (weight > 1e-30 && weight < 1e38 && (double)f[c] * (double)s->wi[2] < 1e38)
            assert_true(fabs((double)s->weight[c] - weight) <= 2.01 * UNIT * weight); /* two roundings */
    }
}

/* |2 (wo.h) h - wo| = |wo|: the rounding of k, of the products and of the differences stays below 8 u. */
static void check_unit(const float w[3])
{
    double length = sqrt((double)w[0] * (double)w[0] + (double)w[1] * (double)w[1] +
                         (double)w[2] * (double)w[2]);
    assert_true(fabs(length - 1.0) <= 8 * UNIT);
}

static void every_sample_keeps_the_promises_of_the_header(void **state)
{
    (void)state;
    static const hnbrdf_kind kinds[] = {HNBRDF_KIND_HYBRID, HNBRDF_KIND_NEURAL, HNBRDF_KIND_GGX};
    rng r = rng_make(45);
    for (int n = 0; n < 6; n++) {
        hnbrdf_model *model = random_model(&r, kinds[n % 3], (hnbrdf_encoding)(n / 3), 8, 2, 4);
        for (int k = 0; k < 20000; k++) {
            hnbrdf_material m = random_material(&r, k & 1);
            if (k & 2)
                random_lobes(&r, &m.lobes);
            const float u[3] = {rng_float(&r), rng_float(&r), rng_float(&r)};
            hnbrdf_sample_result s;
            float wo[3];
            if (k % 3)
                direction_uniform(&r, wo);
            else
                direction_grazing(&r, wo);
            hnbrdf_sample(model, &m, wo, u, &s);
            check_result(model, &m, wo, &s);
            check_unit(s.wi);
        }
        hnbrdf_model_free(model);
    }
}

/* Every combination of the ends of u, with roughness and view at their ends too. */
static void ends_of_u_give_finite_directions_and_densities(void **state)
{
    (void)state;
    static const float ends[] = {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.75f, 1.0f - 0x1p-24f};
    static const float alphas[] = {HNBRDF_MIN_ALPHA, 0.03f, HNBRDF_MAX_ALPHA};
    static const double cosines[] = {1.0, 0.5, 1e-2, 1e-4, 1e-7, 1e-30};
    enum { ENDS = sizeof ends / sizeof ends[0] };
    rng r = rng_make(46);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_HALF_DIFFERENCE, 8, 2, 4);
    int drawn = 0, total = 0;
    for (int a = 0; a < 9; a++)
        for (int v = 0; v < 6; v++)
            for (int k = 0; k < ENDS * ENDS * ENDS; k++) {
                hnbrdf_material m = random_material(&r, 1);
                if (k & 1)
                    random_lobes(&r, &m.lobes);
                const float u[3] = {ends[k % ENDS], ends[k / ENDS % ENDS], ends[k / (ENDS * ENDS)]};
                hnbrdf_sample_result s;
                float wo[3];
                m.alpha[0] = alphas[a % 3];
                m.alpha[1] = alphas[a / 3];
                direction(cosines[v], 1.3 * v, wo);
                hnbrdf_sample(model, &m, wo, u, &s);
                check_result(model, &m, wo, &s);
                check_unit(s.wi);
                drawn += s.pdf > 0.0f;
                total++;
            }
    assert_true(drawn > total / 2); /* finite because drawn, not because refused */
    hnbrdf_model_free(model);
}

/* u[2] = 0 is the normal between n and wo (turned no farther from n than wo is): its reflection is above the
 * horizon, so a refusal would mean that the radicand fell below 0. */
static void smallest_u_is_never_refused(void **state)
{
    (void)state;
    rng r = rng_make(50);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    for (int k = 0; k < 20000; k++) {
        hnbrdf_material m = random_material(&r, 1);
        const float u[3] = {0.0f, rng_float(&r), 0.0f};
        hnbrdf_sample_result s;
        float wo[3];
        direction_uniform(&r, wo);
        hnbrdf_sample(model, &m, wo, u, &s);
        assert_true(s.pdf > 0.0f);
    }
    hnbrdf_model_free(model);
}

static void bad_numbers_give_a_result_that_can_be_used(void **state)
{
    (void)state;
    static const float bad[] = {0.0f, -0.0f, -1.0f, 2.0f, 1e-38f, 3e38f, INFINITY, -INFINITY, NAN};
    const uint32_t n = sizeof bad / sizeof bad[0];
    rng r = rng_make(47);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_HALF_DIFFERENCE, 8, 2, 4);
    for (int k = 0; k < 50000; k++) {
        hnbrdf_material m = random_material(&r, 0);
        if (k & 8)
            random_lobes(&r, &m.lobes);
        const float u[3] = {rng_float(&r), rng_float(&r), rng_float(&r)};
        hnbrdf_sample_result s;
        float wo[3];
        direction_uniform(&r, wo);
        wo[rng_u32(&r) % 3] = bad[rng_u32(&r) % n];
        if (k % 4 == 0)
            ((float *)&m)[rng_u32(&r) % (sizeof m / sizeof(float))] = bad[rng_u32(&r) % n];
        hnbrdf_sample(model, &m, wo, u, &s);
        check_result(model, &m, wo, &s);
        for (int c = 0; c < 3; c++)
            assert_true(isfinite(s.wi[c]));
    }
    hnbrdf_model_free(model);
}

static void density_is_zero_below_the_horizon(void **state)
{
    (void)state;
    rng r = rng_make(48);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    static const float below[] = {0.0f, -0.0f, -0.3f, -INFINITY, NAN};
    for (size_t k = 0; k < sizeof below / sizeof below[0]; k++) {
        hnbrdf_material m = random_material(&r, 1);
        float w[3], v[3];
        direction_uniform(&r, w);
        direction_uniform(&r, v);
        v[2] = below[k];
        assert_true(hnbrdf_pdf(model, &m, w, v) == 0.0f);
        assert_true(hnbrdf_pdf(model, &m, v, w) == 0.0f);
    }
    hnbrdf_model_free(model);
}

/* A single scattering of GGX cannot reflect more than it receives (kd = 0). */
static void ggx_gains_no_energy(void **state)
{
    (void)state;
    static integrals sums;
    rng r = rng_make(49);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    for (int k = 0; k < CONFIGURATIONS; k += 3) {
        hnbrdf_material m;
        float wo[3];
        configuration(k, &m, wo);
        for (int c = 0; c < 3; c++) {
            m.kd[c] = 0.0f;
            m.eta[c] = c == 0 ? HNBRDF_MAX_ETA : 3.0f;
        }
        chart c = chart_make(&m, wo);
        integrate(model, &m, wo, &c, &sums);
        assert_true(sums.albedo[0] <= 1.0 + quadrature);
        assert_true(sums.albedo[1] <= sums.albedo[0]);
    }
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_follow_the_density_and_weights_are_unbiased),
        cmocka_unit_test(hybrid_samples_follow_the_density_and_weights_are_unbiased),
        cmocka_unit_test(neural_samples_follow_the_density_and_weights_are_unbiased),
        cmocka_unit_test(every_sample_keeps_the_promises_of_the_header),
        cmocka_unit_test(ends_of_u_give_finite_directions_and_densities),
        cmocka_unit_test(smallest_u_is_never_refused),
        cmocka_unit_test(bad_numbers_give_a_result_that_can_be_used),
        cmocka_unit_test(density_is_zero_below_the_horizon),
        cmocka_unit_test(ggx_gains_no_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
