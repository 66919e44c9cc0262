/* pool.h: the training data: for every material that this process holds a number of tiles of random
 * pairs with the measured value, some of them from the grid sampler and some uniform.
 *
 * The tiles of the first materials are drawn once and kept. Those of the others, where memory has
 * an end, are drawn again whenever they are wanted: tiles are wanted in turn, so that their random
 * numbers go on from tile to tile. */
#ifndef HNBRDF_FIT_POOL_H
#define HNBRDF_FIT_POOL_H

#include "fit/horizon.h"
#include "fit/kernel.h"
#include "hnbrdf/fit.h"

/* Floats of one tile: x [FIT_TILE][6], then analytic, target, wi, wo [3][FIT_TILE] each. Training
 * wants the first three parts, and the directions only where the analytic part is trained. */
enum {
    FIT_POOL_X = 0,
    FIT_POOL_ANALYTIC = FIT_INPUTS * FIT_TILE,
    FIT_POOL_TARGET = FIT_POOL_ANALYTIC + 3 * FIT_TILE,
    FIT_POOL_WI = FIT_POOL_TARGET + 3 * FIT_TILE,
    FIT_POOL_WO = FIT_POOL_WI + 3 * FIT_TILE,
    FIT_POOL_TILE = FIT_POOL_WO + 3 * FIT_TILE
};

/* One material held. */
typedef struct fit_source {
    const hnbrdf_measured *measured;
    fit_horizon horizon;    /* set when its tiles are first drawn */
    uint64_t sequence;      /* of its random numbers: its number among the materials of all */
    hnbrdf_material fitted; /* whose frame and f_a the tiles are encoded with */
    hnbrdf_rng rng;         /* of one that is not kept: before tile `next` */
    int next;
} fit_source;

typedef struct fit_pool {
    float *data; /* [kept][tiles][FIT_POOL_TILE] */
    int kept;    /* of the materials held, the first ones */
    int tiles;   /* per material */
    float horizon_share, bright_share, uniform_share;
    uint64_t seed;
    hnbrdf_encoding encoding;
    fit_source *sources; /* [held] */
} fit_pool;

/* How many of `held` materials are kept: all, or what goes into so many bytes. */
int hnbrdf_fit_pool_keeps(int held, int tiles, double bytes);

/* A tile as the kernels see it. */
fit_tile hnbrdf_fit_tile_view(const float *tile);
/* The same of a material that is kept. */
fit_tile hnbrdf_fit_pool_view(const fit_pool *pool, int at, int tile);

/* Draw all tiles of material `at` of those held, horizon_share of the pairs near the horizon, where
 * all are held to an albedo of at most 1 (unless that is 0); bright_share of the others where it is
 * bright, uniform_share of the rest by the uniform sampler; depends on (seed, sequence) only. 0
 * if less than 1 % of the drawn pairs were valid measurements, 1 otherwise. drawn says what was
 * found. */
int hnbrdf_fit_pool_draw(const fit_pool *pool, int at, hnbrdf_fit_drawn *drawn);

/* The first tiles of it as a pool of one material: those kept, or drawn into `room`, which has
 * room for so many. */
fit_pool hnbrdf_fit_pool_head(const fit_pool *pool, int at, int tiles, float *room);

/* What its tiles are encoded with from now on: fills x and f_a of those kept. */
void hnbrdf_fit_pool_encode(const fit_pool *pool, int at, const hnbrdf_material *fitted);

/* A tile of its pairs that is none of the pool's. */
void hnbrdf_fit_pool_encode_tile(const fit_pool *pool, int at, float *tile);

/* An encoded tile: where it is kept, or in `room`, [FIT_POOL_TILE]. One thread a material. */
const float *hnbrdf_fit_pool_fetch(const fit_pool *pool, int at, int tile, float *room);

#endif
