/* fit.c: the fit from measured data to a model: draw data, fit GGX per material, train the
 * network. */
#include "fit/trainer.h"
#include "core/encoding.h"

#include "base/clock.h"
#include "base/error.h"
#include "fit/ggx.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    DEFAULT_STEPS = 32000,
    DEFAULT_FROZEN_STEPS = 3000,
    DEFAULT_BATCH = 2048,
    DEFAULT_POOL = 131072
};
enum { ASYMMETRY_PAIRS = 4096 };
#define RECIPROCAL 0.02 /* data whose asymmetry is less count as reciprocal */
/* The peak rate of networks with up to RATE_UNITS hidden units in all; larger ones need less in
 * proportion, or units die early and for good (64x3 on 100 materials, 8000 steps: SMAPE 0.098 at
 * 0.06, 0.075 at 0.02, 0.081 at 0.01). */
#define DEFAULT_RATE 6e-2f
#define RATE_UNITS 64
#define DEFAULT_FLOOR 0.003f
#define DEFAULT_UNIFORM_SHARE 0.5f
/* share of the directions drawn: hnbrdf_fit_pool_draw() gives up below it */
#define LEAST_VALID 0.01
#define POOL_LIMIT 1.25e9 /* bytes of training data; beyond, fewer pairs a material */

static void piece_done(trainer *t, const char *stage, int worker)
{
    int done = atomic_fetch_add(&t->finished, 1) + 1;
    if (worker == 0)
        hnbrdf_fit_tell(t, stage, (double)done / t->count, NAN,
                        (double)done * t->pool.tiles * FIT_TILE, 0);
}

/* ---- Stages 1 and 2: data, GGX --------------------------------------------------------------- */

static void draw_one(void *context, int material, int worker)
{
    trainer *t = context;
    if (!hnbrdf_fit_pool_draw(&t->pool, material, t->data[material], t->options.uniform_share,
                              t->options.seed, &t->drawn[material]))
        atomic_store(&t->undrawn, 1);
    piece_done(t, "sampling", worker);
}

/* The analytic part as it is given, and as the parameters it would be trained by. */
static void take_analytic(const hnbrdf_material *given, float *parameters, hnbrdf_material *taken)
{
    hnbrdf_fit_ggx_parameters(given, parameters);
    *taken = *given;
    memset(taken->latent, 0, sizeof taken->latent);
}

static void fit_one(void *context, int material, int worker)
{
    trainer *t = context;
    hnbrdf_material_init(&t->materials[material]);
    if (t->options.search)
        memset(t->options.search + material, 0, sizeof *t->options.search);
    int neural = t->options.kind == HNBRDF_KIND_NEURAL;
    if (!neural || !t->isotropic[material]) {
        float *p = t->parameters + t->layout.analytic + (size_t)material * FIT_ANALYTIC;
        hnbrdf_material fitted = t->materials[material];
        hnbrdf_fit_search *search = t->options.search ? t->options.search + material : NULL;
        if (t->options.materials) {
            take_analytic(&t->options.materials[material], p, &fitted);
        } else {
            hnbrdf_fit_ggx(t->kernel, &t->pool, material, t->isotropic[material], p, search);
            hnbrdf_fit_ggx_material(p, &fitted);
        }
        if (neural) /* of GGX it takes the tangent frame alone */
            t->materials[material].rotation = fitted.rotation;
        else
            t->materials[material] = fitted;
    }
    if (t->options.kind != HNBRDF_KIND_GGX) {
        double started = hnbrdf_thread_seconds();
        hnbrdf_fit_pool_encode(&t->pool, material, t->encoding, &t->materials[material]);
        t->encoded[material] = hnbrdf_thread_seconds() - started;
    }
    piece_done(t, "ggx", worker);
}

/* ---- Result ---------------------------------------------------------------------------------- */

/* The trained weights as desc wants them, row-major without padding, in `weights`. */
static void describe_network(const trainer *t, float *weights, hnbrdf_model_desc *desc)
{
    const fit_layout *l = &t->layout;
    const float *p = t->parameters;
    desc->encoding = t->encoding;
    desc->hidden = l->hidden_size;
    desc->layers = l->layers;
    desc->latent = l->latent_size;
    desc->floor = l->floor;
    for (int k = 0; k <= l->layers; k++) {
        int rows, columns;
        hnbrdf_fit_layer_size(l, k, &rows, &columns);
        desc->weights[k] = weights;
        desc->biases[k] = p + l->bias[k];
        for (int o = 0; o < rows; o++)
            for (int i = 0; i < columns; i++)
                *weights++ = p[hnbrdf_fit_weight_at(l, k, o, i)];
    }
}

