/* bake_tables.c: what `bake` tried and picked, for people, as CSV and as JSON. */
#include "base/error.h"
#include "base/write.h"
#include "report/bake.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static double ratio_to_ggx(const hnbrdf_bake_report *r, const hnbrdf_bake_size *size)
{
    return size->ns / r->rows[0].size.ns;
}

/* ---- For people ------------------------------------------------------------------------------ */

void report_bake_heading(const hnbrdf_bake_report *r, const char *path, FILE *file)
{
    fprintf(file, "%d material%s of %s; %s sampler, %zu pairs a material, seed %" PRIu64 "\n",
            r->material_count, r->material_count == 1 ? "" : "s", path,
            hnbrdf_sampler_name(r->sampler), r->pairs, r->seed);
    fprintf(file, "learned from and judged by %s; GGX part %s\n",
            r->from_data ? "the measurements" : "the model",
            r->kept        ? "kept from the model"
            : r->from_data ? "fitted to the measurements"
                           : "fitted to the model");
}

/* The columns that models and rows share. */
static void print_size(const hnbrdf_bake_report *r, const hnbrdf_bake_size *s, const char *encoding,
                       const char *fit, FILE *file)
{
    char name[16];
    fprintf(file, "%-6s %6d  %-18s  %6zu  %7zu  %8.1f  %6.2f  %-5s  ",
            hnbrdf_bake_size_name(s, name), s->latent, encoding, s->multiplications, s->weights,
            s->ns, ratio_to_ggx(r, s), fit);
}

void report_bake_columns(const hnbrdf_bake_report *r, FILE *file)
{
    fprintf(file, "\n%-6s %6s  %-18s  %6s  %7s  %8s  %6s  %-5s  %7s  %7s  %8s  %7s\n", "net",
            "latent", "encoding", "mults", "numbers", "ns/eval", "x GGX", "fit", "SMAPE", "worst",
            "analytic", "seconds");
    print_size(r, &r->model, "", "model", file);
    if (r->from_data)
        fprintf(file, "%7.4f  %7.4f\n", r->model_smape, r->model_worst);
    else
        fprintf(file, "%7s  %7s\n", "-", "-");
}

void report_bake_row(const hnbrdf_bake_report *r, const hnbrdf_bake_row *row, FILE *file)
{
    print_size(r, &row->size, row->size.hidden ? hnbrdf_encoding_name(row->encoding) : "",
               row->half   ? "half"
               : row->full ? "full"
                           : "short",
               file);
    fprintf(file, "%7.4f  %7.4f  %8.4f  %7.1f\n", row->smape, row->worst, row->analytic,
            row->seconds);
}

static const char *judge_name(const hnbrdf_bake_report *r)
{
    return r->judge == HNBRDF_BAKE_WORST ? "highest" : "mean";
}

static void print_reason(const hnbrdf_bake_report *r, const hnbrdf_bake_row *row, FILE *file)
{
    const char *within = r->met ? "within" : "NOT within";
    switch (r->wish) {
    case HNBRDF_BAKE_ERROR:
        if (r->reason == HNBRDF_BAKE_GGX_IS_ENOUGH)
            fprintf(file, "GGX alone is within the error: the network is dropped (kind ggx)\n");
        else
            fprintf(file, "%s error %.4f, %s %.4f\n", judge_name(r), hnbrdf_bake_judged(r, row),
                    within, r->max_error);
        break;
    case HNBRDF_BAKE_TIME:
        fprintf(file, "%.1f ns%s, %s %.1f\n", row->half ? row->size.half_ns : row->size.ns,
                row->half ? " with the network in half precision" : "", within, r->max_ns);
        break;
    case HNBRDF_BAKE_SIZE:
        fprintf(file, "%zu multiplications, within %zu\n", row->size.multiplications,
                r->max_multiplications);
        break;
    case HNBRDF_BAKE_AUTO:
    case HNBRDF_BAKE_FRONT:
        fprintf(file, "the lowest error times ns of those tried: %.2f\n",
                hnbrdf_bake_judged(r, row) * row->size.ns);
        break;
    case HNBRDF_BAKE_NET:
        break;
    }
}

