/* measure.c: makes all rows and times them, with the peaks of this machine along the way. */
#include "base/clock.h"
#include "base/error.h"
#include "bench/baselines.h"
#include "bench/peak.h"

#include <stdlib.h>
#include <string.h>

typedef struct timing {
    bench *b;
    double peak_seconds; /* when the peak was measured last */
    hnbrdf_result result;
    hnbrdf_error *error;
} timing;

/* Peaks are measured again and again along the way: the clock rate changes within a run. */
static int between(void *user, double share)
{
    timing *t = user;
    t->result = bench_show(&t->b->watch, "timing", share, "", t->error);
    if (t->result || hnbrdf_seconds() - t->peak_seconds < 1.0)
        return t->result != HNBRDF_OK;
    for (int k = 0; k < t->b->peak_count; k++) {
        double fma, muladd;
        bench_peak *peak = &t->b->peaks[k];
        bench_peaks_of(peak->variant, &fma, &muladd);
        peak->fma = fmax(peak->fma, fma);
        peak->muladd = fmax(peak->muladd, muladd);
    }
    t->peak_seconds = hnbrdf_seconds();
    return 0;
}

static void choose_peaks(bench *b)
{
    for (int v = HNBRDF_VARIANT_PLAIN; hnbrdf_variant_name((hnbrdf_variant)v); v++)
        if (hnbrdf_variant_available((hnbrdf_variant)v) && b->peak_count < BENCH_PEAKS)
            b->peaks[b->peak_count++].variant = hnbrdf_variant_name((hnbrdf_variant)v);
}

static hnbrdf_result time_rows(bench *b, double sample_ns, hnbrdf_error *error)
{
    hnbrdf_probe **probes = calloc(4 * BENCH_ROWS + BENCH_DEVICES, sizeof *probes);
    int count = 0;
    if (!probes)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    choose_peaks(b);
    for (int k = 0; k < b->io_count; k++)
        probes[count++] = &b->io[k];
    for (int k = 0; k < b->row_count; k++) {
        probes[count++] = &b->rows[k].whole;
        hnbrdf_probe *const others[] = {&b->rows[k].network, &b->rows[k].draw, &b->rows[k].density};
        for (int i = 0; i < 3; i++)
            if (others[i]->evaluations > 0)
                probes[count++] = others[i];
    }
    timing t = {.b = b, .peak_seconds = -2.0, .error = error};
    const hnbrdf_timing how = {
        .sample_ns = sample_ns, .rounds = b->rounds, .between = between, .user = &t};
    hnbrdf_time_probes(&how, probes, count);
    free(probes);
    return t.result;
}

hnbrdf_result bench_measure(bench *b, const bench_gpu_options *options, double sample_ns,
                            hnbrdf_error *error)
{
    bench_cpu *cpu = NULL;
    bench_gpu *gpu = NULL;
    bench_baseline_rows *baselines = NULL;
    b->rows = calloc(BENCH_ROWS, sizeof *b->rows);
    if (!b->rows)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    hnbrdf_result result = bench_cpu_open(b, &cpu, error);
    if (!result)
        result = bench_baseline_rows_open(b, &baselines, error);
    if (!result)
        result = bench_gpu_open(b, options, &gpu, error);
    if (!result)
        result = time_rows(b, sample_ns, error);
    bench_gpu_close(gpu);
    bench_baseline_rows_close(baselines);
    bench_cpu_close(cpu);
    return result;
}

void bench_free(bench *b)
{
    for (int k = 0; k < b->model_count; k++)
        hnbrdf_model_free(b->models[k].model);
    free(b->rows);
    memset(b, 0, sizeof *b);
}