/* Latent codes, and the analytic part where it was trained along. */
static void settle_materials(trainer *t)
{
    const fit_layout *l = &t->layout;
    for (int m = 0; m < t->count; m++) {
        memcpy(t->materials[m].latent, t->parameters + l->codes + (size_t)(m * l->latent_size),
               sizeof(float) * (size_t)l->latent_size);
        if (l->train_analytic)
            hnbrdf_fit_ggx_material(t->parameters + l->analytic + (size_t)m * FIT_ANALYTIC,
                                    &t->materials[m]);
    }
}

/* The same model with lobes for its first t->count materials, which stand in desc. */
static hnbrdf_result fit_lobes(trainer *t, hnbrdf_model_desc *desc, hnbrdf_material *materials,
                               hnbrdf_model **model, hnbrdf_error *error)
{
    hnbrdf_model *bare;
    hnbrdf_result result = hnbrdf_model_create(desc, NULL, &bare, error);
    if (result)
        return result;
    t->stage_started = hnbrdf_seconds();
    for (int m = 0; m < t->count && !result; m++) {
        result = hnbrdf_lobes_fit(bare, &materials[m], &materials[m].lobes, error);
        hnbrdf_fit_tell(t, "lobes", (double)(m + 1) / t->count, NAN, 0.0, 0);
    }
    hnbrdf_model_free(bare);
    return result ? result : hnbrdf_model_create(desc, NULL, model, error);
}

static hnbrdf_result make_model(trainer *t, hnbrdf_model **model, hnbrdf_error *error)
{
    const fit_layout *l = &t->layout;
    size_t h = (size_t)l->hidden_size, in = FIT_INPUTS + (size_t)l->latent_size;
    size_t numbers = h * in + (size_t)l->layers * h * h + 6 * h;
    int before = t->options.freeze ? hnbrdf_model_material_count(t->options.freeze) : 0;
    size_t count = (size_t)before + (size_t)t->count;
    hnbrdf_model_desc desc = {0};
    float *weights = malloc(sizeof(float) * (numbers + 1));
    hnbrdf_material *materials = calloc(count, sizeof *materials);
    const char **names = calloc(count, sizeof *names);
    hnbrdf_result result = HNBRDF_ERROR_MEMORY;
    if (!weights || !materials || !names) {
        hnbrdf_fail(error, result, "out of memory for the fitted model");
    } else {
        if (t->options.freeze)
            hnbrdf_model_describe(t->options.freeze, &desc);
        else if (l->kind != HNBRDF_KIND_GGX)
            describe_network(t, weights, &desc);
        settle_materials(t);
        int kept = 0; /* a new material takes the place of a known one of its name */
        for (int m = 0; m < t->count; m++) {
            names[m] = hnbrdf_measured_name(t->data[m]);
            materials[m] = t->materials[m];
        }
        for (int m = 0; m < before; m++) {
            int replaced = 0;
            for (int k = 0; k < t->count && !replaced; k++)
                replaced = strcmp(names[k], desc.names[m]) == 0;
            if (replaced)
                continue;
            names[t->count + kept] = desc.names[m];
            materials[t->count + kept++] = desc.materials[m];
        }
        desc.kind = l->kind;
        desc.material_count = t->count + kept;
        desc.materials = materials;
        desc.names = names;
        result = fit_lobes(t, &desc, materials, model, error);
    }
    free(weights);
    free(materials);
    free(names);
    return result;
}