void report_bake_result(const hnbrdf_bake_report *r, const char *output, FILE *file)
{
    const hnbrdf_bake_row *row = &r->rows[r->picked];
    const hnbrdf_bake_size *s = &row->size;
    char name[16];
    fprintf(file, "\n%s: %s", output, hnbrdf_bake_size_name(s, name));
    if (s->hidden)
        fprintf(file, ", l = %d, %s, %zu multiplications", s->latent,
                hnbrdf_encoding_name(row->encoding), s->multiplications);
    if (s->hidden && r->model.multiplications)
        fprintf(file, ", %.1f times fewer than the model's",
                (double)r->model.multiplications / (double)s->multiplications);
    fprintf(file, "\n");
    print_reason(r, row, file);
    fprintf(file, "\n%-32s  %7s  %8s\n", "material", "SMAPE", "analytic");
    for (int m = 0; m < r->material_count; m++)
        fprintf(file, "%-32s  %7.4f  %8.4f\n", r->names[m], row->errors[m].smape,
                row->errors[m].smape_analytic);
    fprintf(file, "%-32s  %7.4f  %8.4f\n", "mean", row->smape, row->analytic);
    if (s->hidden)
        fprintf(file, "\nweights in half precision (export --precision half): %s error %.4f\n",
                judge_name(r), r->half_smape);
    if (r->timed_on)
        fprintf(file, "\nns/eval: the exported shader on %s, buffers subtracted\n", r->timed_on);
    else
        fprintf(file,
                "\nns/eval: hnbrdf_eval_batch(), one material, one thread of this machine, the "
                "least of several interleaved rounds\n");
}

void report_bake_stage(const hnbrdf_bake_progress *p, char what[64], char detail[64])
{
    char first[16], last[16];
    detail[0] = '\0';
    if (isfinite(p->loss))
        snprintf(detail, 64, "loss %.4f", p->loss);
    switch (p->stage) {
    case HNBRDF_BAKE_TIMING:
        snprintf(what, 64, "timing");
        return;
    case HNBRDF_BAKE_GGX:
        snprintf(what, 64, "GGX");
        snprintf(detail, 64, "%s", p->done < 0.5 ? "drawing data" : "fitting");
        return;
    case HNBRDF_BAKE_LOBES:
        snprintf(what, 64, "lobes");
        return;
    case HNBRDF_BAKE_SHORT_FITS:
    case HNBRDF_BAKE_FULL_FITS:
        break;
    }
    hnbrdf_bake_size_name(p->first, first);
    hnbrdf_bake_size_name(p->last, last);
    snprintf(what, 64, "%s fits of %s%s%s", p->stage == HNBRDF_BAKE_FULL_FITS ? "full" : "short",
             first, strcmp(first, last) ? " to " : "", strcmp(first, last) ? last : "");
}

hnbrdf_result report_bake_verdict(const hnbrdf_bake_report *r, double seconds, const char *output,
                                  hnbrdf_error *error)
{
    if (r->end == HNBRDF_BAKE_STOPPED)
        return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED,
                           "interrupted; %s has the best of what was tried", output);
    if (r->met)
        return HNBRDF_OK;
    if (r->end == HNBRDF_BAKE_OUT_OF_TIME)
        return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED,
                           "the %s s are over; %s has the best of what was tried",
                           HNBRDF_NUMBER(seconds), output);
    if (r->wish == HNBRDF_BAKE_AUTO)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT,
                           "no network is clearly smaller than the model's; %s has GGX alone",
                           output);
    if (r->wish != HNBRDF_BAKE_ERROR)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT,
                           "nothing takes at most %s ns here; %s has GGX alone",
                           HNBRDF_NUMBER(r->max_ns), output);
    if (r->from_data)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT,
                           "no network tried is within %s; %s has the most accurate one",
                           HNBRDF_NUMBER(r->max_error), output);
    return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT,
                       "no network that is clearly smaller than the model's comes within %s of it; "
                       "%s has the most accurate one",
                       HNBRDF_NUMBER(r->max_error), output);
}

/* ---- CSV ------------------------------------------------------------------------------------- */

static const char columns[] =
    "net,latent,encoding,backend,mults,weights,ns_per_eval,ratio_to_ggx,fit,steps,seed,"
    "seconds,sampler,reference,smape,smape_worst,smape_analytic,picked";

static const char *backend_of(const hnbrdf_bake_report *r)
{
    return r->timed_on ? r->timed_on : "c-batch";
}

static void write_csv_row(const hnbrdf_bake_report *r, int k, FILE *file)
{
    const hnbrdf_bake_row *row = &r->rows[k];
    const hnbrdf_bake_size *s = &row->size;
    char name[16];
    fprintf(file, "%s,%d,%s,", hnbrdf_bake_size_name(s, name), s->latent,
            s->hidden ? hnbrdf_encoding_name(row->encoding) : "");
    hnbrdf_write_csv_text(file, backend_of(r));
    fprintf(file, ",%zu,%zu,%.2f,%.3f,%s,%ld,%" PRIu64 ",%.2f,%s,%s,%.6f,%.6f,%.6f,%d\n",
            s->multiplications, s->weights, row->half ? s->half_ns : s->ns,
            (row->half ? s->half_ns : s->ns) / r->rows[0].size.ns,
            row->half   ? "half"
            : row->full ? "full"
                        : "short",
            row->steps, row->seed, row->seconds, hnbrdf_sampler_name(r->sampler),
            r->from_data ? "data" : "model", row->smape, row->worst, row->analytic, k == r->picked);
}

