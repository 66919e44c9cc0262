/* trainer.h: a fit under way, shared by its stages (fit.c), the training of the network (train.c)
 * and checkpoints (checkpoint.c). */
#ifndef HNBRDF_FIT_TRAINER_H
#define HNBRDF_FIT_TRAINER_H

#include "base/threads.h"
#include "fit/pool.h"
#include "fit/schedule.h"
#include "fit/share.h"
#include "fit/soap.h"
#include "hnbrdf/fit.h"

#include <stdatomic.h>

/* What everybody knows of a material. */
typedef struct fit_material {
    char name[HNBRDF_MAX_NAME + 1];
    int isotropic;
    double asymmetry; /* of f(wi, wo) against f(wo, wi); 0 where nobody asks for it */
} fit_material;

/* What its GGX fit made of a material. */
typedef struct fit_found {
    hnbrdf_material material;
    float parameters[FIT_ANALYTIC];
    hnbrdf_fit_search search;
} fit_found;

typedef struct trainer {
    const hnbrdf_measured *const *data;
    hnbrdf_fit_options options; /* as given, defaults filled in */
    hnbrdf_encoding encoding;
    int count; /* materials */
    fit_layout layout;
    const fit_kernel *kernel;
    hnbrdf_threads *workers;
    hnbrdf_communicator ranks; /* 0 of 1 where the fit is alone */
    int *owner;                /* [count] the rank whose material it is */
    int *held, held_count;     /* [held_count] the materials of this rank */
    int *at;                   /* [count] where in held; -1: nowhere */
    int lost;                  /* 1: another rank was not reached */
    int asked;                 /* 1: the callback of this rank asked to stop */
    hnbrdf_result trouble;     /* what this rank has to tell the others of */
    int troubled;              /* 1: some rank has */
    double exchange;           /* seconds with other ranks */
    double elapsed;            /* seconds of the stage, by the clock of rank 0 */
    fit_material *known;       /* [count] */
    fit_found *found;          /* [count], from the GGX stage */
    hnbrdf_fit_drawn *drawn;   /* [count] */
    double *encoded;           /* [held_count] processor seconds of encoding */
    fit_pool pool;             /* of the materials held */
    float *room;               /* [threads][FIT_GGX_TILES] where some are not kept */
    /* [layout.count], twice for the moments, which follow on */
    float *parameters, *moments, *gradient;
    float *best;   /* parameters of the best state so far */
    fit_soap soap; /* of the network; a frozen one has no use for it */
    float *derived, *scratch;
    /* A step: which tiles, where those of this rank lie, what comes of them (gradient.c). */
    fit_share shares;
    const int *tile_material;
    const float *const *tile_data;
    struct fit_sums *sums;
    double *losses; /* [tiles a step] */
    float mix;
    struct fit_supply *supply; /* where tiles come from (supply.c) */
    struct fit_frozen *frozen; /* searches on a network that stays (frozen.c) */
    double redrawing;          /* processor seconds of it */
    double stepping;           /* of SOAP's steps */
    /* State of the network stage besides the arrays: what a checkpoint holds. */
    fit_schedule schedule; /* of the step to come */
    long step, since; /* since: where it was last set back, or 0: Adam and warm-up start there */
    double share, peak, running; /* done, peak rate, running loss */
    double best_loss;            /* as judge.c measures it */
    long best_step;
    int best_dead, set_backs;
    double start_loss;   /* of the untrained state; known anew after a resume */
    atomic_int finished; /* pieces of the stage that are done */
    double stage_started, shown;
    int stopped; /* 1: a callback asked to stop, and all ranks know */
} trainer;

/* A stage starts: its clock and its count of finished pieces. */
void hnbrdf_fit_stage_begin(trainer *t);
double hnbrdf_fit_stage_seconds(const trainer *t);
/* Tell the caller how far a stage is, from the calling thread only; at most ten times a second
 * unless `always`. pairs is how many were handled since the stage began. */
void hnbrdf_fit_tell(trainer *t, const char *stage, double done, double loss, double pairs,
                     int always);

/* ---- options.c ------------------------------------------------------------------------------- */

/* What 0 stands for, and what is out of range. */
hnbrdf_result hnbrdf_fit_fill_options(hnbrdf_fit_options *options, int count, hnbrdf_error *error);

/* ---- ranks.c: talk among ranks, by all of them at the same time ------------------------------ */

int hnbrdf_fit_is_alone(const trainer *t);
/* The callbacks, with their time taken. 0 where a rank is lost, then and from then on. */
int hnbrdf_fit_gather(trainer *t, const void *mine, void *all, const size_t *bytes);
int hnbrdf_fit_exchange(trainer *t, const void *send, const size_t *send_bytes, void *received,
                        const size_t *received_bytes);
