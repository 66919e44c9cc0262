/* views.c: the pixels that a material is fitted in: of a picture with a sharp highlight all around
 * it, and few of the others. */
#include "fit/views.h"

#include "fit/pixels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    EQUAL = 16,     /* points of each sun and of the even light */
    NEAR = 48,      /* of the one sun whose highlight is there */
    FAR = 4,        /* then of the other suns */
    SPARSE = 9,     /* of so many pixels across and down one, where highlights are sharp */
    MOST_NEAR = 160 /* pixels near a highlight, about */
};

/* ---- One pixel ------------------------------------------------------------------------------- */

/* One pair more. */
static void put(fit_view *view, const hnbrdf_measured *measured, const fit_pixel *p, int *pairs,
                const float wi[3], double weight, int sun)
{
    float f[3] = {0.0f, 0.0f, 0.0f};
    static const float up[3] = {0.0f, 0.0f, 1.0f};
    const int b = (*pairs)++;
    const int valid =
        weight > 0.0 && wi[2] > 0.0f && hnbrdf_measured_eval(measured, wi, p->wo, f) != 0;
    const float *from = valid ? wi : up;
    for (int c = 0; c < 3; c++) {
        view->tile[FIT_POOL_WI + c * FIT_TILE + b] = from[c];
        view->tile[FIT_POOL_WO + c * FIT_TILE + b] = p->wo[c];
        view->tile[FIT_POOL_TARGET + c * FIT_TILE + b] =
            valid ? fminf(fmaxf(f[c], 0.0f), FIT_MOST) : 0.0f;
    }
    for (int s = 0; s < FIT_LIGHTS; s++)
        view->lights[s][b] = valid && (sun < 0 || sun == s) ? (float)weight : 0.0f;
}

static void fill(fit_view *view, const hnbrdf_measured *measured, const hnbrdf_prepared *ggx,
                 const fit_pixel *p, int near, hnbrdf_rng *rng)
{
    int pairs = 0, count = 0, even = FIT_TILE;
    float wi[3];
    for (int s = 0; s < FIT_SUNS; s++)
        count += near >> s & 1;
    for (int s = 0; s < FIT_SUNS; s++) {
        const int points = count != 1 ? EQUAL : (near >> s & 1 ? NEAR : FAR);
        for (int k = 0; k < points; k++) {
            const double weight = hnbrdf_fit_pixel_sun(p, s, k, points, wi);
            put(view, measured, p, &pairs, wi, weight, s);
        }
        even -= points;
    }
    for (int k = 0; k < even; k++) {
        const double weight = hnbrdf_fit_pixel_even(p, ggx, k, even, rng, wi);
        put(view, measured, p, &pairs, wi, weight, -1);
    }
}

/* ---- Which pixels ---------------------------------------------------------------------------- */

/* The suns, as bits, in whose highlight it is. */
static int near_suns(const fit_pixel *p, double alpha)
{
    int near = 0;
    for (int s = 0; s < FIT_SUNS; s++)
        near |= hnbrdf_fit_pixel_is_near(p, s, alpha) << s;
    return near;
}

/* Every how many-th pixel near a sharp highlight is taken. */
static int stride_near(int side, double alpha)
{
    int near = 0;
    for (int k = 0; k < side * side; k++) {
        fit_pixel p;
        near += hnbrdf_fit_pixel_at(k, side, &p) && near_suns(&p, alpha);
    }
    return (near + MOST_NEAR - 1) / MOST_NEAR;
}

static void fill_all(fit_views *views, const hnbrdf_measured *measured, const hnbrdf_prepared *ggx)
{
    const double alpha = (double)ggx->alpha[0];
    const int sharp = ggx->alpha[0] < FIT_SHARP;
    const int side = sharp ? FIT_PIXELS_SHARP : FIT_PIXELS_SIDE;
    const int stride = sharp ? stride_near(side, alpha) : 4, far = sharp ? SPARSE : 1;
    int seen = 0;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 0, UINT64_C(6) << 40);
    for (int k = 0; k < side * side && views->count < FIT_VIEWS_MOST; k++) {
        fit_pixel p;
        if (!hnbrdf_fit_pixel_at(k, side, &p))
            continue;
        const int near = near_suns(&p, alpha), x = k % side, y = k / side;
        const int taken =
            sharp ? (near ? seen++ % stride == 0 : x % far == far / 2 && y % far == far / 2)
                  : (x + 2 * y) % 4 == 0;
        if (!taken)
            continue;
        fit_view *view = &views->of[views->count++];
        view->share = (float)(sharp && !near ? far * far : stride);
        fill(view, measured, ggx, &p, near, &rng);
    }
}

/* ---- The whole ------------------------------------------------------------------------------- */

static void add_ggx(const fit_view *view, double ggx[FIT_LIGHTS], double peak[FIT_LIGHTS])
{
    for (int s = 0; s < FIT_LIGHTS; s++)
        for (int c = 0; c < 3; c++) {
            double error = 0.0, truth = 0.0;
            for (int b = 0; b < FIT_TILE; b++) {
                const double w = (double)view->lights[s][b];
                const double t = (double)view->tile[FIT_POOL_TARGET + c * FIT_TILE + b];
                error += w * ((double)view->tile[FIT_POOL_ANALYTIC + c * FIT_TILE + b] - t);
                truth += w * t;
            }
            ggx[s] += (double)view->share * error * error;
            peak[s] = fmax(peak[s], truth);
        }
}

int hnbrdf_fit_views_make(fit_views *views, const fit_pool *pool, int at)
{
    const fit_source *source = &pool->sources[at];
    static const char *const name = "ggx";
    const hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = 1, .materials = &source->fitted, .names = &name};
    hnbrdf_model *model = NULL;
    hnbrdf_prepared ggx;
    double peak[FIT_LIGHTS] = {0.0}, pixels = 0.0;
    memset(views, 0, sizeof *views);
    views->of = calloc(FIT_VIEWS_MOST, sizeof *views->of);
    if (!views->of || hnbrdf_model_create(&desc, NULL, &model, NULL))
        return 0;
    hnbrdf_prepare(model, hnbrdf_model_material(model, 0), &ggx);
    fill_all(views, source->measured, &ggx);
    hnbrdf_model_free(model);
    for (int v = 0; v < views->count; v++) {
        hnbrdf_fit_pool_encode_tile(pool, at, views->of[v].tile);
        add_ggx(&views->of[v], views->ggx, peak);
        pixels += (double)views->of[v].share;
    }
    for (int s = 0; s < FIT_LIGHTS; s++) { /* a hundredth of what nobody sees */
        const double unseen = 3.0 * pixels * (peak[s] / 510.0) * (peak[s] / 510.0);
        views->ggx[s] = fmax(fmax(views->ggx[s], 0.01 * unseen), 1e-30);
    }
    return 1;
}
