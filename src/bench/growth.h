/* growth.h: how costs grow with the size of what they are paid for. */
#ifndef HNBRDF_BENCH_GROWTH_H
#define HNBRDF_BENCH_GROWTH_H

#include "bench/bench.h"

/* What was measured at one size. */
typedef struct growth_point {
    double size; /* H, N, l, materials, pairs */
    double cost; /* NaN: unknown */
    double work; /* the arithmetic: multiplications, numbers, materials; any unit */
} growth_point;

/* One cost against one size, sizes ascending. */
enum { GROWTH_POINTS = 8, GROWTH_SERIES = 64 };
typedef struct growth_series {
    const char *what, *unit, *against;
    growth_point points[GROWTH_POINTS];
    int count;
} growth_series;

typedef struct growth {
    growth_series series[GROWTH_SERIES];
    int count;
    const char *cpu;
    char device[BENCH_NAME]; /* "vulkan:NAME"; empty: none */
    int quick;
} growth;

/* e of cost = a size^e, by least squares of the logarithms; `last`: by the last two points alone.
 * NaN with fewer than two points that are above 0. */
typedef struct growth_exponents {
    double cost, work, last_cost, last_work;
} growth_exponents;
growth_exponents bench_growth_exponents(const growth_series *series);

typedef struct bench_growth_options {
    int quick;          /* a few small sizes */
    const char *device; /* as in bench_gpu_options; "all" is the first one */
    bench_watch watch;
} bench_growth_options;

/* Takes a minute or two. */
hnbrdf_result bench_growth(const bench_growth_options *options, growth *g, hnbrdf_error *error);

/* The argument is a growth: a table, a line each; CSV, a row a point. */
void bench_growth_print(const void *growth, FILE *file);
void bench_growth_write_csv(const void *growth, FILE *file);

/* ---- growth_series.c ------------------------------------------------------------------------- */

/* Another series without points. */
growth_series *bench_growth_add(growth *g, const char *what, const char *unit, const char *against);
void bench_growth_point(growth_series *series, double size, double cost, double work);

/* A size that is varied, and what a model is without that. */
typedef enum growth_axis {
    GROWTH_H = 0,
    GROWTH_N,
    GROWTH_L,
    GROWTH_MATERIALS,
    GROWTH_AXES
} growth_axis;
typedef struct growth_shape {
    int hidden, layers, latent, materials;
} growth_shape;
/* Shape k of an axis; 0 when there are no more. */
int bench_growth_shape(const growth *g, growth_axis axis, int k, growth_shape *shape);
const char *bench_growth_axis_name(growth_axis axis);
double bench_growth_size(growth_axis axis, const growth_shape *shape);
/* A hybrid with weights that mean nothing. */
hnbrdf_result bench_growth_model(const growth_shape *shape, hnbrdf_model **model,
                                 hnbrdf_error *error);

/* ---- The parts ------------------------------------------------------------------------------- */

/* growth_cpu.c: evaluation. growth_files.c: files, edits, names, export. growth_fit.c: fits.
 * growth_gpu.c: shaders. */
hnbrdf_result bench_growth_cpu(growth *g, const bench_watch *watch, hnbrdf_error *error);
hnbrdf_result bench_growth_files(growth *g, const bench_watch *watch, hnbrdf_error *error);
hnbrdf_result bench_growth_fit(growth *g, const bench_watch *watch, hnbrdf_error *error);
hnbrdf_result bench_growth_gpu(growth *g, const bench_growth_options *options, hnbrdf_error *error);

#endif
