/* mix.h: what the files of the path between two materials share: the directions in which it is
 * looked at, what a place on it should be, and the material that comes nearest. */
#ifndef HNBRDF_EDIT_MIX_H
#define HNBRDF_EDIT_MIX_H

#include "hnbrdf/hnbrdf.h"

/* ---- Directions: mix_pairs.c ----------------------------------------------------------------- */

enum {
    MIX_BOUNDED = 3, /* views, the first ones, from which the albedo has bounds */
    MIX_MAX_VIEWS = 7,
    MIX_SIDE = 26,     /* of the grid of half vectors of a view */
    MIX_END_SIDE = 40, /* the same for the albedo of an end */
    MIX_MAX_PAIRS = MIX_BOUNDED * MIX_END_SIDE * MIX_END_SIDE
};

typedef struct mix_pairs {
    int count;
    int view[MIX_MAX_PAIRS];
    float wi[MIX_MAX_PAIRS][3], wo[MIX_MAX_PAIRS][3];
    double weight[MIX_MAX_PAIRS]; /* wi.z times the solid angle */
} mix_pairs;

typedef float mix_values[MIX_MAX_PAIRS][3];
typedef struct mix_albedo {
    double at[MIX_BOUNDED][3]; /* directional, per channel */
} mix_albedo;

/* Pairs for a material of about this roughness: every view there is, or the bounded ones alone. */
void hnbrdf_mix_pairs_make(const hnbrdf_model *model, const hnbrdf_material *material, int side,
                           int bounded, mix_pairs *pairs);
void hnbrdf_mix_eval(const hnbrdf_model *model, const hnbrdf_material *material,
                     const mix_pairs *pairs, mix_values f);
/* f: of all pairs, from the first channel of the first. */
mix_albedo hnbrdf_mix_albedo_of(const mix_pairs *pairs, const float *f);

/* ---- The goal: mix_goal.c -------------------------------------------------------------------- */

/* A place on the path is a shift from the straight line: of the latent code, l numbers, then of
 * the logarithms of kd, reflectance, fitted kd, fitted reflectance (three channels each), alpha
 * and fitted alpha. Those of a channel change that channel alone, so that one evaluation gives
 * the derivative by all three: they are one group. */
enum {
    MIX_CHANNEL_GROUPS = 4,
    MIX_ALPHA_GROUPS = 2,
    MIX_SHIFTS = 3 * MIX_CHANNEL_GROUPS + MIX_ALPHA_GROUPS,
    MIX_MAX_UNKNOWNS = HNBRDF_MAX_LATENT + MIX_SHIFTS,
    MIX_MAX_GROUPS = HNBRDF_MAX_LATENT + MIX_CHANNEL_GROUPS + MIX_ALPHA_GROUPS
};

typedef struct mix_goal {
    const hnbrdf_model *model;
    hnbrdf_material straight; /* hnbrdf_material_mix() */
    int unknowns, groups;
    mix_pairs pairs;
    mix_values ends[2], target;
    mix_albedo low, high;
} mix_goal;

void hnbrdf_mix_goal_make(const hnbrdf_model *model, const hnbrdf_material *a,
                          const hnbrdf_material *b, const mix_albedo albedos[2], float t,
                          mix_goal *goal);
/* The unknown that a group stands for in a channel. */
int hnbrdf_mix_unknown(const mix_goal *goal, int group, int channel);
/* Always a legal material. */
hnbrdf_material hnbrdf_mix_material(const mix_goal *goal, const double shift[MIX_MAX_UNKNOWNS]);
/* The shift that gives what this end is, edited to kd, eta and alpha of the straight line. */
void hnbrdf_mix_shift_to(const mix_goal *goal, const hnbrdf_material *end,
                         double shift[MIX_MAX_UNKNOWNS]);

/* ---- The fit: mix_fit.c ---------------------------------------------------------------------- */

typedef struct mix_work mix_work;
extern const size_t hnbrdf_mix_work_size;

/* Where the place should be as far as the goal does not tell. */
typedef struct mix_prior {
    double shift[MIX_MAX_UNKNOWNS];
    double weight; /* of the squared distance, above 0 */
} mix_prior;

/* Moves the shift to where the goal is met best, not far from the prior; returns the cost there. */
double hnbrdf_mix_fit(const mix_goal *goal, mix_work *work, const mix_prior *prior,
                      double shift[MIX_MAX_UNKNOWNS]);

#endif
