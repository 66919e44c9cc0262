/* network.c: the network by its definition, one evaluation in plain C, and its shape. */
#include "core/kernel.h"

int hnbrdf_layer_inputs(const hnbrdf_model_desc *desc, int layer)
{
    return layer == 0 ? HNBRDF_ENCODING_SIZE + desc->latent : desc->hidden;
}

int hnbrdf_layer_outputs(const hnbrdf_model_desc *desc, int layer)
{
    if (layer < desc->layers)
        return desc->hidden;
    return desc->kind == HNBRDF_KIND_HYBRID ? 6 : 3;
}

static float row(float sum, const float *weights, int columns, const float *x)
{
    for (int i = 0; i < columns; i++)
        sum += weights[i] * x[i];
    return sum;
}

void hnbrdf_network(const hnbrdf_model_desc *desc, const float *latent, const float *x, float *out)
{
    float a[HNBRDF_MAX_HIDDEN], b[HNBRDF_MAX_HIDDEN];
    for (int r = 0; r < desc->hidden; r++) {
        const float *weights = desc->weights[0] + r * (HNBRDF_ENCODING_SIZE + desc->latent);
        float folded =
            row(desc->biases[0][r], weights + HNBRDF_ENCODING_SIZE, desc->latent, latent);
        b[r] = row(folded, weights, HNBRDF_ENCODING_SIZE, x);
    }
    for (int k = 1; k <= desc->layers; k++) {
        float *to = k < desc->layers ? b : out;
        for (int i = 0; i < desc->hidden; i++)
            a[i] = hnbrdf_hard_gelu(b[i]);
        for (int r = 0; r < hnbrdf_layer_outputs(desc, k); r++)
            to[r] = row(desc->biases[k][r], desc->weights[k] + r * desc->hidden, desc->hidden, a);
    }
}

void hnbrdf_network_block(const hnbrdf_prepared *prepared,
                          float x[HNBRDF_ENCODING_SIZE][HNBRDF_LANES],
                          float out[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES])
{
    prepared->model->kernel->network(prepared, x, out);
}
