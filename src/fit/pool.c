/* pool.c: draw and encode the training data. */
#include "fit/pool.h"

#include "core/encoding.h"
#include "core/frame.h"
#include "core/microfacet.h"

float *hnbrdf_fit_pool_tile(const fit_pool *pool, int material, int tile)
{
    return pool->data + ((size_t)material * (size_t)pool->tiles + (size_t)tile) * FIT_POOL_TILE;
}

fit_tile hnbrdf_fit_pool_view(const fit_pool *pool, int material, int tile)
{
    const float *p = hnbrdf_fit_pool_tile(pool, material, tile);
    fit_tile view = {p + 12 * FIT_TILE, p + 9 * FIT_TILE, p, p + 3 * FIT_TILE, p + 6 * FIT_TILE};
    return view;
}

int hnbrdf_fit_pool_draw(const fit_pool *pool, int material, const hnbrdf_measured *measured,
                         float uniform_share, uint64_t seed, hnbrdf_fit_drawn *drawn)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, seed, (uint64_t)material);
    long pairs = (long)pool->tiles * FIT_TILE, draws = 0;
    *drawn = (hnbrdf_fit_drawn){0.0, 0.0, 0.0, 0.0};
    for (long k = 0; k < pairs; k++) {
        float *tile = hnbrdf_fit_pool_tile(pool, material, (int)(k / FIT_TILE));
        size_t b = (size_t)(k % FIT_TILE);
        float wi[3], wo[3], f[3];
        int is_uniform = floor((double)uniform_share * (double)(k + 1)) >
                         floor((double)uniform_share * (double)k);
        do {
            if (draws == 100 * pairs) {
                drawn->valid = (double)k / (double)draws;
                return 0;
            }
            draws++;
            hnbrdf_sampler_draw(is_uniform ? HNBRDF_SAMPLER_UNIFORM : HNBRDF_SAMPLER_GRID, &rng, wi,
                                wo);
        } while (!hnbrdf_measured_eval(measured, wi, wo, f));
        for (size_t c = 0; c < 3; c++) {
            tile[c * FIT_TILE + b] = wi[c];
            tile[(3 + c) * FIT_TILE + b] = wo[c];
            tile[(6 + c) * FIT_TILE + b] =
                hnbrdf_clamp(f[c], 0.0f, FIT_MOST); /* a model is never negative */
            drawn->largest = fmax(drawn->largest, (double)f[c]);
            drawn->dark += f[c] < (float)FIT_SMAPE_OFFSET;
            drawn->cut += f[c] > FIT_MOST;
        }
    }
    drawn->valid = (double)pairs / (double)draws;
    drawn->dark /= 3.0 * (double)pairs;
    drawn->cut /= 3.0 * (double)pairs;
    return 1;
}

void hnbrdf_fit_pool_encode(const fit_pool *pool, int material, hnbrdf_encoding encoding,
                            const hnbrdf_material *fitted)
{
    hnbrdf_frame frame = hnbrdf_frame_of(fitted);
    for (int t = 0; t < pool->tiles; t++) {
        float *tile = hnbrdf_fit_pool_tile(pool, material, t);
        for (size_t b = 0; b < FIT_TILE; b++) {
            float wi[3], wo[3], i[3], o[3], *x = tile + 12 * FIT_TILE + b * FIT_INPUTS;
            for (size_t c = 0; c < 3; c++) {
                wi[c] = tile[c * FIT_TILE + b];
                wo[c] = tile[(3 + c) * FIT_TILE + b];
            }
            hnbrdf_to_tangent(frame, wi, i);
            hnbrdf_to_tangent(frame, wo, o);
            hnbrdf_pair pair = hnbrdf_pair_make(i, o);
            hnbrdf_encode(encoding, &pair, x);
            float specular = hnbrdf_specular(&pair, fitted->alpha[0], fitted->alpha[1]);
            for (size_t c = 0; c < 3; c++)
                tile[(9 + c) * FIT_TILE + b] =
                    hnbrdf_microfacet(fitted->kd[c], fitted->eta[c], pair.c, specular);
        }
    }
}
