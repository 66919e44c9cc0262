/* bake_tables.c: what `bake` tried and picked, for people, as CSV and as JSON. */
#include "cli/bake.h"
#include "cli/csv.h"

#include <math.h>

void bake_print_heading(const bake *b)
{
    char size[16];
    printf("%d material%s of %s; %s sampler, %ld pairs a material, seed %ld\n", b->count,
           b->count == 1 ? "" : "s", b->path, hnbrdf_sampler_name((hnbrdf_sampler)b->sampler),
           b->pairs, b->seed);
    printf("learned from and judged by %s; GGX part %s\n",
           b->from_data ? "the measurements" : "the model",
           b->keep        ? "kept from the model"
           : b->from_data ? "fitted to the measurements"
                          : "fitted to the model");
    cli_print_reading();
    printf("\n%-6s %6s  %6s  %7s  %8s  %6s  %-5s  %7s  %7s  %8s  %7s\n", "net", "latent", "mults",
           "numbers", "ns/eval", "x GGX", "fit", "SMAPE", "worst", "analytic", "seconds");
    const bake_candidate *own = &b->reference_size;
    bake_size_name(own, size);
    printf("%-6s %6d  %6zu  %7zu  %8.1f  %6.2f  %-5s  ", size, own->latent, own->mults,
           own->weights, own->ns, own->ns / b->candidates[0].ns, "model");
    if (b->from_data)
        printf("%7.4f  %7.4f\n", b->reference_smape, b->reference_worst);
    else
        printf("%7s  %7s\n", "-", "-");
}

void bake_print_row(const bake *b, const bake_row *row)
{
    char size[16];
    const bake_candidate *c = row->candidate;
    bake_size_name(c, size);
    printf("%-6s %6d  %6zu  %7zu  %8.1f  %6.2f  %-5s  %7.4f  %7.4f  %8.4f  %7.1f\n", size,
           c->latent, c->mults, c->weights, c->ns, c->ns / b->candidates[0].ns,
           row->full ? "full" : "short", row->smape, row->worst, row->analytic, row->seconds);
    fflush(stdout);
}

static void print_reason(const bake *b, const bake_row *row)
{
    const char *whose = b->worst ? "highest" : "mean";
    if (b->wish == BAKE_ERROR && b->met && row->candidate->hidden == 0)
        printf("GGX alone is within the error: the network is dropped (kind ggx)\n");
    else if (b->wish == BAKE_ERROR)
        printf("%s error %.4f, %s %.4f\n", whose, bake_judged(b, row),
               b->met ? "within" : "NOT within", b->max_error);
    else if (b->wish == BAKE_TIME)
        printf("%.1f ns, %s %.1f\n", row->candidate->ns, b->met ? "within" : "NOT within",
               b->max_ns);
    else if (b->wish == BAKE_AUTO)
        printf("the lowest error times ns of those tried: %.2f\n",
               bake_judged(b, row) * row->candidate->ns);
}

void bake_print_result(const bake *b, const char *output)
{
    const bake_row *row = &b->rows[b->picked];
    const bake_candidate *c = row->candidate;
    char size[16];
    bake_size_name(c, size);
    printf("\n%s: %s", output, size);
    if (c->hidden)
        printf(", l = %d, %s, %zu multiplications", c->latent, hnbrdf_encoding_name(row->encoding),
               c->mults);
    if (c->hidden && b->reference_size.mults)
        printf(", %.1f times fewer than the model's",
               (double)b->reference_size.mults / (double)c->mults);
    printf("\n");
    print_reason(b, row);
    printf("\n%-32s  %7s  %8s\n", "material", "SMAPE", "analytic");
    for (int m = 0; m < b->count; m++)
        printf("%-32s  %7.4f  %8.4f\n", hnbrdf_measured_name(b->reference[m]), row->errors[m].smape,
               row->errors[m].smape_analytic);
    printf("%-32s  %7.4f  %8.4f\n", "mean", row->smape, row->analytic);
    if (c->hidden)
        printf("\nweights in half precision (export --precision half): %s error %.4f\n",
               b->worst ? "highest" : "mean", b->half);
    printf("\nns/eval: hnbrdf_eval_batch(), one material, one thread of this machine, the least of "
           "several "
           "interleaved rounds\n");
}

