/* bake_fit.c: fits candidates to the reference, several at once, and measures what comes out. */
#include "cli/bake.h"
#include "base/interrupt.h"
#include "base/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SHORT_PAIRS = 20000, /* measured of a short fit, at most */
    SHORT_POOL = 32768,  /* drawn a material for one, unless asked for */
    FULL_POOL = 131072,
    LEAST_STEPS = 100 /* an interrupted fit of fewer is not worth a row */
};
#define MEMORY 1.5e9    /* bytes of training data that all fits together may take */
#define PAIR_BYTES 72.0 /* of one pair in the trainer's pool */

void bake_catch_interrupts(int on)
{
    hnbrdf_catch_interrupts(on);
}

int bake_interrupted(void)
{
    return hnbrdf_interrupted();
}

double bake_judged(const bake *b, const bake_row *row)
{
    return b->worst ? row->worst : row->smape;
}

/* ---- Rows ------------------------------------------------------------------------------------ */

/* errors [materials]: of the model's material at[m], or m. */
static hnbrdf_result measure(const bake *b, const hnbrdf_model *model, const int *at, size_t pairs,
                             hnbrdf_comparison *errors, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int m = 0; m < b->count && result == HNBRDF_OK; m++)
        result =
            hnbrdf_compare(model, hnbrdf_model_material(model, at ? at[m] : m), b->reference[m],
                           (hnbrdf_sampler)b->sampler, pairs, (uint64_t)b->seed, &errors[m], error);
    return result;
}

static void summarise(const bake *b, const hnbrdf_comparison *errors, double *mean, double *worst,
                      double *analytic)
{
    *mean = *worst = *analytic = 0.0;
    for (int m = 0; m < b->count; m++) {
        *mean += errors[m].smape / b->count;
        *worst = fmax(*worst, errors[m].smape);
        *analytic += errors[m].smape_analytic / b->count;
    }
}

/* Takes model and errors of `made` over, also on failure. */
static int add_row(bake *b, const bake_row *made)
{
    bake_row *rows = realloc(b->rows, ((size_t)b->row_count + 1) * sizeof *rows);
    if (!rows) {
        free(made->errors);
        hnbrdf_model_free(made->model);
        return cli_fail("out of memory");
    }
    b->rows = rows;
    bake_row *row = &rows[b->row_count++];
    *row = *made;
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(row->model, &desc);
    row->encoding = desc.encoding;
    summarise(b, row->errors, &row->smape, &row->worst, &row->analytic);
    return b->told(b, row);
}

double bake_half_error(const bake *b)
{
    const bake_row *row = &b->rows[b->picked];
    double mean = NAN, worst = NAN, analytic;
    hnbrdf_model *model = row->candidate->hidden ? bake_half(row->model) : NULL;
    hnbrdf_comparison *errors = calloc((size_t)b->count, sizeof *errors);
    size_t pairs = (size_t)b->pairs;
    if (model && errors && measure(b, model, NULL, pairs, errors, NULL) == HNBRDF_OK)
        summarise(b, errors, &mean, &worst, &analytic);
    free(errors);
    hnbrdf_model_free(model);
    return b->worst ? worst : mean;
}

/* ---- GGX alone ------------------------------------------------------------------------------- */

static int show_ggx(void *user, const hnbrdf_fit_progress *p)
{
    cli_progress *line = user;
    int drawing = strcmp(p->stage, "sampling") == 0;
    cli_progress_update(line, 0.5 * p->done + (drawing ? 0.0 : 0.5),
                        drawing ? "drawing data" : "fitting");
    return bake_interrupted();
}

static hnbrdf_result fit_ggx(bake *b, hnbrdf_error *error)
{
    cli_progress line;
    hnbrdf_model *model;
    hnbrdf_fit_options options = {.kind = HNBRDF_KIND_GGX,
                                  .pool = b->pool ? (int)b->pool : SHORT_POOL,
                                  .seed = (uint64_t)b->seed,
                                  .threads = (int)b->threads,
                                  .progress = show_ggx,
                                  .progress_user = &line};
    cli_progress_begin(&line, "GGX");
    hnbrdf_result result = hnbrdf_fit((const hnbrdf_measured *const *)b->reference, b->count,
                                      &options, &model, NULL, error);
    cli_progress_end(&line);
    if (result)
        return result;
    for (int m = 0; m < b->count; m++)
        b->analytic[m] = *hnbrdf_model_material(model, m);
    hnbrdf_model_free(model);
    return HNBRDF_OK;
}

