/* editing_mix.c: how far mixtures go astray: half way between two members of a family, and over
 * all pairs of a model's materials. */
#include "hnbrdf/edit.h"
#include "report/editing.h"

#include "base/error.h"
#include "base/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Half way between two members ------------------------------------------------------------ */

/* The two members of most different alpha; 0 if the model lacks one. */
static int find_ends(const editing_report *r, int model, int family, const hnbrdf_material *ends[2])
{
    const double alphas[2] = {editing_alphas[0], editing_alphas[EDITING_ALPHAS - 1]};
    for (int k = 0; k < 2; k++) {
        char name[48];
        editing_member_name(family, alphas[k], name, sizeof name);
        ends[k] = hnbrdf_model_material(r->models[model].model,
                                        hnbrdf_model_find(r->models[model].model, name));
    }
    return ends[0] && ends[1];
}

static hnbrdf_result measure_half(editing_report *r, const hnbrdf_material *const ends[2],
                                  editing_half *half)
{
    const hnbrdf_model *model = r->models[half->model].model;
    hnbrdf_family_parameters parameters;
    hnbrdf_measured *truth;
    hnbrdf_material path[HNBRDF_MIX_KNOTS], mixed, frozen;
    hnbrdf_comparison comparison;
    char name[64];
    double middle = sqrt(editing_alphas[0] * editing_alphas[EDITING_ALPHAS - 1]);
    hnbrdf_family_member(half->family, middle, &parameters);
    snprintf(name, sizeof name, "%s, half way", hnbrdf_family_name(half->family));
    hnbrdf_result result = hnbrdf_family_open(half->family, &parameters, name, &truth, r->error);
    if (result)
        return result;
    result = hnbrdf_mix_path_fit(model, ends[0], ends[1], path, r->error);
    if (!result)
        result = editing_fit_frozen(r, half->model, &truth, 1, &frozen);
    if (!result) {
        hnbrdf_mix_path_at(path, 0.5f, &mixed);
        result = hnbrdf_compare(model, &mixed, truth, (hnbrdf_sampler)r->sampler, (size_t)r->pairs,
                                (uint64_t)r->seed, &comparison, r->error);
    }
    if (!result) {
        half->smape = comparison.smape;
        half->ggx = comparison.smape_analytic;
        result = hnbrdf_compare(model, &frozen, truth, (hnbrdf_sampler)r->sampler, (size_t)r->pairs,
                                (uint64_t)r->seed, &comparison, r->error);
    }
    if (!result)
        half->frozen = comparison.smape;
    hnbrdf_measured_close(truth);
    return result;
}

static hnbrdf_result measure_halves(editing_report *r)
{
    hnbrdf_result result = HNBRDF_OK;
    r->halves = calloc((size_t)r->count + 1, sizeof *r->halves);
    if (!r->halves)
        return hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int m = 0; m < r->count && !result; m++) {
        const editing_member *member = &r->members[m];
        const hnbrdf_material *ends[2];
        editing_half *half = &r->halves[r->half_count];
        if (m > 0 && member[-1].family == member->family)
            continue;
        *half = (editing_half){.family = member->family, .model = member->model};
        if (!find_ends(r, member->model, member->family, ends))
            continue;
        editing_show(r, 0.7 * m / r->count);
        result = measure_half(r, ends, half);
        r->half_count += !result;
    }
    return result;
}

/* ---- All pairs ------------------------------------------------------------------------------- */

enum { VIEWS = 3 };

typedef struct albedos {
    double at[VIEWS][3];
} albedos;

static void fill_albedos(const hnbrdf_model *model, const hnbrdf_material *material, albedos *a)
{
    static const double degrees[VIEWS] = {0.0, 30.0, 60.0};
    for (int v = 0; v < VIEWS; v++) {
        double theta = degrees[v] * 3.14159265358979323846 / 180.0;
        const float wo[3] = {(float)sin(theta), 0.0f, (float)cos(theta)};
        hnbrdf_albedo(model, material, wo, a->at[v]);
    }
}

typedef struct pair_job {
    const editing_report *r;
    const hnbrdf_model *model;
    albedos *ends; /* [materials] */
    editing_pairs *set;
    hnbrdf_result *results; /* [pairs] */
} pair_job;

static void fill_end(void *context, int index, int worker)
{
    pair_job *job = context;
    (void)worker;
    fill_albedos(job->model, hnbrdf_model_material(job->model, index), &job->ends[index]);
}

/* value over the larger end or the smaller end over value, whichever is more; an albedo under a
 * thousandth counts as that. */
static double beyond(double value, double a, double b)
{
    static const double dark = 1e-3;
    double low = fmax(fmin(a, b), dark), high = fmax(fmax(a, b), dark);
    value = fmax(value, dark);
    return fmax(value / high, low / value);
}

