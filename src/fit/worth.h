/* worth.h: how far a material is from the data with the network and with GGX alone: over pairs, and
 * in a small picture. */
#ifndef HNBRDF_FIT_WORTH_H
#define HNBRDF_FIT_WORTH_H

#include "fit/pool.h"
#include "hnbrdf/fit.h"

/* A material as two models see it. */
typedef struct fit_sides {
    const hnbrdf_prepared *hybrid;
    const hnbrdf_prepared *ggx; /* of a ggx model */
} fit_sides;

/* Mean SMAPE over the pairs of `tiles` tiles of material `at` of the pool; room [FIT_POOL_TILE]. */
void hnbrdf_fit_worth_smape(const fit_sides *sides, const fit_pool *pool, int at, int tiles,
                            float *room, hnbrdf_fit_worth *worth);
/* Mean squared error of a picture of a sphere under an even light and one of three small suns, the
 * one under which the hybrid does worst beside GGX. Always the same directions; lobes of
 * `sides->ggx` choose some of them. */
void hnbrdf_fit_worth_picture(const fit_sides *sides, const hnbrdf_measured *measured,
                              hnbrdf_fit_worth *worth);

#endif
