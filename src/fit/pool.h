/* pool.h: the training data, drawn once: for every material a number of tiles of random pairs
 * with the measured value, some of them from the grid sampler and some uniform. */
#ifndef HNBRDF_FIT_POOL_H
#define HNBRDF_FIT_POOL_H

#include "fit/kernel.h"
#include "hnbrdf/fit.h"

/* Floats of one tile: wi, wo, target, analytic [3][FIT_TILE] each, then x [FIT_TILE][6]. */
enum { FIT_POOL_TILE = (12 + FIT_INPUTS) * FIT_TILE };

typedef struct fit_pool {
    float *data; /* [materials][tiles][FIT_POOL_TILE] */
    int tiles;   /* per material */
} fit_pool;

/* Where one tile lies. */
float *hnbrdf_fit_pool_tile(const fit_pool *pool, int material, int tile);
/* The same, as the kernels see it. */
fit_tile hnbrdf_fit_pool_view(const fit_pool *pool, int material, int tile);

/* Draw all tiles of one material, uniform_share of the pairs by the uniform sampler; depends on
 * (seed, material) only. 0 if less than 1 % of the drawn pairs were valid measurements, 1
 * otherwise. drawn says what was found. */
int hnbrdf_fit_pool_draw(const fit_pool *pool, int material, const hnbrdf_measured *measured,
                         float uniform_share, uint64_t seed, hnbrdf_fit_drawn *drawn);

/* Fill x, and f_a of `fitted`, for one material: what a frozen analytic part needs. */
void hnbrdf_fit_pool_encode(const fit_pool *pool, int material, hnbrdf_encoding encoding,
                            const hnbrdf_material *fitted);

#endif
