/* fit.c: the fit from measured data to a model: draw data, fit GGX per material, train the
 * network. */
#include "fit/trainer.h"

#include "base/clock.h"
#include "base/error.h"
#include "core/encoding.h"
#include "fit/axis.h"
#include "fit/ggx.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* share of the directions drawn: hnbrdf_fit_pool_draw() gives up below it */
#define LEAST_VALID 0.01

static void piece_done(trainer *t, const char *stage, int worker)
{
    int done = atomic_fetch_add(&t->finished, 1) + 1;
    if (worker == 0)
        hnbrdf_fit_tell(t, stage, (double)done / t->held_count, NAN,
                        (double)done * t->pool.tiles * FIT_TILE, 0);
}

/* ---- Stages 1 and 2: data, GGX --------------------------------------------------------------- */

static void draw_one(void *context, int k, int worker)
{
    trainer *t = context;
    hnbrdf_fit_pool_draw(&t->pool, k, &t->drawn[t->held[k]]);
    piece_done(t, "sampling", worker);
}

/* The analytic part as it is given, and as the parameters it would be trained by. */
static void take_analytic(const hnbrdf_material *given, float *parameters, hnbrdf_material *taken)
{
    hnbrdf_fit_ggx_parameters(given, parameters);
    *taken = *given;
    memset(taken->latent, 0, sizeof taken->latent);
}

static void fit_ggx(trainer *t, int k, int worker, hnbrdf_material *fitted)
{
    fit_found *found = &t->found[t->held[k]];
    float *room = t->room ? t->room + (size_t)worker * FIT_GGX_TILES * FIT_POOL_TILE : NULL;
    const fit_pool head = hnbrdf_fit_pool_head(&t->pool, k, FIT_GGX_TILES, room);
    const int isotropic = t->known[t->held[k]].isotropic;
    const double axis = isotropic ? 0.0 : hnbrdf_fit_axis(t->data[t->held[k]]);
    hnbrdf_fit_ggx(t->kernel, &head, 0, isotropic, axis, found->parameters, &found->search);
    hnbrdf_fit_ggx_material(found->parameters, fitted);
}

static void fit_one(void *context, int k, int worker)
{
    trainer *t = context;
    const int m = t->held[k], neural = t->options.kind == HNBRDF_KIND_NEURAL;
    fit_found *found = &t->found[m];
    hnbrdf_material_init(&found->material);
    if (!neural || !t->known[m].isotropic) {
        hnbrdf_material fitted = found->material;
        if (t->options.materials)
            take_analytic(&t->options.materials[m], found->parameters, &fitted);
        else
            fit_ggx(t, k, worker, &fitted);
        if (neural) /* of GGX it takes the tangent frame alone */
            found->material.rotation = fitted.rotation;
        else
            found->material = fitted;
    }
    if (t->options.kind != HNBRDF_KIND_GGX) {
        double started = hnbrdf_thread_seconds();
        hnbrdf_fit_pool_encode(&t->pool, k, &found->material);
        t->encoded[k] = hnbrdf_thread_seconds() - started;
    }
    piece_done(t, "ggx", worker);
}

/* What the GGX stage found, of all ranks, to where it is wanted. */
static hnbrdf_result spread_found(trainer *t, hnbrdf_error *error)
{
    hnbrdf_result result = hnbrdf_fit_share_records(t, t->found, sizeof *t->found, error);
    for (int m = 0; m < t->count && !result; m++) {
        memcpy(t->parameters + t->layout.analytic + (size_t)m * FIT_ANALYTIC,
               t->found[m].parameters, sizeof t->found[m].parameters);
        if (t->options.search)
            t->options.search[m] = t->found[m].search;
    }
    return result;
}

/* ---- Memory ---------------------------------------------------------------------------------- */

/* The materials that this rank has, and the pairs of those that are kept; for the others there is
 * a place for each thread. */