/* Kind, sizes, encoding and floor are those of the network that stays. */
static hnbrdf_result take_frozen(hnbrdf_fit_options *o, hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(o->freeze, &desc);
    if (desc.kind == HNBRDF_KIND_GGX)
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "the model to freeze is a ggx model: it has no network; fit with kind ggx instead");
    if (desc.scale != 1.0f || desc.shift != 0.0f)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "the model to freeze has scale %s and shift %s, expected 1 and 0",
                           HNBRDF_NUMBER(desc.scale), HNBRDF_NUMBER(desc.shift));
    o->kind = desc.kind;
    o->hidden = desc.hidden;
    o->layers = desc.layers;
    o->latent = desc.latent;
    o->latent_none = desc.latent == 0;
    o->encoding = hnbrdf_encoding_name(desc.encoding);
    o->floor = desc.floor;
    o->floor_none = desc.floor == 0.0f;
    return HNBRDF_OK;
}

/* Mean SMAPE between f(wi, wo) and f(wo, wi) of one material over uniform pairs. */
static double asymmetry(const hnbrdf_measured *measured)
{
    hnbrdf_rng rng;
    double sum = 0.0;
    int used = 0;
    hnbrdf_rng_seed(&rng, 0, UINT64_C(3) << 40);
    for (int k = 0; k < ASYMMETRY_PAIRS; k++) {
        float wi[3], wo[3], f[3], g[3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        if (!hnbrdf_measured_eval(measured, wi, wo, f) ||
            !hnbrdf_measured_eval(measured, wo, wi, g))
            continue;
        for (int c = 0; c < 3; c++)
            if (f[c] != g[c])
                sum += 2.0 * fabs((double)f[c] - (double)g[c]) /
                       (fabs((double)f[c]) + fabs((double)g[c]));
        used += 3;
    }
    return used ? sum / used : 0.0;
}

/* The most accurate for these data (examples/encodings.md): a reciprocal one where the data are. */
static hnbrdf_encoding default_encoding(const hnbrdf_measured *const *data, int count)
{
    double sum = 0.0;
    for (int m = 0; m < count; m++) {
        if (!hnbrdf_measured_is_isotropic(data[m]))
            return HNBRDF_ENCODING_ANGLES_ANISOTROPIC;
        sum += asymmetry(data[m]);
    }
    return sum <= RECIPROCAL * count ? HNBRDF_ENCODING_ANGLES : HNBRDF_ENCODING_ANGLES_DIRECTED;
}

static float default_rate(float units)
{
    return DEFAULT_RATE * fminf(1.0f, (float)RATE_UNITS / units);
}

/* A number and the flag that asks for none exclude each other. */
static hnbrdf_result check_flags(const hnbrdf_fit_options *o, hnbrdf_error *error)
{
    const struct {
        const char *number, *flag;
        double value;
        int none;
    } pairs[] = {{"latent", "latent_none", o->latent, o->latent_none},
                 {"floor", "floor_none", (double)o->floor, o->floor_none},
                 {"uniform_share", "uniform_none", (double)o->uniform_share, o->uniform_none}};
    hnbrdf_encoding encoding;
    for (size_t k = 0; k < sizeof pairs / sizeof pairs[0]; k++)
        if (pairs[k].value != 0.0 && pairs[k].none)
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "fit options: %s is %s and %s is set, expected one of them",
                               pairs[k].number, HNBRDF_NUMBER(pairs[k].value), pairs[k].flag);
    if (o->encoding && !hnbrdf_encoding_from_name(o->encoding, &encoding))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "fit options: encoding is \"%.40s\", expected one of %s", o->encoding,
                           HNBRDF_ENCODING_LIST);
    return HNBRDF_OK;
}

