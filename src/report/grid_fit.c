/* grid_fit.c: trains or reuses the models of a report, one after the other, and measures them. */
#include "report/grid.h"

#include "base/clock.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/threads.h"
#include "report/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What is under way, for the progress line; all in seconds. */
typedef struct watch {
    const report *r;
    const report_entry *entry;
    double started;
    double before;      /* the network: data and GGX of one entry, as the entry ggx took */
    double work_second; /* units of work a second, as the last network did */
    double later;       /* expected for the entries after this one */
} watch;

/* ---- What a finished model was made with --------------------------------------------------------
 * models/NAME.txt: the settings in one line, then what the fit took. Written last: it says that the
 * model beside it is complete. */

static uint64_t hash_text(uint64_t h, const char *text)
{
    return hnbrdf_hash(h, text, strlen(text) + 1);
}

static void describe_settings(const report *r, const report_entry *e, char *text, size_t size)
{
    uint64_t h = HNBRDF_HASH_START;
    for (int m = 0; m < r->data.count; m++) {
        h = hash_text(h, hnbrdf_measured_name(r->data.items[m]));
        h = hash_text(h, hnbrdf_measured_summary(r->data.items[m]));
    }
    snprintf(
        text, size, "hnbrdf %s, %d materials (%016llx), seed %ld, %ld steps, %g s, pool %ld, %s\n",
        hnbrdf_version(), r->data.count, (unsigned long long)h, r->seed, r->steps, r->budget,
        r->pool, e->form == REPORT_HYBRID && r->analytic == HNBRDF_FIT_JOINT ? "joint" : "default");
}

static hnbrdf_result write_record(const report *r, const report_entry *e)
{
    char settings[512];
    report_output output;
    char *path = report_path(r, e->name, "txt");
    hnbrdf_result result = path ? report_output_open(path, &output, r->error) : HNBRDF_ERROR_MEMORY;
    free(path);
    if (result != HNBRDF_OK)
        return result;
    describe_settings(r, e, settings, sizeof settings);
    fprintf(output.file, "%ssteps %ld\nseconds %.3f\npairs_per_s %.0f\n", settings, e->steps,
            e->seconds, e->pairs_per_s);
    for (int m = 0; e->form == REPORT_GGX && m < r->data.count; m++)
        fprintf(output.file, "search %d %.9g %.9g %.9g %.9g\n", r->search[m].starts,
                r->search[m].best, r->search[m].second, (double)r->search[m].second_alpha[0],
                (double)r->search[m].second_alpha[1]);
    if (report_is_judged(e->form)) {
        fputs("judged", output.file);
        for (int m = 0; m < r->data.count; m++)
            fprintf(output.file, " %d", (int)e->judged[m]);
        putc('\n', output.file);
    }
    return report_output_close(&output, r->error);
}

static int read_judged(const report *r, report_entry *e, FILE *file)
{
    char word[8] = "";
    int same = fscanf(file, " %7s", word) == 1 && strcmp(word, "judged") == 0;
    for (int m = 0; m < r->data.count && same; m++) {
        unsigned value = 0;
        same = fscanf(file, " %u", &value) == 1 && value <= REPORT_WORSE;
        e->judged[m] = (unsigned char)value;
    }
    return same;
}

/* 1 if there is a record of a model made with these very settings. */
static int read_record(const report *r, report_entry *e)
{
    char settings[512], found[512] = "";
    char *path = report_path(r, e->name, "txt");
    FILE *file = path ? fopen(path, "r") : NULL;
    free(path);
    if (!file)
        return 0;
    describe_settings(r, e, settings, sizeof settings);
    int same = fgets(found, sizeof found, file) && strcmp(found, settings) == 0 &&
               fscanf(file, "steps %ld seconds %lf pairs_per_s %lf", &e->steps, &e->seconds,
                      &e->pairs_per_s) == 3;
    for (int m = 0; same && e->form == REPORT_GGX && m < r->data.count; m++) {
        hnbrdf_fit_search *s = &r->search[m];
        same = fscanf(file, " search %d %lf %lf %f %f", &s->starts, &s->best, &s->second,
                      &s->second_alpha[0], &s->second_alpha[1]) == 5;
    }
    if (same && report_is_judged(e->form))
        same = read_judged(r, e, file);
    fclose(file);
    return same;
}