static hnbrdf_result make_ggx_model(const bake *b, hnbrdf_model **model, hnbrdf_error *error)
{
    const char **names = malloc((size_t)b->count * sizeof *names);
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_GGX,
                              .material_count = b->count,
                              .materials = b->analytic,
                              .names = names};
    hnbrdf_result result = HNBRDF_ERROR_MEMORY;
    for (int m = 0; names && m < b->count; m++)
        names[m] = hnbrdf_measured_name(b->reference[m]);
    if (names)
        result = hnbrdf_model_create(&desc, NULL, model, error);
    free(names);
    return result;
}

/* The model's own error, where there are measurements to know it by. */
static hnbrdf_result measure_reference(bake *b, hnbrdf_comparison *errors, hnbrdf_error *error)
{
    double analytic;
    b->reference_smape = b->reference_worst = NAN;
    if (!b->from_data)
        return HNBRDF_OK;
    hnbrdf_result result = measure(b, b->model, b->chosen, (size_t)b->pairs, errors, error);
    if (!result)
        summarise(b, errors, &b->reference_smape, &b->reference_worst, &analytic);
    return result;
}

int bake_ggx(bake *b)
{
    hnbrdf_error error = {"out of memory"};
    hnbrdf_result result = HNBRDF_OK;
    bake_row row = {.candidate = &b->candidates[0], .full = 1, .seed = b->seed};
    double started = cli_seconds();
    b->analytic = calloc((size_t)b->count, sizeof *b->analytic);
    row.errors = calloc((size_t)b->count, sizeof *row.errors);
    if (!b->analytic || !row.errors)
        result = HNBRDF_ERROR_MEMORY;
    for (int m = 0; m < b->count && !result && b->keep; m++)
        b->analytic[m] = *hnbrdf_model_material(b->model, b->chosen[m]);
    if (!result && !b->keep)
        result = fit_ggx(b, &error);
    row.seconds = cli_seconds() - started;
    if (!result)
        result = measure_reference(b, row.errors, &error);
    if (!result)
        result = make_ggx_model(b, &row.model, &error);
    if (!result)
        result = measure(b, row.model, NULL, (size_t)b->pairs, row.errors, &error);
    if (!result)
        return add_row(b, &row);
    free(row.errors);
    hnbrdf_model_free(row.model);
    return cli_fail("%s", error.text);
}

/* ---- Waves ----------------------------------------------------------------------------------- */

typedef struct wave wave;

typedef struct task {
    wave *of;
    const bake_job *job;
    int worker;
    bake_row row;
    hnbrdf_result result;
    hnbrdf_error error;
} task;

struct wave {
    bake *b;
    task *tasks;
    int count, width;
    double seconds;
    cli_progress line;
};

static long pool_of(const bake *b, int full)
{
    return b->pool ? b->pool : full ? FULL_POOL : SHORT_POOL;
}

int bake_width(const bake *b, int full)
{
    double most = MEMORY / ((double)b->count * (double)pool_of(b, full) * PAIR_BYTES);
    int threads = b->threads ? (int)b->threads : cli_processors();
    return most < 1.0 ? 1 : most < threads ? (int)most : threads;
}

/* The main thread speaks for all: they began together and are of about the same size. */
static int show(void *user, const hnbrdf_fit_progress *p)
{
    task *t = user;
    if (t->worker == 0) {
        const wave *w = t->of;
        char detail[64] = "";
        int rounds = (w->count + w->width - 1) / w->width, round = (int)(t - w->tasks) / w->width;
        double share = strcmp(p->stage, "network") == 0 ? p->done : 0.0;
        if (isfinite(p->loss))
            snprintf(detail, sizeof detail, "loss %.4f", p->loss);
        cli_progress_update(&t->of->line, (round + share) / rounds, detail);
    }
    return bake_interrupted();
}

static void set_options(const bake *b, const task *t, hnbrdf_fit_options *o)
{
    const bake_job *job = t->job;
    int threads = b->threads ? (int)b->threads : cli_processors();
    memset(o, 0, sizeof *o);
    o->kind = HNBRDF_KIND_HYBRID;
    o->hidden = job->candidate->hidden;
    o->layers = job->candidate->layers;
    o->latent = job->candidate->latent;
    o->latent_none = job->candidate->latent == 0;
    o->encoding = b->encoding >= 0 ? hnbrdf_encoding_name((hnbrdf_encoding)b->encoding) : NULL;
    o->materials = b->analytic;
    o->steps = job->full ? b->steps : b->short_steps;
    o->seconds = t->of->seconds;
    o->pool = (int)pool_of(b, job->full);
    o->seed = (uint64_t)job->seed;
    o->threads = threads > t->of->width ? threads / t->of->width : 1;
}