static int allocate_pool(trainer *t)
{
    const size_t threads = (size_t)hnbrdf_threads_count(t->workers);
    fit_pool *pool = &t->pool;
    const size_t held = (size_t)t->held_count + 1;
    pool->kept = hnbrdf_fit_pool_keeps(t->held_count, pool->tiles,
                                       t->options.memory ? (double)t->options.memory : INFINITY);
    if (pool->kept < t->held_count)
        t->room = malloc(sizeof(float) * threads * FIT_GGX_TILES * FIT_POOL_TILE);
    pool->sources = calloc(held, sizeof *pool->sources);
    pool->data =
        malloc(sizeof(float) * (size_t)pool->kept * (size_t)pool->tiles * FIT_POOL_TILE + 1);
    t->encoded = calloc(held, sizeof(double));
    for (int k = 0; k < t->held_count && pool->sources; k++)
        pool->sources[k] =
            (fit_source){.measured = t->data[t->held[k]], .sequence = (uint64_t)t->held[k]};
    return pool->data && pool->sources && t->encoded && (t->room || pool->kept == t->held_count);
}

/* Every array of the trainer; NULL where one failed shows in the return value. */
static int allocate(trainer *t)
{
    const fit_layout *l = &t->layout;
    const size_t materials = (size_t)t->count;
    const size_t threads = (size_t)hnbrdf_threads_count(t->workers);
    t->found = calloc(materials, sizeof *t->found);
    t->drawn = calloc(materials, sizeof *t->drawn);
    t->parameters = calloc(3 * l->count, sizeof(float));
    t->best = calloc(l->count, sizeof(float));
    t->gradient = calloc(l->count, sizeof(float));
    t->derived = calloc(l->derived_count + 1, sizeof(float));
    t->scratch = calloc(threads * l->scratch_count + 1, sizeof(float));
    t->moments = t->parameters ? t->parameters + l->count : NULL;
    return allocate_pool(t) &&
           (t->options.freeze ||
            (hnbrdf_fit_sums_make(t) && hnbrdf_fit_soap_make(&t->soap, l, t->kernel))) &&
           hnbrdf_fit_schedule_start(&t->schedule, t->count, t->pool.tiles, t->options.seed) &&
           t->found && t->drawn && t->parameters && t->best && t->gradient && t->derived &&
           t->scratch;
}

static void release(trainer *t)
{
    hnbrdf_threads_stop(t->workers);
    hnbrdf_fit_supply_free(t);
    hnbrdf_fit_sums_free(t);
    hnbrdf_fit_soap_free(&t->soap);
    hnbrdf_fit_frozen_free(t);
    hnbrdf_fit_schedule_free(&t->schedule);
    void *all[] = {t->pool.data, t->pool.sources, t->room,     t->owner,   t->held,
                   t->at,        t->known,        t->found,    t->drawn,   t->encoded,
                   t->best,      t->parameters,   t->gradient, t->derived, t->scratch};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        free(all[i]);
}

/* ---- Refusals -------------------------------------------------------------------------------- */

/* Is there a material with too few measurements to draw from? Which, and how many others? */
static hnbrdf_result check_drawn(const trainer *t, hnbrdf_error *error)
{
    int first = -1, others = -1;
    char more[64] = "";
    for (int m = 0; m < t->count; m++)
        if (t->drawn[m].valid < LEAST_VALID) {
            first = first < 0 ? m : first;
            others++;
        }
    if (first < 0)
        return HNBRDF_OK;
    if (others > 0)
        snprintf(more, sizeof more, "; so it is with %d other material%s", others,
                 others == 1 ? "" : "s");
    return hnbrdf_fail(
        error, HNBRDF_ERROR_FORMAT,
        "%s: %s %% of the directions drawn are valid measurements, expected at least %s %%%s",
        t->known[first].name,
        hnbrdf_print_number((char[HNBRDF_NUMBER_TEXT]){""}, 100.0 * t->drawn[first].valid, 3),
        HNBRDF_NUMBER(100.0 * LEAST_VALID), more);
}

