/* half.h: what a network in half precision is made of; its numbers are kept in floats. */
#ifndef HNBRDF_GLSL_HALF_H
#define HNBRDF_GLSL_HALF_H

#include "core/half.h"
#include "core/model.h"

#include <math.h>

/* The nearest number of half precision; beyond 65504 that. */
static inline float hnbrdf_round_to_half(float x)
{
    return hnbrdf_float_of_half(hnbrdf_half_of(x));
}

/* A number of a network in half precision. Biases may reach 8192 and weights of hidden layers 2048;
 * with units of at least -0.1875, which is as low as HardGELU goes, 64 of them cannot pass 65504
 * below zero. The last layer is in single precision and keeps its numbers. */
static inline float hnbrdf_half_weight(const hnbrdf_model_desc *desc, int layer, float weight)
{
    return layer < desc->layers ? hnbrdf_round_to_half(fminf(fmaxf(weight, -2048.0f), 2048.0f))
                                : weight;
}

static inline float hnbrdf_half_bias(const hnbrdf_model_desc *desc, int layer, float bias)
{
    return layer < desc->layers ? hnbrdf_round_to_half(fminf(fmaxf(bias, -8192.0f), 8192.0f))
                                : bias;
}

/* The largest size that inputs (layer 0) or units of the layer before may have, so that no sum of
 * this layer passes 65504, its roundings included. A number of half precision; 60000 at most, as
 * for the last layer. */
float hnbrdf_half_limit(const hnbrdf_model_desc *desc, int layer);

#endif
