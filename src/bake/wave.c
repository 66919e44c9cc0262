/* wave.c: fits candidates to the reference, several at once, and keeps the best seed of each. */
#include "bake/task.h"
#include "base/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SHORT_PAIRS = 20000, /* measured of a short fit, at most */
    SHORT_POOL = 32768,  /* drawn a material for one, unless asked for */
    FULL_POOL = 131072,
    LEAST_STEPS = 100, /* a fit that was stopped sooner is not worth a row */
    WHOLE = 1000       /* shares are counted in parts of this */
};
#define MEMORY 1.5e9    /* bytes of training data that all fits together may take */
#define PAIR_BYTES 72.0 /* of one pair in the trainer's pool */

typedef struct wave wave;

typedef struct task {
    wave *of;
    const bake_job *job;
    atomic_int done; /* of WHOLE */
    hnbrdf_bake_row row;
    hnbrdf_model *model;
    hnbrdf_result result;
    hnbrdf_error error;
} task;

struct wave {
    bake_task *b;
    task *tasks;
    int count, width;
    double seconds;
};

static int pool_of(const bake_task *b, int full)
{
    return b->options.pool ? b->options.pool : full ? FULL_POOL : SHORT_POOL;
}

static int threads_of(const bake_task *b)
{
    return b->options.threads ? b->options.threads : hnbrdf_processors();
}

int hnbrdf_bake_width(const bake_task *b, int full)
{
    double most = MEMORY / ((double)b->count * (double)pool_of(b, full) * PAIR_BYTES);
    int threads = threads_of(b);
    return most < 1.0 ? 1 : most < threads ? (int)most : threads;
}

/* ---- One fit --------------------------------------------------------------------------------- */

static int show(void *user, const hnbrdf_fit_progress *p)
{
    task *t = user;
    wave *w = t->of;
    long done = 0;
    if (strcmp(p->stage, "network") == 0)
        atomic_store(&t->done, (int)(p->done * WHOLE));
    for (int k = 0; k < w->count; k++)
        done += atomic_load(&w->tasks[k].done);
    const hnbrdf_bake_progress progress = {.stage = t->job->full ? HNBRDF_BAKE_FULL_FITS
                                                                 : HNBRDF_BAKE_SHORT_FITS,
                                           .done = (double)done / WHOLE / w->count,
                                           .loss = p->loss,
                                           .first = w->tasks[0].job->size,
                                           .last = w->tasks[w->count - 1].job->size};
    return hnbrdf_bake_tell(w->b, &progress);
}

static hnbrdf_fit_options fit_options(const bake_task *b, task *t)
{
    const bake_job *job = t->job;
    int threads = threads_of(b), width = t->of->width;
    return (hnbrdf_fit_options){
        .kind = HNBRDF_KIND_HYBRID,
        .hidden = job->size->hidden,
        .layers = job->size->layers,
        .latent = job->size->latent,
        .latent_none = job->size->latent == 0,
        .encoding = job->size->encoding
                        ? hnbrdf_encoding_name((hnbrdf_encoding)(job->size->encoding - 1))
                        : b->options.encoding,
        .materials = b->analytic,
        .steps = job->full                  ? b->options.steps
                 : b->options.steps / 8 > 0 ? b->options.steps / 8
                                            : 1,
        .seconds = t->of->seconds,
        .pool = pool_of(b, job->full),
        .seed = job->seed,
        .lobes_none = 1, /* errors do not depend on them */
        .threads = threads > width ? threads / width : 1,
        .progress = show,
        .progress_user = t};
}

static hnbrdf_result fit(const bake_task *b, task *t)
{
    hnbrdf_fit_report report;
    const hnbrdf_fit_options options = fit_options(b, t);
    hnbrdf_result result =
        hnbrdf_fit(b->reference, b->count, &options, &t->model, &report, &t->error);
    if (result)
        return result;
    t->row = (hnbrdf_bake_row){.size = *t->job->size,
                               .full = t->job->full,
                               .seed = t->job->seed,
                               .steps = report.steps,
                               .seconds = report.seconds,
                               .half = hnbrdf_bake_needs_half(b, t->job->size),
                               .errors = calloc((size_t)b->count, sizeof *t->row.errors)};
    if (report.stopped && report.steps < LEAST_STEPS)
        return HNBRDF_ERROR_CANCELLED;
    size_t pairs = b->options.pairs;
    if (!(t->job->full && !report.stopped) && pairs > SHORT_PAIRS)
        pairs = SHORT_PAIRS;
    if (!t->row.errors)
        return hnbrdf_fail(&t->error, HNBRDF_ERROR_MEMORY, "out of memory");
    hnbrdf_model *rounded = t->row.half ? hnbrdf_bake_half(t->model) : NULL;
    if (t->row.half && !rounded)
        return hnbrdf_fail(&t->error, HNBRDF_ERROR_MEMORY, "out of memory");
    result =
        hnbrdf_bake_measure(b, rounded ? rounded : t->model, NULL, pairs, t->row.errors, &t->error);
    hnbrdf_model_free(rounded);
    if (!result)
        hnbrdf_bake_summarise(b, &t->row);
    return result;
}

