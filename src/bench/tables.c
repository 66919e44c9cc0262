/* tables.c: the rows of `hnbrdf bench` as a table, CSV and JSON. */
#include "base/threads.h"
#include "base/write.h"
#include "bench/bench.h"

#include <math.h>
#include <string.h>

static const char columns[] = "model,net,encoding,latent,backend,variant,weights,precision,ns_per_"
                              "eval,evals_per_s,peak_fraction,"
                              "ratio_to_ggx,compile_ms,bytes,mults,smape,psnr,io_ns,net_ns,net_"
                              "peak_fraction,first_dispatch_ms,"
                              "threads,net_muladd_fraction,sample_ns,density_ns,scene_bytes";

/* ---- What follows from a row ----------------------------------------------------------------- */

typedef struct figures {
    double ns, network_ns, io_ns, per_second, peak_fraction, network_peak_fraction,
        network_muladd_fraction, ratio;
} figures;

static figures figures_of(const bench *b, const bench_row *row)
{
    const bench_row *ggx = bench_ggx(b, row);
    figures f = {.ns = bench_ns(row),
                 .network_ns = bench_network_ns(row),
                 .io_ns = row->io ? row->io->ns : (double)NAN,
                 .ratio = (double)NAN};
    f.per_second = 1e9 / f.ns;
    f.peak_fraction = bench_peak_fraction(b, row, f.ns, 1);
    f.network_peak_fraction = bench_peak_fraction(b, row, f.network_ns, 1);
    f.network_muladd_fraction = bench_peak_fraction(b, row, f.network_ns, 0);
    if (ggx)
        f.ratio = f.ns / bench_ns(ggx);
    return f;
}

static const char *encoding_of(const bench_row *row)
{
    return row->model->desc.kind == HNBRDF_KIND_GGX || row->model->is_baseline
               ? "none"
               : hnbrdf_encoding_name(row->encoding);
}

static size_t multiplications(const bench_row *row)
{
    return row->model->is_baseline ? 0 : hnbrdf_model_multiplications(row->model->model);
}

/* ---- For people ------------------------------------------------------------------------------ */

/* A number with `digits` decimals in `width` columns; a dash where it is unknown. */
static void print_number(FILE *file, int width, int digits, double value)
{
    if (isfinite(value))
        fprintf(file, "  %*.*f", width, digits, value);
    else
        fprintf(file, "  %*s", width, "-");
}

static void print_row(const bench *b, const bench_row *row, int name, int backend, FILE *file)
{
    char net[16];
    figures f = figures_of(b, row);
    fprintf(file, "%-*s  %-5s  %-18s  %-*s  %-7s  %-15s  %-5s", name, row->model->name,
            bench_net(row->model, net), encoding_of(row), backend, row->backend, row->variant,
            row->weights, row->precision);
    print_number(file, 8, 2, f.ns);
    print_number(file, 7, 2, f.per_second * 1e-6);
    print_number(file, 7, 2, f.ratio);
    print_number(file, 6, 1, 100.0 * f.peak_fraction);
    print_number(file, 8, 2, f.network_ns);
    print_number(file, 6, 1, 100.0 * f.network_peak_fraction);
    print_number(file, 6, 2, f.io_ns);
    print_number(file, 7, 0, row->compile_ms);
    print_number(file, 7, 0, row->first_ms);
    fprintf(file, "  %7zu", row->bytes);
    print_number(file, 6, 4, row->smape);
    print_number(file, 5, 2, row->psnr);
    fprintf(file, "\n");
}

static void print_heading(const bench *b, FILE *file)
{
    fprintf(file, "%s, %d threads in this machine; CPU rows on one thread, in its own CPU time\n",
            b->cpu, hnbrdf_processors());
    for (int k = 0; k < b->peak_count; k++)
        fprintf(file, "%s %s: %.1f GFLOP/s fused, %.1f with additions apart",
                k ? "," : "peak of one thread,", b->peaks[k].variant, b->peaks[k].fma * 1e-9,
                b->peaks[k].muladd * 1e-9);
    fprintf(file, "\n");
    fprintf(file,
            "least of %ld rounds over all rows; ns/eval without buffers (io), network: the network "
            "alone\n",
            b->rounds);
    if (isfinite(b->models[0].smape))
        fprintf(file,
                "SMAPE by the %s sampler, %ld pairs a material; PSNR in dB of spheres %ld pixels "
                "wide, %ld "
                "samples a pixel\n",
                hnbrdf_sampler_name(b->sampler), b->pairs, b->size, b->spp);
    fprintf(file, "\n");
}