static hnbrdf_result fill_options(hnbrdf_fit_options *o, int count, hnbrdf_error *error)
{
    if (o->freeze) {
        hnbrdf_result result = take_frozen(o, error);
        if (result)
            return result;
    }
    hnbrdf_result flags = check_flags(o, error);
    if (flags)
        return flags;
    o->hidden = o->hidden ? o->hidden : 32;
    o->layers = o->layers ? o->layers : 2;
    if (o->latent == 0 && !o->latent_none)
        o->latent = o->kind == HNBRDF_KIND_NEURAL ? 12 : 4;
    if (o->floor == 0.0f && !o->floor_none)
        o->floor = DEFAULT_FLOOR;
    o->steps = o->steps ? o->steps : (o->freeze ? DEFAULT_FROZEN_STEPS : DEFAULT_STEPS);
    o->batch = o->batch ? o->batch : DEFAULT_BATCH;
    if (o->pool == 0)
        o->pool = (int)fmin(
            DEFAULT_POOL, POOL_LIMIT / ((double)count * FIT_POOL_TILE / FIT_TILE * sizeof(float)));
    o->learning_rate = o->learning_rate == 0.0f ? default_rate((float)o->hidden * (float)o->layers)
                                                : o->learning_rate;
    if (o->uniform_share == 0.0f && !o->uniform_none)
        o->uniform_share = DEFAULT_UNIFORM_SHARE;
    if (o->hidden < 1 || o->hidden > HNBRDF_MAX_HIDDEN || o->layers < 1 ||
        o->layers > HNBRDF_MAX_LAYERS)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "network %dx%d, expected 1x1 to %dx%d",
                           o->hidden, o->layers, HNBRDF_MAX_HIDDEN, HNBRDF_MAX_LAYERS);
    if (o->latent < 0 || o->latent > HNBRDF_MAX_LATENT)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "latent code of %d floats, expected 0 to %d", o->latent,
                           HNBRDF_MAX_LATENT);
    if (o->steps < 1 || o->batch < 1 || o->batch > 1 << 24 || o->pool > 1 << 26 || o->threads < 0 ||
        !(o->seconds >= 0.0) || !(o->learning_rate > 0.0f && o->learning_rate <= FLT_MAX) ||
        !(o->floor >= 0.0f && o->floor < 1.0f) ||
        !(o->uniform_share >= 0.0f && o->uniform_share <= 1.0f) ||
        (unsigned)o->loss > HNBRDF_FIT_SMAPE || (unsigned)o->schedule > HNBRDF_FIT_CONSTANT ||
        !hnbrdf_kind_name(o->kind))
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "a fit option is out of its range: steps, batch and pool at least 1, learning "
            "rate above 0 and finite, floor and uniform share from 0 to 1, seconds and threads not "
            "negative");
    if (o->resume && !o->checkpoint)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "nothing to resume from: no checkpoint is named");
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
    t->drawn = calloc(materials, sizeof *t->drawn);
    t->encoded = calloc(materials, sizeof(double));
    t->order = calloc(materials, sizeof(int));
    t->cursor = calloc(materials, sizeof(int));
    t->parameters = calloc(3 * l->count, sizeof(float));
    t->best = calloc(l->count, sizeof(float));
    t->gradient = calloc(l->count, sizeof(float));
    t->chunk_gradients = calloc(FIT_CHUNKS * l->count, sizeof(float));
    t->derived = calloc(l->derived_count + 1, sizeof(float));
    t->scratch =
        calloc((size_t)hnbrdf_threads_count(t->workers) * l->scratch_count + 1, sizeof(float));
    t->tile_material = calloc(tiles, sizeof(int));
    t->tile_index = calloc(tiles, sizeof(int));
    t->moments = t->parameters ? t->parameters + l->count : NULL;
    return t->pool.data && t->materials && t->isotropic && t->drawn && t->encoded && t->order &&
           t->cursor && t->parameters && t->best && t->gradient && t->chunk_gradients &&
           t->derived && t->scratch && t->tile_material && t->tile_index;
}

static void release(trainer *t)
{
    hnbrdf_threads_stop(t->workers);
    void *all[] = {t->pool.data, t->materials,     t->isotropic,       t->drawn,
                   t->order,     t->encoded,       t->cursor,          t->parameters,
                   t->best,      t->gradient,      t->chunk_gradients, t->derived,
                   t->scratch,   t->tile_material, t->tile_index};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        free(all[i]);
}