static void forget(const report *r, const report_entry *e, const char *suffix)
{
    char *path = report_path(r, e->name, suffix);
    if (path)
        remove(path);
    free(path);
}

/* ---- Fitting --------------------------------------------------------------------------------- */

/* Multiplications; only ratios matter. */
static double work_of(const report *r, const report_entry *e)
{
    double hidden = e->net[0], inputs = 6.0 + e->latent;
    double mults = hidden * (inputs + hidden * (e->net[1] - 1) + 6.0);
    return e->form == REPORT_GGX ? 0.0 : mults * (double)(r->steps ? r->steps : 32000);
}

static double network_seconds(const watch *w, const report_entry *e)
{
    return e->form != REPORT_GGX && w->r->budget > 0.0 ? w->r->budget
                                                       : work_of(w->r, e) / w->work_second;
}

static void watch_entry(watch *w, const report_entry *e)
{
    const report *r = w->r;
    w->entry = e;
    w->later = 0.0;
    for (int k = (int)(e - r->entries) + 1; k < r->count; k++) {
        report_entry probe = r->entries[k];
        if (!r->resume || !read_record(r, &probe))
            w->later += w->before + network_seconds(w, &probe);
    }
}

static void learn_from(watch *w, const report_entry *e)
{
    if (e->form == REPORT_GGX)
        w->before = e->seconds;
    else if (e->seconds > w->before)
        w->work_second = work_of(w->r, e) / (e->seconds - w->before);
}

static int show(void *user, const hnbrdf_fit_progress *p)
{
    watch *w = user;
    char detail[96], loss[32] = "";
    int in_network = strcmp(p->stage, "network") == 0;
    double left = w->later + network_seconds(w, w->entry) * (in_network ? 1.0 - p->done : 1.0);
    double spent = hnbrdf_seconds() - w->started;
    if (!in_network)
        left += w->before * (strcmp(p->stage, "ggx") == 0 ? 1.0 - p->done : 1.0);
    if (isfinite(p->loss))
        snprintf(loss, sizeof loss, ", loss %.4f", p->loss);
    snprintf(detail, sizeof detail, "%d of %d %s%s", (int)(w->entry - w->r->entries) + 1,
             w->r->count, w->entry->name, loss);
    report_show(&w->r->watch, spent / (spent + left), detail);
    return report_stop(&w->r->watch);
}

static void set_options(const report *r, const report_entry *e, hnbrdf_fit_options *o)
{
    static const hnbrdf_kind kinds[REPORT_FORMS] = {
        [REPORT_GGX] = HNBRDF_KIND_GGX,
        [REPORT_HYBRID] = HNBRDF_KIND_HYBRID,
        [REPORT_PAPER] = HNBRDF_KIND_HYBRID,
        [REPORT_NEURAL] = HNBRDF_KIND_NEURAL,
    };
    memset(o, 0, sizeof *o);
    o->kind = kinds[e->form];
    o->hidden = e->net[0];
    o->layers = e->net[1];
    o->latent = e->latent;
    o->analytic = (hnbrdf_fit_analytic)r->analytic;
    if (e->form == REPORT_PAPER) {
        o->encoding = hnbrdf_encoding_name(HNBRDF_ENCODING_DIRECTIONS);
        o->floor_none = 1;
        o->analytic = HNBRDF_FIT_JOINT;
    }
    o->steps = r->steps;
    o->seconds = r->budget;
    o->pool = (int)r->pool;
    o->seed = (uint64_t)r->seed;
    o->threads = (int)r->threads;
}

