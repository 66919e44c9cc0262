/* ggx.c: fit Lambert + one GGX lobe to one material. */
#include "fit/ggx.h"

#include "core/frame.h"
#include "core/microfacet.h"
#include "fit/adam.h"

#include <math.h>
#include <string.h>

enum {
    SCOUT_STEPS = 120, /* every start, on SCOUT_TILES */
    SCOUT_TILES = 24,
    KEEP = 3, /* starts that go on, on REFINE_TILES */
    REFINE_STEPS = 250,
    REFINE_TILES = FIT_GGX_TILES
};

/* Isotropic: the alphas tied, no rotation; all; all but the rotation. */
typedef enum ggx_freedom { GGX_FREE, GGX_TIED, GGX_HELD } ggx_freedom;

/* Nearer than this, in radians, a lobe lies along the axis anyway, and is the better judge. */
#define AXIS_NEAR 0.03
/* Times the loss of the best lobe: what one along the axis may have. */
#define AXIS_COST 1.03

/* SMAPE saturates: far from the data it is flat, and the channels of a grey lobe then settle on
 * different colours. A share of log-L1, which never does, decides. */
#define FINAL_MIX 0.7f

void hnbrdf_fit_ggx_project(float *p, int isotropic)
{
    for (int c = 0; c < 3; c++) {
        p[FIT_KD + c] = hnbrdf_clamp(p[FIT_KD + c], 0.0f, 1.0f);
        p[FIT_ETA + c] = hnbrdf_clamp(p[FIT_ETA + c], -6.9f, 4.595f); /* ln 0.001, ln 99 */
    }
    if (isotropic) {
        p[FIT_ALPHA] = p[FIT_ALPHA + 1] = 0.5f * (p[FIT_ALPHA] + p[FIT_ALPHA + 1]);
        p[FIT_ROTATION] = 0.0f;
    }
    for (int a = 0; a < 2; a++)
        p[FIT_ALPHA + a] = hnbrdf_clamp(p[FIT_ALPHA + a], -9.2103f, 0.0f); /* ln 1.0001e-4 */
}

void hnbrdf_fit_ggx_parameters(const hnbrdf_material *material, float *p)
{
    for (int c = 0; c < 3; c++) {
        p[FIT_KD + c] = material->kd[c];
        p[FIT_ETA + c] = logf(material->eta[c] - 1.0f);
    }
    for (int a = 0; a < 2; a++)
        p[FIT_ALPHA + a] = logf(material->alpha[a]);
    p[FIT_ROTATION] = material->rotation;
    hnbrdf_fit_ggx_project(p, 0);
}

