/* test_render_tabulated.c: the tabulated sampler is one: density and draws agree, nothing is
 * missed, and the samples of what it tabulates have hardly any variance. */
#include "render/tabulated.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static hnbrdf_model *make_model(float alpha, float kd)
{
    hnbrdf_material m;
    hnbrdf_model *model = NULL;
    const char *name = "m";
    hnbrdf_material_init(&m);
    m.alpha[0] = m.alpha[1] = alpha;
    for (int c = 0; c < 3; c++)
        m.kd[c] = kd;
    const hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = 1, .materials = &m, .names = &name};
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
    return model;
}

typedef struct estimate {
    double mean, variance;
    int refused;
} estimate;

/* The albedo of one view, from draws of the surface. */
static estimate albedo(const render_surface *surface, const float wo[3], int draws)
{
    estimate e = {0.0, 0.0, 0};
    hnbrdf_rng rng;
    double square = 0.0;
    hnbrdf_rng_seed(&rng, 5, 0);
    for (int k = 0; k < draws; k++) {
        const float u[3] = {hnbrdf_rng_float(&rng), hnbrdf_rng_float(&rng), hnbrdf_rng_float(&rng)};
        float wi[3], f[3], pdf = surface->sample(surface, wo, u, wi);
        if (!(pdf > 0.0f)) {
            e.refused++;
            continue;
        }
        assert_true(pdf == surface->pdf(surface, wi, wo));
        surface->eval(surface, 1, wi, wo, f);
        double weight = (double)f[0] * (double)wi[2] / (double)pdf;
        e.mean += weight / draws;
        square += weight * weight / draws;
    }
    e.variance = square - e.mean * e.mean;
    return e;
}

static void check_material(float alpha, float kd)
{
    enum { DRAWS = 20000 };
    static const float cosines[] = {1.0f, 0.7f, 0.25f};
    hnbrdf_model *model = make_model(alpha, kd);
    render_surface lobes = render_surface_model(model, hnbrdf_model_material(model, 0)),
                   tabulated = lobes;
    render_table *table = NULL;
    hnbrdf_error error;
    assert_int_equal(render_table_create(&lobes, &table, &error), HNBRDF_OK);
    render_surface_tabulate(&tabulated, table);
    for (int v = 0; v < 3; v++) {
        const float z = cosines[v], r = sqrtf(1.0f - z * z), wo[3] = {0.6f * r, -0.8f * r, z};
        estimate a = albedo(&lobes, wo, DRAWS), b = albedo(&tabulated, wo, DRAWS);
        /* Five standard deviations of the difference of two means. */
        assert_true(fabs(a.mean - b.mean) <= 5.0 * sqrt((a.variance + b.variance) / DRAWS));
        assert_true(b.variance < 0.2 * a.mean * a.mean);
        assert_true(b.refused <= DRAWS / 20);
    }
    render_table_free(table);
    hnbrdf_model_free(model);
}

static void samples_have_the_albedo_and_little_variance(void **state)
{
    (void)state;
    check_material(0.3f, 0.2f);
    check_material(0.05f, 0.0f);
}

/* Midpoints of rings and turns of the half vector resolve the lobe; what the table puts below the
 * horizon is lost. */
static void the_density_integrates_to_at_most_one(void **state)
{
    (void)state;
    enum { RINGS = 720, TURNS = 720 };
    const double pi = 3.14159265358979323846;
    hnbrdf_model *model = make_model(0.2f, 0.1f);
    render_surface surface = render_surface_model(model, hnbrdf_model_material(model, 0));
    render_table *table = NULL;
    hnbrdf_error error;
    assert_int_equal(render_table_create(&surface, &table, &error), HNBRDF_OK);
    assert_true(render_table_bytes() < 6000000);
    render_surface_tabulate(&surface, table);
    const float wo[3] = {0.6f, 0.0f, 0.8f};
    double total = 0.0;
    for (int r = 0; r < RINGS; r++)
        for (int t = 0; t < TURNS; t++) {
            double u = (r + 0.5) / RINGS, theta = u * u * 0.5 * pi,
                   phi = 2.0 * pi * (t + 0.5) / TURNS;
            double h[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)}, c = 0.0;
            float wi[3];
            for (int k = 0; k < 3; k++)
                c += h[k] * (double)wo[k];
            for (int k = 0; k < 3; k++)
                wi[k] = (float)(2.0 * c * h[k] - (double)wo[k]);
            if (c > 0.0 && wi[2] > 0.0f)
                total += (double)surface.pdf(&surface, wi, wo) * 4.0 * c * sin(theta) *
                         (pi * u / RINGS) * (2.0 * pi / TURNS);
        }
    assert_true(total <= 1.001 && total >= 0.97);
    render_table_free(table);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_have_the_albedo_and_little_variance),
        cmocka_unit_test(the_density_integrates_to_at_most_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
