/* fit.c: the fit from measured data to a model: draw data, fit GGX per material, train the network. */
#define _POSIX_C_SOURCE 200809L
#include "hnbrdf/fit.h"

#include "core/error.h"
#include "fit/adam.h"
#include "fit/ggx.h"
#include "fit/pool.h"
#include "fit/workers.h"

#include <math.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    CHUNKS = 16,          /* gradients are summed in this many pieces, whatever the number of threads */
    WARM_UP = 100,        /* steps */
    DEFAULT_STEPS = 32000,
    SNAPSHOT_EVERY = 100, /* steps between copies of a state to fall back to */
};
#define POOL_LIMIT 1.25e9 /* bytes of training data; beyond, fewer pairs a material */
#define LAST_RATE 0.01    /* the cosine schedule ends at this share of the peak rate */

/* A fit under way. */
typedef struct trainer {
    const hnbrdf_measured *const *data;
    hnbrdf_fit_options options;
    int count;
    fit_layout layout;
    const fit_kernel *kernel;
    fit_workers *workers;
    fit_pool pool;
    hnbrdf_material *materials;             /* [count], from the GGX stage */
    int *isotropic, *drawn;                 /* [count] */
    float *parameters, *moments, *gradient; /* [layout.count], twice for the moments */
    float *snapshot;                        /* parameters and moments that were finite */
    float *derived, *chunk_gradients, *scratch;
    double chunk_losses[CHUNKS];
    int *tile_material, *tile_index;        /* [tiles a step] */
    int *order, *cursor;                    /* shuffled materials; the next tile of each */
    int tiles_per_step, order_at;
    float mix;
    atomic_int finished;                    /* pieces of the stage that are done */
    double stage_started, shown;
    int stopped;
} trainer;

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* ---- Progress ------------------------------------------------------------------------------------ */

static void stage_begin(trainer *t)
{
    atomic_store(&t->finished, 0);
    t->stage_started = seconds_now();
    t->shown = 0.0;
}

/* From the calling thread only, at most ten times a second. */
static void report(trainer *t, const char *stage, double done, double loss, long step, double pairs)
{
    double now = seconds_now(), elapsed = now - t->stage_started;
    if (!t->options.progress || (now - t->shown < 0.1 && done < 1.0))
        return;
    t->shown = now;
    hnbrdf_fit_progress p = {stage, done, loss, elapsed > 0.0 ? pairs / elapsed : 0.0, NAN, step};
    if (done > 0.01 || elapsed > 2.0)
        p.seconds_left = elapsed * (1.0 - done) / fmax(done, 1e-6);
    if (t->options.progress(t->options.progress_user, &p))
        t->stopped = 1;
}

static void piece_done(trainer *t, const char *stage, int worker)
{
    int done = atomic_fetch_add(&t->finished, 1) + 1;
    if (worker == 0)
        report(t, stage, (double)done / t->count, NAN, 0, (double)done * t->pool.tiles * FIT_TILE);
}

/* ---- Stages 1 and 2: data, GGX -------------------------------------------------------------------- */

static void draw_one(void *context, int material, int worker)
{
    trainer *t = context;
    t->drawn[material] = fit_pool_draw(&t->pool, material, t->data[material], t->options.seed);
    piece_done(t, "sampling", worker);
}

static void fit_one(void *context, int material, int worker)
{
    trainer *t = context;
    hnbrdf_material_init(&t->materials[material]);
    if (t->options.kind != HNBRDF_KIND_NEURAL) {
        float *p = t->parameters + t->layout.analytic + (size_t)material * FIT_ANALYTIC;
        fit_ggx(t->kernel, &t->pool, material, t->isotropic[material], p);
        fit_ggx_material(p, &t->materials[material]);
    }
    if (t->options.kind != HNBRDF_KIND_GGX)
        fit_pool_encode(&t->pool, material, t->options.encoding, &t->materials[material]);
    piece_done(t, "ggx", worker);
}

/* ---- Stage 3: the network ------------------------------------------------------------------------- */