/* As hnbrdf_fit(), but one that was stopped is an error. */
static hnbrdf_result fit(const report *r, const hnbrdf_fit_options *options, const char *name,
                         hnbrdf_model **model, hnbrdf_fit_report *made)
{
    hnbrdf_error error;
    hnbrdf_model *fitted = NULL;
    hnbrdf_result result = hnbrdf_fit((const hnbrdf_measured *const *)r->data.items, r->data.count,
                                      options, &fitted, made, &error);
    if (result == HNBRDF_OK)
        *model = fitted;
    if (result == HNBRDF_ERROR_CANCELLED ||
        (result == HNBRDF_OK && (report_stop(&r->watch) || made->stopped)))
        return report_interrupted(r);
    return result == HNBRDF_OK ? result : hnbrdf_fail(r->error, result, "%s: %s", name, error.text);
}

static hnbrdf_result save(const report *r, const hnbrdf_model *model, const report_entry *e,
                          const char *path)
{
    hnbrdf_error error;
    hnbrdf_result result = hnbrdf_model_save(model, path, &error);
    return result == HNBRDF_OK ? write_record(r, e)
                               : hnbrdf_fail(r->error, result, "%s: %s", e->name, error.text);
}

/* The first entry is made by all ranks together, and saved by one. */
static int is_shared(const report_entry *e)
{
    return e->form == REPORT_GGX;
}

/* Fits and saves; goes on from a checkpoint that --resume finds. */
static hnbrdf_result fit_entry(const report *r, report_entry *e, watch *w, hnbrdf_model **model)
{
    hnbrdf_fit_options options;
    hnbrdf_fit_report made;
    hnbrdf_model *fitted = NULL;
    hnbrdf_result result = HNBRDF_ERROR_MEMORY;
    hnbrdf_fit_worth *worth = calloc((size_t)r->data.count, sizeof *worth);
    char *checkpoint = report_path(r, e->name, "checkpoint"),
         *path = report_path(r, e->name, "safetensors");
    if (!worth) {
        hnbrdf_fail(r->error, result, "out of memory");
    } else if (checkpoint && path) {
        forget(r, e, "txt");
        set_options(r, e, &options);
        options.worth = report_is_judged(e->form) ? worth : NULL;
        options.search = e->form == REPORT_GGX ? r->search : NULL;
        options.ranks = is_shared(e) ? r->ranks : NULL;
        options.progress = show;
        options.progress_user = w;
        if (e->form != REPORT_GGX) {
            options.checkpoint = checkpoint;
            options.resume = r->resume && access(checkpoint, R_OK) == 0;
        }
        result = fit(r, &options, e->name, &fitted, &made);
    }
    if (result == HNBRDF_OK) {
        e->steps = made.steps;
        e->seconds = made.seconds;
        e->pairs_per_s = made.pairs_per_s;
        for (int m = 0; m < r->data.count; m++)
            e->judged[m] = worth[m].alone ? REPORT_ALONE : worth[m].worse ? REPORT_WORSE : 0;
        if (!is_shared(e) || report_rank(r) == 0)
            result = save(r, fitted, e, path);
    }
    if (result == HNBRDF_OK) {
        remove(checkpoint);
        *model = fitted;
    } else {
        hnbrdf_model_free(fitted);
    }
    free(checkpoint);
    free(path);
    free(worth);
    return result;
}

/* The model of an earlier run, if --resume allows it and it is complete. */
static hnbrdf_model *reuse(const report *r, report_entry *e)
{
    hnbrdf_model *model = NULL;
    if (!r->resume || !read_record(r, e))
        return NULL;
    char *path = report_path(r, e->name, "safetensors");
    if (path && hnbrdf_model_load(path, NULL, &model, NULL) != HNBRDF_OK)
        model = NULL;
    free(path);
    return model;
}