void hnbrdf_fit_ggx_material(const float *p, hnbrdf_material *material)
{
    for (int c = 0; c < 3; c++) {
        material->kd[c] = hnbrdf_clamp(p[FIT_KD + c], 0.0f, 1.0f);
        material->eta[c] = hnbrdf_clamp(1.0f + expf(p[FIT_ETA + c]), 1.001f, 100.0f);
    }
    for (int a = 0; a < 2; a++)
        material->alpha[a] =
            hnbrdf_clamp(expf(p[FIT_ALPHA + a]), HNBRDF_MIN_ALPHA, HNBRDF_MAX_ALPHA);
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

/* Adam from p on; p ends as the best state seen. Returns its loss. */
static double descend(const fit_kernel *kernel, const fit_pool *pool, int material,
                      ggx_freedom freedom, int tiles, int steps, double rate, float *p)
{
    float moments[2 * FIT_ANALYTIC] = {0}, gradient[FIT_ANALYTIC], best[FIT_ANALYTIC];
    memcpy(best, p, sizeof best);
    double least = INFINITY;
    for (int step = 1; step <= steps + 1; step++) {
        double share = (double)step / steps;
        float mix = FINAL_MIX * (float)fmin(1.0, 2.0 * share);
        double loss = loss_of(kernel, pool, material, tiles, mix, p, gradient);
        if (mix >= FINAL_MIX && loss < least) {
            least = loss;
            memcpy(best, p, sizeof best);
        }
        if (freedom == GGX_TIED)
            gradient[FIT_ALPHA] = gradient[FIT_ALPHA + 1] =
                0.5f * (gradient[FIT_ALPHA] + gradient[FIT_ALPHA + 1]);
        if (freedom != GGX_FREE)
            gradient[FIT_ROTATION] = 0.0f;
        hnbrdf_fit_adam(p, gradient, moments, moments + FIT_ANALYTIC, FIT_ANALYTIC, step,
                        rate * (1.02 - fmin(1.0, share)));
        hnbrdf_fit_ggx_project(p, freedom == GGX_TIED);
    }
    memcpy(p, best, sizeof best);
    return least;
}

#define QUARTER 1.57079632679489662f

/* A lobe has two descriptions, a quarter of a turn apart: x is where it is narrower, along the
 * grooves of a brushed metal. Materials alike then have frames alike, for the network that they
 * share, and for mixtures. */
static void settle_frame(float *p)
{
    const float along = p[FIT_ALPHA + 1];
    if (!(p[FIT_ALPHA] > along))
        return;
    p[FIT_ALPHA + 1] = p[FIT_ALPHA];
    p[FIT_ALPHA] = along;
    p[FIT_ROTATION] += p[FIT_ROTATION] > 0.0f ? -QUARTER : QUARTER;
}

/* The same lobe with its rotation at the nearest of the axis and what is across it, if that costs
 * nearly nothing: a lobe about as wide along as across lies anywhere, but what the network learns
 * does not. */
static double turn_to_axis(const fit_kernel *kernel, const fit_pool *pool, int material, int tiles,
                           double axis, double loss, float *parameters)
{
    double off = remainder(axis - (double)parameters[FIT_ROTATION], (double)QUARTER);
    float p[FIT_ANALYTIC];
    if (fabs(off) < AXIS_NEAR)
        return loss;
    memcpy(p, parameters, sizeof p);
    p[FIT_ROTATION] += (float)off;
    double turned = descend(kernel, pool, material, GGX_HELD, tiles, REFINE_STEPS, 0.03, p);
    if (!(turned <= AXIS_COST * loss))
        return loss;
    memcpy(parameters, p, sizeof p);
    return turned;
}

/* ---- Diffuse and reflectance of one channel -----------------------------------------------------
 * With the lobe given, kd and eta of a  * channel are found by search: its loss has several
 * minima in them (a dark channel may be read as  * diffuse or as the lobe's tail) where Adam
 * stays in the nearest. */

enum { SEARCH_PAIRS = SCOUT_TILES * FIT_TILE, SEARCH_KD = 25, SEARCH_ETA = 17 };

typedef struct lobe {
    float specular[SEARCH_PAIRS], c[SEARCH_PAIRS]; /* D V V and wi.h of every pair */
    int pairs;
} lobe;

static void lobe_make(const fit_pool *pool, int material, int tiles, const float *p, lobe *l)
{
    hnbrdf_material m;
    hnbrdf_fit_ggx_material(p, &m);
    hnbrdf_frame frame = hnbrdf_frame_of(&m);
    l->pairs = tiles * FIT_TILE;
    for (int k = 0; k < l->pairs; k++) {
        fit_tile tile = hnbrdf_fit_pool_view(pool, material, k / FIT_TILE);
        int b = k % FIT_TILE;
        const float wi[3] = {tile.wi[b], tile.wi[FIT_TILE + b], tile.wi[2 * FIT_TILE + b]};
        const float wo[3] = {tile.wo[b], tile.wo[FIT_TILE + b], tile.wo[2 * FIT_TILE + b]};
        float i[3], o[3];
        hnbrdf_to_tangent(frame, wi, i);
        hnbrdf_to_tangent(frame, wo, o);
        hnbrdf_pair pair = hnbrdf_pair_make(i, o);
        l->specular[k] = hnbrdf_specular(&pair, m.alpha[0], m.alpha[1]);
        l->c[k] = pair.c;
    }
}

static double channel_loss(const float *reflected, const float *target, int pairs, float kd)
{
    double sum = 0.0;
    for (int k = 0; k < pairs; k++) {
        float f = kd * HNBRDF_INV_PI + reflected[k], t = target[k];
        float smape = 2.0f * fabsf(f - t) / (f + t + (float)FIT_SMAPE_OFFSET);
        float ratio = hnbrdf_log((f + (float)FIT_LOG_OFFSET) / (t + (float)FIT_LOG_OFFSET));
        sum += (double)(FINAL_MIX * smape + (1.0f - FINAL_MIX) * fabsf(ratio));
    }
    return sum;
}

/* Moves kd and eta of every channel to the best of a grid, if that is better than where they are.
 * */
static void search_channels(const fit_pool *pool, int material, int tiles, float *p)
{
    lobe l;
    lobe_make(pool, material, tiles, p, &l);
    for (int c = 0; c < 3; c++) {
        float target[SEARCH_PAIRS], reflected[SEARCH_PAIRS];
        float best_kd = p[FIT_KD + c], best_eta = p[FIT_ETA + c];
        double least = INFINITY;
        for (int k = 0; k < l.pairs; k++)
            target[k] = hnbrdf_fit_pool_view(pool, material, k / FIT_TILE)
                            .target[c * FIT_TILE + k % FIT_TILE];
        for (int e = -1; e < SEARCH_ETA; e++) { /* -1: where it is; then eta - 1 from 0.01 to 90 */
            float above = e < 0 ? p[FIT_ETA + c] : logf(0.01f) + 9.1f * (float)e / (SEARCH_ETA - 1);
            for (int k = 0; k < l.pairs; k++)
                reflected[k] =
                    hnbrdf_fresnel_dielectric(1.0f + expf(above), l.c[k]) * l.specular[k];
            for (int d = -1; d < SEARCH_KD; d++) { /* -1: where it is; 0; then 1e-3 to 1 */
                float kd =
                    d < 0 ? p[FIT_KD + c]
                          : (d == 0 ? 0.0f
                                    : expf(-6.9f * (float)(SEARCH_KD - 1 - d) / (SEARCH_KD - 2)));
                double loss = channel_loss(reflected, target, l.pairs, kd);
                if (loss < least) {
                    least = loss;
                    best_kd = kd;
                    best_eta = above;
                }
            }
        }
        p[FIT_KD + c] = best_kd;
        p[FIT_ETA + c] = best_eta;
    }
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
        p[FIT_KD + c] = hnbrdf_clamp(mean[c], 0.001f, 0.99f);
        p[FIT_ETA + c] = logf(eta - 1.0f);
    }
    p[FIT_ALPHA] = logf(axis == 1 ? 3.0f * alpha : alpha);
    p[FIT_ALPHA + 1] = logf(axis == 2 ? 3.0f * alpha : alpha);
    p[FIT_ROTATION] = turns[k / 8 / axes];
    return 1;
}

