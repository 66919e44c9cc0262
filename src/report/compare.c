/* compare.c: measures a model against measured materials and writes the table. */
#include "report/compare.h"

#include "base/error.h"
#include "base/text.h"
#include "base/threads.h"
#include "base/write.h"
#include "report/output.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* ---- Which materials ------------------------------------------------------------------------- */

hnbrdf_result compare_choose(model_comparison *j, hnbrdf_measured *const *items, int count,
                             int skip_missing, hnbrdf_error *error)
{
    j->rows = calloc((size_t)count, sizeof *j->rows);
    if (!j->rows)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    for (int k = 0; k < count; k++) {
        compare_row *r = &j->rows[j->count];
        const char *name = hnbrdf_measured_name(items[k]);
        r->measured = items[k];
        r->material = hnbrdf_model_find(j->model, name);
        r->material_against = j->against ? hnbrdf_model_find(j->against, name) : 0;
        if (r->material >= 0 && r->material_against >= 0)
            j->count++;
        else if (!skip_missing)
            return hnbrdf_fail(
                error, HNBRDF_ERROR_ARGUMENT,
                "%s: the model has no material %s (--skip-missing leaves such data out)",
                r->material < 0 ? j->path : j->path_against, name);
    }
    return j->count ? HNBRDF_OK
                    : hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                                  "%s: the model has none of the materials of the data", j->path);
}

/* ---- Measuring ------------------------------------------------------------------------------- */

typedef struct measuring {
    model_comparison *j;
    const report_watch *watch;
    atomic_int done, failed;
} measuring;

static void measure(void *context, int index, int worker)
{
    measuring *m = context;
    const model_comparison *j = m->j;
    compare_row *r = &j->rows[index];
    if (atomic_load(&m->failed))
        return;
    r->result =
        hnbrdf_compare(j->model, hnbrdf_model_material(j->model, r->material), r->measured,
                       j->sampler, (size_t)j->pairs, (uint64_t)j->seed, &r->error, &r->message);
    if (r->result == HNBRDF_OK && j->against)
        r->result = hnbrdf_compare(
            j->against, hnbrdf_model_material(j->against, r->material_against), r->measured,
            j->sampler, (size_t)j->pairs, (uint64_t)j->seed, &r->error_against, &r->message);
    if (r->result != HNBRDF_OK)
        atomic_store(&m->failed, 1);
    int done = atomic_fetch_add(&m->done, 1) + 1;
    if (worker == 0)
        report_show(m->watch, (double)done / j->count, hnbrdf_measured_name(r->measured));
}

static void add_to_mean(hnbrdf_comparison *mean, const hnbrdf_comparison *error, int count)
{
    mean->smape += error->smape / count;
    mean->smape_analytic += error->smape_analytic / count;
    mean->mae += error->mae / count;
    mean->mse += error->mse / count;
    mean->pairs += error->pairs;
}

hnbrdf_result compare_measure(model_comparison *j, int threads, const report_watch *watch,
                              hnbrdf_error *error)
{
    measuring m = {.j = j, .watch = watch};
    hnbrdf_threads *workers = hnbrdf_threads_start(threads < j->count ? threads : j->count);
    if (!workers)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    hnbrdf_threads_run(workers, j->count, measure, &m);
    hnbrdf_threads_stop(workers);
    for (int k = 0; k < j->count; k++) {
        const compare_row *r = &j->rows[k];
        if (r->result != HNBRDF_OK)
            return hnbrdf_fail(error, r->result, "%s", r->message.text);
        add_to_mean(&j->mean, &r->error, j->count);
        add_to_mean(&j->mean_against, &r->error_against, j->count);
    }
    return HNBRDF_OK;
}

/* ---- Output ---------------------------------------------------------------------------------- */

static void write_number(FILE *file, const char *before, double value)
{
    char text[HNBRDF_NUMBER_TEXT];
    hnbrdf_format_float(text, sizeof text, (float)value);
    fprintf(file, "%s%s", before, text);
}