/* ---- Measuring ------------------------------------------------------------------------------- */

typedef struct measuring {
    const report *r;
    report_entry *e;
    const hnbrdf_model *model;
    hnbrdf_result *results; /* [REPORT_SAMPLERS][materials] */
} measuring;

static void measure_one(void *context, int index, int worker)
{
    measuring *job = context;
    const report *r = job->r;
    (void)worker;
    job->results[index] = hnbrdf_compare(
        job->model, report_material(r, job->model, index % r->data.count),
        r->data.items[index % r->data.count], (hnbrdf_sampler)(index / r->data.count),
        (size_t)r->pairs, (uint64_t)r->seed, &job->e->errors[index], NULL);
}

static void average(report_entry *e, int materials)
{
    memset(e->mean, 0, sizeof e->mean);
    for (int k = 0; k < REPORT_SAMPLERS * materials; k++) {
        hnbrdf_comparison *mean = &e->mean[k / materials];
        mean->smape += e->errors[k].smape / materials;
        mean->smape_analytic += e->errors[k].smape_analytic / materials;
        mean->pairs += e->errors[k].pairs;
    }
}

static hnbrdf_result measure(const report *r, report_entry *e, const hnbrdf_model *model)
{
    hnbrdf_result code = HNBRDF_OK;
    int items = REPORT_SAMPLERS * r->data.count;
    measuring job = {r, e, model, calloc((size_t)items, sizeof(hnbrdf_result))};
    hnbrdf_threads *workers = hnbrdf_threads_start((int)r->threads);
    if (job.results && workers) {
        hnbrdf_threads_run(workers, items, measure_one, &job);
        for (int k = 0; k < items && code == HNBRDF_OK; k++)
            if (job.results[k] != HNBRDF_OK)
                code = hnbrdf_fail(r->error, job.results[k], "%s: %s",
                                   hnbrdf_measured_name(r->data.items[k % r->data.count]),
                                   hnbrdf_strerror(job.results[k]));
    } else {
        code = hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    }
    hnbrdf_threads_stop(workers);
    free(job.results);
    return code;
}

/* ---- The whole grid -------------------------------------------------------------------------- */

static void describe(report_entry *e, const hnbrdf_model *model)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    e->kind = desc.kind;
    e->encoding = desc.encoding;
    e->floor = desc.floor;
    e->weights = hnbrdf_model_weight_count(model);
    e->mults = hnbrdf_model_multiplications(model);
}

static hnbrdf_result measure_all(report *r, report_entry *e, const hnbrdf_model *model)
{
    hnbrdf_result result = measure(r, e, model);
    if (result == HNBRDF_OK && r->image_size)
        result = report_images_entry(r, e, model);
    if (result == HNBRDF_OK && (!is_shared(e) || report_rank(r) == 0))
        result = report_keep_figures(r, e, model);
    return result;
}

static hnbrdf_result finish_entry(report *r, report_entry *e, const hnbrdf_model *model)
{
    hnbrdf_result result = HNBRDF_OK;
    describe(e, model);
    if (!r->resume || !report_take_figures(r, e, model))
        result = measure_all(r, e, model);
    if (result != HNBRDF_OK)
        return result;
    average(e, r->data.count);
    report_images_average(r, e);
    e->done = 1;
    return HNBRDF_OK;
}

static hnbrdf_result run_entry(report *r, report_entry *e, watch *w)
{
    hnbrdf_model *model = reuse(r, e);
    int missing = model == NULL;
    hnbrdf_result result = is_shared(e) ? report_agree(r, HNBRDF_OK, &missing) : HNBRDF_OK;
    watch_entry(w, e);
    if (missing) { /* of a shared one, by any */
        hnbrdf_model_free(model);
        model = NULL;
        result = result == HNBRDF_OK ? fit_entry(r, e, w, &model) : result;
    }
    if (result == HNBRDF_OK && is_shared(e)) {
        for (int m = 0; m < r->data.count; m++)
            r->ggx[m] = *hnbrdf_model_material(model, m);
        r->ggx_model = model;
    }
    if (result == HNBRDF_OK)
        result = finish_entry(r, e, model);
    if (result == HNBRDF_OK)
        learn_from(w, e);
    if (model != r->ggx_model)
        hnbrdf_model_free(model);
    return result;
}

