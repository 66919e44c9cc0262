/* test_sampling_density.c: draws of hnbrdf_sample() follow hnbrdf_pdf(): chi-squared, rejected
 * share, mean weights; weights of the analytic part are bounded. Over made-up materials from the
 * smallest roughness to 1 and over every material of the shipped model. */
#include "core_support.h"
#include "sampling_statistics.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* The density over the chart, and the integral of f cos for the three channels. */
typedef struct integrals {
    sampling_expected expected;
    double albedo[3];
} integrals;

static void integrate(const hnbrdf_model *model, const hnbrdf_material *m, const float wo[3],
                      const sampling_chart *c, integrals *sum)
{
    memset(sum, 0, sizeof *sum);
    for (int k = 0; k < SAMPLING_POINTS; k++) {
        float wi[3], f[3];
        double area = sampling_chart_point(c, k, wi);
        if (area == 0.0)
            continue;
        double share = (double)hnbrdf_pdf(model, m, wi, wo) * area;
        sum->expected.share[sampling_chart_cell_of_point(k)] += share;
        sum->expected.total += share;
        hnbrdf_eval(model, m, wi, wo, f);
        for (int i = 0; i < 3; i++)
            sum->albedo[i] += (double)f[i] * (double)wi[2] * area;
    }
}

/* One material seen from one direction, and what a fixed number of draws gave. */
typedef struct experiment {
    sampling_counted counted;
    double weight[3], weight2[3]; /* sums of the weights and of their squares */
} experiment;

static void draw(const hnbrdf_model *model, const hnbrdf_material *m, const float wo[3],
                 const sampling_chart *c, rng *r, experiment *e)
{
    hnbrdf_prepared prepared;
    memset(e, 0, sizeof *e);
    hnbrdf_prepare(model, m, &prepared);
    for (int k = 0; k < SAMPLING_DRAWS; k++) {
        const float u[2] = {rng_float(r), rng_float(r)};
        hnbrdf_sample_result s;
        hnbrdf_prepared_sample(&prepared, wo, u, &s);
        if (!(s.pdf > 0.0f)) {
            e->counted.rejected++;
            continue;
        }
        e->counted.counts[sampling_chart_cell(c, s.wi)]++;
        for (int i = 0; i < 3; i++) {
            e->weight[i] += (double)s.weight[i];
            e->weight2[i] += (double)s.weight[i] * (double)s.weight[i];
        }
    }
}

/* The configurations: alpha from the smallest to 1, both anisotropies, dielectric and almost
 * metallic, from normal to grazing incidence. */
enum { GUESSED, FITTED, PAPER }; /* lobes */
static const struct {
    float alpha[2], eta, kd, rotation;
    int lobes;
} materials[] = {
    {{1.0f, 1.0f}, 1.5f, 0.5f, 0.0f, GUESSED},   {{0.5f, 0.5f}, 30.0f, 0.0f, 0.0f, GUESSED},
    {{0.1f, 0.1f}, 1.5f, 0.8f, 0.0f, GUESSED},   {{0.01f, 0.01f}, 2.0f, 0.2f, 0.0f, GUESSED},
    {{1e-3f, 1e-3f}, 3.0f, 0.1f, 0.0f, GUESSED}, {{1e-4f, 1e-4f}, 1.5f, 0.5f, 0.0f, GUESSED},
    {{0.4f, 0.05f}, 10.0f, 0.1f, 0.7f, GUESSED}, {{1.0f, 0.001f}, 2.5f, 0.3f, -2.0f, GUESSED},
    {{0.02f, 0.9f}, 1.2f, 0.5f, 0.0f, GUESSED},  {{0.1f, 0.1f}, 1.5f, 0.8f, 0.0f, FITTED},
    {{0.4f, 0.05f}, 10.0f, 0.1f, 0.7f, FITTED},  {{0.001f, 0.001f}, 2.0f, 0.2f, 0.0f, FITTED},
    {{0.8f, 0.8f}, 1.5f, 0.5f, 0.0f, PAPER},     {{0.4f, 0.05f}, 10.0f, 0.1f, 0.7f, PAPER}};
