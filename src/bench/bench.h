/* bench.h: run time beside error: models, the rows of the table, and what is timed for them. */
#ifndef HNBRDF_BENCH_BENCH_H
#define HNBRDF_BENCH_BENCH_H

#include "base/probe.h"
#include "hnbrdf/measured.h"

#include <math.h>
#include <stdio.h>

/* Functions that return an hnbrdf_result leave a message in *error when it is not HNBRDF_OK. */

/* How far the long functions are. Zero-initialise; what is NULL is not called. */
typedef struct bench_watch {
    /* `what` is being done, `share` of it is, now on `detail`; anything but 0 stops. */
    int (*show)(void *user, const char *what, double share, const char *detail);
    void (*tell)(void *user, const char *line); /* a line about a device that was opened */
    void (*warn)(void *user, const char *line); /* why there are fewer rows than one may expect */
    void *user;
} bench_watch;

/* HNBRDF_OK, or HNBRDF_ERROR_CANCELLED where the callback says stop. */
hnbrdf_result bench_show(const bench_watch *watch, const char *what, double share,
                         const char *detail, hnbrdf_error *error);

enum { BENCH_NAME = 96, BENCH_MODELS = 32, BENCH_ROWS = 512, BENCH_DEVICES = 8 };

/* What one would pick instead of a model of this library. */
typedef enum bench_baseline {
    BENCH_MEASUREMENT = 0, /* by its reader */
    BENCH_TABLE,           /* of 90 x 90 x 180 values, trilinear, made of the measurement */
    BENCH_TWO_LOBES,       /* Lambert and two GGX lobes, fitted here */
    BENCH_NBRDF,           /* a network for each material (Sztrajman et al. 2021), where given */
    BENCH_BASELINES
} bench_baseline;

typedef struct bench_model {
    char name[BENCH_NAME]; /* of the file, without folder and extension; or KIND-HxN */
    hnbrdf_model *model;
    hnbrdf_model_desc desc;
    const hnbrdf_material *material; /* the one that is evaluated */
    double smape, psnr;              /* means over the materials that have data; NaN: unknown */
    double half_smape;               /* of the network in half precision; NaN without Vulkan */
    int is_baseline;                 /* 1: one of bench.baselines, `model` is NULL */
    /* of bench_peer_model(); NaN unless the encoding is `directions` */
    double peer_smape, peer_psnr;
} bench_model;

typedef struct bench_row {
    const bench_model *model;
    char backend[BENCH_NAME]; /* "c-single", "vulkan:llvmpipe ..." */
    const char *variant, *weights, *precision;
    hnbrdf_encoding encoding;
    int threads;                 /* 0: unknown, on real GPUs */
    hnbrdf_probe whole, network; /* network: the same with nothing but the network */
    hnbrdf_probe draw, density;  /* a direction with its density; a density; of single calls */
    const hnbrdf_probe *io;      /* of the row's buffers; NULL: it has none */
    double compile_ms, first_ms; /* NaN on the CPU */
    size_t bytes;
    double smape, psnr;
} bench_row;

/* What one thread can do with the instructions of this name, in FLOP/s: with fused multiply-adds,
 * and with multiplications and additions apart, as all of this library's arithmetic is. */
enum { BENCH_PEAKS = 8 };
typedef struct bench_peak {
    const char *variant;
    double fma, muladd;
} bench_peak;

typedef struct bench {
    bench_model models[BENCH_MODELS]; /* the first one is GGX alone, to compare with */
    int model_count;
    bench_row *rows; /* [BENCH_ROWS] */
    int row_count;
    bench_model baselines[BENCH_BASELINES];      /* those without a name are not wanted */
    hnbrdf_measured *const *data, *const *nbrdf; /* borrowed */
    int data_count, nbrdf_count;
    hnbrdf_probe io[BENCH_DEVICES];
    int io_count;
    bench_peak peaks[BENCH_PEAKS];
    int peak_count;
    const char *command_line;
    hnbrdf_sampler sampler;
    long pairs, size, spp, rounds;
    const char *cpu;
    bench_watch watch;
} bench;

/* ---- models.c -------------------------------------------------------------------------------- */

/* Models are added behind the place of GGX, called by the name of the file in `path`. Takes the
 * model over, also on failure. */
hnbrdf_result bench_add_model(bench *b, hnbrdf_model *model, const char *path, hnbrdf_error *error);

typedef struct bench_fit {
    int net[2]; /* net[1] layers of net[0] units */
    long steps; /* 0: by seconds */
    double seconds;
    int pool;
} bench_fit;
/* A model called hybrid-HxN. */
hnbrdf_result bench_fit_model(bench *b, hnbrdf_measured *const *data, int count,
                              const bench_fit *fit, hnbrdf_error *error);
