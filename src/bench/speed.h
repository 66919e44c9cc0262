/* speed.h: how fast a fit was, how near to the machine's limit, and what bounds it. */
#ifndef HNBRDF_BENCH_SPEED_H
#define HNBRDF_BENCH_SPEED_H

#include "hnbrdf/fit.h"

#include <stdio.h>

typedef struct bench_speed {
    const hnbrdf_fit_report *report;
    /* FLOP/s of the network's passes while they ran, on all threads of this process together */
    double kernel_flops;
    /* FLOP/s that this machine can reach: fused, and multiplied and added apart */
    double peak, muladd;
} bench_speed;

/* Measures the machine's limit, about 0.1 s, if the fit trained a network. */
bench_speed bench_speed_of(const hnbrdf_fit_report *report);
/* A few lines for people. */
void bench_speed_print(const bench_speed *speed, FILE *file);
/* The same and the rest of the report as one JSON object. */
void bench_speed_write_json(const bench_speed *speed, FILE *file);

#endif
