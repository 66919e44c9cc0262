/* bake.h: what the parts of `hnbrdf bake` share: the task, the candidates, and what was tried. */
#ifndef HNBRDF_CLI_BAKE_H
#define HNBRDF_CLI_BAKE_H

#include "cli/cli.h"
#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"

/* What is asked for. */
typedef enum bake_wish {
    BAKE_ERROR = 0, /* the fewest multiplications with an error of at most max_error */
    BAKE_TIME,      /* the lowest error within max_ns an evaluation */
    BAKE_AUTO,      /* the lowest product of error and time */
    BAKE_NET        /* the network net[] */
} bake_wish;

/* A size that a network may have; hidden 0 is GGX alone. */
typedef struct bake_candidate {
    int hidden, layers, latent;
    size_t mults, weights; /* as hnbrdf_model_multiplications(), hnbrdf_model_weight_count() */
    double ns;             /* an evaluation by hnbrdf_eval_batch() on one thread of this machine */
} bake_candidate;

/* A model that was made, by a short fit, a full one, or none (GGX). Errors are SMAPE. */
typedef struct bake_row {
    const bake_candidate *candidate;
    int full; /* 1: trained to the full length; of GGX always */
    long steps, seed;
    double seconds;                /* of the fit */
    double smape, worst, analytic; /* mean and highest over the materials; mean of f_a alone */
    hnbrdf_encoding encoding;
    hnbrdf_comparison *errors; /* [materials] */
    hnbrdf_model *model;
} bake_row;

typedef struct bake {
    /* The task. */
    const char *path; /* of `model`, for messages */
    const hnbrdf_model *model;
    const int *chosen; /* [count] materials of the model */
    /* [count] what is learned and judged by: measurements, or the model */
    hnbrdf_measured **reference;
    int count;
    int from_data; /* 1: the reference is measured */
    int keep;      /* 1: kd, eta, alpha and rotation stay the model's; 0: fitted to the reference */
    bake_wish wish;
    double max_error, max_ns;
    int net[2];
    int latent; /* -1: chosen */
    int worst;  /* 1: max_error holds for every material, 0: for their mean */
    /* How. */
    int sampler, encoding; /* encoding -1: by the data */
    long pairs, steps, short_steps, restarts, seed, threads, pool;
    double seconds; /* for all; 0: by steps */
    /* What came of it. */
    double started;
    hnbrdf_material *analytic;               /* [count] */
    bake_candidate reference_size;           /* the model's own */
    double reference_smape, reference_worst; /* NaN where the reference is the model itself */
    bake_candidate *candidates;              /* by multiplications, GGX first */
    int candidate_count;
    bake_row *rows; /* in the order made */
    int row_count;
    int picked;  /* of rows; -1: none */
    double half; /* bake_half_error() of it */
    int met;     /* 1: the picked row is what was asked for */
    int stopped; /* 1: interrupted or out of time */
    int (*told)(const struct bake *b, const bake_row *row); /* after each row; not 0 ends all */
} bake;

/* ---- bake_teacher.c: a material of a model as something to fit to ---------------------------- */

/* The model must outlive it. 0, or CLI_FAILURE after a message. */
int bake_teacher(const hnbrdf_model *model, int material, hnbrdf_measured **measured);

/* ---- bake_half.c ----------------------------------------------------------------------------- */

/* The model with the weights of an export in half precision; NULL when memory is short. */
hnbrdf_model *bake_half(const hnbrdf_model *model);

/* ---- bake_sizes.c: candidates, and what they cost -------------------------------------------- */

/* Makes b->candidates and measures the time of each and of the model. Likewise. */
int bake_make_candidates(bake *b);

/* ---- bake_fit.c: one wave of fits ------------------------------------------------------------ */

/* One fit to make: which candidate, from which seed, for how long. */
typedef struct bake_job {
    const bake_candidate *candidate;
    long seed;
    int full;
} bake_job;

/* Stops the fits as soon as it is set to 1 by a signal. */
void bake_catch_interrupts(int on);
int bake_interrupted(void);

/* The analytic part of every material into b->analytic, and GGX alone as the first row. Likewise.
 * */
int bake_ggx(bake *b);
/* Makes the fits, several at once, and adds a row for each candidate among them: the best of its
 * seeds. `seconds`: for each fit, 0: by steps. What an interrupt stops gives no row. Likewise. */
int bake_wave(bake *b, const bake_job *jobs, int count, double seconds);
/* SMAPE of the picked row with weights in half precision, as it is judged; NAN for GGX or when
 * memory is short. */
double bake_half_error(const bake *b);
/* How many fits run at once. */
int bake_width(const bake *b, int full);
/* The error that the wish is about. */
double bake_judged(const bake *b, const bake_row *row);

/* ---- bake_search.c --------------------------------------------------------------------------- */

/* Tries candidates until the wish is met, the time is up or Ctrl-C; sets picked, met and stopped.
 * 0, or CLI_FAILURE after a message. */
int bake_search(bake *b);

/* ---- bake_tables.c, bake_plot.c -------------------------------------------------------------- */

void bake_print_heading(const bake *b);
void bake_print_row(const bake *b, const bake_row *row);
void bake_print_result(const bake *b, const char *output);
void bake_write_csv(const bake *b, FILE *file);
void bake_write_json(const bake *b, FILE *file);
/* SVG: error against time of every row, limits, and the picked one. */
void bake_write_plot(const bake *b, FILE *file);
/* "8x2" or "ggx". */
void bake_size_name(const bake_candidate *candidate, char text[16]);

#endif
