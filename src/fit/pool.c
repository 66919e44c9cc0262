/* pool.c: draw and encode the training data. */
#include "fit/pool.h"

#include "core/encoding.h"
#include "core/frame.h"
#include "core/microfacet.h"
#include "fit/bright.h"

#include <limits.h>

int hnbrdf_fit_pool_keeps(int held, int tiles, double bytes)
{
    const double most = bytes / ((double)tiles * FIT_POOL_TILE * sizeof(float));
    return most < held ? (int)most : held;
}

static float *kept_tile(const fit_pool *pool, int at, int tile)
{
    return pool->data + ((size_t)at * (size_t)pool->tiles + (size_t)tile) * FIT_POOL_TILE;
}

fit_tile hnbrdf_fit_tile_view(const float *p)
{
    return (fit_tile){p + FIT_POOL_X, p + FIT_POOL_ANALYTIC, p + FIT_POOL_WI, p + FIT_POOL_WO,
                      p + FIT_POOL_TARGET};
}

fit_tile hnbrdf_fit_pool_view(const fit_pool *pool, int at, int tile)
{
    return hnbrdf_fit_tile_view(kept_tile(pool, at, tile));
}

/* ---- Drawing --------------------------------------------------------------------------------- */

/* What a drawing under way has come to. */
typedef struct drawing {
    hnbrdf_rng rng;
    /* pairs looked at so far, those with a valid measurement; when it gives up */
    long looked, valid, most;
    hnbrdf_fit_drawn sums;
} drawing;

static void put(float *tile, size_t b, const float wi[3], const float wo[3], const float f[3],
                hnbrdf_fit_drawn *sums)
{
    for (size_t c = 0; c < 3; c++) {
        tile[FIT_POOL_WI + c * FIT_TILE + b] = wi[c];
        tile[FIT_POOL_WO + c * FIT_TILE + b] = wo[c];
        tile[FIT_POOL_TARGET + c * FIT_TILE + b] =
            hnbrdf_clamp(f[c], 0.0f, FIT_MOST); /* a model is never negative */
        sums->largest = fmax(sums->largest, (double)f[c]);
        sums->dark += f[c] < (float)FIT_SMAPE_OFFSET;
        sums->cut += f[c] > FIT_MOST;
    }
}

/* Whether number k of a series takes part where `share` of them do, spread evenly. */
static int is_turn(double k, double share)
{
    return floor(share * (k + 1.0)) > floor(share * k);
}

/* Pair number k of a material. 0 if what it looked at has no valid measurement. */
static int draw_pair(const fit_pool *pool, const fit_source *source, double k, drawing *d,
                     float wi[3], float wo[3], float f[3])
{
    const double low = (double)pool->horizon_share, above = k - floor(low * k);
    const double bright = (double)pool->bright_share, others = above - floor(bright * above);
    int valid;
    if (is_turn(k, low)) {
        valid = hnbrdf_fit_horizon_draw(&source->horizon, source->measured, &d->rng, wi, wo, f);
        d->looked++;
    } else if (is_turn(above, bright)) {
        valid = hnbrdf_fit_bright_draw(source->measured, &d->rng, wi, wo, f);
        d->looked += FIT_BRIGHT_CANDIDATES;
    } else {
        const int is_uniform = is_turn(others, (double)pool->uniform_share);
        hnbrdf_sampler_draw(is_uniform ? HNBRDF_SAMPLER_UNIFORM : HNBRDF_SAMPLER_GRID, &d->rng, wi,
                            wo);
        valid = hnbrdf_measured_eval(source->measured, wi, wo, f) != 0;
        d->looked++;
    }
    d->valid += valid;
    if (valid && pool->horizon_share > 0.0f)
        hnbrdf_fit_horizon_hold(&source->horizon, wi, wo, f);
    return valid;
}

/* The pairs of tile `index` of a material; how many there are before it gives up. */
static int draw_tile(const fit_pool *pool, const fit_source *source, int index, drawing *d,
                     float *tile)
{
    for (int b = 0; b < FIT_TILE; b++) {
        float wi[3], wo[3], f[3];
        do
            if (d->looked >= d->most)
                return b;
        while (!draw_pair(pool, source, (double)index * FIT_TILE + b, d, wi, wo, f));
        put(tile, (size_t)b, wi, wo, f, &d->sums);
    }
    return FIT_TILE;
}