/* As hnbrdf_lobes_fit() could give them: shares that change with the view, one lobe wider than
 * alpha. */
static const hnbrdf_lobes fitted = {{0.7f, 3.0f},
                                    {{0.1f, 0.5f, 0.3f, 0.6f}, {0.8f, 0.25f, 0.6f, 0.02f}}};
/* cos theta, phi */
static const double views[][2] = {{1.0, 0.0}, {0.8, 1.0}, {0.3, 4.0}, {0.05, 2.5}};
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

/* The mean weight is the integral of f cos: another deviate. */
static double albedo_deviate(const integrals *sums, const experiment *e)
{
    double worst = 0.0;
    for (int c = 0; c < 3; c++) {
        double mean = e->weight[c] / SAMPLING_DRAWS, square = e->weight2[c] / SAMPLING_DRAWS;
        double error = SAMPLING_QUADRATURE * sums->albedo[c];
        double variance = fmax(0.0, square - mean * mean) / SAMPLING_DRAWS + error * error;
        worst = fmax(worst, fabs(mean - sums->albedo[c]) / sqrt(variance));
    }
    return worst;
}

/* ---- A density that is wrong ------------------------------------------------------------------
 * */

/* Where 2 % are put: everywhere, or from one half of the draws, left or below, to the other. */
enum { EVERYWHERE, LEFT_TO_RIGHT, BELOW_TO_ABOVE, MISTAKES };

static void plant(sampling_expected *expected, int mistake)
{
    double so_far = 0.0, total = 0.0;
    for (int place = 0; place < SAMPLING_CELLS; place++) {
        double *share = &expected->share[sampling_cell_in_order(place, mistake == BELOW_TO_ABOVE)];
        int first_half = so_far < 0.5 * expected->total;
        so_far += *share;
        *share *= mistake == EVERYWHERE || first_half ? 1.02 : 0.98;
        total += *share;
    }
    expected->total = total;
}

static void check_that_mistakes_are_noticed(const sampling_expected *expected,
                                            const sampling_counted *counted, double *least)
{
    for (int mistake = 0; mistake < MISTAKES; mistake++) {
        sampling_expected wrong = *expected;
        plant(&wrong, mistake);
        double deviate = sampling_deviate(&wrong, counted);
        *least = fmin(*least, deviate);
        if (!(deviate > SAMPLING_THRESHOLD))
            fail_msg("2 %% put in place %d of the density are not noticed: %.2f", mistake, deviate);
    }
}

/* ---- Running it -------------------------------------------------------------------------------
 * */

typedef struct worst_deviates {
    double density, albedo, least_mistake;
} worst_deviates;

static void run_experiment(const hnbrdf_model *model, const hnbrdf_material *m, const float wo[3],
                           rng *r, worst_deviates *worst)
{
    static integrals sums;
    static experiment e;
    sampling_chart c = sampling_chart_make(m, wo);
    integrate(model, m, wo, &c, &sums);
    draw(model, m, wo, &c, r, &e);
    double density = sampling_deviate(&sums.expected, &e.counted),
           albedo = albedo_deviate(&sums, &e);
    worst->density = fmax(worst->density, density);
    worst->albedo = fmax(worst->albedo, albedo);
    if (!(density < SAMPLING_THRESHOLD && albedo < SAMPLING_THRESHOLD))
        fail_msg("alpha %g %g, cos %.2f: off by %.1f standard deviations, the albedo by %.1f",
                 (double)m->alpha[0], (double)m->alpha[1], (double)wo[2], density, albedo);
    check_that_mistakes_are_noticed(&sums.expected, &e.counted, &worst->least_mistake);
}

static void print_worst(const worst_deviates *worst)
{
    print_message(
        "    worst deviates: density %.2f, albedo %.2f; a density 2 %% wrong: at least %.2f\n",
        worst->density, worst->albedo, worst->least_mistake);
}

