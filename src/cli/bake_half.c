/* bake_half.c: what becomes of a baked network whose weights are rounded as an export in half
 * precision rounds them. */
#include "cli/bake.h"
#include "glsl/half.h"

#include <stdlib.h>

/* The numbers of layer k, rounded, into *to, which moves on. */
static void round_layer(const hnbrdf_model_desc *from, int k, float **to,
                        hnbrdf_model_desc *rounded)
{
    int rows = hnbrdf_layer_outputs(from, k), columns = hnbrdf_layer_inputs(from, k);
    rounded->weights[k] = *to;
    for (int i = 0; i < rows * columns; i++)
        *(*to)++ = hnbrdf_half_weight(from, k, from->weights[k][i]);
    rounded->biases[k] = *to;
    for (int i = 0; i < rows; i++)
        *(*to)++ = hnbrdf_half_bias(from, k, from->biases[k][i]);
}

hnbrdf_model *bake_half(const hnbrdf_model *model)
{
    hnbrdf_model_desc desc, rounded;
    hnbrdf_model *made = NULL;
    float *numbers = malloc(sizeof(float) * (hnbrdf_model_weight_count(model) + 1)), *to = numbers;
    if (!numbers)
        return NULL;
    hnbrdf_model_describe(model, &desc);
    rounded = desc;
    for (int k = 0; k <= desc.layers && desc.kind != HNBRDF_KIND_GGX; k++)
        round_layer(&desc, k, &to, &rounded);
    if (hnbrdf_model_create(&rounded, NULL, &made, NULL) != HNBRDF_OK)
        made = NULL;
    free(numbers);
    return made;
}