int hnbrdf_fit_broadcast(trainer *t, void *data, size_t bytes);
/* The error of a rank that is lost. */
hnbrdf_result hnbrdf_fit_fail_lost(const trainer *t, hnbrdf_error *error);
/* What every rank came to: the error of the first that failed, for all; else OK. From then on all
 * know whether to stop. */
hnbrdf_result hnbrdf_fit_agree(trainer *t, hnbrdf_result mine, hnbrdf_error *error);
/* records [count], of which each rank has filled in those of its materials: all of them to all. */
hnbrdf_result hnbrdf_fit_share_records(trainer *t, void *records, size_t size, hnbrdf_error *error);

/* ---- hold.c: who has which material, and what it is ------------------------------------------ */

/* Fills owner, held, at and known. Refuses ranks with other options. */
hnbrdf_result hnbrdf_fit_hold(trainer *t, hnbrdf_error *error);
/* The most accurate encoding for these data. */
hnbrdf_result hnbrdf_fit_choose_encoding(trainer *t, hnbrdf_error *error);

/* ---- supply.c -------------------------------------------------------------------------------- */

hnbrdf_result hnbrdf_fit_supply_make(trainer *t, hnbrdf_error *error);
void hnbrdf_fit_supply_free(trainer *t);
/* The tiles of the next step. 0 where a rank is lost. */
int hnbrdf_fit_supply_step(trainer *t);
/* The next step is that of t->schedule. */
void hnbrdf_fit_supply_restart(trainer *t);
/* The tiles of round r of the sample that judge.c sees, the first ones of all materials. */
/* Bytes of a tile on its way. */
size_t hnbrdf_fit_supply_tile_bytes(const fit_layout *layout);
int hnbrdf_fit_supply_rounds(const trainer *t);
void hnbrdf_fit_supply_round(trainer *t, int r);

/* ---- gradient.c ------------------------------------------------------------------------------ */

int hnbrdf_fit_sums_make(trainer *t);
void hnbrdf_fit_sums_free(trainer *t);
/* Bytes of a step: of gradients from one rank to another that adds them up, and of what a rank
 * tells all. */
size_t hnbrdf_fit_sums_sent(const fit_share *share, const fit_layout *layout, int from, int to);
size_t hnbrdf_fit_sums_gathered(const fit_share *share, const fit_layout *layout, int from);
/* Loss and gradient of the mean over the pairs of the step's tiles. Where a rank is lost, neither.
 */
double hnbrdf_fit_step_gradient(trainer *t);

/* ---- judge.c: the start is the best state so far; a step was made, look at it if it is time; go
 * back to the best state at a lower rate; leave the best state there is in parameters, and say
 * which. All but set_back leave the choice of tiles, mix and gradient changed. */
void hnbrdf_fit_judge_start(trainer *t);
void hnbrdf_fit_judge(trainer *t);
void hnbrdf_fit_set_back(trainer *t);
void hnbrdf_fit_judge_end(trainer *t, hnbrdf_fit_report *report);

/* ---- train.c, checkpoint.c, result.c --------------------------------------------------------- */

/* Floating-point operations of both passes over one pair; see hnbrdf_fit_report. */
double hnbrdf_fit_pair_flops(const fit_layout *layout);
/* The network stage, from a fresh start or from a checkpoint. Fills steps, rate and loss of the
 * report. */
hnbrdf_result hnbrdf_fit_train(trainer *t, hnbrdf_fit_report *report, hnbrdf_error *error);

/* The same on a network that stays. */
hnbrdf_result hnbrdf_fit_frozen(trainer *t, hnbrdf_fit_report *report, hnbrdf_error *error);
void hnbrdf_fit_frozen_free(trainer *t);

/* Write options.checkpoint, aside and renamed. */
hnbrdf_result hnbrdf_fit_checkpoint_save(const trainer *t, hnbrdf_error *error);
/* Go on from options.checkpoint, which rank 0 reads. It must come from the same data, options and
 * seed. */
hnbrdf_result hnbrdf_fit_checkpoint_load(trainer *t, hnbrdf_error *error);

/* The model of what was found and trained, with lobes. */
hnbrdf_result hnbrdf_fit_result(trainer *t, hnbrdf_model **model, hnbrdf_fit_report *report,
                                hnbrdf_error *error);

/* alone.c: of the materials [count] of a hybrid as desc has it, gives those that are worse than
 * `ggx` [count] its parameters and the code that turns the network off. Fills options.worth and the
 * counts of the report. */
hnbrdf_result hnbrdf_fit_leave_alone(trainer *t, const hnbrdf_model_desc *desc,
                                     const hnbrdf_material *ggx, hnbrdf_material *materials,
                                     hnbrdf_fit_report *report, hnbrdf_error *error);

#endif
