/* compare.c: SMAPE, MAE and MSE of a model against a measurement over drawn pairs of directions
 * (De Oliveira et al. 2026; the samplers are those of measured.h). */
#include "hnbrdf/metrics.h"

#include "base/error.h"

#include <math.h>
#include <string.h>

enum { BLOCK = 256, DRAWS_PER_PAIR = 1000 };

/* "compare": a sequence of its own, so that no error is measured on the pairs a fit was trained
 * on. */
static const uint64_t compare_sequence = 0x636f6d70617265u;

typedef struct pair_block {
    float wi[BLOCK][3], wo[BLOCK][3];
    float reference[BLOCK][3];
    size_t count;
} pair_block;

typedef struct error_sums {
    double smape, smape_analytic, absolute, squared;
} error_sums;

double hnbrdf_smape(double f, double reference)
{
    double sum = fabs(f) + fabs(reference);
    return sum > 0.0 ? 2.0 * fabs(f - reference) / sum : 0.0;
}

/* Fill the block with up to `wanted` valid pairs; *draws counts down the attempts that are left. */
static void draw_block(const hnbrdf_measured *measured, hnbrdf_sampler sampler, size_t wanted,
                       hnbrdf_rng *rng, uint64_t *draws, pair_block *block)
{
    size_t n = 0;
    for (; n<wanted && * draws> 0; --*draws) {
        hnbrdf_sampler_draw(sampler, rng, block->wi[n], block->wo[n]);
        if (hnbrdf_measured_eval(measured, block->wi[n], block->wo[n], block->reference[n]))
            n++;
    }
    block->count = n;
}

/* What is compared with the measurement: a material of a model, or another measurement. */
typedef struct compared {
    const hnbrdf_model *model;
    const hnbrdf_material *material;
    const hnbrdf_measured *approximation;
} compared;

/* f[n] and the analytic part of it, of the pairs of the block. */
static void eval_block(const compared *c, const pair_block *block, float f[][3],
                       float analytic[][3])
{
    if (!c->approximation)
        hnbrdf_eval_batch(c->model, c->material, block->count, block->wi[0], 0, block->wo[0], 0,
                          f[0], 0);
    for (size_t n = 0; n < block->count; n++)
        if (c->approximation) {
            hnbrdf_measured_eval(c->approximation, block->wi[n], block->wo[n], f[n]);
            memcpy(analytic[n], f[n], sizeof analytic[n]);
        } else {
            hnbrdf_eval_analytic(c->model, c->material, block->wi[n], block->wo[n], analytic[n]);
        }
}

static void add_block(const compared *c, const pair_block *block, error_sums *sums)
{
    float f[BLOCK][3], analytic[BLOCK][3];
    eval_block(c, block, f, analytic);
    for (size_t n = 0; n < block->count; n++)
        for (int channel = 0; channel < 3; channel++) {
            double reference = (double)block->reference[n][channel];
            double difference = (double)f[n][channel] - reference;
            sums->smape += hnbrdf_smape((double)f[n][channel], reference);
            sums->smape_analytic += hnbrdf_smape((double)analytic[n][channel], reference);
            sums->absolute += fabs(difference);
            sums->squared += difference * difference;
        }
}

static hnbrdf_result compare(const compared *c, const hnbrdf_measured *measured,
                             hnbrdf_sampler sampler, size_t pairs, uint64_t seed,
                             hnbrdf_comparison *comparison, hnbrdf_error *error)
{
    if (!hnbrdf_sampler_name(sampler))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "compare: no sampler has the number %d",
                           (int)sampler);
    if (pairs == 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "compare: 0 pairs, expected at least 1");

    uint64_t draws =
        pairs > UINT64_MAX / DRAWS_PER_PAIR ? UINT64_MAX : (uint64_t)pairs * DRAWS_PER_PAIR;
    error_sums sums = {0};
    size_t used = 0;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, seed, compare_sequence);
    while (used < pairs && draws > 0) {
        pair_block block;
        draw_block(measured, sampler, pairs - used < BLOCK ? pairs - used : BLOCK, &rng, &draws,
                   &block);
        add_block(c, &block, &sums);
        used += block.count;
    }
    if (used == 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "%s: none of %zu x %d %s pairs of directions has a valid measurement",
                           hnbrdf_measured_name(measured), pairs, (int)DRAWS_PER_PAIR,
                           hnbrdf_sampler_name(sampler));
    double values = 3.0 * (double)used;
    comparison->smape = sums.smape / values;
    comparison->smape_analytic = sums.smape_analytic / values;
    comparison->mae = sums.absolute / values;
    comparison->mse = sums.squared / values;
    comparison->pairs = used;
    return HNBRDF_OK;
}

hnbrdf_result hnbrdf_compare(const hnbrdf_model *model, const hnbrdf_material *material,
                             const hnbrdf_measured *measured, hnbrdf_sampler sampler, size_t pairs,
                             uint64_t seed, hnbrdf_comparison *comparison, hnbrdf_error *error)
{
    const compared c = {model, material, NULL};
    if (!model || !material || !measured || !comparison)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "compare: an argument is NULL");
    return compare(&c, measured, sampler, pairs, seed, comparison, error);
}

hnbrdf_result hnbrdf_compare_measured(const hnbrdf_measured *approximation,
                                      const hnbrdf_measured *measured, hnbrdf_sampler sampler,
                                      size_t pairs, uint64_t seed, hnbrdf_comparison *comparison,
                                      hnbrdf_error *error)
{
    const compared c = {NULL, NULL, approximation};
    if (!approximation || !measured || !comparison)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "compare: an argument is NULL");
    return compare(&c, measured, sampler, pairs, seed, comparison, error);
}
