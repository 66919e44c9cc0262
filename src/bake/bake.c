/* bake.c: one bake from its options to the model and the report. */
#include "bake/task.h"
#include "base/clock.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- What is learned from -------------------------------------------------------------------- */

static hnbrdf_result take_measurements(bake_task *b, hnbrdf_error *error)
{
    for (int m = 0; m < b->count; m++) {
        const char *name = b->report.names[m];
        for (int k = 0; k < b->options.data_count && !b->reference[m]; k++)
            if (b->options.data[k] && strcmp(hnbrdf_measured_name(b->options.data[k]), name) == 0)
                b->reference[m] = b->options.data[k];
        if (!b->reference[m])
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "no measurement of %s among the %d given: materials go by the "
                               "names of their files",
                               name, b->options.data_count);
    }
    return HNBRDF_OK;
}

static hnbrdf_result make_teachers(bake_task *b, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int m = 0; m < b->count && !result; m++) {
        result = hnbrdf_bake_teacher(b->model, b->chosen[m], &b->teachers[m], error);
        b->reference[m] = b->teachers[m];
    }
    return result;
}

/* ---- The report ------------------------------------------------------------------------------ */

/* Pointers and the texts they point to in one piece of memory. */
static const char **copy_names(const bake_task *b)
{
    size_t count = (size_t)b->count, size = count * sizeof(char *);
    for (int m = 0; m < b->count; m++)
        size += strlen(hnbrdf_model_material_name(b->model, b->chosen[m])) + 1;
    const char **names = malloc(size);
    char *to = names ? (char *)(names + count) : NULL;
    for (int m = 0; m < b->count && names; m++) {
        const char *name = hnbrdf_model_material_name(b->model, b->chosen[m]);
        size_t length = strlen(name) + 1;
        names[m] = memcpy(to, name, length);
        to += length;
    }
    return names;
}

static hnbrdf_result begin_report(bake_task *b, hnbrdf_error *error)
{
    const hnbrdf_bake_options *o = &b->options;
    b->report = (hnbrdf_bake_report){.wish = o->wish,
                                     .judge = o->judge,
                                     .sampler = o->sampler,
                                     .pairs = o->pairs,
                                     .seed = o->seed,
                                     .max_error = o->max_error,
                                     .max_ns = o->max_ns,
                                     .max_multiplications = o->max_multiplications,
                                     .from_data = b->from_data,
                                     .kept = b->keep,
                                     .material_count = b->count,
                                     .names = copy_names(b),
                                     .picked = -1,
                                     .timed_on = o->timed_on,
                                     .half_smape = (double)NAN};
    b->reference = calloc((size_t)b->count, sizeof *b->reference);
    b->teachers = b->from_data ? NULL : calloc((size_t)b->count, sizeof *b->teachers);
    if (!b->report.names || !b->reference || (!b->from_data && !b->teachers))
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    return HNBRDF_OK;
}

/* ---- The whole ------------------------------------------------------------------------------- */

/* GGX alone is no answer only because there was no time for a network. */
static hnbrdf_result check_end(const bake_task *b, hnbrdf_error *error)
{
    const hnbrdf_bake_report *r = &b->report;
    if (r->end == HNBRDF_BAKE_COMPLETE || r->met || r->rows[r->picked].size.hidden)
        return HNBRDF_OK;
    return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED, "%s before a network was fitted",
                       r->end == HNBRDF_BAKE_STOPPED ? "interrupted" : "the time was over");
}

static hnbrdf_result bake(bake_task *b, const hnbrdf_bake_options *options, hnbrdf_error *error)
{
    hnbrdf_result result = hnbrdf_bake_take_options(b, options, error);
    if (!result)
        result = begin_report(b, error);
    if (!result)
        result = b->from_data ? take_measurements(b, error) : make_teachers(b, error);
    if (!result)
        result = hnbrdf_bake_make_candidates(b, error);
    if (!result)
        result = hnbrdf_bake_search(b, error);
    if (!result)
        result = check_end(b, error);
    if (!result && b->report.rows[b->report.picked].size.hidden)
        result = hnbrdf_bake_lobes(b, &b->models[b->report.picked], error);
    return result;
}

static void release(bake_task *b)
{
    for (int k = 0; k < b->report.row_count; k++)
        hnbrdf_model_free(b->models[k]);
    hnbrdf_bake_report_free(&b->report);
    for (int m = 0; b->teachers && m < b->count; m++)
        hnbrdf_measured_close(b->teachers[m]);
    free(b->models);
    free(b->candidates);
    free(b->analytic);
    free(b->teachers);
    free((void *)b->reference);
    free(b->chosen);
}

hnbrdf_result hnbrdf_bake(const hnbrdf_model *model, const hnbrdf_bake_options *options,
                          hnbrdf_model **baked, hnbrdf_bake_report *report, hnbrdf_error *error)
{
    bake_task b = {.model = model, .telling = ATOMIC_FLAG_INIT, .started = hnbrdf_seconds()};
    if (!model || !baked)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%s is NULL, expected a %s",
                           model ? "baked" : "model", model ? "place for a model" : "model");
    hnbrdf_result result = bake(&b, options, error);
    if (result == HNBRDF_OK) {
        b.report.half_smape = report ? hnbrdf_bake_half_error(&b) : (double)NAN;
        *baked = b.models[b.report.picked];
        b.models[b.report.picked] = NULL;
    }
    if (result == HNBRDF_OK && report) {
        *report = b.report;
        for (int k = 0; k < b.report.row_count; k++)
            hnbrdf_model_free(b.models[k]);
        memset(&b.report, 0, sizeof b.report);
    }
    release(&b);
    return result;
}
