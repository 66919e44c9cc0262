/* frozen.h: a fit on a network that stays, under way. Every material is a problem of its own: few
 * numbers, found by several searches (descent.h), at first many on a few pairs, then the best on
 * more, and in the end one that is pulled more and less strongly towards right pictures. */
#ifndef HNBRDF_FIT_FROZEN_H
#define HNBRDF_FIT_FROZEN_H

#include "fit/descent.h"
#include "fit/trainer.h"
#include "fit/views.h"

enum { FIT_STARTS = 16, FIT_PULLS = 4, FIT_PHASES = 3 };

/* As long as the share done is below `until`, so many searches go on, each on so many tiles, with
 * this mix of losses (kernel.h). `width` is that of kernel.own(). */
typedef struct fit_phase {
    double until;
    int searches, tiles;
    float mix, width;
    double pulls[FIT_PULLS]; /* of searches 0, 1, ..., in turn; 0 throughout: no pictures */
} fit_phase;
extern const fit_phase hnbrdf_fit_phases[FIT_PHASES];

/* The searches of one material. No pointers. */
typedef struct fit_searches {
    int64_t phase, count;
    fit_point point[FIT_STARTS];
} fit_searches;

/* Of a chunk of tiles or of pixels and one search. */
typedef struct fit_chunk_sums {
    double loss, alone, squares[FIT_LIGHTS];
} fit_chunk_sums;

/* Chunks of one material, first those of tiles, then those of pixels, for one thread. */
typedef struct fit_unit {
    int held, first, chunks;
} fit_unit;

struct fit_frozen {
    fit_searches *of;            /* [count] those of this rank are up to date */
    float *rows;                 /* see kernel.own_rows */
    fit_views *views;            /* [held] */
    float *normals;              /* [held][slots][normal_size] */
    fit_chunk_sums *sums;        /* [held][slots] */
    size_t normal_size;          /* of one, and of the second one of the analytic part alone */
    double *ggx;                 /* [held] SMAPE of GGX over the tiles of the phase */
    int slots, phase, ggx_phase; /* ggx_phase: of ggx; -1: none */
    fit_unit *units;
    int unit_count;
    float most;   /* see fit_unknowns */
    double pairs; /* looked at so far by this rank, those of pixels included */
};

/* ---- look.c ---------------------------------------------------------------------------------- */

/* Numbers that every search of a material has. */
fit_unknowns hnbrdf_fit_unknowns_of(const trainer *t, int material);
/* Slots that a material needs, at most. */
int hnbrdf_fit_slots(void);
/* The loss of a code at the start, over some tiles. */
double hnbrdf_fit_loss_of(trainer *t, const float *own, const float *const *tiles, int count,
                          float *scratch);
/* All searches of this rank in phase f->phase: what their trials come to, and the next ones. */
void hnbrdf_fit_look(trainer *t);
/* The mix of losses of a phase, as options.loss has it. */
float hnbrdf_fit_phase_mix(const trainer *t, int phase);
/* Floating-point operations of one pair: forward, and backward for each channel. */
double hnbrdf_fit_own_flops(const fit_layout *layout);

#endif
