/* bench.h: what the parts of `hnbrdf bench` share: models, rows of the table, and what is timed for
 * them. */
#ifndef HNBRDF_CLI_BENCH_H
#define HNBRDF_CLI_BENCH_H

#include "cli/cli.h"

/* ---- bench_probe.c: timing ------------------------------------------------------------------- */

/* One thing that is timed. */
typedef struct bench_probe {
    double (*run)(void *context,
                  long repeats); /* ns that so many repeats took; NaN: cannot be measured */
    void *context;
    long evaluations; /* of one repeat */
    long repeats;     /* of one sample; chosen by bench_time() */
    double ns;        /* of one evaluation, the least of all samples; NaN before */
} bench_probe;

/* NULL without run: nothing to time. */
bench_probe bench_probe_make(double (*run)(void *context, long repeats), void *context,
                             long evaluations);

/* Samples of at least `sample_ns` each, of every probe in turn, `rounds` times: what disturbs the
 * machine for a while disturbs all of them alike, and the least time is the least disturbed one.
 * between is called after each sample with the share that is done. */
typedef struct bench_timing {
    double sample_ns;
    long rounds;
    void (*between)(void *user, double share);
    void *user;
} bench_timing;
void bench_time(const bench_timing *timing, bench_probe *const *probes, int count);

/* Nanoseconds of this thread alone, in which others that want the processor do not count. */
double bench_thread_ns(void);

/* ---- The models and the table ---------------------------------------------------------------- */

enum { BENCH_NAME = 96, BENCH_MODELS = 32, BENCH_ROWS = 512, BENCH_DEVICES = 8 };

typedef struct bench_model {
    char name[BENCH_NAME]; /* of the file, without folder and extension; or KIND-HxN */
    hnbrdf_model *model;
    hnbrdf_model_desc desc;
    const hnbrdf_material *material; /* the one that is evaluated */
    double smape, psnr;              /* means over the materials that have data; NaN: unknown */
    double half_smape;               /* of the network in half precision; NaN without Vulkan */
    /* of bench_peer_model(); NaN unless the encoding is `directions` */
    double peer_smape, peer_psnr;
} bench_model;

typedef struct bench_row {
    const bench_model *model;
    char backend[BENCH_NAME]; /* "c-single", "vulkan:llvmpipe ..." */
    const char *variant, *weights, *precision;
    hnbrdf_encoding encoding;
    int threads;                 /* 0: unknown, on real GPUs */
    bench_probe whole, network;  /* network: the same with nothing but the network */
    const bench_probe *io;       /* of the row's buffers; NULL: it has none */
    double compile_ms, first_ms; /* NaN on the CPU */
    size_t bytes;
    double smape, psnr;
} bench_row;

/* What one thread can do with the instructions of this name, in FLOP/s: with fused multiply-adds,
 * and with multiplications and additions apart, as all of this library's arithmetic is. */
enum { BENCH_PEAKS = 6 };
typedef struct bench_peak {
    const char *variant;
    double fma, muladd;
} bench_peak;

typedef struct bench {
    bench_model models[BENCH_MODELS]; /* the first one is GGX alone, to compare with */
    int model_count;
    bench_row *rows; /* [BENCH_ROWS] */
    int row_count;
    bench_probe io[BENCH_DEVICES];
    int io_count;
    bench_peak peaks[BENCH_PEAKS];
    int peak_count;
    const char *command_line;
    int sampler;
    long pairs, size, spp, rounds;
    const char *cpu;
} bench;

/* Another row, or NULL after a message. Numbers are NaN, nothing is timed. */
bench_row *bench_add_row(bench *b, const bench_model *model, const char *backend,
                         const char *variant, const char *weights, const char *precision);
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

/* ---- bench_cpu.c ----------------------------------------------------------------------------- */

typedef struct bench_cpu bench_cpu;
/* Adds the rows of the C library. NULL after a message; close after bench_time(). */
bench_cpu *bench_cpu_open(bench *b);
void bench_cpu_close(bench_cpu *cpu);
/* The processor's name, as far as the system tells. */
const char *bench_cpu_name(void);

/* ---- bench_gpu.c ----------------------------------------------------------------------------- */

typedef struct bench_gpu bench_gpu;
typedef struct bench_gpu_options {
    const char *device; /* a number, "all" or "none" */
    int peer;           /* rows in the published style too */
    long evaluations;
} bench_gpu_options;
/* Adds the rows of Vulkan devices, none where there is no Vulkan. NULL after a message. */
bench_gpu *bench_gpu_open(bench *b, const bench_gpu_options *options);
void bench_gpu_close(bench_gpu *gpu);

/* ---- bench_peer.c ---------------------------------------------------------------------------- */

/* A shader in the style of the published ones for the first materials of a hybrid model whose
 * hidden size is a multiple of 4; malloc'ed, NULL when memory is short. It defines what an
 * exported scene does. */
char *bench_peer_shader(const hnbrdf_model_desc *desc, int materials);
/* The model whose values that shader gives: every number with three decimals, isotropic, no
 * floor. NULL when memory is short. */
hnbrdf_model *bench_peer_model(const hnbrdf_model_desc *desc);

/* ---- bench_quality.c ------------------------------------------------------------------------- */

/* Fills smape and psnr of the models, and of their peers if `peers`. 0, or CLI_FAILURE after a
 * message. */
int bench_measure_quality(bench *b, const cli_data *data, int peers);

/* ---- bench_write.c, bench_plot.c ------------------------------------------------------------- */

void bench_print(const bench *b);
void bench_write_csv(const bench *b, FILE *file);
void bench_write_json(const bench *b, FILE *file);
/* SVG: error against run time. */
void bench_write_plot(const bench *b, FILE *file);

#endif
