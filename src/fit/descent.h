/* descent.h: the numbers that one material has of its own, on a network that stays, by the method
 * of Levenberg and Marquardt. There are few of them, so that their matrix is small. */
#ifndef HNBRDF_FIT_DESCENT_H
#define HNBRDF_FIT_DESCENT_H

#include "fit/kernel.h"

#include <stdint.h>

enum { FIT_UNKNOWNS = HNBRDF_MAX_LATENT + FIT_ROTATION };

/* Which numbers are unknown, and how far they may go. */
typedef struct fit_unknowns {
    int latent;    /* numbers of the code */
    int analytic;  /* 1: kd, eta and alpha too */
    int isotropic; /* 1: one alpha */
    float most;    /* of the first number of the code: beyond, it may turn the network off */
} fit_unknowns;

int hnbrdf_fit_unknowns_count(const fit_unknowns *unknowns);

/* What a search makes smaller, and its normal equations. */
typedef struct fit_normal {
    double loss;              /* of pairs, and `pull` times the mean of worth */
    double pairs;             /* mean loss of a pair and channel */
    double alone;             /* SMAPE of the analytic part alone, that of GGX being 1 */
    double worth[FIT_LIGHTS]; /* squared errors in pictures, those of GGX alone being 1 */
    double gradient[FIT_UNKNOWNS], matrix[FIT_UNKNOWNS][FIT_UNKNOWNS];
} fit_normal;

/* One search. No pointers: checkpoints and ranks move it as it is. */
typedef struct fit_point {
    fit_normal normal; /* at `at` */
    double damping, pull;
    float at[FIT_OWN], trial[FIT_OWN];
    int64_t known; /* 0: `trial` is `at`, and is to be looked at whatever its loss */
} fit_point;

/* A search that starts at own [FIT_OWN]. */
void hnbrdf_fit_point_start(fit_point *point, const float *own);
/* The sample, or the loss, is another one: what is known of `at` is so no more. */
void hnbrdf_fit_point_renew(fit_point *point);
/* Sums as kernel.own() makes them, times scale, to the normal equations. */
void hnbrdf_fit_normal_add(fit_normal *normal, const fit_unknowns *unknowns, const float *sums,
                           int stride, double scale);
/* What `trial` comes to: `at` is the better of both, and `trial` what is to be looked at next. */
void hnbrdf_fit_point_settle(fit_point *point, const fit_unknowns *unknowns,
                             const fit_normal *trial);

#endif