static void run_task(void *context, int index, int worker)
{
    wave *w = context;
    task *t = &w->tasks[index];
    const bake *b = w->b;
    hnbrdf_fit_options options;
    hnbrdf_fit_report report;
    t->worker = worker;
    t->result = HNBRDF_ERROR_CANCELLED;
    if (bake_interrupted())
        return;
    set_options(b, t, &options);
    options.progress = show;
    options.progress_user = t;
    t->result = hnbrdf_fit((const hnbrdf_measured *const *)b->reference, b->count, &options,
                           &t->row.model, &report, &t->error);
    if (t->result)
        return;
    t->row.candidate = t->job->candidate;
    t->row.full = t->job->full;
    t->row.seed = t->job->seed;
    t->row.steps = report.steps;
    t->row.seconds = report.seconds;
    if (report.stopped && report.steps < LEAST_STEPS) {
        t->result = HNBRDF_ERROR_CANCELLED;
        return;
    }
    long pairs = t->job->full && !report.stopped ? b->pairs : SHORT_PAIRS;
    t->row.errors = calloc((size_t)b->count, sizeof *t->row.errors);
    t->result = HNBRDF_ERROR_MEMORY;
    if (t->row.errors)
        t->result = measure(b, t->row.model, NULL, (size_t)(pairs < b->pairs ? pairs : b->pairs),
                            t->row.errors, &t->error);
    if (!t->result)
        summarise(b, t->row.errors, &t->row.smape, &t->row.worst, &t->row.analytic);
}

static void drop(task *t)
{
    free(t->row.errors);
    hnbrdf_model_free(t->row.model);
    t->row.errors = NULL;
    t->row.model = NULL;
}

/* A row for each candidate, the best of its seeds. */
static int collect(wave *w)
{
    int code = CLI_OK;
    for (int k = 0; k < w->count; k++) {
        task *best = NULL;
        for (int i = 0; i < w->count; i++) {
            task *t = &w->tasks[i];
            if (t->job->candidate == w->tasks[k].job->candidate && t->row.model &&
                t->result == HNBRDF_OK &&
                (!best || bake_judged(w->b, &t->row) < bake_judged(w->b, &best->row)))
                best = t;
        }
        if (best && code == CLI_OK) {
            bake_row row = best->row;
            best->row.model = NULL;
            best->row.errors = NULL;
            code = add_row(w->b, &row);
        }
        for (int i = 0; i < w->count; i++) /* the other seeds have had their turn */
            if (w->tasks[i].job->candidate == w->tasks[k].job->candidate)
                drop(&w->tasks[i]);
    }
    for (int k = 0; k < w->count && code == CLI_OK; k++)
        if (w->tasks[k].result != HNBRDF_OK && w->tasks[k].result != HNBRDF_ERROR_CANCELLED)
            code = cli_fail("%s", w->tasks[k].error.text[0] ? w->tasks[k].error.text
                                                            : hnbrdf_strerror(w->tasks[k].result));
    return code;
}

int bake_wave(bake *b, const bake_job *jobs, int count, double seconds)
{
    char first[16], last[16], what[64];
    int width = bake_width(b, jobs[0].full);
    wave w = {.b = b, .count = count, .seconds = seconds, .width = width < count ? width : count};
    w.tasks = calloc((size_t)count, sizeof *w.tasks);
    hnbrdf_threads *workers = hnbrdf_threads_start(w.width);
    if (!w.tasks || !workers) {
        free(w.tasks);
        hnbrdf_threads_stop(workers);
        return cli_fail("out of memory");
    }
    for (int k = 0; k < count; k++) {
        w.tasks[k].of = &w;
        w.tasks[k].job = &jobs[k];
    }
    bake_size_name(jobs[0].candidate, first);
    bake_size_name(jobs[count - 1].candidate, last);
    snprintf(what, sizeof what, "%s fits of %s%s%s", jobs[0].full ? "full" : "short", first,
             strcmp(first, last) ? " to " : "", strcmp(first, last) ? last : "");
    cli_progress_begin(&w.line, what);
    hnbrdf_threads_run(workers, count, run_task, &w);
    cli_progress_end(&w.line);
    hnbrdf_threads_stop(workers);
    int code = collect(&w);
    free(w.tasks);
    return code;
}
