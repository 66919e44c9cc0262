/* growth_fit.c: how fits grow with the network, the materials and the pairs. */
#include "base/error.h"
#include "bench/growth.h"
#include "hnbrdf/fit.h"
#include "measured/families.h"

#include <stdlib.h>

enum { MOST_MATERIALS = 64 };

typedef struct data {
    hnbrdf_measured *items[MOST_MATERIALS];
    int count;
} data;

/* Members of one family, from smooth to rough. */
static hnbrdf_result open_data(data *d, int count, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (; d->count < count && !result; d->count += !result) {
        char name[32];
        hnbrdf_family_parameters parameters;
        snprintf(name, sizeof name, "paint_%05d", d->count);
        hnbrdf_family_member(0, 0.05 * pow(12.0, d->count / (double)MOST_MATERIALS), &parameters);
        result = hnbrdf_family_open(0, &parameters, name, &d->items[d->count], error);
    }
    return result;
}

static void close_data(data *d)
{
    for (int k = 0; k < d->count; k++)
        hnbrdf_measured_close(d->items[k]);
}

static hnbrdf_result fit(const growth *g, const data *d, int count, const growth_shape *shape,
                         long steps, hnbrdf_fit_report *report, hnbrdf_error *error)
{
    hnbrdf_model *model;
    const hnbrdf_fit_options options = {.hidden = shape->hidden,
                                        .layers = shape->layers,
                                        .latent = shape->latent,
                                        .encoding = "angles",
                                        .steps = steps,
                                        .pool = g->quick ? 1024 : 8192,
                                        .seed = 1};
    hnbrdf_result result = hnbrdf_fit((const hnbrdf_measured *const *)d->items, count, &options,
                                      &model, report, error);
    if (!result)
        hnbrdf_model_free(model);
    return result;
}

static double processor_ms(const hnbrdf_fit_report *r)
{
    const hnbrdf_fit_times *t = &r->times;
    return 1e3 * (t->drawing + t->ggx + t->encoding + t->network + t->update);
}

/* What both passes take for a pair. */
static hnbrdf_result by_network(growth *g, const data *d, growth_axis axis,
                                const bench_watch *watch, hnbrdf_error *error)
{
    growth_series *series =
        bench_growth_add(g, "fit, forward and backward", "ns/pair", bench_growth_axis_name(axis));
    growth_shape shape;
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; !result && bench_growth_shape(g, axis, k, &shape); k++) {
        hnbrdf_fit_report report;
        result = bench_show(watch, "fits", 0.3 * (int)axis + 0.05 * k, "", error);
        if (!result)
            result = fit(g, d, 2, &shape, g->quick ? 20 : 300, &report, error);
        if (!result)
            bench_growth_point(series, bench_growth_size(axis, &shape),
                               1e9 * report.times.network / report.pairs,
                               report.flops / report.pairs);
    }
    return result;
}

static hnbrdf_result by_materials(growth *g, data *d, const bench_watch *watch, hnbrdf_error *error)
{
    growth_series *series = bench_growth_add(g, "fit, everything", "ms", "materials");
    growth_shape shape;
    hnbrdf_result result = HNBRDF_OK;
    (void)bench_growth_shape(g, GROWTH_N, 0, &shape);
    for (int count = 1; count <= (g->quick ? 4 : MOST_MATERIALS) && !result; count *= 4) {
        hnbrdf_fit_report report;
        result = bench_show(watch, "fits", 0.6 + 0.003 * count, "", error);
        if (!result)
            result = open_data(d, count, error);
        if (!result)
            result = fit(g, d, count, &shape, 20, &report, error);
        if (!result)
            bench_growth_point(series, count, processor_ms(&report), count);
    }
    return result;
}

static hnbrdf_result by_pairs(growth *g, const data *d, const bench_watch *watch,
                              hnbrdf_error *error)
{
    growth_series *series = bench_growth_add(g, "fit, everything", "ms", "pairs");
    growth_shape shape;
    hnbrdf_result result = HNBRDF_OK;
    (void)bench_growth_shape(g, GROWTH_N, 0, &shape);
    for (long steps = 20; steps <= (g->quick ? 80 : 1280) && !result; steps *= 4) {
        hnbrdf_fit_report report;
        result = bench_show(watch, "fits", 0.8 + 0.0001 * (double)steps, "", error);
        if (!result)
            result = fit(g, d, 2, &shape, steps, &report, error);
        if (!result)
            bench_growth_point(series, report.pairs, processor_ms(&report), report.pairs);
    }
    return result;
}

hnbrdf_result bench_growth_fit(growth *g, const bench_watch *watch, hnbrdf_error *error)
{
    data d = {.count = 0};
    hnbrdf_result result = open_data(&d, 2, error);
    if (!result)
        result = by_network(g, &d, GROWTH_H, watch, error);
    if (!result)
        result = by_network(g, &d, GROWTH_N, watch, error);
    if (!result)
        result = by_materials(g, &d, watch, error);
    if (!result)
        result = by_pairs(g, &d, watch, error);
    close_data(&d);
    return result;
}