static void print_row(const model_comparison *j, int width, const char *name,
                      const hnbrdf_comparison *error, const hnbrdf_comparison *against, FILE *file)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(j->model, &desc);
    fprintf(file, "%-*s  %8.4f", width, name, error->smape);
    if (desc.kind == HNBRDF_KIND_NEURAL)
        fprintf(file, "  %8s", "-");
    else
        fprintf(file, "  %8.4f", error->smape_analytic);
    if (j->against)
        fprintf(file, "  %8.4f", against->smape);
    fprintf(file, "  %10zu\n", error->pairs);
}

void compare_print_wins(const model_comparison *j, FILE *file)
{
    int wins = 0, losses = 0;
    for (int k = 0; k < j->count; k++) {
        double gain = j->rows[k].error_against.smape - j->rows[k].error.smape;
        wins += gain > 0.0;
        losses += gain < 0.0;
    }
    fprintf(file, "lower SMAPE: %s for %d of %d materials, %s (against) for %d\n", j->path, wins,
            j->count, j->path_against, losses);
}

void compare_print(const model_comparison *j, FILE *file)
{
    int width = (int)strlen("material");
    for (int k = 0; k < j->count; k++) {
        int length = (int)strlen(hnbrdf_measured_name(j->rows[k].measured));
        width = length > width ? length : width;
    }
    fprintf(file, "%-*s  %8s  %8s%s  %10s\n", width, "material", "SMAPE", "analytic",
            j->against ? "   against" : "", "pairs");
    for (int k = 0; k < j->count; k++)
        print_row(j, width, hnbrdf_measured_name(j->rows[k].measured), &j->rows[k].error,
                  &j->rows[k].error_against, file);
    print_row(j, width, "mean", &j->mean, &j->mean_against, file);
    fprintf(file,
            "\n%s sampler, %ld pairs a material, seed %ld; SMAPE: 0 is perfect, 2 the worst\n",
            hnbrdf_sampler_name(j->sampler), j->pairs, j->seed);
}

static void write_csv_row(FILE *file, const char *name, const hnbrdf_comparison *error)
{
    hnbrdf_write_csv_text(file, name);
    write_number(file, ",", error->smape);
    write_number(file, ",", error->smape_analytic);
    fprintf(file, ",%zu\n", error->pairs);
}

void compare_write_csv(const void *comparison, FILE *file)
{
    const model_comparison *j = comparison;
    fputs("material,smape,smape_analytic,pairs\n", file);
    for (int k = 0; k < j->count; k++)
        write_csv_row(file, hnbrdf_measured_name(j->rows[k].measured), &j->rows[k].error);
    write_csv_row(file, "mean", &j->mean);
}

static void write_json_errors(const model_comparison *j, FILE *file, const hnbrdf_comparison *error,
                              const hnbrdf_comparison *against)
{
    write_number(file, "\"smape\": ", error->smape);
    write_number(file, ", \"smape_analytic\": ", error->smape_analytic);
    write_number(file, ", \"mae\": ", error->mae);
    write_number(file, ", \"mse\": ", error->mse);
    if (j->against)
        write_number(file, ", \"smape_against\": ", against->smape);
    fprintf(file, ", \"pairs\": %zu}", error->pairs);
}

void compare_write_json(const void *comparison, FILE *file)
{
    const model_comparison *j = comparison;
    fputs("{\n  \"model\": ", file);
    hnbrdf_write_json_text(file, j->path);
    if (j->against) {
        fputs(",\n  \"against\": ", file);
        hnbrdf_write_json_text(file, j->path_against);
    }
    fprintf(file,
            ",\n  \"sampler\": \"%s\",\n  \"pairs\": %ld,\n  \"seed\": %ld,\n  \"materials\": [",
            hnbrdf_sampler_name(j->sampler), j->pairs, j->seed);
    for (int k = 0; k < j->count; k++) {
        fprintf(file, "%s\n    {\"name\": ", k ? "," : "");
        hnbrdf_write_json_text(file, hnbrdf_measured_name(j->rows[k].measured));
        fputs(", ", file);
        write_json_errors(j, file, &j->rows[k].error, &j->rows[k].error_against);
    }
    fputs("\n  ],\n  \"mean\": {", file);
    write_json_errors(j, file, &j->mean, &j->mean_against);
    fputs("\n}\n", file);
}
