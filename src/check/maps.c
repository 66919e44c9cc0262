/* maps.c: the relative error of implementations over (cos theta_h, alpha) and (cos theta_i, cos
 * theta_o). */
#include "check/maps.h"

#include "check/oracle.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { SIDE = STABILITY_MAP_SIDE, SAMPLES = 4, PER_BLOCK = STABILITY_BLOCK / SAMPLES };

static const double PI = 3.14159265358979323846, LOWEST = 1e-7;

/* Below the middle the logarithm of the cosine, above it that of one minus it. */
static double one_minus(double t, double near)
{
    return t < 0.5 ? 1.0 - LOWEST * pow(0.5 / LOWEST, 2.0 * t)
                   : near * pow(0.5 / near, 2.0 * (1.0 - t));
}

double stability_map_cosine(double t, double near)
{
    return t < 0.5 ? LOWEST * pow(0.5 / LOWEST, 2.0 * t) : 1.0 - one_minus(t, near);
}

double stability_map_position(double cosine, double one_minus_cosine, double near)
{
    return cosine < 0.5 ? 0.5 * log(cosine / LOWEST) / log(0.5 / LOWEST)
                        : 1.0 - 0.5 * log(one_minus_cosine / near) / log(0.5 / near);
}

/* cos is 1 - rest; the sine of that angle without cancellation, times (cos phi, sin phi). */
static void direction(double rest, double phi, double w[3])
{
    double sine = sqrt(rest * (2.0 - rest));
    w[0] = sine * cos(phi);
    w[1] = sine * sin(phi);
    w[2] = 1.0 - rest;
}

/* wi and wo on both sides of h, in the plane that holds h and the horizontal across it. */
static void pair_about(const double h[3], double phi, double theta_d, float pair[6])
{
    const double across[3] = {-sin(phi), cos(phi), 0.0};
    for (int i = 0; i < 3; i++) {
        pair[i] = (float)(cos(theta_d) * h[i] + sin(theta_d) * across[i]);
        pair[3 + i] = (float)(cos(theta_d) * h[i] - sin(theta_d) * across[i]);
    }
}

static void make_pair(stability_map_kind kind, hnbrdf_rng *rng, int row, int column, float pair[6])
{
    double x = (column + (double)hnbrdf_rng_float(rng)) / SIDE,
           y = (row + (double)hnbrdf_rng_float(rng)) / SIDE;
    double phi = 2.0 * PI * (double)hnbrdf_rng_float(rng), other = (double)hnbrdf_rng_float(rng),
           w[3];
    if (kind == STABILITY_MAP_HALF) {
        direction(one_minus(x, STABILITY_NEAR_HALF), phi, w);
        if (x < 0.5)
            w[2] = stability_map_cosine(x, STABILITY_NEAR_HALF);
        pair_about(w, phi, 0.49 * PI * other, pair);
        return;
    }
    for (int d = 0; d < 2; d++) {
        double t = d ? y : x;
        direction(one_minus(t, STABILITY_NEAR_COSINE), d ? 2.0 * PI * other : phi, w);
        w[2] = stability_map_cosine(t, STABILITY_NEAR_COSINE);
        for (int i = 0; i < 3; i++)
            pair[3 * d + i] = (float)w[i];
    }
}

static double relative_error(stability_map_kind kind, const oracle_point *point, const float f[3])
{
    double worst = 0.0;
    for (int c = 0; c < 3; c++) {
        double expected = kind == STABILITY_MAP_HALF ? point->analytic[c] : point->value[c];
        double scale = kind == STABILITY_MAP_HALF ? expected : point->scale[c];
        worst = fmax(worst, fabs((double)f[c] - expected) / fmax(scale, (double)FLT_MIN));
    }
    return worst;
}

/* PER_BLOCK cells of one row from `column` on. */
static hnbrdf_result map_block(const hnbrdf_model_desc *desc, stability_map_kind kind,
                               hnbrdf_rng *rng, int row, int column, stability_block *block,
                               stability_backend *const *backends, int count,
                               float (*errors)[SIDE][SIDE], hnbrdf_error *error)
{
    stability_stage stage = kind == STABILITY_MAP_HALF ? STABILITY_ANALYTIC : STABILITY_VALUE;
    oracle_point points[STABILITY_BLOCK];
    float values[STABILITY_BLOCK][STABILITY_NUMBERS];
    for (int k = 0; k < STABILITY_BLOCK; k++) {
        make_pair(kind, rng, row, column + k / SAMPLES, block->pairs[k]);
        oracle_evaluate(desc, &block->material, block->pairs[k], block->pairs[k] + 3, &points[k]);
    }
    for (int b = 0; b < count; b++) {
        hnbrdf_result result = backends[b]->run(backends[b], stage, block, values, error);
        if (result)
            return result;
        for (int k = 0; k < STABILITY_BLOCK; k++) {
            float *cell = &errors[b][row][column + k / SAMPLES];
            *cell = fmaxf(*cell, (float)relative_error(kind, &points[k], values[k]));
        }
    }
    return HNBRDF_OK;
}

hnbrdf_result stability_map(const hnbrdf_model *model, const hnbrdf_material *material,
                            stability_map_kind kind, stability_backend *const *backends, int count,
                            float (*errors)[SIDE][SIDE], hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_rng rng;
    stability_block block;
    hnbrdf_model_describe(model, &desc);
    if (kind == STABILITY_MAP_HALF && desc.kind == HNBRDF_KIND_HYBRID)
        desc.kind =
            HNBRDF_KIND_GGX; /* f_a is all that is looked at, and the oracle's network is slow */
    hnbrdf_rng_seed(&rng, 1, (uint64_t)kind);
    memset(errors, 0, (size_t)count * sizeof *errors);
    memset(&block, 0, sizeof block);
    block.material = *material;
    hnbrdf_result result = HNBRDF_OK;
    for (int row = 0; row < SIDE; row++) {
        if (kind == STABILITY_MAP_HALF) {
            float alpha = powf(10.0f, -4.0f * (1.0f - ((float)row + 0.5f) / SIDE));
            block.material.alpha[0] = block.material.alpha[1] = alpha;
            block.material.rotation = 0.0f;
        }
        for (int column = 0; column < SIDE && !result; column += PER_BLOCK)
            result =
                map_block(&desc, kind, &rng, row, column, &block, backends, count, errors, error);
    }
    return result;
}
