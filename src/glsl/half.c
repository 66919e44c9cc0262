/* half.c: the numbers of a network in half precision. */
#include "glsl/half.h"

/* 66 roundings of 2^-10 each may add 6.7 %: 60000 leaves 9 % to 65504. */
static const float LARGEST_SUM = 60000.0f;

/* The largest half not above x, which is at least 2^-14. */
static float round_down(float x)
{
    int exponent;
    frexpf(x, &exponent);
    float unit = ldexpf(1.0f, exponent - 11);
    return floorf(x / unit) * unit;
}

float hnbrdf_half_limit(const hnbrdf_model_desc *desc, int layer)
{
    float limit = LARGEST_SUM;
    int rows = hnbrdf_layer_outputs(desc, layer), columns = hnbrdf_layer_inputs(desc, layer);
    for (int row = 0; row < rows && layer < desc->layers; row++) {
        const float *w = desc->weights[layer] + (size_t)row * (size_t)columns;
        float size = 0.0f;
        for (int i = 0; i < columns; i++)
            size += fabsf(hnbrdf_half_weight(desc, layer, w[i]));
        float left = LARGEST_SUM - fabsf(hnbrdf_half_bias(desc, layer, desc->biases[layer][row]));
        limit = limit * size > left ? left / size : limit;
    }
    return round_down(limit);
}