/* A model's names differ; better refused now than after training. */
static hnbrdf_result check_names(const trainer *t, hnbrdf_error *error)
{
    const size_t count = (size_t)t->count;
    hnbrdf_model *model = NULL;
    hnbrdf_material *materials = calloc(count, sizeof *materials);
    const char **names = calloc(count, sizeof *names);
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_GGX, .material_count = t->count};
    desc.materials = materials;
    desc.names = names;
    hnbrdf_result result = HNBRDF_ERROR_MEMORY;
    for (int m = 0; materials && names && m < t->count; m++) {
        hnbrdf_material_init(&materials[m]);
        names[m] = t->known[m].name;
    }
    if (materials && names)
        result = hnbrdf_model_create(&desc, NULL, &model, error);
    else
        hnbrdf_fail(error, result, "out of memory for %d names", t->count);
    hnbrdf_model_free(model);
    free(materials);
    free(names);
    return result;
}

/* ---- The whole ------------------------------------------------------------------------------- */

static hnbrdf_result draw(trainer *t, hnbrdf_fit_report *result, hnbrdf_error *error)
{
    hnbrdf_fit_stage_begin(t);
    hnbrdf_threads_run(t->workers, t->held_count, draw_one, t);
    result->times.drawing = hnbrdf_threads_busy(t->workers);
    hnbrdf_result status = hnbrdf_fit_share_records(t, t->drawn, sizeof *t->drawn, error);
    if (!status)
        status = check_drawn(t, error);
    if (!status && t->options.drawn)
        memcpy(t->options.drawn, t->drawn, (size_t)t->count * sizeof *t->drawn);
    return status;
}

static hnbrdf_result find_ggx(trainer *t, hnbrdf_fit_report *result, hnbrdf_error *error)
{
    const double before = hnbrdf_threads_busy(t->workers);
    hnbrdf_fit_stage_begin(t);
    hnbrdf_threads_run(t->workers, t->held_count, fit_one, t);
    for (int k = 0; k < t->held_count; k++)
        result->times.encoding += t->encoded[k];
    result->times.ggx = hnbrdf_threads_busy(t->workers) - before - result->times.encoding;
    return spread_found(t, error);
}

static hnbrdf_result run(trainer *t, hnbrdf_model **model, hnbrdf_fit_report *result,
                         hnbrdf_error *error)
{
    hnbrdf_result status = draw(t, result, error);
    if (!status)
        status = find_ggx(t, result, error);
    if (!status)
        status = hnbrdf_fit_agree(t, status, error);
    if (status)
        return status;
    if (t->stopped && t->options.kind != HNBRDF_KIND_GGX && !t->options.resume)
        return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED,
                           "stopped before the network's first step");
    if (t->options.kind != HNBRDF_KIND_GGX)
        status = t->options.freeze ? hnbrdf_fit_frozen(t, result, error)
                                   : hnbrdf_fit_train(t, result, error);
    result->stopped = t->stopped;
    return status ? status : hnbrdf_fit_result(t, model, result, error);
}

static hnbrdf_result check_arguments(const trainer *t, hnbrdf_error *error)
{
    const hnbrdf_communicator *ranks = &t->ranks;
    if (t->count < 1 || t->count > HNBRDF_MAX_MATERIALS)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%d materials to fit, expected 1 to %d",
                           t->count, HNBRDF_MAX_MATERIALS);
    if (ranks->size < 1 || ranks->rank < 0 || ranks->rank >= ranks->size)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "rank %d of %d, expected 0 to size - 1",
                           ranks->rank, ranks->size);
    if (ranks->size > 1 && (!ranks->gather || !ranks->exchange || !ranks->broadcast))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "a callback of the communicator is NULL, expected all three");
    return HNBRDF_OK;
}

/* What the options and the data say, before there is room for anything. */
static hnbrdf_result prepare(trainer *t, hnbrdf_error *error)
{
    hnbrdf_fit_options *o = &t->options;
    hnbrdf_result result = check_arguments(t, error);
    if (!result)
        result = hnbrdf_fit_fill_options(o, t->count, error);
    for (int m = 0; o->materials && m < t->count && !result; m++)
        result = hnbrdf_material_check(&o->materials[m], error);
    if (t->ranks.size > 1 && t->ranks.gather && t->ranks.broadcast)
        result = hnbrdf_fit_agree(t, result, error);
    if (!result)
        result = hnbrdf_fit_hold(t, error);
    return result ? result : check_names(t, error);
}

