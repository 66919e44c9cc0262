/* bench_probe.c: timing on a machine that others use too: many short samples in turn, the least
 * counts. */
#include "cli/bench.h"

#include "base/clock.h"

#include <math.h>

enum { MOST_REPEATS = 1 << 24 };

bench_probe bench_probe_make(double (*run)(void *context, long repeats), void *context,
                             long evaluations)
{
    return (bench_probe){
        .run = run, .context = context, .evaluations = evaluations, .ns = (double)NAN};
}

double bench_thread_ns(void)
{
    return 1e9 * hnbrdf_thread_seconds();
}

/* Takes one sample and keeps it if it is the best so far. */
static double sample(bench_probe *probe)
{
    double total = probe->run(probe->context, probe->repeats);
    double ns = total / (double)probe->repeats / (double)probe->evaluations;
    if (!isnan(ns) && !(probe->ns <= ns)) /* the first one replaces NaN */
        probe->ns = ns;
    return total;
}

/* Doubles the repeats until a sample is long enough; also warms up. */
static void choose_repeats(bench_probe *probe, double sample_ns)
{
    probe->repeats = 1;
    while (sample(probe) < sample_ns && probe->repeats < MOST_REPEATS)
        probe->repeats *= 2;
}

void bench_time(const bench_timing *timing, bench_probe *const *probes, int count)
{
    double steps = (double)count * (double)(timing->rounds + 2), done = 0.0;
    for (int k = 0; k < count; k++) {
        choose_repeats(probes[k], timing->sample_ns);
        timing->between(timing->user, (done += 2.0) / steps);
    }
    for (long round = 0; round < timing->rounds; round++)
        for (int k = 0; k < count; k++) {
            sample(probes[k]);
            timing->between(timing->user, (done += 1.0) / steps);
        }
}