/* ---- CSV ------------------------------------------------------------------------------------- */

void bake_write_csv(const bake *b, FILE *file)
{
    char size[16];
    fputs(
        "net,latent,encoding,backend,mults,weights,ns_per_eval,ratio_to_ggx,fit,steps,seed,seconds,"
        "sampler,"
        "reference,smape,smape_worst,smape_analytic,picked\n",
        file);
    for (int k = 0; k < b->row_count; k++) {
        const bake_row *row = &b->rows[k];
        const bake_candidate *c = row->candidate;
        bake_size_name(c, size);
        fprintf(
            file, "%s,%d,%s,c-batch,%zu,%zu,%.2f,%.3f,%s,%ld,%ld,%.2f,%s,%s,%.6f,%.6f,%.6f,%d\n",
            size, c->latent, c->hidden ? hnbrdf_encoding_name(row->encoding) : "", c->mults,
            c->weights, c->ns, c->ns / b->candidates[0].ns, row->full ? "full" : "short",
            row->steps, row->seed, row->seconds, hnbrdf_sampler_name((hnbrdf_sampler)b->sampler),
            b->from_data ? "data" : "model", row->smape, row->worst, row->analytic, k == b->picked);
    }
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static void write_row(const bake *b, const bake_row *row, FILE *file)
{
    char size[16];
    const bake_candidate *c = row->candidate;
    bake_size_name(c, size);
    fprintf(file, "    {\"net\": \"%s\", \"latent\": %d, ", size, c->latent);
    if (c->hidden)
        fprintf(file, "\"encoding\": \"%s\", ", hnbrdf_encoding_name(row->encoding));
    fprintf(
        file,
        "\"mults\": %zu, \"weights\": %zu, \"ns_per_eval\": %.2f, \"ratio_to_ggx\": %.3f, \"fit\": "
        "\"%s\", "
        "\"steps\": %ld, \"seed\": %ld, \"seconds\": %.2f, \"smape\": %.6f, \"smape_worst\": %.6f, "
        "\"smape_analytic\": %.6f,\n     \"errors\": [",
        c->mults, c->weights, c->ns, c->ns / b->candidates[0].ns, row->full ? "full" : "short",
        row->steps, row->seed, row->seconds, row->smape, row->worst, row->analytic);
    for (int m = 0; m < b->count; m++)
        fprintf(file, "%s[%.6f, %.6f]", m ? ", " : "", row->errors[m].smape,
                row->errors[m].smape_analytic);
    fprintf(file, "]}");
}

void bake_write_json(const bake *b, FILE *file)
{
    static const char *const wishes[] = {"max-error", "max-ns", "auto", "net"};
    fprintf(file, "{\n  \"wish\": \"%s\", \"met\": %s, \"stopped\": %s, \"picked\": %d,\n",
            wishes[b->wish], b->met ? "true" : "false", b->stopped ? "true" : "false", b->picked);
    fprintf(
        file,
        "  \"sampler\": \"%s\", \"pairs\": %ld, \"reference\": \"%s\", \"backend\": \"c-batch\",\n",
        hnbrdf_sampler_name((hnbrdf_sampler)b->sampler), b->pairs, b->from_data ? "data" : "model");
    fprintf(file, "  \"model\": {\"mults\": %zu, \"weights\": %zu, \"ns_per_eval\": %.2f",
            b->reference_size.mults, b->reference_size.weights, b->reference_size.ns);
    if (b->from_data)
        fprintf(file, ", \"smape\": %.6f, \"smape_worst\": %.6f", b->reference_smape,
                b->reference_worst);
    fputs("},\n", file);
    if (!isnan(b->half))
        fprintf(file, "  \"smape_half\": %.6f,\n", b->half);
    fputs("  \"materials\": [", file);
    for (int m = 0; m < b->count; m++) {
        fputs(m ? ", " : "", file);
        cli_write_json_text(file, hnbrdf_measured_name(b->reference[m]));
    }
    fputs("],\n  \"rows\": [\n", file);
    for (int k = 0; k < b->row_count; k++) {
        write_row(b, &b->rows[k], file);
        fputs(k + 1 < b->row_count ? ",\n" : "\n", file);
    }
    fputs("  ]\n}\n", file);
}