static void run_kind(hnbrdf_kind kind, int step, uint64_t seed)
{
    rng r = rng_make(seed);
    worst_deviates worst = {0.0, 0.0, 99.0};
    hnbrdf_model *model = random_model(&r, kind, HNBRDF_ENCODING_HALF_DIFFERENCE, 8, 1, 4);
    for (int k = 0; k < CONFIGURATIONS; k += step) {
        hnbrdf_material m;
        float wo[3];
        /* each material from two of the views, its neighbour from the others */
        if ((k / VIEWS + k) % 2)
            continue;
        configuration(k, &m, wo);
        run_experiment(model, &m, wo, &r, &worst);
    }
    print_worst(&worst);
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

/* Each material as fitted and anisotropic, from a view each; the views go round. */
static void samples_of_every_shipped_material_follow_the_density(void **state)
{
    (void)state;
    rng r = rng_make(51);
    worst_deviates worst = {0.0, 0.0, 99.0};
    hnbrdf_model *model = sampling_shipped_model(HNBRDF_EXAMPLE_MODEL);
    int count = hnbrdf_model_material_count(model);
    for (int k = 0; k < count; k++) {
        float wo[3];
        const double *view = views[(k + k / (count / 2)) % VIEWS];
        direction(view[0], view[1], wo);
        run_experiment(model, hnbrdf_model_material(model, k), wo, &r, &worst);
    }
    print_worst(&worst);
    hnbrdf_model_free(model);
}

/* ---- Weights ----------------------------------------------------------------------------------
 * */

/* Of f_a and the lobes that are guessed. Where a share s in [0.2, 0.9] goes to visible normals
 * and the rest to the cosine, f cos/pdf is at most the larger of what each lobe alone gives: F
 * G2/G1(wo)/s <= 5, or less where the normals are bounded, and kd/(1 - s) = kd (1 + specular/d)
 * <= 3 (d + 1.05) <= 4.2 with d >= kd/3. */
static const double largest_weight = 5.0 * (1.0 + 1e-5); /* rounding: pdf and f_a are within 4e-6 */

static void weights_of_the_analytic_part_are_bounded(void **state)
{
    (void)state;
    static const double heights[] = {1.0, 0.5, 0.1, 1e-2, 1e-3, 1e-5, 1e-7};
    enum { HEIGHTS = sizeof heights / sizeof heights[0] };
    rng r = rng_make(52);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_GGX, HNBRDF_ENCODING_DIRECTIONS, 0, 0, 0);
    double worst[HEIGHTS] = {0.0};
    for (int k = 0; k < 200000; k++) {
        hnbrdf_material m = random_material(&r, k % 2);
        hnbrdf_sample_result s;
        const float u[2] = {rng_float(&r), rng_float(&r)};
        float wo[3];
        if (k % 3 == 0) /* coloured, white or black; a mirror of metal or hardly any */
            for (int c = 0; c < 3; c++) {
                m.kd[c] = (float)(k / 3 >> c & 1);
                m.eta[c] = k / 24 % 2 ? HNBRDF_MAX_ETA : 1.00000012f;
            }
        direction(heights[k % HEIGHTS], 6.0 * (double)rng_float(&r), wo);
        hnbrdf_sample(model, &m, wo, u, &s);
        for (int c = 0; c < 3; c++)
            worst[k % HEIGHTS] = fmax(worst[k % HEIGHTS], (double)s.weight[c]);
    }
    for (int h = 0; h < HEIGHTS; h++) {
        print_message("    cosine %g: largest weight %.3f\n", heights[h], worst[h]);
        assert_true(worst[h] > 0.9 && worst[h] <= largest_weight);
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
        sampling_chart c = sampling_chart_make(&m, wo);
        integrate(model, &m, wo, &c, &sums);
        assert_true(sums.albedo[0] <= 1.0 + SAMPLING_QUADRATURE);
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
        cmocka_unit_test(samples_of_every_shipped_material_follow_the_density),
        cmocka_unit_test(weights_of_the_analytic_part_are_bounded),
        cmocka_unit_test(ggx_gains_no_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