void report_bake_csv(const void *report, FILE *file)
{
    const hnbrdf_bake_report *r = report;
    fprintf(file, "%s\n", columns);
    for (int k = 0; k < r->row_count; k++)
        write_csv_row(r, k, file);
}

void report_bake_front_csv(const void *of, FILE *file)
{
    const report_bake_front *front = of;
    fprintf(file, "materials,%s\n", columns);
    for (int n = 0; n < front->count; n++)
        for (int k = 0; k < front->reports[n].row_count; k++) {
            fprintf(file, "%d,", front->reports[n].material_count);
            write_csv_row(&front->reports[n], k, file);
        }
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static void write_row(const hnbrdf_bake_report *r, const hnbrdf_bake_row *row, FILE *file)
{
    char name[16];
    const hnbrdf_bake_size *s = &row->size;
    fprintf(file, "    {\"net\": \"%s\", \"latent\": %d, ", hnbrdf_bake_size_name(s, name),
            s->latent);
    if (s->hidden)
        fprintf(file, "\"encoding\": \"%s\", ", hnbrdf_encoding_name(row->encoding));
    fprintf(file,
            "\"mults\": %zu, \"weights\": %zu, \"ns_per_eval\": %.2f, \"ratio_to_ggx\": %.3f, "
            "\"fit\": \"%s\", \"steps\": %ld, \"seed\": %" PRIu64
            ", \"seconds\": %.2f, \"smape\": %.6f, \"smape_worst\": %.6f, "
            "\"smape_analytic\": %.6f,\n     \"errors\": [",
            s->multiplications, s->weights, s->ns, ratio_to_ggx(r, s), row->full ? "full" : "short",
            row->steps, row->seed, row->seconds, row->smape, row->worst, row->analytic);
    for (int m = 0; m < r->material_count; m++)
        fprintf(file, "%s[%.6f, %.6f]", m ? ", " : "", row->errors[m].smape,
                row->errors[m].smape_analytic);
    fprintf(file, "]}");
}

static const char *wish_name(hnbrdf_bake_wish wish)
{
    switch (wish) {
    case HNBRDF_BAKE_AUTO:
        return "auto";
    case HNBRDF_BAKE_ERROR:
        return "max-error";
    case HNBRDF_BAKE_TIME:
        return "max-ns";
    case HNBRDF_BAKE_SIZE:
        return "max-mults";
    case HNBRDF_BAKE_NET:
        return "net";
    case HNBRDF_BAKE_FRONT:
        return "front";
    }
    return "";
}

void report_bake_json(const void *report, FILE *file)
{
    const hnbrdf_bake_report *r = report;
    fprintf(file, "{\n  \"wish\": \"%s\", \"met\": %s, \"stopped\": %s, \"picked\": %d,\n",
            wish_name(r->wish), r->met ? "true" : "false",
            r->end != HNBRDF_BAKE_COMPLETE ? "true" : "false", r->picked);
    fprintf(file, "  \"sampler\": \"%s\", \"pairs\": %zu, \"reference\": \"%s\", \"backend\": ",
            hnbrdf_sampler_name(r->sampler), r->pairs, r->from_data ? "data" : "model");
    hnbrdf_write_json_text(file, backend_of(r));
    fputs(",\n", file);
    fprintf(file, "  \"model\": {\"mults\": %zu, \"weights\": %zu, \"ns_per_eval\": %.2f",
            r->model.multiplications, r->model.weights, r->model.ns);
    if (r->from_data)
        fprintf(file, ", \"smape\": %.6f, \"smape_worst\": %.6f", r->model_smape, r->model_worst);
    fputs("},\n", file);
    if (!isnan(r->half_smape))
        fprintf(file, "  \"smape_half\": %.6f,\n", r->half_smape);
    fputs("  \"materials\": [", file);
    for (int m = 0; m < r->material_count; m++) {
        fputs(m ? ", " : "", file);
        hnbrdf_write_json_text(file, r->names[m]);
    }
    fputs("],\n  \"rows\": [\n", file);
    for (int k = 0; k < r->row_count; k++) {
        write_row(r, &r->rows[k], file);
        fputs(k + 1 < r->row_count ? ",\n" : "\n", file);
    }
    fputs("  ]\n}\n", file);
}