static void measure_mixture(const pair_job *job, const hnbrdf_material *mixed, editing_mixture *m)
{
    const albedos *a = &job->ends[m->ends[0]], *b = &job->ends[m->ends[1]];
    albedos between;
    fill_albedos(job->model, mixed, &between);
    for (int v = 0; v < VIEWS; v++)
        for (int c = 0; c < 3; c++) {
            double factor = beyond(between.at[v][c], a->at[v][c], b->at[v][c]);
            if (factor > m->beyond) {
                m->beyond = factor;
                m->channel = c;
            }
        }
}

/* All mixtures of a pair. */
static void measure_pair(void *context, int index, int worker)
{
    pair_job *job = context;
    editing_mixture *list = &job->set->list[index * EDITING_STEPS];
    hnbrdf_material path[HNBRDF_MIX_KNOTS], mixed;
    (void)worker;
    job->results[index] =
        hnbrdf_mix_path_fit(job->model, hnbrdf_model_material(job->model, list->ends[0]),
                            hnbrdf_model_material(job->model, list->ends[1]), path, NULL);
    for (int t = 0; t < EDITING_STEPS && !job->results[index]; t++) {
        hnbrdf_mix_path_at(path, (float)list[t].t, &mixed);
        measure_mixture(job, &mixed, &list[t]);
    }
}

static void list_mixtures(editing_pairs *set, int materials)
{
    int k = 0;
    for (int a = 0; a < materials; a++)
        for (int b = a + 1; b < materials; b++)
            for (int t = 1; t <= EDITING_STEPS; t++)
                set->list[k++] = (editing_mixture){.ends = {a, b}, .t = t / (EDITING_STEPS + 1.0)};
}

static void count_within(editing_pairs *set)
{
    for (int p = 0; p < set->pairs; p++) {
        int within = 0;
        for (int t = 0; t < EDITING_STEPS; t++)
            within += set->list[p * EDITING_STEPS + t].beyond <= EDITING_WIDENED;
        set->within += within;
        set->all += within == EDITING_STEPS;
    }
}

/* In rounds, to show how far they are. */
static hnbrdf_result run_pairs(editing_report *r, hnbrdf_threads *workers, pair_job *job)
{
    enum { ROUND = 16 };
    editing_pairs *set = job->set;
    editing_mixture *all = set->list;
    hnbrdf_result *results = job->results;
    for (int first = 0; first < set->pairs; first += ROUND) {
        int count = set->pairs - first < ROUND ? set->pairs - first : ROUND;
        set->list = all + first * EDITING_STEPS;
        job->results = results + first;
        hnbrdf_threads_run(workers, count, measure_pair, job);
        set->list = all;
        job->results = results;
        editing_show(r, 0.7 + 0.3 * first / set->pairs);
        if (report_stop(&r->watch))
            return editing_interrupted(r);
    }
    for (int p = 0; p < set->pairs; p++)
        if (results[p])
            return hnbrdf_fail(r->error, results[p], "a path between two materials: %s",
                               hnbrdf_strerror(results[p]));
    return HNBRDF_OK;
}

static hnbrdf_result measure_pairs(editing_report *r, int model)
{
    editing_pairs *set = &r->pair_sets[r->pair_set_count];
    pair_job job = {.r = r, .model = r->models[model].model, .set = set};
    int materials = hnbrdf_model_material_count(job.model);
    hnbrdf_result result = HNBRDF_OK;
    set->model = model;
    set->pairs = materials * (materials - 1) / 2;
    set->mixtures = set->pairs * EDITING_STEPS;
    set->list = calloc((size_t)set->mixtures + 1, sizeof *set->list);
    job.ends = calloc((size_t)materials, sizeof *job.ends);
    job.results = calloc((size_t)set->pairs + 1, sizeof *job.results);
    hnbrdf_threads *workers = hnbrdf_threads_start((int)r->threads);
    if (!set->list || !job.ends || !job.results || !workers)
        result = hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    if (!result) {
        list_mixtures(set, materials);
        hnbrdf_threads_run(workers, materials, fill_end, &job);
        result = run_pairs(r, workers, &job);
    }
    if (!result) {
        count_within(set);
        r->pair_set_count++;
    }
    hnbrdf_threads_stop(workers);
    free(job.results);
    free(job.ends);
    return result;
}

hnbrdf_result editing_measure_mixtures(editing_report *r)
{
    r->detail = "mixtures";
    r->current = r->total - r->done;
    hnbrdf_result result = measure_halves(r);
    for (int k = 0; k < r->model_count && !result; k++)
        result = measure_pairs(r, k);
    return result;
}
