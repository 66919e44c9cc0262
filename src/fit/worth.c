/* worth.c: a fitted material beside its GGX alone, against the data. */
#include "fit/worth.h"

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
    SIDE = 24,       /* pixels across */
    SHARP_SIDE = 96, /* where a highlight is as sharp as the sun itself */
    SUN_POINTS = 48, /* directions to a sun in or near the highlight */
    FAR_POINTS = 6,  /* elsewhere */
    EVEN = 32,       /* directions to the even light, of radiance 1 */
    SHARP_EVEN = 8,  /* as there are more pixels */
    SUNS = 3
};
#define SHARP 0.05f                      /* alpha below: most of a highlight is within 3 degrees */
static const double SUN_RADIUS = 0.0524, /* 3 degrees; a sharper light shows single pixels */
    SUN_RADIANCE = 200.0, PI = 3.14159265358979323846;
/* Towards them: from above, from the left, and nearly from the camera, which is at +z. */
static const double suns[SUNS][3] = {
    {-0.42, 0.62, 0.6627}, {0.8, 0.1, 0.5916}, {0.1, -0.3, 0.9487}};

/* One point of the sphere: its frame, its view and what light it sends there. */
typedef struct pixel {
    double frame[3][3]; /* x, y and the normal */
    float wo[3];
    double truth[3];               /* the radiance under one light, so far */
    double error[3], ggx_error[3]; /* of it */
} pixel;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void pixel_at(double x, double y, pixel *p)
{
    const double z = sqrt(1.0 - x * x - y * y), across = sqrt(x * x + z * z);
    memset(p, 0, sizeof *p);
    const double frame[3][3] = {
        {z / across, 0.0, -x / across}, {-x * y / across, across, -y * z / across}, {x, y, z}};
    memcpy(p->frame, frame, sizeof frame);
    for (int k = 0; k < 3; k++)
        p->wo[k] = (float)frame[k][2];
}

/* Light of this weight from a direction of the pixel's frame. */
static void light(const fit_sides *sides, const hnbrdf_measured *measured, pixel *p,
                  const float wi[3], double weight)
{
    float target[3], f[3], ggx[3];
    if (!(wi[2] > 0.0f) || !hnbrdf_measured_eval(measured, wi, p->wo, target))
        return;
    hnbrdf_prepared_eval(sides->hybrid, wi, p->wo, f);
    hnbrdf_prepared_eval(sides->ggx, wi, p->wo, ggx);
    for (int c = 0; c < 3; c++) {
        const double true_value = fmax((double)target[c], 0.0);
        p->truth[c] += weight * true_value;
        p->error[c] += weight * ((double)f[c] - true_value);
        p->ggx_error[c] += weight * ((double)ggx[c] - true_value);
    }
}

/* How many: many where the half vector is within the sun's radius and the lobe's of the normal. */
static int sun_points(const double sun[3], const pixel *p, double alpha)
{
    const double *n = p->frame[2], h[3] = {sun[0], sun[1], sun[2] + 1.0};
    const double cosine = dot(n, h) / sqrt(dot(h, h)), reach = SUN_RADIUS + 4.0 * alpha;
    return cosine > cos(fmin(reach, 1.5)) ? SUN_POINTS : FAR_POINTS;
}

/* The points of a sun's disc, a spiral of equal areas. */
static void light_sun(const fit_sides *sides, const hnbrdf_measured *measured, pixel *p,
                      const double sun[3])
{
    const int points = sun_points(sun, p, (double)sides->ggx->alpha[0]);
    const double flat = sqrt(sun[0] * sun[0] + sun[1] * sun[1]);
    const double x[3] = {sun[1] / flat, -sun[0] / flat, 0.0};
    const double y[3] = {sun[1] * x[2] - sun[2] * x[1], sun[2] * x[0] - sun[0] * x[2],
                         sun[0] * x[1] - sun[1] * x[0]};
    for (int k = 0; k < points; k++) {
        const double r = SUN_RADIUS * sqrt((k + 0.5) / points), turn = 2.399963 * k;
        double w[3];
        float wi[3];
        for (int c = 0; c < 3; c++)
            w[c] = sqrt(1.0 - r * r) * sun[c] + r * (cos(turn) * x[c] + sin(turn) * y[c]);
        for (int c = 0; c < 3; c++)
            wi[c] = (float)dot(p->frame[c], w);
        light(sides, measured, p, wi,
              SUN_RADIANCE * PI * SUN_RADIUS * SUN_RADIUS * (double)wi[2] / points);
    }
}

static void light_evenly(const fit_sides *sides, const hnbrdf_measured *measured, pixel *p,
                         int count, hnbrdf_rng *rng)
{
    for (int k = 0; k < count; k++) {
        float u[2], wi[3];
        u[0] = ((float)k + hnbrdf_rng_float(rng)) / (float)count;
        u[1] = hnbrdf_rng_float(rng);
        const float pdf = hnbrdf_prepared_draw(sides->ggx, p->wo, u, wi);
        if (pdf > 0.0f)
            light(sides, measured, p, wi, (double)wi[2] / ((double)pdf * count));
    }
}

/* Squared errors of one light, summed over pixels and channels, and the largest radiance. */
typedef struct squares {
    double hybrid, ggx, peak;
} squares;

/* One pixel under the even light with each sun in turn. */
static void add_pixel(const fit_sides *sides, const hnbrdf_measured *measured, pixel *p, int even,
                      hnbrdf_rng *rng, squares sums[SUNS])
{
    light_evenly(sides, measured, p, even, rng);
    for (int s = 0; s < SUNS; s++) {
        pixel lit = *p;
        light_sun(sides, measured, &lit, suns[s]);
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
    const int sharp = sides->ggx->alpha[0] < SHARP, side = sharp ? SHARP_SIDE : SIDE;
    squares sums[SUNS] = {{0.0, 0.0, 0.0}};
    hnbrdf_rng rng;
    int pixels = 0, worst = 0;
    hnbrdf_rng_seed(&rng, 0, UINT64_C(5) << 40);
    for (int k = 0; k < side * side; k++) {
        const double x = (2 * (k % side) + 1) / (double)side - 1.0;
        const double y = (2 * (k / side) + 1) / (double)side - 1.0;
        pixel p;
        if (x * x + y * y > 0.999)
            continue;
        pixel_at(x, y, &p);
        add_pixel(sides, measured, &p, sharp ? SHARP_EVEN : EVEN, &rng, sums);
        pixels++;
    }
    for (int s = 1; s < SUNS; s++)
        if (sums[s].hybrid * sums[worst].ggx > sums[worst].hybrid * sums[s].ggx)
            worst = s;
    worth->picture = sums[worst].hybrid / (3.0 * pixels);
    worth->ggx_picture = sums[worst].ggx / (3.0 * pixels);
    const double half_step = sums[worst].peak / 510.0;
    worth->unseen = half_step * half_step;
}
