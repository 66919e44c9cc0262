/* speed.c: how fast a fit was, how near to the machine's limit, and what bounds it. */
#include "bench/speed.h"

#include "bench/peak.h"

#include <math.h>
#include <string.h>

typedef struct part {
    const char *name, *title;
    double seconds;
} part;

enum { PARTS = 7 };

static void list_parts(const hnbrdf_fit_times *t, part parts[PARTS])
{
    const part all[PARTS] = {
        {"drawing", "drawing and looking up data", t->drawing},
        {"ggx", "fitting GGX", t->ggx},
        {"encoding", "encoding", t->encoding},
        {"network", "forward and backward", t->network},
        {"update", "gradient sum, steps", t->update},
        {"exchange", "talking to other processes", t->exchange},
        {"waiting", "waiting or other programs", t->waiting},
    };
    for (int k = 0; k < PARTS; k++)
        parts[k] = all[k];
}

bench_speed bench_speed_of(const hnbrdf_fit_report *report)
{
    bench_speed speed = {.report = report};
    if (report->flops > 0.0 && report->times.network > 0.0) {
        speed.kernel_flops =
            report->flops / report->ranks / report->times.network * report->threads;
        speed.peak = bench_fma_peak(report->threads);
        speed.muladd = bench_muladd_peak(report->threads);
    }
    return speed;
}

/* Of one process there are no others. */
static int is_told(const hnbrdf_fit_report *r, const part *p)
{
    return r->ranks > 1 || strcmp(p->name, "exchange") != 0;
}

static double share(double some, double whole)
{
    return whole > 0.0 ? some / whole : 0.0;
}

void bench_speed_print(const bench_speed *speed, FILE *file)
{
    const hnbrdf_fit_report *r = speed->report;
    part parts[PARTS];
    double all = r->threads * r->seconds;
    list_parts(&r->times, parts);
    if (r->pairs > 0.0) {
        fprintf(file,
                "speed: %.2f M pairs/s everything included, %.2f in the network stage, %d thread%s",
                share(r->pairs, r->seconds) * 1e-6, r->pairs_per_s * 1e-6, r->threads,
                r->threads == 1 ? "" : "s");
        if (r->ranks > 1)
            fprintf(file, " in each of %d processes; of the first one:", r->ranks);
        fputc('\n', file);
        fprintf(
            file,
            "network kernels (%s): %.1f GFLOP/s, %.0f %% of the FMA peak of %.0f (%s), %.0f %% of "
            "separate multiplications and additions\n",
            r->instructions, speed->kernel_flops * 1e-9,
            100.0 * share(speed->kernel_flops, speed->peak), speed->peak * 1e-9, bench_peak_name(),
            100.0 * share(speed->kernel_flops, speed->muladd));
    }
    fprintf(file, "time:");
    for (int k = 0; k < PARTS; k++)
        if (is_told(r, &parts[k]))
            fprintf(file, "%s %.0f %% %s", k ? "," : "", 100.0 * share(parts[k].seconds, all),
                    parts[k].title);
    fprintf(file, "\n");
}

/* JSON knows no NaN. */
static void write_number(double value, FILE *file)
{
    if (isfinite(value))
        fprintf(file, "%.9g", value);
    else
        fputs("null", file);
}

void bench_speed_write_json(const bench_speed *speed, FILE *file)
{
    const hnbrdf_fit_report *r = speed->report;
    part parts[PARTS];
    list_parts(&r->times, parts);
    fprintf(file, "{\"steps\": %ld, \"stopped\": %s, \"loss\": ", r->steps,
            r->stopped ? "true" : "false");
    write_number(r->final_loss, file);
    fprintf(file,
            ",\n \"set_backs\": %d, \"rate\": %.9g, \"best_step\": %ld, \"ggx_alone\": %s, "
            "\"best_loss\": ",
            r->set_backs, r->rate, r->best_step, r->ggx_alone ? "true" : "false");
    write_number(r->best_loss, file);
    fputs(", \"ggx_loss\": ", file);
    write_number(r->ggx_loss, file);
    fprintf(file,
            ",\n \"seconds\": %.6f, \"threads\": %d, \"instructions\": \"%s\",\n"
            " \"pairs\": %.0f, \"pairs_per_s\": %.0f, \"network_pairs_per_s\": %.0f,\n"
            " \"network_flops_per_s\": %.4g, \"fma_peak_flops_per_s\": %.4g, "
            "\"muladd_peak_flops_per_s\": %.4g,\n \"processor_seconds\": {",
            r->seconds, r->threads, r->instructions, r->pairs, share(r->pairs, r->seconds),
            r->pairs_per_s, speed->kernel_flops, speed->peak, speed->muladd);
    for (int k = 0; k < PARTS; k++)
        if (is_told(r, &parts[k]))
            fprintf(file, "%s\"%s\": %.6f", k ? ", " : "", parts[k].name, parts[k].seconds);
    fputs("}}\n", file);
}