static float uniform(hnbrdf_rng *rng, double deviation)
{
    return (float)((2.0 * (double)hnbrdf_rng_float(rng) - 1.0) * deviation * 1.7320508);
}

/* He initialisation (2015); the correction starts near exp(-3), the gate near open. */
static void initialise(trainer *t)
{
    const fit_layout *l = &t->layout;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, t->options.seed, UINT64_C(1) << 40);
    float *p = t->parameters;
    size_t n = (size_t)l->padded, h = (size_t)l->hidden_size;
    double deviation = sqrt(2.0 / (FIT_INPUTS + l->latent_size));
    for (size_t i = 0; i < FIT_INPUTS; i++)
        for (size_t u = 0; u < h; u++)
            p[l->first + i * n + u] = uniform(&rng, deviation);
    for (size_t i = 0; i < (size_t)l->latent_size; i++)
        for (size_t u = 0; u < h; u++)
            p[l->latent + i * n + u] = uniform(&rng, deviation);
    for (int k = 1; k < l->layers; k++)
        for (size_t i = 0; i < h; i++)
            for (size_t u = 0; u < h; u++)
                p[l->hidden[k] + i * n + u] = uniform(&rng, sqrt(2.0 / (double)h));
    for (size_t o = 0; o < (size_t)l->outputs; o++) {
        for (size_t u = 0; u < h; u++)
            p[l->last + o * n + u] = uniform(&rng, sqrt(0.5 / (double)h));
        p[l->bias[l->layers] + o] = o < 3 ? -3.0f : 1.5f;
    }
    for (size_t i = 0; i < (size_t)(l->materials * l->latent_size); i++)
        p[l->codes + i] = uniform(&rng, 0.5);
}

/* Choose the tiles of a step: materials in shuffled rounds, each material's tiles in turn. */
static void schedule(trainer *t, hnbrdf_rng *rng)
{
    for (int k = 0; k < t->tiles_per_step; k++) {
        if (t->order_at == 0)
            for (int i = t->count - 1; i > 0; i--) {
                int j = (int)(((uint64_t)hnbrdf_rng_u32(rng) * (uint64_t)(i + 1)) >> 32);
                int swap = t->order[i];
                t->order[i] = t->order[j];
                t->order[j] = swap;
            }
        int material = t->order[t->order_at];
        t->order_at = (t->order_at + 1) % t->count;
        t->tile_material[k] = material;
        t->tile_index[k] = t->cursor[material];
        t->cursor[material] = (t->cursor[material] + 1) % t->pool.tiles;
    }
}

static void chunk(void *context, int index, int worker)
{
    trainer *t = context;
    int each = t->tiles_per_step / CHUNKS;
    float *gradient = t->chunk_gradients + (size_t)index * t->layout.count;
    memset(gradient, 0, sizeof(float) * t->layout.count);
    double loss = 0.0;
    for (int k = index * each; k < (index + 1) * each; k++) {
        fit_tile tile = fit_pool_view(&t->pool, t->tile_material[k], t->tile_index[k]);
        loss += t->kernel->network(&t->layout, t->parameters, t->derived, &tile, t->tile_material[k], t->mix,
                                   t->scratch + (size_t)worker * t->layout.scratch_count, gradient);
    }
    t->chunk_losses[index] = loss;
}

/* Loss and gradient of the mean over one step's pairs. */
static double step_gradient(trainer *t)
{
    t->kernel->derive(&t->layout, t->parameters, t->derived);
    fit_workers_run(t->workers, CHUNKS, chunk, t);
    double scale = 1.0 / (3.0 * FIT_TILE * t->tiles_per_step), loss = 0.0;
    memcpy(t->gradient, t->chunk_gradients, sizeof(float) * t->layout.count);
    for (int c = 1; c < CHUNKS; c++) {
        const float *g = t->chunk_gradients + (size_t)c * t->layout.count;
        for (size_t i = 0; i < t->layout.count; i++)
            t->gradient[i] += g[i];
    }
    for (size_t i = 0; i < t->layout.count; i++)
        t->gradient[i] *= (float)scale;
    for (int c = 0; c < CHUNKS; c++)
        loss += t->chunk_losses[c];
    return loss * scale;
}

