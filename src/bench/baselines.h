/* baselines.h: what one would pick instead of a model of this library, evaluated as one would. */
#ifndef HNBRDF_BENCH_BASELINES_H
#define HNBRDF_BENCH_BASELINES_H

#include "bench/bench.h"

/* ---- two_lobes.c ----------------------------------------------------------------------------- */

/* f is the sum of both; the second one has no kd. */
typedef struct bench_two_lobes {
    hnbrdf_material lobe[2];
} bench_two_lobes;

/* Starts at `one`, a GGX fit of the measurement, whose rotation and ratio of alphas stay. `ggx` is
 * a model of kind ggx. */
hnbrdf_result bench_two_lobes_fit(const hnbrdf_model *ggx, const hnbrdf_material *one,
                                  const hnbrdf_measured *measured, bench_two_lobes *fitted,
                                  hnbrdf_error *error);
/* All arrays [count][3] and packed; scratch as large as f. */
void bench_two_lobes_eval(const hnbrdf_model *ggx, const bench_two_lobes *lobes, size_t count,
                          const float *wi, const float *wo, float *f, float *scratch);

/* ---- baselines.c ----------------------------------------------------------------------------- */

/* One baseline of one material. */
typedef struct bench_stand_in {
    hnbrdf_measured *measured; /* its values */
    int owned;                 /* 1: to be closed */
    bench_two_lobes lobes;     /* of BENCH_TWO_LOBES alone */
} bench_stand_in;

/* Makes it: measured NULL where this material has none. bench_stand_in_close() frees it. */
hnbrdf_result bench_stand_in_open(const bench *b, bench_baseline baseline,
                                  hnbrdf_measured *measured, bench_stand_in *made,
                                  hnbrdf_error *error);
void bench_stand_in_close(bench_stand_in *stand_in);
/* The material of GGX alone that has this measurement's name; NULL: none. */
const hnbrdf_material *bench_ggx_material(const bench *b, const hnbrdf_measured *measured);

/* ---- rows_baselines.c ------------------------------------------------------------------------ */

typedef struct bench_baseline_rows bench_baseline_rows;
/* Adds their rows, on the first measurement. Close after timing, on failure too. */
hnbrdf_result bench_baseline_rows_open(bench *b, bench_baseline_rows **rows, hnbrdf_error *error);
void bench_baseline_rows_close(bench_baseline_rows *rows);

#endif