/* The best of several states, best first. */
typedef struct ranking {
    double losses[KEEP];
    float states[KEEP][FIT_ANALYTIC];
} ranking;

static void rank(ranking *r, double loss, const float *p)
{
    int i = 0;
    while (i < KEEP && !(loss < r->losses[i]))
        i++;
    for (int j = KEEP - 1; j > i; j--) {
        r->losses[j] = r->losses[j - 1];
        memcpy(r->states[j], r->states[j - 1], sizeof r->states[j]);
    }
    if (i < KEEP) {
        r->losses[i] = loss;
        memcpy(r->states[i], p, sizeof r->states[i]);
    }
}

static void rank_nothing(ranking *r)
{
    for (int i = 0; i < KEEP; i++)
        r->losses[i] = INFINITY;
}

/* Geometric mean of f, times pi: a robust albedo. */
static void mean_albedo(const fit_pool *pool, int material, int tiles, float mean[3])
{
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        for (int t = 0; t < tiles; t++)
            for (int b = 0; b < FIT_TILE; b++)
                sum +=
                    log((double)hnbrdf_fit_pool_view(pool, material, t).target[c * FIT_TILE + b] +
                        1e-4);
        mean[c] = 3.14159265f * (float)exp(sum / (tiles * FIT_TILE));
    }
}

double hnbrdf_fit_ggx(const fit_kernel *kernel, const fit_pool *pool, int material, int isotropic,
                      double axis, float *parameters, hnbrdf_fit_search *search)
{
    const ggx_freedom freedom = isotropic ? GGX_TIED : GGX_FREE;
    int scouts = SCOUT_TILES < pool->tiles ? SCOUT_TILES : pool->tiles;
    int refiners = REFINE_TILES < pool->tiles ? REFINE_TILES : pool->tiles, starts;
    float p[FIT_ANALYTIC], mean[3];
    ranking scouted, refined;
    rank_nothing(&scouted);
    rank_nothing(&refined);
    mean_albedo(pool, material, scouts, mean);
    for (starts = 0; start(starts, isotropic, mean, p); starts++) {
        double loss = descend(kernel, pool, material, freedom, scouts, SCOUT_STEPS, 0.1, p);
        rank(&scouted, loss, p);
    }
    for (int i = 0; i < KEEP && scouted.losses[i] < INFINITY; i++) {
        float *kept = scouted.states[i];
        search_channels(pool, material, scouts, kept);
        double loss = descend(kernel, pool, material, freedom, refiners, REFINE_STEPS, 0.03, kept);
        rank(&refined, loss, kept);
    }
    if (search) {
        *search = (hnbrdf_fit_search){starts, refined.losses[0], refined.losses[1], {0.0f, 0.0f}};
        for (int a = 0; a < 2 && refined.losses[1] < INFINITY; a++)
            search->second_alpha[a] = expf(refined.states[1][FIT_ALPHA + a]);
    }
    if (!(refined.losses[0] < INFINITY)) { /* no finite loss: the mean colour, rough and faint */
        start(3, isotropic, mean, parameters);
        return NAN;
    }
    memcpy(parameters, refined.states[0], sizeof refined.states[0]);
    if (isotropic)
        return refined.losses[0];
    const double loss =
        turn_to_axis(kernel, pool, material, refiners, axis, refined.losses[0], parameters);
    settle_frame(parameters);
    return loss;
}
