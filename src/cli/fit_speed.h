/* fit_speed.h: how fast a fit was, how near to the machine's limit, and what bounds it. */
#ifndef HNBRDF_CLI_FIT_SPEED_H
#define HNBRDF_CLI_FIT_SPEED_H

#include "hnbrdf/fit.h"

#include <stdio.h>

typedef struct fit_speed {
    const hnbrdf_fit_report *report;
    /* FLOP/s of the network's passes while they ran, on all threads together */
    double kernel_flops;
    /* FLOP/s that this machine can reach: fused, and multiplied and added apart */
    double peak, muladd;
} fit_speed;

/* Measures the machine's limit, about 0.1 s, if the fit trained a network. */
fit_speed fit_speed_of(const hnbrdf_fit_report *report);
/* A few lines for people. */
void fit_speed_print(const fit_speed *speed);
/* The same and the rest of the report as one JSON object. */
void fit_speed_write_json(const fit_speed *speed, FILE *file);

#endif