/* The batches that a row of the CPU is compared with: of one material, without fusing; or NULL. */
static const bench_row *exact_batch(const bench *b, const bench_row *row)
{
    for (int k = 0; k < b->row_count && strncmp(row->backend, "c-", 2) == 0; k++) {
        const bench_row *peer = &b->rows[k];
        const size_t length = strlen(peer->variant);
        if (peer != row && peer->model == row->model && strcmp(peer->backend, "c-batch") == 0 &&
            strncmp(peer->variant, row->variant, length) == 0 &&
            (row->variant[length] == '\0' || row->variant[length] == '-'))
            return peer;
    }
    return NULL;
}

/* How the rows of one model stand against each other, which is what engineers compare. */
static void print_ratios(const bench *b, const bench_row *row, FILE *file)
{
    figures f = figures_of(b, row);
    if (!isfinite(f.network_ns) || !isfinite(f.ns))
        return;
    fprintf(file, "  %s, %s %s %s %s: whole BRDF %.2f times its network", row->model->name,
            row->backend, row->variant, row->weights, row->precision, f.ns / f.network_ns);
    if (isfinite(f.network_peak_fraction))
        fprintf(file, ", network at %.1f %% of the peak (%.1f %% of that without fusing)",
                100.0 * f.network_peak_fraction, 100.0 * f.network_muladd_fraction);
    const bench_row *batch = exact_batch(b, row);
    if (batch)
        fprintf(file, ", %.2f times c-batch %s", f.ns / bench_ns(batch), batch->variant);
    for (int k = 0; k < b->row_count; k++) {
        const bench_row *peer = &b->rows[k];
        if (strcmp(peer->weights, "published-style") == 0 && peer != row &&
            peer->model == row->model && strcmp(peer->backend, row->backend) == 0)
            fprintf(file, ", %.2f times the published style", f.ns / bench_ns(peer));
    }
    fprintf(file, "\n");
}

/* What a renderer needs, and what all materials take. */
static void print_uses(const bench *b, int name, FILE *file)
{
    fprintf(file,
            "\none at a time, ns: a value, a direction with its density, a density%s\n%-*s  %8s  "
            "%8s  %8s",
            b->data_count ? "; bytes of all materials" : "", name, "", "value", "sample",
            "density");
    fprintf(file, b->data_count ? "  %10s  %6s\n" : "\n", "bytes", "SMAPE");
    for (int k = 0; k < b->row_count; k++) {
        const bench_row *row = &b->rows[k];
        if (strcmp(row->backend, "c-single-prepared") != 0)
            continue;
        fprintf(file, "%-*s", name, row->model->name);
        print_number(file, 8, 1, bench_ns(row));
        print_number(file, 8, 1, row->draw.ns);
        print_number(file, 8, 1, row->density.ns);
        if (b->data_count) {
            print_number(file, 10, 0, bench_scene_bytes(b, row->model));
            print_number(file, 6, 4, row->smape);
        }
        fprintf(file, "\n");
    }
}

void bench_print(const void *of, FILE *file)
{
    const bench *b = of;
    int name = (int)strlen("model"), backend = (int)strlen("backend");
    for (int k = 0; k < b->row_count; k++) {
        int length = (int)strlen(b->rows[k].model->name), other = (int)strlen(b->rows[k].backend);
        name = length > name ? length : name;
        backend = other > backend ? other : backend;
    }
    print_heading(b, file);
    fprintf(file,
            "%-*s  %-5s  %-18s  %-*s  %-7s  %-15s  %-5s  %8s  %7s  %7s  %6s  %8s  %6s  %6s  %7s  "
            "%7s  %7s  "
            "%6s  %5s\n",
            name, "model", "net", "encoding", backend, "backend", "variant", "weights", "prec.",
            "ns/eval", "M/s", "x GGX", "% peak", "network", "% peak", "io", "compile", "first",
            "bytes", "SMAPE", "PSNR");
    for (int k = 0; k < b->row_count; k++)
        print_row(b, &b->rows[k], name, backend, file);
    print_uses(b, name, file);
    fprintf(file, "\nratios:\n");
    for (int k = 0; k < b->row_count; k++)
        print_ratios(b, &b->rows[k], file);
}

/* ---- For programs ---------------------------------------------------------------------------- */

static void write_csv_number(FILE *file, double value)
{
    if (isfinite(value))
        fprintf(file, ",%.6g", value);
    else
        putc(',', file);
}