/* The anchored parts of the analytic parameters after a step: ranges, ties, rotation. */
static void settle_analytic(trainer *t)
{
    for (int m = 0; m < t->count; m++) {
        float *p = t->parameters + t->layout.analytic + (size_t)m * FIT_ANALYTIC;
        p[FIT_ROTATION] = t->materials[m].rotation; /* the encoded directions were turned by it */
        fit_ggx_project(p, t->isotropic[m]);
    }
}

static int all_finite(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return 0;
    return 1;
}

static void train(trainer *t, hnbrdf_fit_report *result)
{
    size_t state = 3 * t->layout.count; /* parameters and moments, which lie one behind the other */
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, t->options.seed, UINT64_C(2) << 40);
    initialise(t);
    memcpy(t->snapshot, t->parameters, sizeof(float) * state);
    stage_begin(t);
    double peak = (double)t->options.learning_rate, running = NAN, pairs = 0.0;
    long step = 0;
    for (double share = 0.0; share < 1.0 && !t->stopped;) {
        t->mix = (float)fmin(1.0, fmax(0.0, (share - 0.3) / 0.4));
        schedule(t, &rng);
        double loss = step_gradient(t);
        step++;
        pairs += (double)t->tiles_per_step * FIT_TILE;
        if (!isfinite(loss) || (step % SNAPSHOT_EVERY == 0 && !all_finite(t->parameters, state))) {
            memcpy(t->parameters, t->snapshot, sizeof(float) * state); /* back to a good state, slower */
            peak *= 0.3;
        } else {
            if (step % SNAPSHOT_EVERY == 0)
                memcpy(t->snapshot, t->parameters, sizeof(float) * state);
            double cosine = 0.5 + 0.5 * cos(3.14159265358979 * share);
            double rate = peak * (LAST_RATE + (1.0 - LAST_RATE) * cosine) * fmin(1.0, (double)step / WARM_UP);
            fit_adam(t->parameters, t->gradient, t->moments, t->layout.count, step, rate);
            if (t->layout.train_analytic)
                settle_analytic(t);
            running = isfinite(running) ? 0.98 * running + 0.02 * loss : loss;
        }
        share = t->options.seconds > 0.0 ? (seconds_now() - t->stage_started) / t->options.seconds
                                         : (double)step / (double)t->options.steps;
        report(t, "network", fmin(share, 1.0), running, step, pairs);
    }
    if (!all_finite(t->parameters, t->layout.count))
        memcpy(t->parameters, t->snapshot, sizeof(float) * state);
    double elapsed = seconds_now() - t->stage_started;
    result->final_loss = running;
    result->pairs_per_s = elapsed > 0.0 ? pairs / elapsed : 0.0;
    result->steps = step;
}

/* ---- Result ---------------------------------------------------------------------------------------- */

