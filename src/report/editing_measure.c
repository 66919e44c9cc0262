/* editing_measure.c: how far each way is from the truth: over directions, and on a sphere. */
#include "report/editing.h"

#include "base/error.h"
#include "base/threads.h"
#include "report/grid.h"

#include <math.h>
#include <stdlib.h>

/* ---- Over directions ------------------------------------------------------------------------- */

/* Three comparisons a case: the edited one gives its analytic part too. */
enum { COMPARISONS = 3 };
static const editing_way compared[COMPARISONS] = {EDITING_UNEDITED, EDITING_EDITED, EDITING_FROZEN};

typedef struct job {
    const editing_report *r;
    editing_member *member;
    hnbrdf_result *results; /* [cases * COMPARISONS] */
} job;

static void compare_one(void *context, int index, int worker)
{
    job *j = context;
    const editing_report *r = j->r;
    editing_case *c = &j->member->cases[index / COMPARISONS];
    editing_way way = compared[index % COMPARISONS];
    hnbrdf_comparison comparison;
    (void)worker;
    j->results[index] = hnbrdf_compare(r->models[j->member->model].model, &c->materials[way],
                                       c->truth, (hnbrdf_sampler)r->sampler, (size_t)r->pairs,
                                       (uint64_t)r->seed, &comparison, NULL);
    if (j->results[index])
        return;
    c->smape[way] = comparison.smape;
    if (way == EDITING_EDITED)
        c->smape[EDITING_GGX] = comparison.smape_analytic;
}

static hnbrdf_result compare(const editing_report *r, editing_member *m)
{
    hnbrdf_result result = HNBRDF_OK;
    int items = m->count * COMPARISONS;
    job j = {r, m, calloc((size_t)items, sizeof(hnbrdf_result))};
    hnbrdf_threads *workers = hnbrdf_threads_start((int)r->threads);
    if (!j.results || !workers)
        result = hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    if (!result)
        hnbrdf_threads_run(workers, items, compare_one, &j);
    for (int k = 0; k < items && !result; k++)
        if (j.results[k])
            result = hnbrdf_fail(r->error, j.results[k], "%s: %s",
                                 hnbrdf_measured_name(m->cases[k / COMPARISONS].truth),
                                 hnbrdf_strerror(j.results[k]));
    hnbrdf_threads_stop(workers);
    free(j.results);
    return result;
}

/* ---- Spheres --------------------------------------------------------------------------------- */

static hnbrdf_result render_case(editing_report *r, int model, editing_case *c)
{
    const hnbrdf_model *network = r->models[model].model;
    render_surface surfaces[EDITING_WAYS + 1];
    const render_surface *all[EDITING_WAYS + 1];
    render_image reference = {0};
    for (int way = 0; way < EDITING_WAYS; way++)
        surfaces[way] = way == EDITING_GGX ? render_surface_analytic(network, &c->materials[way])
                                           : render_surface_model(network, &c->materials[way]);
    surfaces[EDITING_WAYS] = render_surface_measured(c->truth);
    for (int k = 0; k <= EDITING_WAYS; k++)
        all[k] = &surfaces[k];
    /* They share their random directions, which suit all of them. */
    render_guide guide = render_guide_fit(all, EDITING_WAYS + 1, r->spheres.guide);
    for (int k = 0; k <= EDITING_WAYS; k++)
        render_surface_guide(&surfaces[k], &guide);
    hnbrdf_result result =
        report_spheres_render(&r->spheres, &surfaces[EDITING_WAYS], &reference, r->error);
    for (int way = 0; way < EDITING_WAYS && !result; way++) {
        render_image image = {0};
        hnbrdf_image_error error;
        result = report_spheres_render(&r->spheres, &surfaces[way], &image, r->error);
        if (!result)
            result = report_picture_compare(&image, &reference, &error, r->error);
        if (!result)
            c->psnr[way] = fmin(error.psnr, REPORT_PSNR_LIMIT);
        render_image_free(&image);
    }
    render_image_free(&reference);
    return result;
}

/* ---- One member ------------------------------------------------------------------------------ */

static hnbrdf_result fit_truths(editing_report *r, editing_member *m)
{
    hnbrdf_measured **data = calloc((size_t)m->count, sizeof *data);
    hnbrdf_material *materials = calloc((size_t)m->count, sizeof *materials);
    hnbrdf_result result =
        data && materials ? HNBRDF_OK : hnbrdf_fail(r->error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int k = 0; k < m->count && !result; k++)
        data[k] = m->cases[k].truth;
    if (!result)
        result = editing_fit_frozen(r, m->model, data, m->count, materials);
    for (int k = 0; k < m->count && !result; k++)
        m->cases[k].materials[EDITING_FROZEN] = materials[k];
    free(data);
    free(materials);
    return result;
}

hnbrdf_result editing_measure(editing_report *r, int index)
{
    editing_member *m = &r->members[index];
    r->detail = m->name;
    r->current = 3.0; /* of the 6 that editing_begin() counts for a member */
    hnbrdf_result result = fit_truths(r, m);
    r->done += r->current;
    if (!result)
        result = compare(r, m);
    for (int k = 0; k < m->count && r->image_size && !result; k++) {
        editing_show(r, (double)k / m->count);
        result = render_case(r, m->model, &m->cases[k]);
        if (result == HNBRDF_ERROR_CANCELLED || (!result && report_stop(&r->watch)))
            result = editing_interrupted(r);
    }
    r->done += r->current;
    m->done = !result;
    return result;
}