static void write_csv_row(const bench *b, const bench_row *row, FILE *file)
{
    char net[16];
    figures f = figures_of(b, row);
    hnbrdf_write_csv_text(file, row->model->name);
    fprintf(file, ",%s,%s,%d,", bench_net(row->model, net), encoding_of(row),
            row->model->desc.latent);
    hnbrdf_write_csv_text(file, row->backend);
    fprintf(file, ",%s,%s,%s", row->variant, row->weights, row->precision);
    const double before[] = {f.ns, f.per_second, f.peak_fraction, f.ratio, row->compile_ms};
    for (int k = 0; k < 5; k++)
        write_csv_number(file, before[k]);
    fprintf(file, ",%zu,%zu", row->bytes, multiplications(row));
    const double after[] = {row->smape,   row->psnr, f.io_ns, f.network_ns, f.network_peak_fraction,
                            row->first_ms};
    for (int k = 0; k < 6; k++)
        write_csv_number(file, after[k]);
    write_csv_number(file, row->threads ? row->threads : (double)NAN);
    const double last[] = {f.network_muladd_fraction, row->draw.ns, row->density.ns,
                           bench_scene_bytes(b, row->model)};
    for (int k = 0; k < 4; k++)
        write_csv_number(file, last[k]);
    putc('\n', file);
}

void bench_write_csv(const void *of, FILE *file)
{
    const bench *b = of;
    fprintf(file, "%s\n", columns);
    for (int k = 0; k < b->row_count; k++)
        write_csv_row(b, &b->rows[k], file);
}

static void write_json_text(FILE *file, const char *name, const char *text)
{
    fprintf(file, "\"%s\": ", name);
    hnbrdf_write_json_text(file, text);
    fputs(", ", file);
}

static void write_json_number(FILE *file, const char *name, double value)
{
    if (isfinite(value))
        fprintf(file, "\"%s\": %.6g, ", name, value);
    else
        fprintf(file, "\"%s\": null, ", name);
}

static void write_json_row(const bench *b, const bench_row *row, FILE *file)
{
    char net[16];
    figures f = figures_of(b, row);
    fputs("    {", file);
    write_json_text(file, "model", row->model->name);
    write_json_text(file, "kind",
                    row->model->is_baseline ? "baseline" : hnbrdf_kind_name(row->model->desc.kind));
    write_json_text(file, "net", bench_net(row->model, net));
    write_json_text(file, "encoding", encoding_of(row));
    write_json_number(file, "latent", row->model->desc.latent);
    write_json_text(file, "backend", row->backend);
    write_json_text(file, "variant", row->variant);
    write_json_text(file, "weights", row->weights);
    write_json_text(file, "precision", row->precision);
    write_json_number(file, "ns_per_eval", f.ns);
    write_json_number(file, "evals_per_s", f.per_second);
    write_json_number(file, "peak_fraction", f.peak_fraction);
    write_json_number(file, "ratio_to_ggx", f.ratio);
    write_json_number(file, "compile_ms", row->compile_ms);
    write_json_number(file, "smape", row->smape);
    write_json_number(file, "psnr", row->psnr);
    write_json_number(file, "io_ns", f.io_ns);
    write_json_number(file, "net_ns", f.network_ns);
    write_json_number(file, "net_peak_fraction", f.network_peak_fraction);
    write_json_number(file, "net_muladd_fraction", f.network_muladd_fraction);
    write_json_number(file, "first_dispatch_ms", row->first_ms);
    write_json_number(file, "threads", row->threads ? row->threads : (double)NAN);
    write_json_number(file, "sample_ns", row->draw.ns);
    write_json_number(file, "density_ns", row->density.ns);
    write_json_number(file, "scene_bytes", bench_scene_bytes(b, row->model));
    fprintf(file, "\"bytes\": %zu, \"mults\": %zu}", row->bytes, multiplications(row));
}

void bench_write_json(const void *of, FILE *file)
{
    const bench *b = of;
    fputs("{\n  ", file);
    write_json_text(file, "command", b->command_line);
    write_json_text(file, "version", hnbrdf_version());
    write_json_text(file, "cpu", b->cpu);
    write_json_number(file, "processors", hnbrdf_processors());
    fputs("\"peaks\": [", file);
    for (int k = 0; k < b->peak_count; k++)
        fprintf(file, "%s{\"variant\": \"%s\", \"fma\": %.6g, \"muladd\": %.6g}", k ? ", " : "",
                b->peaks[k].variant, b->peaks[k].fma, b->peaks[k].muladd);
    fputs("], ", file);
    write_json_number(file, "rounds", (double)b->rounds);
    write_json_text(file, "sampler", hnbrdf_sampler_name(b->sampler));
    write_json_number(file, "pairs", (double)b->pairs);
    write_json_number(file, "sphere_pixels", (double)b->size);
    write_json_number(file, "sphere_samples", (double)b->spp);
    fputs("\n  \"rows\": [\n", file);
    for (int k = 0; k < b->row_count; k++) {
        write_json_row(b, &b->rows[k], file);
        fputs(k + 1 < b->row_count ? ",\n" : "\n", file);
    }
    fputs("  ]\n}\n", file);
}