static hnbrdf_result make_model(trainer *t, const char **names, hnbrdf_model **model, hnbrdf_error *error)
{
    const fit_layout *l = &t->layout;
    const float *p = t->parameters;
    size_t n = (size_t)l->padded, h = (size_t)l->hidden_size, in = FIT_INPUTS + (size_t)l->latent_size;
    hnbrdf_model_desc desc = {0};
    desc.kind = l->kind;
    desc.material_count = t->count;
    desc.materials = t->materials;
    for (int m = 0; m < t->count; m++)
        names[m] = hnbrdf_measured_name(t->data[m]);
    desc.names = names;
    if (l->kind == HNBRDF_KIND_GGX)
        return hnbrdf_model_create(&desc, NULL, model, error);

    float *weights = malloc(sizeof(float) * (h * in + (size_t)l->layers * h * h + 6 * h));
    if (!weights)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory for the fitted network");
    desc.encoding = t->options.encoding;
    desc.hidden = l->hidden_size;
    desc.layers = l->layers;
    desc.latent = l->latent_size;
    desc.floor = l->floor;
    float *w = weights;
    for (int k = 0; k <= l->layers; k++) {
        size_t rows = k < l->layers ? h : (size_t)l->outputs, columns = k == 0 ? in : h;
        desc.weights[k] = w;
        desc.biases[k] = p + l->bias[k];
        for (size_t o = 0; o < rows; o++)
            for (size_t i = 0; i < columns; i++)
                *w++ = k == l->layers ? p[l->last + o * n + i]
                       : k > 0        ? p[l->hidden[k] + i * n + o]
                                      : p[l->first + i * n + o]; /* latent rows follow the first six */
    }
    for (int m = 0; m < t->count; m++) {
        size_t code = l->codes + (size_t)(m * l->latent_size);
        memcpy(t->materials[m].latent, p + code, sizeof(float) * (size_t)l->latent_size);
        if (l->train_analytic)
            fit_ggx_material(p + l->analytic + (size_t)m * FIT_ANALYTIC, &t->materials[m]);
    }
    hnbrdf_result result = hnbrdf_model_create(&desc, NULL, model, error);
    free(weights);
    return result;
}

static hnbrdf_result fill_options(hnbrdf_fit_options *o, int count, hnbrdf_error *error)
{
    o->hidden = o->hidden ? o->hidden : 32;
    o->layers = o->layers ? o->layers : 2;
    o->latent = o->latent ? o->latent : (o->kind == HNBRDF_KIND_NEURAL ? 12 : 4);
    if (!o->encoding_set)
        o->encoding = HNBRDF_ENCODING_HALF_DIFFERENCE;
    o->floor = o->floor == 0.0f ? 0.003f : fmaxf(o->floor, 0.0f);
    o->steps = o->steps ? o->steps : DEFAULT_STEPS;
    o->batch = o->batch ? o->batch : 2048;
    if (o->pool == 0)
        o->pool = (int)fmin(131072.0, POOL_LIMIT / ((double)count * FIT_POOL_TILE / FIT_TILE * sizeof(float)));
    o->learning_rate = o->learning_rate == 0.0f ? 1e-2f : o->learning_rate;
    if (o->hidden < 1 || o->hidden > HNBRDF_MAX_HIDDEN || o->layers < 1 || o->layers > HNBRDF_MAX_LAYERS)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "network %dx%d, expected 1x1 to %dx%d", o->hidden,
                           o->layers, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
    if (o->latent < 1 || o->latent > HNBRDF_MAX_LATENT)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "latent code of %d floats, expected 1 to %d",
                           o->latent, HNBRDF_MAX_LATENT);
    if (o->steps < 1 || o->batch < 1 || o->batch > 1 << 24 || o->pool > 1 << 26 || o->threads < 0 ||
        !(o->seconds >= 0.0) || !(o->learning_rate > 0.0f) || !(o->floor < 1.0f) || !hnbrdf_kind_name(o->kind) ||
        !hnbrdf_encoding_name(o->encoding))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "a fit option is out of its range: steps, batch and pool at least 1, learning "
                           "rate above 0, floor below 1, seconds and threads not negative");
    if (o->kind == HNBRDF_KIND_GGX)
        o->latent = 0;
    return HNBRDF_OK;
}

