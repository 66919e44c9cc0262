/* ggx.c: fit Lambert + one GGX lobe to one material. */
#include "fit/ggx.h"

#include "fit/adam.h"

#include <math.h>
#include <string.h>

enum {
    SCOUT_STEPS = 120, /* every start, on SCOUT_TILES */
    SCOUT_TILES = 24,
    KEEP = 3, /* starts that go on, on REFINE_TILES */
    REFINE_STEPS = 250,
    REFINE_TILES = 96
};

static float clampf(float x, float low, float high)
{
    return x > low ? (x < high ? x : high) : low;
}

void hnbrdf_fit_ggx_project(float *p, int isotropic)
{
    for (int c = 0; c < 3; c++) {
        p[FIT_KD + c] = clampf(p[FIT_KD + c], 0.0f, 1.0f);
        p[FIT_ETA + c] = clampf(p[FIT_ETA + c], -6.9f, 4.595f); /* ln 0.001, ln 99 */
    }
    if (isotropic) {
        p[FIT_ALPHA] = p[FIT_ALPHA + 1] = 0.5f * (p[FIT_ALPHA] + p[FIT_ALPHA + 1]);
        p[FIT_ROTATION] = 0.0f;
    }
    for (int a = 0; a < 2; a++)
        p[FIT_ALPHA + a] = clampf(p[FIT_ALPHA + a], -9.2103f, 0.0f); /* ln 1.0001e-4 */
}

void hnbrdf_fit_ggx_material(const float *p, hnbrdf_material *material)
{
    for (int c = 0; c < 3; c++) {
        material->kd[c] = clampf(p[FIT_KD + c], 0.0f, 1.0f);
        material->eta[c] = clampf(1.0f + expf(p[FIT_ETA + c]), 1.001f, 100.0f);
    }
    for (int a = 0; a < 2; a++)
        material->alpha[a] = clampf(expf(p[FIT_ALPHA + a]), HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
    /* A turn by pi is none; keep the angle in [-pi/2, pi/2]. */
    material->rotation = (float)remainder((double)p[FIT_ROTATION], 3.14159265358979);
}

/* Mean loss over the first `tiles` tiles; gradient of the mean, or NULL. */
static double loss_of(const fit_kernel *kernel, const fit_pool *pool, int material, int tiles,
                      float mix, const float *p, float *gradient)
{
    double sum = 0.0;
    float unused[FIT_ANALYTIC], *g = gradient ? gradient : unused;
    memset(g, 0, sizeof unused);
    for (int t = 0; t < tiles; t++) {
        fit_tile tile = hnbrdf_fit_pool_view(pool, material, t);
        sum += kernel->analytic(p, &tile, mix, NULL, g);
    }
    float scale = 1.0f / (3.0f * FIT_TILE * (float)tiles);
    for (int i = 0; i < FIT_ANALYTIC; i++)
        g[i] *= scale;
    return sum * (double)scale;
}

/* Adam from p on; p ends as the best state seen. Returns its loss with mix = 1. */
static double descend(const fit_kernel *kernel, const fit_pool *pool, int material, int isotropic,
                      int tiles, int steps, double rate, float *p)
{
    float moments[2 * FIT_ANALYTIC] = {0}, gradient[FIT_ANALYTIC], best[FIT_ANALYTIC];
    memcpy(best, p, sizeof best);
    double least = INFINITY;
    for (int step = 1; step <= steps + 1; step++) {
        double share = (double)step / steps;
        float mix = (float)fmin(1.0, 2.0 * share);
        double loss = loss_of(kernel, pool, material, tiles, mix, p, gradient);
        if (mix >= 1.0f && loss < least) {
            least = loss;
            memcpy(best, p, sizeof best);
        }
        if (isotropic) {
            gradient[FIT_ALPHA] = gradient[FIT_ALPHA + 1] =
                0.5f * (gradient[FIT_ALPHA] + gradient[FIT_ALPHA + 1]);
            gradient[FIT_ROTATION] = 0.0f;
        }
        hnbrdf_fit_adam(p, gradient, moments, FIT_ANALYTIC, step, rate * (1.02 - fmin(1.0, share)));
        hnbrdf_fit_ggx_project(p, isotropic);
    }
    memcpy(p, best, sizeof best);
    return least;
}

/* Start k of the search; 0 when there are no more. */
static int start(int k, int isotropic, const float mean[3], float *p)
{
    static const float alphas[] = {0.01f, 0.05f, 0.2f, 0.6f}, etas[] = {1.4f, 4.0f};
    static const float turns[] = {0.0f, 0.785398f};
    int axes = isotropic ? 1 : 3, rotations = isotropic ? 1 : 2;
    if (k >= 8 * axes * rotations)
        return 0;
    float alpha = alphas[k % 4], eta = etas[k / 4 % 2];
    int axis = k / 8 % axes;
    for (int c = 0; c < 3; c++) {
        p[FIT_KD + c] = clampf(mean[c], 0.001f, 0.99f);
        p[FIT_ETA + c] = logf(eta - 1.0f);
    }
    p[FIT_ALPHA] = logf(axis == 1 ? 3.0f * alpha : alpha);
    p[FIT_ALPHA + 1] = logf(axis == 2 ? 3.0f * alpha : alpha);
    p[FIT_ROTATION] = turns[k / 8 / axes];
    return 1;
}

double hnbrdf_fit_ggx(const fit_kernel *kernel, const fit_pool *pool, int material, int isotropic,
                      float *parameters)
{
    int scouts = SCOUT_TILES < pool->tiles ? SCOUT_TILES : pool->tiles;
    int refiners = REFINE_TILES < pool->tiles ? REFINE_TILES : pool->tiles;
    float kept[KEEP][FIT_ANALYTIC], p[FIT_ANALYTIC], mean[3];
    double losses[KEEP];
    for (int i = 0; i < KEEP; i++)
        losses[i] = INFINITY;
    for (int c = 0; c < 3; c++) { /* geometric mean of f, times pi: a robust albedo */
        double sum = 0.0;
        for (int t = 0; t < scouts; t++)
            for (int b = 0; b < FIT_TILE; b++)
                sum += log((double)hnbrdf_fit_pool_view(pool, material, t).target[c * FIT_TILE + b] +
                           1e-4);
        mean[c] = 3.14159265f * (float)exp(sum / (scouts * FIT_TILE));
    }
    for (int k = 0; start(k, isotropic, mean, p); k++) {
        double loss = descend(kernel, pool, material, isotropic, scouts, SCOUT_STEPS, 0.1, p);
        for (int i = 0; i < KEEP; i++)
            if (loss < losses[i]) { /* insert, shift the worse ones down */
                for (int j = KEEP - 1; j > i; j--) {
                    losses[j] = losses[j - 1];
                    memcpy(kept[j], kept[j - 1], sizeof kept[j]);
                }
                losses[i] = loss;
                memcpy(kept[i], p, sizeof kept[i]);
                break;
            }
    }
    int best = -1;
    double least = INFINITY;
    for (int i = 0; i < KEEP && losses[i] < INFINITY; i++) {
        double loss = descend(kernel, pool, material, isotropic, refiners, REFINE_STEPS, 0.03, kept[i]);
        if (best < 0 || loss < least) {
            best = i;
            least = loss;
        }
    }
    if (best < 0) { /* no start gave a finite loss: the mean colour, rough and faint */
        start(3, isotropic, mean, parameters);
        return NAN;
    }
    memcpy(parameters, kept[best], sizeof kept[best]);
    return least;
}
