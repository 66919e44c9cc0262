/* task.h: what the files of this room share: the task, the candidates, and what came of them. */
#ifndef HNBRDF_BAKE_TASK_H
#define HNBRDF_BAKE_TASK_H

#include "base/error.h"
#include "hnbrdf/bake.h"
#include "hnbrdf/fit.h"

#include <stdatomic.h>

typedef struct bake_task {
    const hnbrdf_model *model;
    hnbrdf_bake_options options; /* with the numbers that 0 stands for */
    int encoding, latent;        /* -1: chosen */
    int *chosen;                 /* [count] materials of the model */
    int count, from_data, keep;
    const hnbrdf_measured **reference; /* [count] what is learned from and judged by */
    hnbrdf_measured **teachers;        /* [count] the same of a teacher; or NULL */
    double started;
    hnbrdf_material *analytic;    /* [count] */
    hnbrdf_bake_size *candidates; /* by multiplications, GGX first */
    int candidate_count;
    hnbrdf_bake_report report;
    hnbrdf_model **models; /* [report.row_count] */
    atomic_int stopped;    /* 1: the callback said so */
    hnbrdf_result lost;    /* not OK: another rank is */
    hnbrdf_error lost_error;
    atomic_flag telling; /* set while a thread is in the callback */
} bake_task;

/* All functions that return an hnbrdf_result leave a message in *error when it is not HNBRDF_OK. */

/* ---- options.c ------------------------------------------------------------------------------- */

/* Refuses what is out of range; copies the options into the task, with what 0 stands for. */
hnbrdf_result hnbrdf_bake_take_options(bake_task *b, const hnbrdf_bake_options *options,
                                       hnbrdf_error *error);

/* ---- teacher.c: a material of a model as something to fit to --------------------------------- */

/* The model must outlive it. */
hnbrdf_result hnbrdf_bake_teacher(const hnbrdf_model *model, int material,
                                  hnbrdf_measured **measured, hnbrdf_error *error);

/* ---- half.c ---------------------------------------------------------------------------------- */

/* A hybrid with the weights of an export in half precision; NULL when memory is short. */
hnbrdf_model *hnbrdf_bake_half(const hnbrdf_model *model);
/* Whether this size is within max_ns in half precision alone. */
int hnbrdf_bake_needs_half(const bake_task *b, const hnbrdf_bake_size *size);

/* ---- lobes.c: what candidates are fitted without --------------------------------------------- */

/* *model with lobes of its materials, in place of *model. */
hnbrdf_result hnbrdf_bake_lobes(bake_task *b, hnbrdf_model **model, hnbrdf_error *error);

/* ---- tell.c: the progress callback ----------------------------------------------------------- */

/* From any thread; a call that meets another one is left out. Returns hnbrdf_bake_is_stopped(). */
int hnbrdf_bake_tell(bake_task *b, const hnbrdf_bake_progress *progress);
/* Says that the last row is new. */
void hnbrdf_bake_tell_row(bake_task *b, hnbrdf_bake_stage stage);
int hnbrdf_bake_is_stopped(const bake_task *b);

/* ---- sizes.c: candidates, and what they cost ------------------------------------------------- */

/* Makes b->candidates and measures the time of each and of the model. */
hnbrdf_result hnbrdf_bake_make_candidates(bake_task *b, hnbrdf_error *error);
/* How many encodings each network is tried with. */
int hnbrdf_bake_encoding_count(const bake_task *b);
int hnbrdf_bake_same_size(const hnbrdf_bake_size *x, const hnbrdf_bake_size *y);

/* ---- rows.c: what was made, and how good it is ----------------------------------------------- */

/* errors [count]: of the model's material at[m], or m where at is NULL. */
hnbrdf_result hnbrdf_bake_measure(const bake_task *b, const hnbrdf_model *model, const int *at,
                                  size_t pairs, hnbrdf_comparison *errors, hnbrdf_error *error);
/* Means and the highest of row->errors into the row. */
void hnbrdf_bake_summarise(const bake_task *b, hnbrdf_bake_row *row);
/* Adds the row and tells so. Takes model and row->errors over, also on failure. */
hnbrdf_result hnbrdf_bake_add_row(bake_task *b, const hnbrdf_bake_row *row, hnbrdf_model *model,
                                  hnbrdf_bake_stage stage, hnbrdf_error *error);
/* The judged error of the picked row with weights in half precision; NaN for GGX or when memory is
 * short. */
double hnbrdf_bake_half_error(const bake_task *b);

/* ---- ggx.c ----------------------------------------------------------------------------------- */

/* The analytic part of every material into b->analytic, and GGX alone as the first row. */
hnbrdf_result hnbrdf_bake_ggx(bake_task *b, hnbrdf_error *error);

/* ---- wave.c: several fits at once ------------------------------------------------------------ */

/* One fit to make: which candidate, from which seed, for how long. */
typedef struct bake_job {
    const hnbrdf_bake_size *size;
    uint64_t seed;
    int full;
} bake_job;

/* How many fits run at once. */
int hnbrdf_bake_width(const bake_task *b, int full);
/* Makes the fits and adds a row for each candidate among them: the best of its seeds. `seconds`:
 * for each fit, 0: by steps. What was stopped too early gives no row. */
hnbrdf_result hnbrdf_bake_wave(bake_task *b, const bake_job *jobs, int count, double seconds,
                               hnbrdf_error *error);

/* ---- ranks.c: by all ranks at the same time -------------------------------------------------- */

/* 0 of 1 where the bake is alone. */
int hnbrdf_bake_rank(const bake_task *b);
int hnbrdf_bake_rank_count(const bake_task *b);
/* What rank `from` has, to all. */
hnbrdf_result hnbrdf_bake_spread(const bake_task *b, int from, void *data, size_t bytes,
                                 hnbrdf_error *error);
/* The same of a model; the others get one of their own. */
hnbrdf_result hnbrdf_bake_spread_model(const bake_task *b, int from, hnbrdf_model **model,
                                       hnbrdf_error *error);

/* ---- search.c -------------------------------------------------------------------------------- */

/* Tries candidates until the wish is met, the time is up or the callback stops it; sets picked,
 * reason, met and end of the report. */
hnbrdf_result hnbrdf_bake_search(bake_task *b, hnbrdf_error *error);

#endif