/* GGX alone in its place: the analytic part of the first model that has one, else of default
 * materials. The last of these calls. */
hnbrdf_result bench_add_ggx(bench *b, hnbrdf_error *error);

/* ---- baselines.c ----------------------------------------------------------------------------- */

/* Wants them all, those of NBRDF networks where there are any. Networks go with the measurements
 * of their names; all of these are borrowed until the bench is freed. */
void bench_add_baselines(bench *b, hnbrdf_measured *const *data, int count,
                         hnbrdf_measured *const *nbrdf, int nbrdf_count);
/* "measurement", "table-90x90x180", "ggx-two-lobes", "nbrdf" */
const char *bench_baseline_name(bench_baseline baseline);
/* What all materials of the data take together: the network, and what each of them has, in single
 * precision. NaN without data. */
double bench_scene_bytes(const bench *b, const bench_model *model);

/* ---- rows.c ---------------------------------------------------------------------------------- */

/* Another row. Numbers are NaN, nothing is timed. */
hnbrdf_result bench_add_row(bench *b, const bench_model *model, const char *backend,
                            const char *variant, const char *weights, const char *precision,
                            bench_row **row, hnbrdf_error *error);
/* "16x2", or "none" for ggx. */
const char *bench_net(const bench_model *model, char text[16]);

/* ns of one evaluation less those of its buffers; of the network alone likewise; NaN where
 * unknown. */
double bench_ns(const bench_row *row);
double bench_network_ns(const bench_row *row);
/* The row of GGX alone on the same backend, variant and precision as far as there is one; NULL:
 * none. */
const bench_row *bench_ggx(const bench *b, const bench_row *row);
/* Multiplications and additions of the network in `ns`, as a share of what the row's threads
 * could do with its instructions (a software device's: with the widest there are), fused or not;
 * NaN where unknown. */
double bench_peak_fraction(const bench *b, const bench_row *row, double ns, int fused);

/* ---- measure.c ------------------------------------------------------------------------------- */

typedef struct bench_gpu_options {
    const char *device; /* a number, "all" or "none" */
    int peer;           /* rows in the published style too */
    long evaluations;
} bench_gpu_options;

/* Makes and times all rows: `rounds` samples of each, of at least sample_ns. */
hnbrdf_result bench_measure(bench *b, const bench_gpu_options *gpu, double sample_ns,
                            hnbrdf_error *error);
void bench_free(bench *b);

/* ---- rows_cpu.c ------------------------------------------------------------------------------ */

typedef struct bench_cpu bench_cpu;
/* Adds the rows of the C library. Close after timing, on failure too. */
hnbrdf_result bench_cpu_open(bench *b, bench_cpu **cpu, hnbrdf_error *error);
void bench_cpu_close(bench_cpu *cpu);
/* The processor's name, as far as the system tells. */
const char *bench_cpu_name(char name[BENCH_NAME]);

/* ---- rows_gpu.c ------------------------------------------------------------------------------ */

typedef struct bench_gpu bench_gpu;
/* Adds the rows of Vulkan devices, none where there is no Vulkan. Likewise. */
hnbrdf_result bench_gpu_open(bench *b, const bench_gpu_options *options, bench_gpu **gpu,
                             hnbrdf_error *error);
void bench_gpu_close(bench_gpu *gpu);

/* ---- peer.c ---------------------------------------------------------------------------------- */

/* A shader in the style of the published ones for the first materials of a hybrid model whose
 * hidden size is a multiple of 4; malloc'ed, NULL when memory is short. It defines what an
 * exported scene does. */
char *bench_peer_shader(const hnbrdf_model_desc *desc, int materials);
/* The model whose values that shader gives: every number with three decimals, isotropic, no
 * floor. NULL when memory is short. */
hnbrdf_model *bench_peer_model(const hnbrdf_model_desc *desc);

/* ---- quality.c ------------------------------------------------------------------------------- */

/* Fills smape and psnr of the models, and of their peers if `peers`. */
hnbrdf_result bench_measure_quality(bench *b, hnbrdf_measured *const *data, int count, int peers,
                                    hnbrdf_error *error);

/* ---- tables.c, plot.c: the argument is a bench ----------------------------------------------- */

void bench_print(const void *bench, FILE *file);
void bench_write_csv(const void *bench, FILE *file);
void bench_write_json(const void *bench, FILE *file);
/* SVG: error against run time. */
void bench_write_plot(const void *bench, FILE *file);

#endif
