/* probe.h: timing on a machine that others use too: many short samples in turn, the least
 * counts. */
#ifndef HNBRDF_BASE_PROBE_H
#define HNBRDF_BASE_PROBE_H

/* One thing that is timed. */
typedef struct hnbrdf_probe {
    /* ns that so many repeats took; NaN: cannot be measured */
    double (*run)(void *context, long repeats);
    void (*once)(void *context); /* instead of run: one repeat, by the clock of this thread */
    void *context;
    long evaluations; /* of one repeat; 0: nothing to time */
    long repeats;     /* of one sample; chosen by hnbrdf_time_probes() */
    double ns;        /* of one evaluation, the least of all samples; NaN before */
} hnbrdf_probe;

hnbrdf_probe hnbrdf_probe_make(double (*run)(void *context, long repeats), void *context,
                               long evaluations);
hnbrdf_probe hnbrdf_probe_of_thread(void (*once)(void *context), void *context, long evaluations);

/* Samples of at least `sample_ns` each, of every probe in turn, `rounds` times: what disturbs the
 * machine for a while disturbs all of them alike, and the least time is the least disturbed one.
 * between is called after each sample with the share that is done; anything but 0 ends it. */
typedef struct hnbrdf_timing {
    double sample_ns;
    long rounds;
    int (*between)(void *user, double share);
    void *user;
} hnbrdf_timing;
void hnbrdf_time_probes(const hnbrdf_timing *timing, hnbrdf_probe *const *probes, int count);

#endif