/* Which material has too few measurements to draw from, and how many others. */
static hnbrdf_result refuse_data(const trainer *t, hnbrdf_error *error)
{
    int first = -1, others = -1;
    char more[64] = "";
    for (int m = 0; m < t->count; m++)
        if (t->drawn[m].valid < LEAST_VALID) {
            first = first < 0 ? m : first;
            others++;
        }
    if (others > 0)
        snprintf(more, sizeof more, "; so it is with %d other material%s", others,
                 others == 1 ? "" : "s");
    return hnbrdf_fail(
        error, HNBRDF_ERROR_FORMAT,
        "%s: %s %% of the directions drawn are valid measurements, expected at least %s %%%s",
        hnbrdf_measured_name(t->data[first]),
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
        names[m] = hnbrdf_measured_name(t->data[m]);
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

static hnbrdf_result run(trainer *t, hnbrdf_model **model, hnbrdf_fit_report *result,
                         hnbrdf_error *error)
{
    for (int m = 0; m < t->count; m++) {
        t->isotropic[m] = hnbrdf_measured_is_isotropic(t->data[m]);
        t->order[m] = m;
    }
    hnbrdf_fit_stage_begin(t);
    hnbrdf_threads_run(t->workers, t->count, draw_one, t);
    result->times.drawing = hnbrdf_threads_busy(t->workers);
    if (atomic_load(&t->undrawn))
        return refuse_data(t, error);
    if (t->options.drawn)
        memcpy(t->options.drawn, t->drawn, (size_t)t->count * sizeof *t->drawn);
    hnbrdf_fit_stage_begin(t);
    hnbrdf_threads_run(t->workers, t->count, fit_one, t);
    for (int m = 0; m < t->count; m++)
        result->times.encoding += t->encoded[m];
    result->times.ggx =
        hnbrdf_threads_busy(t->workers) - result->times.drawing - result->times.encoding;
    if (t->stopped && t->options.kind != HNBRDF_KIND_GGX && !t->options.resume)
        return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED,
                           "stopped before the network's first step");
    hnbrdf_result status =
        t->options.kind != HNBRDF_KIND_GGX ? hnbrdf_fit_train(t, result, error) : HNBRDF_OK;
    result->stopped = t->stopped;
    return status ? status : make_model(t, model, error);
}

hnbrdf_result hnbrdf_fit(const hnbrdf_measured *const *data, int count,
                         const hnbrdf_fit_options *options, hnbrdf_model **model,
                         hnbrdf_fit_report *report_out, hnbrdf_error *error)
{
    trainer t = {0};
    double started = hnbrdf_seconds();
    hnbrdf_fit_report result_report = {.final_loss = NAN, .best_loss = NAN, .ggx_loss = NAN};
    if (count < 1 || count > HNBRDF_MAX_MATERIALS)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%d materials to fit, expected 1 to %d",
                           count, HNBRDF_MAX_MATERIALS);
    for (int m = 0; m < count; m++)
        if (!data || !data[m])
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "material %d of %d to fit is NULL", m,
                               count);
    t.data = data;
    t.count = count;
    if (options)
        t.options = *options;
    hnbrdf_result result = fill_options(&t.options, count, error);
    for (int m = 0; t.options.materials && m < count && !result; m++)
        result = hnbrdf_material_check(&t.options.materials[m], error);
    if (!result)
        result = check_names(&t, error);
    if (result)
        return result;
    if (!t.options.encoding || !hnbrdf_encoding_from_name(t.options.encoding, &t.encoding))
        t.encoding = default_encoding(data, count);
    int unit = FIT_TILE * FIT_CHUNKS;
    t.tiles_per_step = (t.options.batch + unit - 1) / unit * FIT_CHUNKS;
    t.pool.tiles = (t.options.pool + FIT_TILE - 1) / FIT_TILE;
    t.pool.tiles = t.pool.tiles > 0 ? t.pool.tiles : 1;
    t.kernel = hnbrdf_fit_kernel_choose();
    hnbrdf_fit_layout_make(&t.layout, t.options.kind, t.options.hidden, t.options.layers,
                           t.options.latent, count, t.options.analytic == HNBRDF_FIT_JOINT,
                           t.options.floor);
    t.workers = hnbrdf_threads_start(t.options.threads);
    if (!t.workers || !allocate(&t))
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY,
                             "out of memory: %d materials of %d pairs need about %.0f MB", count,
                             t.options.pool,
                             (double)count * t.pool.tiles * FIT_POOL_TILE * sizeof(float) * 1e-6);
    else
        result = run(&t, model, &result_report, error);
    result_report.seconds = hnbrdf_seconds() - started;
    result_report.instructions = t.kernel->name;
    if (t.workers) {
        hnbrdf_fit_times *times = &result_report.times;
        result_report.threads = hnbrdf_threads_count(t.workers);
        times->waiting =
            fmax(0.0, result_report.threads * result_report.seconds - times->drawing - times->ggx -
                          times->encoding - times->network - times->update);
    }
    release(&t);
    if (!result && report_out)
        *report_out = result_report;
    return result;
}
