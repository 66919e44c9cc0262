/* network.h: the network, a plain MLP with HardGELU hidden layers. One canonical order of
 * summation: bias, latent inputs, encoded directions, each in index order, product by
 * product. */
#ifndef HNBRDF_CORE_NETWORK_H
#define HNBRDF_CORE_NETWORK_H

#include "core/model.h"

/* Evaluations that the block form does side by side. */
enum { HNBRDF_LANES = 16 };

/* x clamp(x/3 + 1/2, 0, 1), the paper's three-branch HardGELU. */
static inline float hnbrdf_hard_gelu(float x)
{
    float t = x * 0.333333333f + 0.5f;
    t = t < 0.0f ? 0.0f : t;
    t = t > 1.0f ? 1.0f : t;
    return x * t;
}

/* out[hnbrdf_layer_outputs(last)] of one evaluation. latent is [desc->latent], x is [6]. From the
 * weights as the description gives them, row by row: what every kernel is held to. */
void hnbrdf_network(const hnbrdf_model_desc *desc, const float *latent, const float *x, float *out);

/* The same bits for HNBRDF_LANES evaluations by the model's kernel: x[input][lane],
 * out[output][lane]. The latent code is the prepared material's. */
void hnbrdf_network_block(const hnbrdf_prepared *prepared,
                          float x[HNBRDF_ENCODING_SIZE][HNBRDF_LANES],
                          float out[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES]);

#endif
