/* worth.c: a fitted material beside its GGX alone, against the data. */
#include "fit/worth.h"

#include "fit/pixels.h"

#include <math.h>
#include <string.h>

/* ---- Over pairs ------------------------------------------------------------------------------ */

static double smape(const float f[3], const float target[3])
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) {
        const double a = (double)f[c], b = (double)target[c];
        sum += a + b > 0.0 ? 2.0 * fabs(a - b) / (a + b) : 0.0;
    }
    return sum / 3.0;
}

/* Adds pair b of a tile, one of `pairs`. */
static void add_pair(const fit_sides *sides, const float *tile, size_t b, int pairs,
                     hnbrdf_fit_worth *worth)
{
    float wi[3], wo[3], target[3], f[3];
    for (size_t c = 0; c < 3; c++) {
        wi[c] = tile[FIT_POOL_WI + c * FIT_TILE + b];
        wo[c] = tile[FIT_POOL_WO + c * FIT_TILE + b];
        target[c] = tile[FIT_POOL_TARGET + c * FIT_TILE + b];
    }
    hnbrdf_prepared_eval(sides->hybrid, wi, wo, f);
    worth->smape += smape(f, target) / pairs;
    hnbrdf_prepared_eval(sides->ggx, wi, wo, f);
    worth->ggx_smape += smape(f, target) / pairs;
}

void hnbrdf_fit_worth_smape(const fit_sides *sides, const fit_pool *pool, int at, int tiles,
                            float *room, hnbrdf_fit_worth *worth)
{
    const int count = tiles < pool->tiles ? tiles : pool->tiles;
    worth->smape = worth->ggx_smape = 0.0;
    for (int t = 0; t < count; t++) {
        const float *tile = hnbrdf_fit_pool_fetch(pool, at, t, room);
        for (size_t b = 0; b < FIT_TILE; b++)
            add_pair(sides, tile, b, count * FIT_TILE, worth);
    }
}

/* ---- In a picture ---------------------------------------------------------------------------- */

enum {
    SUN_POINTS = 48, /* directions to a sun in or near the highlight */
    FAR_POINTS = 6,  /* elsewhere */
    EVEN = 32,       /* directions to the even light */
    SHARP_EVEN = 8   /* as there are more pixels */
};

/* What light one point of the sphere sends to the camera. */
typedef struct pixel {
    fit_pixel at;
    double truth[3];               /* the radiance under one light, so far */
    double error[3], ggx_error[3]; /* of it */
} pixel;

/* Light of this weight from a direction of the pixel's frame. */
static void light(const fit_sides *sides, const hnbrdf_measured *measured, pixel *p,
                  const float wi[3], double weight)
{
    float target[3], f[3], ggx[3];
    if (!(wi[2] > 0.0f) || !hnbrdf_measured_eval(measured, wi, p->at.wo, target))
        return;
    hnbrdf_prepared_eval(sides->hybrid, wi, p->at.wo, f);
    hnbrdf_prepared_eval(sides->ggx, wi, p->at.wo, ggx);
    for (int c = 0; c < 3; c++) {
        const double true_value = fmax((double)target[c], 0.0);
        p->truth[c] += weight * true_value;
        p->error[c] += weight * ((double)f[c] - true_value);
        p->ggx_error[c] += weight * ((double)ggx[c] - true_value);
    }
}

static void light_sun(const fit_sides *sides, const hnbrdf_measured *measured, pixel *p, int sun)
{
    const int near = hnbrdf_fit_pixel_is_near(&p->at, sun, (double)sides->ggx->alpha[0]);
    const int points = near ? SUN_POINTS : FAR_POINTS;
    for (int k = 0; k < points; k++) {
        float wi[3];
        const double weight = hnbrdf_fit_pixel_sun(&p->at, sun, k, points, wi);
        light(sides, measured, p, wi, weight);
    }
}

static void light_evenly(const fit_sides *sides, const hnbrdf_measured *measured, pixel *p,
                         int count, hnbrdf_rng *rng)
{
    for (int k = 0; k < count; k++) {
        float wi[3];
        const double weight = hnbrdf_fit_pixel_even(&p->at, sides->ggx, k, count, rng, wi);
        if (weight > 0.0)
            light(sides, measured, p, wi, weight);
    }
}

/* Squared errors of one light, summed over pixels and channels, and the largest radiance. */
typedef struct squares {
    double hybrid, ggx, peak;
} squares;

/* One pixel under the even light with each sun in turn. */
static void add_pixel(const fit_sides *sides, const hnbrdf_measured *measured, pixel *p, int even,
                      hnbrdf_rng *rng, squares sums[FIT_SUNS])
{
    light_evenly(sides, measured, p, even, rng);
    for (int s = 0; s < FIT_SUNS; s++) {
        pixel lit = *p;
        light_sun(sides, measured, &lit, s);
        for (int c = 0; c < 3; c++) {
            sums[s].hybrid += lit.error[c] * lit.error[c];
            sums[s].ggx += lit.ggx_error[c] * lit.ggx_error[c];
            sums[s].peak = fmax(sums[s].peak, lit.truth[c]);
        }
    }
}

void hnbrdf_fit_worth_picture(const fit_sides *sides, const hnbrdf_measured *measured,
                              hnbrdf_fit_worth *worth)
{
    const int sharp = sides->ggx->alpha[0] < FIT_SHARP;
    const int side = sharp ? FIT_PIXELS_SHARP : FIT_PIXELS_SIDE;
    squares sums[FIT_SUNS] = {{0.0, 0.0, 0.0}};
    hnbrdf_rng rng;
    int pixels = 0, worst = 0;
    hnbrdf_rng_seed(&rng, 0, UINT64_C(5) << 40);
    for (int k = 0; k < side * side; k++) {
        pixel p = {.truth = {0.0}};
        if (!hnbrdf_fit_pixel_at(k, side, &p.at))
            continue;
        add_pixel(sides, measured, &p, sharp ? SHARP_EVEN : EVEN, &rng, sums);
        pixels++;
    }
    for (int s = 1; s < FIT_SUNS; s++)
        if (sums[s].hybrid * sums[worst].ggx > sums[worst].hybrid * sums[s].ggx)
            worst = s;
    worth->picture = sums[worst].hybrid / (3.0 * pixels);
    worth->ggx_picture = sums[worst].ggx / (3.0 * pixels);
    const double half_step = sums[worst].peak / 510.0;
    worth->unseen = half_step * half_step;
}
