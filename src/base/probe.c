/* probe.c: timing on a machine that others use too: many short samples in turn, the least
 * counts. */
#include "base/probe.h"

#include "base/clock.h"

#include <math.h>

enum { MOST_REPEATS = 1 << 24 };

hnbrdf_probe hnbrdf_probe_make(double (*run)(void *context, long repeats), void *context,
                               long evaluations)
{
    return (hnbrdf_probe){
        .run = run, .context = context, .evaluations = evaluations, .ns = (double)NAN};
}

hnbrdf_probe hnbrdf_probe_of_thread(void (*once)(void *context), void *context, long evaluations)
{
    return (hnbrdf_probe){
        .once = once, .context = context, .evaluations = evaluations, .ns = (double)NAN};
}

static double run(const hnbrdf_probe *probe)
{
    if (probe->run)
        return probe->run(probe->context, probe->repeats);
    const double started = hnbrdf_thread_seconds();
    for (long k = 0; k < probe->repeats; k++)
        probe->once(probe->context);
    return 1e9 * (hnbrdf_thread_seconds() - started);
}

/* Takes one sample and keeps it if it is the best so far. */
static double sample(hnbrdf_probe *probe)
{
    double total = run(probe);
    double ns = total / (double)probe->repeats / (double)probe->evaluations;
    if (!isnan(ns) && !(probe->ns <= ns)) /* the first one replaces NaN */
        probe->ns = ns;
    return total;
}

/* Doubles the repeats until a sample is long enough; also warms up. */
static void choose_repeats(hnbrdf_probe *probe, double sample_ns)
{
    probe->repeats = 1;
    while (sample(probe) < sample_ns && probe->repeats < MOST_REPEATS)
        probe->repeats *= 2;
}

void hnbrdf_time_probes(const hnbrdf_timing *timing, hnbrdf_probe *const *probes, int count)
{
    double steps = (double)count * (double)(timing->rounds + 2), done = 0.0;
    for (int k = 0; k < count; k++) {
        choose_repeats(probes[k], timing->sample_ns);
        if (timing->between(timing->user, (done += 2.0) / steps))
            return;
    }
    for (long round = 0; round < timing->rounds; round++)
        for (int k = 0; k < count; k++) {
            sample(probes[k]);
            if (timing->between(timing->user, (done += 1.0) / steps))
                return;
        }
}
