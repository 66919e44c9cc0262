/* ggx.c: the analytic part of every material, and GGX alone as the first thing tried. */
#include "bake/task.h"
#include "base/clock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POOL = 32768 /* pairs drawn a material, unless asked for */ };

static int show(void *user, const hnbrdf_fit_progress *p)
{
    const int drawing = strcmp(p->stage, "sampling") == 0;
    const hnbrdf_bake_progress progress = {.stage = HNBRDF_BAKE_GGX,
                                           .done = 0.5 * p->done + (drawing ? 0.0 : 0.5),
                                           .loss = (double)NAN};
    return hnbrdf_bake_tell(user, &progress);
}

static hnbrdf_result fit_ggx(bake_task *b, hnbrdf_error *error)
{
    hnbrdf_model *model;
    hnbrdf_fit_options options = {.kind = HNBRDF_KIND_GGX,
                                  .pool = b->options.pool ? b->options.pool : POOL,
                                  .seed = b->options.seed,
                                  .threads = b->options.threads,
                                  .ranks = b->options.ranks,
                                  .progress = show,
                                  .progress_user = b};
    hnbrdf_result result = hnbrdf_fit(b->reference, b->count, &options, &model, NULL, error);
    if (result)
        return result;
    for (int m = 0; m < b->count; m++)
        b->analytic[m] = *hnbrdf_model_material(model, m);
    hnbrdf_model_free(model);
    return HNBRDF_OK;
}

static hnbrdf_result make_model(const bake_task *b, hnbrdf_model **model, hnbrdf_error *error)
{
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_GGX,
                              .material_count = b->count,
                              .materials = b->analytic,
                              .names = b->report.names};
    return hnbrdf_model_create(&desc, NULL, model, error);
}

/* The model's own error, where there are measurements to know it by. */
static hnbrdf_result measure_model(bake_task *b, hnbrdf_bake_row *row, hnbrdf_error *error)
{
    b->report.model_smape = b->report.model_worst = (double)NAN;
    if (!b->from_data)
        return HNBRDF_OK;
    hnbrdf_result result =
        hnbrdf_bake_measure(b, b->model, b->chosen, b->options.pairs, row->errors, error);
    if (!result) {
        hnbrdf_bake_summarise(b, row);
        b->report.model_smape = row->smape;
        b->report.model_worst = row->worst;
    }
    return result;
}

hnbrdf_result hnbrdf_bake_ggx(bake_task *b, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    hnbrdf_model *model = NULL;
    hnbrdf_bake_row row = {.size = b->candidates[0], .full = 1, .seed = b->options.seed};
    double started = hnbrdf_seconds();
    b->analytic = calloc((size_t)b->count, sizeof *b->analytic);
    row.errors = calloc((size_t)b->count, sizeof *row.errors);
    if (!b->analytic || !row.errors)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int m = 0; m < b->count && !result && b->keep; m++)
        b->analytic[m] = *hnbrdf_model_material(b->model, b->chosen[m]);
    if (!result && !b->keep)
        result = fit_ggx(b, error);
    row.seconds = hnbrdf_seconds() - started;
    if (!result)
        result = measure_model(b, &row, error);
    if (!result)
        result = make_model(b, &model, error);
    if (!result)
        result = hnbrdf_bake_measure(b, model, NULL, b->options.pairs, row.errors, error);
    if (!result)
        return hnbrdf_bake_add_row(b, &row, model, HNBRDF_BAKE_GGX, error);
    free(row.errors);
    hnbrdf_model_free(model);
    return result;
}
