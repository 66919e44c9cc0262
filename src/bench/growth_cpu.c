/* growth_cpu.c: how evaluation in C grows with the network, the batch and the materials. */
#include "base/clock.h"
#include "base/error.h"
#include "bench/growth.h"

#include <stdlib.h>

enum { PAIRS = 512, MOST_PAIRS = 65536 };

typedef struct arrays {
    float wi[MOST_PAIRS][3], wo[MOST_PAIRS][3], f[MOST_PAIRS][3];
    int index[MOST_PAIRS];
} arrays;

typedef struct work {
    arrays *a;
    hnbrdf_model *model;
    hnbrdf_prepared prepared;
    int pairs, materials;
    double (*run)(void *context, long repeats);
    growth_series *series;
    double size, arithmetic;
} work;

enum { MOST_WORKS = 64 };
typedef struct works {
    arrays a;
    work work[MOST_WORKS];
    hnbrdf_probe probes[MOST_WORKS];
    int count;
} works;

static double run_batch(void *context, long repeats)
{
    work *w = context;
    arrays *a = w->a;
    double started = hnbrdf_thread_seconds();
    for (long n = 0; n < repeats; n++)
        hnbrdf_prepared_eval_batch(&w->prepared, (size_t)w->pairs, a->wi[0], 0, a->wo[0], 0,
                                   a->f[0], 0);
    return 1e9 * (hnbrdf_thread_seconds() - started);
}

static double run_single(void *context, long repeats)
{
    work *w = context;
    arrays *a = w->a;
    double started = hnbrdf_thread_seconds();
    for (long n = 0; n < repeats; n++)
        for (int k = 0; k < w->pairs; k++)
            hnbrdf_prepared_eval(&w->prepared, a->wi[k], a->wo[k], a->f[k]);
    return 1e9 * (hnbrdf_thread_seconds() - started);
}

/* All materials in turn, in an order without order. */
static double run_many(void *context, long repeats)
{
    work *w = context;
    arrays *a = w->a;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 3, 0);
    for (int k = 0; k < w->pairs; k++)
        a->index[k] = (int)(hnbrdf_rng_u32(&rng) % (uint32_t)w->materials);
    double started = hnbrdf_thread_seconds();
    for (long n = 0; n < repeats; n++)
        hnbrdf_eval_many(w->model, hnbrdf_model_material(w->model, 0), a->index, (size_t)w->pairs,
                         a->wi[0], 0, a->wo[0], 0, a->f[0], 0);
    return 1e9 * (hnbrdf_thread_seconds() - started);
}

static hnbrdf_result add(works *all, growth_series *series, const growth_shape *shape, double size,
                         int pairs, int per_pair, double (*run)(void *, long), hnbrdf_error *error)
{
    if (all->count == MOST_WORKS)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "more than %d sizes", (int)MOST_WORKS);
    work *w = &all->work[all->count];
    *w = (work){.a = &all->a,
                .pairs = pairs,
                .materials = shape->materials,
                .run = run,
                .series = series,
                .size = size};
    hnbrdf_result result = bench_growth_model(shape, &w->model, error);
    if (result)
        return result;
    hnbrdf_prepare(w->model, hnbrdf_model_material(w->model, 0), &w->prepared);
    /* the latent code is folded into the first bias */
    w->arithmetic = (double)hnbrdf_model_multiplications(w->model) -
                    (double)shape->hidden * (double)shape->latent;
    w->arithmetic *= per_pair ? 1.0 : pairs;
    all->probes[all->count++] = hnbrdf_probe_make(run, w, per_pair ? pairs : 1);
    return HNBRDF_OK;
}

static hnbrdf_result add_axis(growth *g, works *all, growth_axis axis, const char *what,
                              double (*run)(void *, long), int pairs, hnbrdf_error *error)
{
    growth_shape shape;
    hnbrdf_result result = HNBRDF_OK;
    growth_series *series = bench_growth_add(g, what, "ns", bench_growth_axis_name(axis));
    for (int k = 0; !result && bench_growth_shape(g, axis, k, &shape); k++)
        result = add(all, series, &shape, bench_growth_size(axis, &shape), pairs, 1, run, error);
    return result;
}

/* Of whole batches, of more and more pairs. */
static hnbrdf_result add_pairs(growth *g, works *all, hnbrdf_error *error)
{
    growth_shape shape;
    hnbrdf_result result = HNBRDF_OK;
    growth_series *series = bench_growth_add(g, "evaluation of a batch", "ns", "pairs");
    (void)bench_growth_shape(g, GROWTH_N, 0, &shape);
    for (int pairs = 16; pairs <= (g->quick ? 1024 : MOST_PAIRS) && !result; pairs *= 8)
        result = add(all, series, &shape, pairs, pairs, 0, run_batch, error);
    return result;
}

static int between(void *user, double share)
{
    return bench_show(user, "evaluations", share, "", NULL) != HNBRDF_OK;
}

static hnbrdf_result measure(works *all, int quick, const bench_watch *watch, hnbrdf_error *error)
{
    hnbrdf_probe *probes[MOST_WORKS];
    for (int k = 0; k < all->count; k++)
        probes[k] = &all->probes[k];
    const hnbrdf_timing how = {.sample_ns = quick ? 1e5 : 5e6,
                               .rounds = quick ? 2 : 12,
                               .between = between,
                               .user = (void *)watch};
    hnbrdf_time_probes(&how, probes, all->count);
    for (int k = 0; k < all->count; k++)
        bench_growth_point(all->work[k].series, all->work[k].size, all->probes[k].ns,
                           all->work[k].arithmetic);
    return bench_show(watch, "evaluations", 1.0, "", error);
}

hnbrdf_result bench_growth_cpu(growth *g, const bench_watch *watch, hnbrdf_error *error)
{
    works *all = calloc(1, sizeof *all);
    hnbrdf_rng rng;
    if (!all)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; k < MOST_PAIRS; k++)
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, all->a.wi[k], all->a.wo[k]);
    hnbrdf_result result = HNBRDF_OK;
    for (growth_axis axis = GROWTH_H; axis <= GROWTH_L && !result; axis++)
        result = add_axis(g, all, axis, "evaluation, batch", run_batch, PAIRS, error);
    for (growth_axis axis = GROWTH_H; axis <= GROWTH_L && !result; axis++)
        result = add_axis(g, all, axis, "evaluation, single", run_single, PAIRS, error);
    if (!result) /* enough pairs that all materials come up */
        result = add_axis(g, all, GROWTH_MATERIALS, "evaluation, mixed batch", run_many,
                          g->quick ? PAIRS : 8192, error);
    if (!result)
        result = add_pairs(g, all, error);
    if (!result)
        result = measure(all, g->quick, watch, error);
    for (int k = 0; k < all->count; k++)
        hnbrdf_model_free(all->work[k].model);
    free(all);
    return result;
}