/* First guesses, until the first entries tell. */
static watch begin_watch(const report *r)
{
    return (watch){
        .r = r, .started = hnbrdf_seconds(), .before = 0.3 * r->data.count, .work_second = 2e6};
}

/* Rank 0 hears of what rank `from` has done, and writes. */
static hnbrdf_result finish_with(const report *r, int from, report_entry *e,
                                 hnbrdf_result (*finished)(const report *r, const report_entry *e))
{
    hnbrdf_result result = report_spread_entry(r, from, e);
    if (result == HNBRDF_OK && report_rank(r) == 0)
        result = finished(r, e);
    return report_agree(r, result, NULL);
}

hnbrdf_result report_run(report *r,
                         hnbrdf_result (*finished)(const report *r, const report_entry *e))
{
    watch w = begin_watch(r);
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0, n; k < r->count && result == HNBRDF_OK; k += n) {
        n = k == 0 ? 1 : report_rank_count(r); /* the first entry: all together */
        n = n < r->count - k ? n : r->count - k;
        const int own = k == 0 ? 0 : k + report_rank(r);
        result = own < k + n ? run_entry(r, &r->entries[own], &w) : HNBRDF_OK;
        result = report_agree(r, result, NULL);
        for (int i = 0; i < n && result == HNBRDF_OK; i++)
            result = finish_with(r, i, &r->entries[k + i], finished);
        int stop = k + n < r->count && report_stop(&r->watch);
        result = report_agree(r, result, &stop);
        if (result == HNBRDF_OK && stop)
            result = report_interrupted(r);
    }
    report_images_end(r);
    return result;
}

/* ---- Models alone ---------------------------------------------------------------------------- */

hnbrdf_result report_load_model(const report *r, const char *path, hnbrdf_model **model)
{
    hnbrdf_result result = hnbrdf_model_load(path, NULL, model, r->error);
    for (int m = 0; result == HNBRDF_OK && m < r->data.count; m++)
        if (hnbrdf_model_find(*model, hnbrdf_measured_name(r->data.items[m])) < 0)
            result = hnbrdf_fail(r->error, HNBRDF_ERROR_ARGUMENT, "%s: has no material %s", path,
                                 hnbrdf_measured_name(r->data.items[m]));
    return result;
}

/* The model of this entry in the folder of an earlier report. */
static hnbrdf_result take_model(const report *r, const report_entry *e, hnbrdf_model **model)
{
    report earlier = {.directory = r->from, .error = r->error};
    char *path = report_path(&earlier, e->name, "safetensors");
    hnbrdf_result result = path ? report_load_model(r, path, model) : HNBRDF_ERROR_MEMORY;
    free(path);
    return result;
}

hnbrdf_result report_make_models(report *r, hnbrdf_model **models)
{
    watch w = begin_watch(r);
    hnbrdf_result result = HNBRDF_OK;
    for (int k = 0; k < r->count && result == HNBRDF_OK; k++) {
        report_entry *e = &r->entries[k];
        watch_entry(&w, e);
        if (r->given && e->form != REPORT_GGX)
            result = report_load_model(r, r->given, &models[k]);
        else if (r->from)
            result = take_model(r, e, &models[k]);
        else if (!(models[k] = reuse(r, e)))
            result = fit_entry(r, e, &w, &models[k]);
        if (result == HNBRDF_OK) {
            describe(e, models[k]);
            learn_from(&w, e);
        }
    }
    return result;
}
