/* grid_outside.c: networks that were not fitted here, over the same pairs as those of the grid:
 * the paper's published ones, and NBRDF, which has a network for each material. */
#include "report/grid.h"

#include "base/error.h"
#include "base/threads.h"

#include <stdlib.h>
#include <string.h>

/* The approximation of material m of the data, or NULL. */
static const hnbrdf_measured *find_nbrdf(const report *r, int m)
{
    const char *name = hnbrdf_measured_name(r->data.items[m]);
    for (int k = 0; k < r->nbrdf.count; k++)
        if (strcmp(hnbrdf_measured_name(r->nbrdf.items[k]), name) == 0)
            return r->nbrdf.items[k];
    return NULL;
}

static int has_material(const report *r, int which, int m)
{
    if (which == REPORT_NBRDF)
        return find_nbrdf(r, m) != NULL;
    return r->published &&
           hnbrdf_model_find(r->published, hnbrdf_measured_name(r->data.items[m])) >= 0;
}

typedef struct measuring {
    report *r;
    int which;
    hnbrdf_result *results; /* [REPORT_SAMPLERS][materials] */
} measuring;

static void measure_one(void *context, int index, int worker)
{
    measuring *job = context;
    report *r = job->r;
    const int m = index % r->data.count;
    const hnbrdf_sampler sampler = (hnbrdf_sampler)(index / r->data.count);
    hnbrdf_comparison *error = &r->outside[job->which].errors[index];
    (void)worker;
    if (!has_material(r, job->which, m))
        return;
    job->results[index] =
        job->which == REPORT_NBRDF
            ? hnbrdf_compare_measured(find_nbrdf(r, m), r->data.items[m], sampler, (size_t)r->pairs,
                                      (uint64_t)r->seed, error, NULL)
            : hnbrdf_compare(r->published, report_material(r, r->published, m), r->data.items[m],
                             sampler, (size_t)r->pairs, (uint64_t)r->seed, error, NULL);
}

static void average(report *r, report_outside *o)
{
    for (int k = 0; k < REPORT_SAMPLERS * r->data.count; k++)
        if (o->errors[k].pairs > 0)
            o->smape[k / r->data.count] += o->errors[k].smape / o->has;
}

static hnbrdf_result measure(report *r, int which, hnbrdf_threads *workers)
{
    const int items = REPORT_SAMPLERS * r->data.count;
    report_outside *o = &r->outside[which];
    measuring job = {r, which, calloc((size_t)items, sizeof *job.results)};
    hnbrdf_result code = HNBRDF_OK;
    o->errors = calloc((size_t)items, sizeof *o->errors);
    for (int m = 0; m < r->data.count; m++)
        o->has += has_material(r, which, m);
    if (!job.results || !o->errors) {
        code = hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    } else if (o->has > 0) {
        hnbrdf_threads_run(workers, items, measure_one, &job);
        for (int k = 0; k < items && code == HNBRDF_OK; k++)
            if (job.results[k] != HNBRDF_OK)
                code = hnbrdf_fail(r->error, job.results[k], "%s: %s",
                                   hnbrdf_measured_name(r->data.items[k % r->data.count]),
                                   hnbrdf_strerror(job.results[k]));
        average(r, o);
    }
    free(job.results);
    return code;
}

hnbrdf_result report_measure_outside(report *r)
{
    hnbrdf_threads *workers = hnbrdf_threads_start((int)r->threads);
    hnbrdf_result code =
        workers ? HNBRDF_OK : hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int which = 0; which < REPORT_OUTSIDES && code == HNBRDF_OK; which++)
        code = measure(r, which, workers);
    hnbrdf_threads_stop(workers);
    return code;
}

double report_ggx_beside(const report *r, const report_outside *o, int sampler)
{
    double sum = 0.0;
    for (int m = 0; m < r->data.count; m++)
        if (o->errors[sampler * r->data.count + m].pairs > 0)
            sum += r->entries[0].errors[sampler * r->data.count + m].smape / o->has;
    return sum;
}
