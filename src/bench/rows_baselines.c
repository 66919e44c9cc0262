/* rows_baselines.c: what the baselines take on one thread: values, directions, densities. */
#include "bench/baselines.h"
#include "base/error.h"
#include "render/tabulated.h"

#include <stdlib.h>

enum { PAIRS = 512 };

typedef struct work {
    struct bench_baseline_rows *rows;
    bench_stand_in stand_in;
    hnbrdf_prepared lobes[2];
    render_surface sampler; /* directions and densities */
} work;

struct bench_baseline_rows {
    const bench *b;
    float wi[PAIRS][3], wo[PAIRS][3], f[PAIRS][3], scratch[PAIRS][3], u[PAIRS][3], pdf[PAIRS];
    render_table *table; /* of the measurement */
    work works[BENCH_BASELINES];
};

/* ---- What is timed --------------------------------------------------------------------------- */

static void run_measured(void *context)
{
    work *w = context;
    bench_baseline_rows *r = w->rows;
    for (int k = 0; k < PAIRS; k++)
        hnbrdf_measured_eval(w->stand_in.measured, r->wi[k], r->wo[k], r->f[k]);
}

static void run_two_lobes(void *context)
{
    work *w = context;
    bench_baseline_rows *r = w->rows;
    for (int k = 0; k < PAIRS; k++) {
        hnbrdf_prepared_eval(&w->lobes[0], r->wi[k], r->wo[k], r->f[k]);
        hnbrdf_prepared_eval(&w->lobes[1], r->wi[k], r->wo[k], r->scratch[0]);
        for (int c = 0; c < 3; c++)
            r->f[k][c] += r->scratch[0][c];
    }
}

static void run_two_lobes_batch(void *context)
{
    work *w = context;
    bench_baseline_rows *r = w->rows;
    bench_two_lobes_eval(r->b->models[0].model, &w->stand_in.lobes, PAIRS, r->wi[0], r->wo[0],
                         r->f[0], r->scratch[0]);
}

static void run_draw(void *context)
{
    work *w = context;
    bench_baseline_rows *r = w->rows;
    for (int k = 0; k < PAIRS; k++)
        r->pdf[k] = w->sampler.sample(&w->sampler, r->wo[k], r->u[k], r->f[k]);
}

static void run_density(void *context)
{
    work *w = context;
    bench_baseline_rows *r = w->rows;
    for (int k = 0; k < PAIRS; k++)
        r->pdf[k] = w->sampler.pdf(&w->sampler, r->wi[k], r->wo[k]);
}

/* ---- How each of them is sampled ------------------------------------------------------------- */

/* Isotropic measurements by a table of their own, as Lawrence et al. (2004) do. */
static hnbrdf_result sample_by_table(work *w, hnbrdf_error *error)
{
    bench_baseline_rows *r = w->rows;
    hnbrdf_measured *measured = r->b->data[0];
    hnbrdf_result result = HNBRDF_OK;
    if (!hnbrdf_measured_is_isotropic(measured))
        return result;
    w->sampler = render_surface_measured(measured);
    if (!r->table)
        result = render_table_create(&w->sampler, &r->table, error);
    if (!result)
        render_surface_tabulate(&w->sampler, r->table);
    return result;
}

/* By their own lobes, half of the directions each. */
static void sample_by_lobes(work *w)
{
    const hnbrdf_model *ggx = w->rows->b->models[0].model;
    render_guide guide = {.model = ggx, .count = 2};
    for (int l = 0; l < 2; l++) {
        guide.lobes[l].material = w->stand_in.lobes.lobe[l];
        guide.lobes[l].share = 0.5f;
        hnbrdf_prepare(ggx, &w->stand_in.lobes.lobe[l], &w->lobes[l]);
    }
    w->sampler = render_surface_model(ggx, &w->stand_in.lobes.lobe[0]);
    render_surface_guide(&w->sampler, &guide);
}

/* As GGX alone is: a network of this kind has nothing of its own for it. */
static void sample_by_ggx(work *w)
{
    const bench *b = w->rows->b;
    const hnbrdf_material *material = bench_ggx_material(b, b->data[0]);
    if (material)
        w->sampler = render_surface_model(b->models[0].model, material);
}

static hnbrdf_result choose_sampler(work *w, bench_baseline baseline, hnbrdf_error *error)
{
    switch (baseline) {
    case BENCH_MEASUREMENT:
    case BENCH_TABLE:
        return sample_by_table(w, error);
    case BENCH_TWO_LOBES:
        sample_by_lobes(w);
        break;
    case BENCH_NBRDF:
    case BENCH_BASELINES:
        sample_by_ggx(w);
        break;
    }
    return HNBRDF_OK;
}

/* ---- Rows ------------------------------------------------------------------------------------ */

static hnbrdf_result add_row(bench *b, work *w, bench_baseline baseline, const char *backend,
                             void (*run)(void *context), hnbrdf_error *error)
{
    bench_row *row;
    const int lobes = baseline == BENCH_TWO_LOBES;
    hnbrdf_result result =
        bench_add_row(b, &b->baselines[baseline], backend,
                      lobes ? hnbrdf_variant_name(b->models[0].desc.variant) : "reader", "none",
                      "float", &row, error);
    if (result)
        return result;
    row->threads = 1;
    row->whole = hnbrdf_probe_of_thread(run, w, PAIRS);
    if (run == run_two_lobes_batch || !w->sampler.sample)
        return HNBRDF_OK;
    row->draw = hnbrdf_probe_of_thread(run_draw, w, PAIRS);
    row->density = hnbrdf_probe_of_thread(run_density, w, PAIRS);
    return HNBRDF_OK;
}

static hnbrdf_result add_baseline(bench *b, bench_baseline_rows *rows, bench_baseline baseline,
                                  hnbrdf_error *error)
{
    work *w = &rows->works[baseline];
    const int lobes = baseline == BENCH_TWO_LOBES;
    w->rows = rows;
    hnbrdf_result result =
        bench_show(&b->watch, "preparing baselines", (double)baseline / BENCH_BASELINES,
                   bench_baseline_name(baseline), error);
    if (!result)
        result = bench_stand_in_open(b, baseline, b->data[0], &w->stand_in, error);
    if (result || !w->stand_in.measured)
        return result;
    result = choose_sampler(w, baseline, error);
    if (!result)
        result = add_row(b, w, baseline, "c-single-prepared", lobes ? run_two_lobes : run_measured,
                         error);
    if (!result && lobes)
        result = add_row(b, w, baseline, "c-batch", run_two_lobes_batch, error);
    return result;
}

hnbrdf_result bench_baseline_rows_open(bench *b, bench_baseline_rows **opened, hnbrdf_error *error)
{
    bench_baseline_rows *rows = *opened = calloc(1, sizeof *rows);
    hnbrdf_result result = HNBRDF_OK;
    hnbrdf_rng rng;
    if (!rows)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    rows->b = b;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; k < PAIRS; k++) {
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, rows->wi[k], rows->wo[k]);
        for (int i = 0; i < 3; i++)
            rows->u[k][i] = hnbrdf_rng_float(&rng);
    }
    for (bench_baseline k = BENCH_MEASUREMENT; k < BENCH_BASELINES && !result; k++)
        if (b->baselines[k].is_baseline)
            result = add_baseline(b, rows, k, error);
    return result;
}

void bench_baseline_rows_close(bench_baseline_rows *rows)
{
    for (int k = 0; rows && k < BENCH_BASELINES; k++)
        bench_stand_in_close(&rows->works[k].stand_in);
    if (rows)
        render_table_free(rows->table);
    free(rows);
}