/* Every array of the trainer; NULL where one failed shows in the return value. */
static int allocate(trainer *t)
{
    const fit_layout *l = &t->layout;
    size_t materials = (size_t)t->count, tiles = (size_t)t->tiles_per_step;
    t->pool.data = malloc(sizeof(float) * materials * (size_t)t->pool.tiles * FIT_POOL_TILE);
    t->materials = calloc(materials, sizeof *t->materials);
    t->isotropic = calloc(materials, sizeof(int));
    t->drawn = calloc(materials, sizeof(int));
    t->order = calloc(materials, sizeof(int));
    t->cursor = calloc(materials, sizeof(int));
    t->parameters = calloc(3 * l->count, sizeof(float));
    t->snapshot = calloc(3 * l->count, sizeof(float));
    t->gradient = calloc(l->count, sizeof(float));
    t->chunk_gradients = calloc(CHUNKS * l->count, sizeof(float));
    t->derived = calloc(l->derived_count + 1, sizeof(float));
    t->scratch = calloc((size_t)fit_workers_count(t->workers) * l->scratch_count + 1, sizeof(float));
    t->tile_material = calloc(tiles, sizeof(int));
    t->tile_index = calloc(tiles, sizeof(int));
    t->moments = t->parameters ? t->parameters + l->count : NULL;
    return t->pool.data && t->materials && t->isotropic && t->drawn && t->order && t->cursor &&
           t->parameters && t->snapshot && t->gradient && t->chunk_gradients && t->derived && t->scratch &&
           t->tile_material && t->tile_index;
}

static void release(trainer *t)
{
    fit_workers_stop(t->workers);
    void *all[] = {t->pool.data, t->materials, t->isotropic, t->drawn, t->order, t->cursor, t->parameters,
                   t->snapshot, t->gradient, t->chunk_gradients, t->derived, t->scratch, t->tile_material,
                   t->tile_index};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        free(all[i]);
}

static hnbrdf_result run(trainer *t, const char **names, hnbrdf_model **model, hnbrdf_fit_report *result,
                         hnbrdf_error *error)
{
    for (int m = 0; m < t->count; m++) {
        t->isotropic[m] = hnbrdf_measured_is_isotropic(t->data[m]);
        t->order[m] = m;
    }
    stage_begin(t);
    fit_workers_run(t->workers, t->count, draw_one, t);
    for (int m = 0; m < t->count; m++)
        if (!t->drawn[m])
            return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                               "%s: fewer than 1 %% of the directions drawn are valid measurements",
                               hnbrdf_measured_name(t->data[m]));
    stage_begin(t);
    fit_workers_run(t->workers, t->count, fit_one, t);
    if (t->options.kind != HNBRDF_KIND_GGX)
        train(t, result);
    result->stopped = t->stopped;
    return make_model(t, names, model, error);
}

hnbrdf_result hnbrdf_fit(const hnbrdf_measured *const *data, int count, const hnbrdf_fit_options *options,
                         hnbrdf_model **model, hnbrdf_fit_report *report_out, hnbrdf_error *error)
{
    trainer t = {0};
    double started = seconds_now();
    hnbrdf_fit_report result_report = {NAN, 0.0, 0.0, 0, 0};
    if (count < 1 || count > HNBRDF_MAX_MATERIALS)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%d materials to fit, expected 1 to %d", count,
                           HNBRDF_MAX_MATERIALS);
    t.data = data;
    t.count = count;
    if (options)
        t.options = *options;
    hnbrdf_result result = fill_options(&t.options, count, error);
    if (result)
        return result;
    int unit = FIT_TILE * CHUNKS;
    t.tiles_per_step = (t.options.batch + unit - 1) / unit * CHUNKS;
    t.pool.tiles = (t.options.pool + FIT_TILE - 1) / FIT_TILE;
    t.pool.tiles = t.pool.tiles > 0 ? t.pool.tiles : 1;
    t.kernel = fit_kernel_choose();
    fit_layout_make(&t.layout, t.options.kind, t.options.hidden, t.options.layers, t.options.latent, count,
                    t.options.analytic == HNBRDF_FIT_JOINT, t.options.floor);
    const char **names = malloc(sizeof *names * (size_t)count);
    t.workers = fit_workers_start(t.options.threads);
    if (!names || !t.workers || !allocate(&t))
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory: %d materials of %d pairs need about %.0f MB",
                             count, t.options.pool,
                             (double)count * t.pool.tiles * FIT_POOL_TILE * sizeof(float) * 1e-6);
    else
        result = run(&t, names, model, &result_report, error);
    free(names);
    release(&t);
    result_report.seconds = seconds_now() - started;
    if (!result && report_out)
        *report_out = result_report;
    return result;
}