int hnbrdf_fit_pool_draw(const fit_pool *pool, int at, hnbrdf_fit_drawn *drawn)
{
    fit_source *source = &pool->sources[at];
    const long pairs = (long)pool->tiles * FIT_TILE;
    float room[FIT_POOL_TILE];
    drawing d = {.most = 100 * pairs};
    hnbrdf_rng_seed(&d.rng, pool->seed, source->sequence);
    if (pool->horizon_share > 0.0f)
        hnbrdf_fit_horizon_make(source->measured, &source->horizon);
    for (int t = 0; t < pool->tiles; t++) {
        int done = draw_tile(pool, source, t, &d, at < pool->kept ? kept_tile(pool, at, t) : room);
        if (done < FIT_TILE) {
            *drawn = d.sums;
            drawn->valid = (double)d.valid / (double)d.looked;
            return 0;
        }
    }
    *drawn = d.sums;
    drawn->valid = (double)d.valid / (double)d.looked;
    drawn->dark /= 3.0 * (double)pairs;
    drawn->cut /= 3.0 * (double)pairs;
    return 1;
}

/* ---- Drawing again --------------------------------------------------------------------------- */

static void draw_next(const fit_pool *pool, fit_source *source, float *tile)
{
    drawing d = {.rng = source->rng, .most = LONG_MAX}; /* it ended before, and does now */
    draw_tile(pool, source, source->next, &d, tile);
    source->rng = d.rng;
    source->next++;
}

static void draw_again(const fit_pool *pool, int at, int tile, float *room)
{
    fit_source *source = &pool->sources[at];
    if (source->next > tile || source->next == 0) {
        hnbrdf_rng_seed(&source->rng, pool->seed, source->sequence);
        source->next = 0;
    }
    while (source->next <= tile)
        draw_next(pool, source, room);
}

fit_pool hnbrdf_fit_pool_head(const fit_pool *pool, int at, int tiles, float *room)
{
    fit_pool head = *pool;
    head.kept = 1;
    head.sources = pool->sources + at;
    head.tiles = tiles < pool->tiles ? tiles : pool->tiles;
    head.data = at < pool->kept ? kept_tile(pool, at, 0) : room;
    for (int t = 0; t < head.tiles && at >= pool->kept; t++)
        draw_again(pool, at, t, room + (size_t)t * FIT_POOL_TILE);
    return head;
}

/* ---- Encoding -------------------------------------------------------------------------------- */

static void encode_tile(const fit_pool *pool, const hnbrdf_material *fitted, hnbrdf_frame frame,
                        float *tile)
{
    for (size_t b = 0; b < FIT_TILE; b++) {
        float wi[3], wo[3], i[3], o[3];
        for (size_t c = 0; c < 3; c++) {
            wi[c] = tile[FIT_POOL_WI + c * FIT_TILE + b];
            wo[c] = tile[FIT_POOL_WO + c * FIT_TILE + b];
        }
        hnbrdf_to_tangent(frame, wi, i);
        hnbrdf_to_tangent(frame, wo, o);
        hnbrdf_pair pair = hnbrdf_pair_make(i, o);
        hnbrdf_encode(pool->encoding, &pair, tile + FIT_POOL_X + b * FIT_INPUTS);
        float specular = hnbrdf_specular(&pair, fitted->alpha[0], fitted->alpha[1]);
        for (size_t c = 0; c < 3; c++)
            tile[FIT_POOL_ANALYTIC + c * FIT_TILE + b] =
                hnbrdf_microfacet(fitted->kd[c], fitted->eta[c], pair.c, specular);
    }
}

void hnbrdf_fit_pool_encode(const fit_pool *pool, int at, const hnbrdf_material *fitted)
{
    pool->sources[at].fitted = *fitted;
    for (int t = 0; t < pool->tiles && at < pool->kept; t++)
        encode_tile(pool, fitted, hnbrdf_frame_of(fitted), kept_tile(pool, at, t));
}

void hnbrdf_fit_pool_encode_tile(const fit_pool *pool, int at, float *tile)
{
    const hnbrdf_material *fitted = &pool->sources[at].fitted;
    encode_tile(pool, fitted, hnbrdf_frame_of(fitted), tile);
}

const float *hnbrdf_fit_pool_fetch(const fit_pool *pool, int at, int tile, float *room)
{
    if (at < pool->kept)
        return kept_tile(pool, at, tile);
    draw_again(pool, at, tile, room);
    hnbrdf_fit_pool_encode_tile(pool, at, room);
    return room;
}
