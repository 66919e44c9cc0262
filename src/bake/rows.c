/* rows.c: the models that were made, and how far each is from what it learned from. */
#include "bake/task.h"

#include <math.h>
#include <stdlib.h>

hnbrdf_result hnbrdf_bake_measure(const bake_task *b, const hnbrdf_model *model, const int *at,
                                  size_t pairs, hnbrdf_comparison *errors, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int m = 0; m < b->count && result == HNBRDF_OK; m++)
        result =
            hnbrdf_compare(model, hnbrdf_model_material(model, at ? at[m] : m), b->reference[m],
                           b->options.sampler, pairs, b->options.seed, &errors[m], error);
    return result;
}

void hnbrdf_bake_summarise(const bake_task *b, hnbrdf_bake_row *row)
{
    row->smape = row->worst = row->analytic = 0.0;
    for (int m = 0; m < b->count; m++) {
        row->smape += row->errors[m].smape / b->count;
        row->worst = fmax(row->worst, row->errors[m].smape);
        row->analytic += row->errors[m].smape_analytic / b->count;
    }
}

hnbrdf_result hnbrdf_bake_add_row(bake_task *b, const hnbrdf_bake_row *row, hnbrdf_model *model,
                                  hnbrdf_bake_stage stage, hnbrdf_error *error)
{
    size_t count = (size_t)b->report.row_count + 1;
    hnbrdf_bake_row *rows = realloc(b->report.rows, count * sizeof *rows);
    if (rows)
        b->report.rows = rows;
    hnbrdf_model **models = realloc(b->models, count * sizeof *models);
    if (models)
        b->models = models;
    if (!rows || !models) {
        free(row->errors);
        hnbrdf_model_free(model);
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    }
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    models[b->report.row_count] = model;
    rows[b->report.row_count] = *row;
    rows[b->report.row_count].encoding = desc.encoding;
    hnbrdf_bake_summarise(b, &rows[b->report.row_count++]);
    hnbrdf_bake_tell_row(b, stage);
    return HNBRDF_OK;
}

double hnbrdf_bake_half_error(const bake_task *b)
{
    int picked = b->report.picked;
    hnbrdf_bake_row row = b->report.rows[picked];
    hnbrdf_model *model = row.size.hidden ? hnbrdf_bake_half(b->models[picked]) : NULL;
    row.errors = calloc((size_t)b->count, sizeof *row.errors);
    double half = (double)NAN;
    if (model && row.errors &&
        hnbrdf_bake_measure(b, model, NULL, b->options.pairs, row.errors, NULL) == HNBRDF_OK) {
        hnbrdf_bake_summarise(b, &row);
        half = hnbrdf_bake_judged(&b->report, &row);
    }
    free(row.errors);
    hnbrdf_model_free(model);
    return half;
}
