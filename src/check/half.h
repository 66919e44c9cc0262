/* half.h: the half-precision variant of a network as exported, in C, each number with a bound. */
#ifndef HNBRDF_CHECK_HALF_H
#define HNBRDF_CHECK_HALF_H

#include "check/bounds.h"

/* The units of the last hidden layer from latent code and encoded directions: every conversion,
 * product and sum rounded to the nearest half, ties to even, which is what a device does that the
 * probe found exact. The bounds are on how far another one, or another order of the sums, may be
 * from that. */
void check_half_hidden(const check_rules *rules, const hnbrdf_model_desc *desc, const float *latent,
                       const check_tracked x[HNBRDF_ENCODING_SIZE],
                       check_tracked units[HNBRDF_MAX_HIDDEN]);

/* hnbrdf_network() and hnbrdf_eval() of that variant, values alone. Kinds without a network
 * evaluate as ever. */
void check_half_network(const hnbrdf_model_desc *desc, const float *latent,
                        const float x[HNBRDF_ENCODING_SIZE], float out[HNBRDF_MAX_OUTPUTS]);
void check_half_eval(const hnbrdf_model *model, const hnbrdf_material *material, const float wi[3],
                     const float wo[3], float f[3]);

#endif
