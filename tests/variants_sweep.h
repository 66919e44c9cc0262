/* variants_sweep.h: inputs for the comparison of variants, made by exact operations alone, so that
 * every machine makes the same: integers, one rounding a number, sqrt. */
#ifndef HNBRDF_TESTS_VARIANTS_SWEEP_H
#define HNBRDF_TESTS_VARIANTS_SWEEP_H

#include "hnbrdf/hnbrdf.h"

#include <stdint.h>

/* xorshift64* (Vigna 2016); any state but 0. */
typedef struct sweep {
    uint64_t state;
} sweep;

uint32_t sweep_u32(sweep *s);
float sweep_unit(sweep *s); /* (u32 >> 8) 2^-24, in [0, 1) */
float sweep_range(sweep *s, float low, float high);

/* Unit vectors above the horizon, and every eighth time or so one that nobody should pass: below,
 * on the horizon, -0, grazing, the mirror of the other, no unit vector, NaN, infinite, denormal,
 * huge. */
void sweep_pair(sweep *s, float wi[3], float wo[3]);

/* Legal; with `wild` set now and then one field that is not. */
void sweep_material(sweep *s, int wild, hnbrdf_material *material);

/* Weights in +-2/sqrt(inputs), two materials. NULL on failure. */
hnbrdf_model *sweep_model(sweep *s, hnbrdf_kind kind, hnbrdf_encoding encoding, int hidden,
                          int layers, int latent);

/* The same model for another variant. */
hnbrdf_model *sweep_variant(const hnbrdf_model *model, hnbrdf_variant variant);

#endif
