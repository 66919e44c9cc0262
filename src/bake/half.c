/* half.c: what becomes of a baked network whose weights are rounded as an export in half precision
 * rounds them. */
#include "bake/task.h"
#include "glsl/half.h"

#include <stdlib.h>

enum { DIRECTION_INPUTS = 6, OUTPUTS = 6 }; /* of a hybrid with any encoding */

/* The numbers of layer k, rounded, into *to, which moves on. */
static void round_layer(const hnbrdf_model_desc *from, int k, float **to,
                        hnbrdf_model_desc *rounded)
{
    int rows = k == from->layers ? OUTPUTS : from->hidden;
    int columns = k == 0 ? DIRECTION_INPUTS + from->latent : from->hidden;
    rounded->weights[k] = *to;
    for (int i = 0; i < rows * columns; i++)
        *(*to)++ = hnbrdf_half_weight(from, k, from->weights[k][i]);
    rounded->biases[k] = *to;
    for (int i = 0; i < rows; i++)
        *(*to)++ = hnbrdf_half_bias(from, k, from->biases[k][i]);
}

hnbrdf_model *hnbrdf_bake_half(const hnbrdf_model *model)
{
    hnbrdf_model_desc desc, rounded;
    hnbrdf_model *made = NULL;
    float *numbers = malloc(sizeof(float) * hnbrdf_model_weight_count(model)), *to = numbers;
    if (!numbers)
        return NULL;
    hnbrdf_model_describe(model, &desc);
    rounded = desc;
    for (int k = 0; k <= desc.layers; k++)
        round_layer(&desc, k, &to, &rounded);
    if (hnbrdf_model_create(&rounded, NULL, &made, NULL) != HNBRDF_OK)
        made = NULL;
    free(numbers);
    return made;
}

int hnbrdf_bake_needs_half(const bake_task *b, const hnbrdf_bake_size *size)
{
    return b->options.wish == HNBRDF_BAKE_TIME && size->ns > b->options.max_ns &&
           size->half_ns <= b->options.max_ns;
}