/* Threads, encoding, sizes and memory. */
static hnbrdf_result set_up(trainer *t, hnbrdf_error *error)
{
    const hnbrdf_fit_options *o = &t->options;
    const int unit = FIT_TILE * FIT_CHUNKS;
    hnbrdf_result result = HNBRDF_OK;
    t->workers = hnbrdf_threads_start(o->threads);
    if (!t->workers)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for threads");
    result = hnbrdf_fit_agree(t, result, error);
    if (!result && (!o->encoding || !hnbrdf_encoding_from_name(o->encoding, &t->encoding)))
        result = hnbrdf_fit_choose_encoding(t, error);
    if (result)
        return result;
    t->shares = hnbrdf_fit_share_make((o->batch + unit - 1) / unit * FIT_CHUNKS, t->ranks.rank,
                                      t->ranks.size, hnbrdf_threads_count(t->workers));
    t->pool.tiles = (o->pool + FIT_TILE - 1) / FIT_TILE;
    t->pool.tiles = t->pool.tiles > 0 ? t->pool.tiles : 1;
    t->pool.horizon_share = o->horizon_share;
    t->pool.bright_share = o->bright_share;
    t->pool.uniform_share = o->uniform_share;
    t->pool.seed = o->seed;
    t->pool.encoding = t->encoding;
    t->kernel = hnbrdf_fit_kernel_choose();
    hnbrdf_fit_layout_make(&t->layout, o->kind, o->hidden, o->layers, o->latent, t->count,
                           o->analytic == HNBRDF_FIT_JOINT, o->floor);
    t->layout.lift = o->lift;
    if (!allocate(t))
        result = hnbrdf_fail(
            error, HNBRDF_ERROR_MEMORY,
            "out of memory: %d materials of %d pairs need about %.0f MB", t->pool.kept, o->pool,
            (double)t->pool.kept * t->pool.tiles * FIT_POOL_TILE * sizeof(float) * 1e-6);
    return hnbrdf_fit_agree(t, result, error);
}

/* What a fit took, all of it. */
static void time_all(const trainer *t, double seconds, hnbrdf_fit_report *report)
{
    hnbrdf_fit_times *times = &report->times;
    report->seconds = seconds;
    report->instructions = t->kernel ? t->kernel->name : NULL;
    report->threads = hnbrdf_threads_count(t->workers);
    report->ranks = t->ranks.size;
    report->kept = (double)t->pool.kept * t->pool.tiles * FIT_POOL_TILE * sizeof(float);
    report->redrawn = t->held_count - t->pool.kept;
    times->exchange = t->exchange;
    times->waiting =
        fmax(0.0, report->threads * seconds - times->drawing - times->ggx - times->encoding -
                      times->network - times->update - times->exchange);
}

hnbrdf_result hnbrdf_fit(const hnbrdf_measured *const *data, int count,
                         const hnbrdf_fit_options *options, hnbrdf_model **model,
                         hnbrdf_fit_report *report_out, hnbrdf_error *error)
{
    trainer t = {.data = data, .count = count, .ranks = {.size = 1}};
    double started = hnbrdf_seconds();
    hnbrdf_fit_report report = {.final_loss = NAN, .best_loss = NAN, .ggx_loss = NAN};
    if (options)
        t.options = *options;
    if (t.options.ranks)
        t.ranks = *t.options.ranks;
    hnbrdf_result result = prepare(&t, error);
    if (!result)
        result = set_up(&t, error);
    if (!result)
        result = run(&t, model, &report, error);
    if (!result) {
        time_all(&t, hnbrdf_seconds() - started, &report);
        if (report_out)
            *report_out = report;
    }
    release(&t);
    return result;
}
