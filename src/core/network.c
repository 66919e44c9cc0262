/* network.c: the network in plain C, one evaluation and a block of evaluations with the same bits. */
#include "core/network.h"

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

/* Four rows at a time: four independent chains of additions instead of one. */
static void layer_single(const float *weights, const float *biases, int rows, int stride, int first,
                         int columns, const float *x, float *sums)
{
    int r = 0;
    for (; r + 4 <= rows; r += 4) {
        const float *w0 = weights + (size_t)r * (size_t)stride + first;
        const float *w1 = w0 + stride, *w2 = w1 + stride, *w3 = w2 + stride;
        float s0 = biases[r], s1 = biases[r + 1], s2 = biases[r + 2], s3 = biases[r + 3];
        for (int i = 0; i < columns; i++) {
            s0 += w0[i] * x[i];
            s1 += w1[i] * x[i];
            s2 += w2[i] * x[i];
            s3 += w3[i] * x[i];
        }
        sums[r] = s0;
        sums[r + 1] = s1;
        sums[r + 2] = s2;
        sums[r + 3] = s3;
    }
    for (; r < rows; r++) {
        const float *w = weights + (size_t)r * (size_t)stride + first;
        float s = biases[r];
        for (int i = 0; i < columns; i++)
            s += w[i] * x[i];
        sums[r] = s;
    }
}

void hnbrdf_network(const hnbrdf_model_desc *desc, const float *latent, const float *x, float *out)
{
    float folded[HNBRDF_MAX_HIDDEN], a[HNBRDF_MAX_HIDDEN], b[HNBRDF_MAX_HIDDEN];
    int stride = HNBRDF_ENCODING_SIZE + desc->latent;
    layer_single(desc->weights[0], desc->biases[0], desc->hidden, stride, HNBRDF_ENCODING_SIZE,
                 desc->latent, latent, folded);
    layer_single(desc->weights[0], folded, desc->hidden, stride, 0, HNBRDF_ENCODING_SIZE, x, b);
    for (int k = 1; k <= desc->layers; k++) {
        for (int i = 0; i < desc->hidden; i++)
            a[i] = hnbrdf_hard_gelu(b[i]);
        float *to = k < desc->layers ? b : out;
        layer_single(desc->weights[k], desc->biases[k], hnbrdf_layer_outputs(desc, k), desc->hidden, 0,
                     desc->hidden, a, to);
    }
}

/* Two rows at a time: every input is loaded once for both. */
static void layer_block(const float *weights, const float *biases, int rows, int stride, int columns,
                        float (*x)[HNBRDF_LANES], float (*sums)[HNBRDF_LANES])
{
    for (int r = 0; r < rows; r += 2) {
        int next = r + 1 < rows ? r + 1 : r; /* an odd last row is computed twice */
        const float *w = weights + (size_t)r * (size_t)stride, *v = weights + (size_t)next * (size_t)stride;
        float s[HNBRDF_LANES], t[HNBRDF_LANES];
        for (int l = 0; l < HNBRDF_LANES; l++) {
            s[l] = biases[r];
            t[l] = biases[next];
        }
        for (int i = 0; i < columns; i++)
            for (int l = 0; l < HNBRDF_LANES; l++) {
                s[l] += w[i] * x[i][l];
                t[l] += v[i] * x[i][l];
            }
        for (int l = 0; l < HNBRDF_LANES; l++) {
            sums[r][l] = s[l];
            sums[next][l] = t[l];
        }
    }
}

void hnbrdf_network_block(const hnbrdf_model_desc *desc, const float *latent,
                          float x[HNBRDF_ENCODING_SIZE][HNBRDF_LANES],
                          float out[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES])
{
    float folded[HNBRDF_MAX_HIDDEN];
    float a[HNBRDF_MAX_HIDDEN][HNBRDF_LANES], b[HNBRDF_MAX_HIDDEN][HNBRDF_LANES];
    int stride = HNBRDF_ENCODING_SIZE + desc->latent;
    layer_single(desc->weights[0], desc->biases[0], desc->hidden, stride, HNBRDF_ENCODING_SIZE,
                 desc->latent, latent, folded);
    layer_block(desc->weights[0], folded, desc->hidden, stride, HNBRDF_ENCODING_SIZE, x, b);
    for (int k = 1; k <= desc->layers; k++) {
        for (int i = 0; i < desc->hidden; i++)
            for (int l = 0; l < HNBRDF_LANES; l++)
                a[i][l] = hnbrdf_hard_gelu(b[i][l]);
        layer_block(desc->weights[k], desc->biases[k], hnbrdf_layer_outputs(desc, k), desc->hidden,
                    desc->hidden, a, k < desc->layers ? b : out);
    }
}