/* Tasks are dealt to ranks in turn. */
static int owner_of(const wave *w, int index)
{
    return index % hnbrdf_bake_rank_count(w->b);
}

static int count_own(const wave *w)
{
    int own = 0;
    for (int k = 0; k < w->count; k++)
        own += owner_of(w, k) == hnbrdf_bake_rank(w->b);
    return own;
}

static void run_task(void *context, int index, int worker)
{
    wave *w = context;
    task *t = &w->tasks[index];
    if (owner_of(w, index) != hnbrdf_bake_rank(w->b))
        return;
    (void)worker;
    t->result = hnbrdf_bake_is_stopped(w->b) ? HNBRDF_ERROR_CANCELLED : fit(w->b, t);
    atomic_store(&t->done, WHOLE);
}

/* ---- All of them ----------------------------------------------------------------------------- */

static void drop(task *t)
{
    free(t->row.errors);
    hnbrdf_model_free(t->model);
    t->row.errors = NULL;
    t->model = NULL;
}

/* ---- Among ranks ----------------------------------------------------------------------------- */

/* What came of a task, from the rank that did it to all. */
static hnbrdf_result spread_task(wave *w, int index, hnbrdf_error *error)
{
    const bake_task *b = w->b;
    task *t = &w->tasks[index];
    const int from = owner_of(w, index), mine = from == hnbrdf_bake_rank(b);
    hnbrdf_comparison *errors = t->row.errors;
    hnbrdf_result result = hnbrdf_bake_spread(b, from, &t->result, sizeof t->result, error);
    if (!result)
        result = hnbrdf_bake_spread(b, from, &t->error, sizeof t->error, error);
    if (result || t->result)
        return result;
    if (!mine && !(errors = calloc((size_t)b->count, sizeof *errors)))
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    result = hnbrdf_ranks_agree(b->options.ranks, result, NULL, error);
    if (!result)
        result = hnbrdf_bake_spread(b, from, &t->row, sizeof t->row, error);
    t->row.errors = errors; /* not that of another process */
    if (!result)
        result = hnbrdf_bake_spread(b, from, errors, (size_t)b->count * sizeof *errors, error);
    return result ? result : hnbrdf_bake_spread_model(b, from, &t->model, error);
}

static hnbrdf_result spread_tasks(wave *w, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; k < w->count && !result && hnbrdf_bake_rank_count(w->b) > 1; k++)
        result = spread_task(w, k, error);
    return result;
}

/* A row for each candidate, the best of its seeds. */
static hnbrdf_result collect(wave *w, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; k < w->count; k++) {
        const hnbrdf_bake_report *r = &w->b->report;
        task *best = NULL;
        for (int i = 0; i < w->count; i++) {
            task *t = &w->tasks[i];
            if (t->job->size == w->tasks[k].job->size && t->model && t->result == HNBRDF_OK &&
                (!best || hnbrdf_bake_judged(r, &t->row) < hnbrdf_bake_judged(r, &best->row)))
                best = t;
        }
        if (best && !result) {
            const hnbrdf_bake_row row = best->row;
            hnbrdf_model *model = best->model;
            best->model = NULL;
            best->row.errors = NULL;
            result = hnbrdf_bake_add_row(w->b, &row, model,
                                         row.full ? HNBRDF_BAKE_FULL_FITS : HNBRDF_BAKE_SHORT_FITS,
                                         error);
        }
        for (int i = 0; i < w->count; i++) /* the other seeds have had their turn */
            if (w->tasks[i].job->size == w->tasks[k].job->size)
                drop(&w->tasks[i]);
    }
    for (int k = 0; k < w->count && !result; k++)
        if (w->tasks[k].result != HNBRDF_OK && w->tasks[k].result != HNBRDF_ERROR_CANCELLED)
            result = hnbrdf_fail(error, w->tasks[k].result, "%s", w->tasks[k].error.text);
    return result;
}

hnbrdf_result hnbrdf_bake_wave(bake_task *b, const bake_job *jobs, int count, double seconds,
                               hnbrdf_error *error)
{
    const int width = hnbrdf_bake_width(b, jobs[0].full);
    wave w = {.b = b, .count = count, .seconds = seconds};
    const int own = count_own(&w);
    w.width = width < own ? width : own > 0 ? own : 1;
    w.tasks = calloc((size_t)count, sizeof *w.tasks);
    hnbrdf_threads *threads = hnbrdf_threads_start(w.width);
    hnbrdf_result result = HNBRDF_OK;
    if (!w.tasks || !threads)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    result = hnbrdf_ranks_agree(b->options.ranks, result, NULL, error);
    if (!result)
        result = hnbrdf_bake_spread(b, 0, &w.seconds, sizeof w.seconds, error);
    if (result) {
        free(w.tasks);
        hnbrdf_threads_stop(threads);
        return result;
    }
    for (int k = 0; k < count; k++) {
        w.tasks[k].of = &w;
        w.tasks[k].job = &jobs[k];
    }
    hnbrdf_threads_run(threads, count, run_task, &w);
    hnbrdf_threads_stop(threads);
    result = spread_tasks(&w, error);
    if (!result)
        result = collect(&w, error);
    for (int k = 0; k < count; k++)
        drop(&w.tasks[k]);
    free(w.tasks);
    return result;
}
