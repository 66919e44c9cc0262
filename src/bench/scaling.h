/* scaling.h: what a fit on many ranks would exchange, on paper. */
#ifndef HNBRDF_BENCH_SCALING_H
#define HNBRDF_BENCH_SCALING_H

#include "hnbrdf/fit.h"

#include <stdio.h>

/* CSV, a row for each network, size of batch and number of ranks (1, 10, 100, 1000); lines before
 * it say what it rests on. Takes a second a network, to measure its speed. */
hnbrdf_result bench_scaling_print(const int (*nets)[2], int count, FILE *file, hnbrdf_error *error);

#endif
