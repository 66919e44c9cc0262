/* trainer.h: a fit under way, shared by its stages (fit.c), the training of the network (train.c)
 * and checkpoints (checkpoint.c). */
#ifndef HNBRDF_FIT_TRAINER_H
#define HNBRDF_FIT_TRAINER_H

#include "fit/pool.h"
#include "base/threads.h"
#include "hnbrdf/fit.h"

#include <stdatomic.h>

/* gradients are summed in this many pieces, whatever the number of threads */
enum { FIT_CHUNKS = 16 };

typedef struct trainer {
    const hnbrdf_measured *const *data;
    hnbrdf_fit_options options; /* as given, defaults filled in */
    hnbrdf_encoding encoding;
    int count; /* materials */
    fit_layout layout;
    const fit_kernel *kernel;
    hnbrdf_threads *workers;
    fit_pool pool;
    hnbrdf_material *materials; /* [count], from the GGX stage */
    int *isotropic;             /* [count] */
    hnbrdf_fit_drawn *drawn;    /* [count] */
    double *encoded;            /* [count] processor seconds of encoding */
    /* [layout.count], twice for the moments, which follow on */
    float *parameters, *moments, *gradient;
    float *best; /* parameters of the best state so far */
    float *derived, *chunk_gradients, *scratch;
    double chunk_losses[FIT_CHUNKS];
    int *tile_material, *tile_index; /* [tiles a step] */
    int *order, *cursor;             /* [count] shuffled materials; the next tile of each */
    int tiles_per_step, order_at;
    float mix;
    /* State of the network stage besides the arrays: what a checkpoint holds. */
    hnbrdf_rng rng;
    long step, since; /* since: where it was last set back, or 0: Adam and warm-up start there */
    double share, peak, running; /* done, peak rate, running loss */
    double best_loss;            /* as judge.c measures it */
    long best_step;
    int best_dead, set_backs;
    double start_loss;   /* of the untrained state; known anew after a resume */
    atomic_int finished; /* pieces of the stage that are done */
    atomic_int undrawn;  /* 1: a material has too few valid measurements */
    double stage_started, shown;
    int stopped;
} trainer;

/* A stage starts: its clock and its count of finished pieces. */
void hnbrdf_fit_stage_begin(trainer *t);
/* Tell the caller how far a stage is, from the calling thread only; at most ten times a second
 * unless `always`. pairs is how many were handled since the stage began. */
void hnbrdf_fit_tell(trainer *t, const char *stage, double done, double loss, double pairs,
                     int always);

/* Loss and gradient of the mean over the pairs of tile_material and tile_index (gradient.c). */
double hnbrdf_fit_step_gradient(trainer *t);

/* judge.c: the start is the best state so far; a step was made, look at it if it is time; go back
 * to the best state at a lower rate; leave the best state there is in parameters, and say which.
 * All but set_back leave the choice of tiles, mix and gradient changed. */
void hnbrdf_fit_judge_start(trainer *t);
void hnbrdf_fit_judge(trainer *t);
void hnbrdf_fit_set_back(trainer *t);
void hnbrdf_fit_judge_end(trainer *t, hnbrdf_fit_report *report);

/* The network stage, from a fresh start or from a checkpoint. Fills steps, rate and loss of the
 * report. */
hnbrdf_result hnbrdf_fit_train(trainer *t, hnbrdf_fit_report *report, hnbrdf_error *error);

/* Write options.checkpoint, aside and renamed. */
hnbrdf_result hnbrdf_fit_checkpoint_save(const trainer *t, hnbrdf_error *error);
/* Go on from options.checkpoint. It must come from the same data, options and seed. */
hnbrdf_result hnbrdf_fit_checkpoint_load(trainer *t, hnbrdf_error *error);

#endif
