/* export_weights.c: a network as the bytes of a uniform block. */
#include "glsl/export_weights.h"

#include "base/error.h"
#include "glsl/half.h"

int hnbrdf_layer_groups(const hnbrdf_model_desc *desc, int layer)
{
    return (hnbrdf_layer_outputs(desc, layer) + 3) / 4;
}

int hnbrdf_layer_columns(const hnbrdf_model_desc *desc, int layer)
{
    int inputs = hnbrdf_layer_inputs(desc, layer);
    return layer == 0 ? inputs : (inputs + 3) / 4 * 4;
}

int hnbrdf_layer_start(const hnbrdf_model_desc *desc, int layer)
{
    int start = HNBRDF_WEIGHTS_HEADER;
    for (int k = 0; k < layer; k++)
        start += hnbrdf_layer_groups(desc, k) * (1 + hnbrdf_layer_columns(desc, k));
    return start;
}

int hnbrdf_summed_column(const hnbrdf_model_desc *desc, int layer, int i)
{
    if (layer > 0)
        return i;
    return i < desc->latent ? HNBRDF_ENCODING_SIZE + i : i - desc->latent;
}

size_t hnbrdf_weights_size(const hnbrdf_model *model)
{
    const hnbrdf_model_desc *desc = &model->desc;
    if (desc->kind == HNBRDF_KIND_GGX)
        return 0;
    return (size_t)hnbrdf_layer_start(desc, desc->layers + 1) * 4 * sizeof(float);
}

/* The bias (column -1) or a weight of one output; 0 outside of the matrix. */
static float number_at(const hnbrdf_model_desc *desc, int half, int layer, int row, int column)
{
    int inputs = hnbrdf_layer_inputs(desc, layer);
    if (row >= hnbrdf_layer_outputs(desc, layer) || column >= inputs)
        return 0.0f;
    if (column < 0) {
        float bias = desc->biases[layer][row];
        return half ? hnbrdf_half_bias(desc, layer, bias) : bias;
    }
    float weight = desc->weights[layer][row * inputs + hnbrdf_summed_column(desc, layer, column)];
    return half ? hnbrdf_half_weight(desc, layer, weight) : weight;
}

static int write_header(const hnbrdf_model_desc *desc, int half, hnbrdf_write_fn write, void *user)
{
    float header[4 * HNBRDF_WEIGHTS_HEADER] = {desc->scale, desc->shift, desc->floor};
    for (int layer = 0; layer <= desc->layers && half; layer++)
        header[3 + layer] = hnbrdf_half_limit(desc, layer);
    return write(user, header, sizeof header);
}

static int write_layer(const hnbrdf_model_desc *desc, int half, int layer, hnbrdf_write_fn write,
                       void *user)
{
    int groups = hnbrdf_layer_groups(desc, layer), columns = hnbrdf_layer_columns(desc, layer);
    for (int group = 0; group < groups; group++)
        for (int column = -1; column < columns; column++) {
            float numbers[4];
            for (int i = 0; i < 4; i++)
                numbers[i] = number_at(desc, half, layer, 4 * group + i, column);
            if (write(user, numbers, sizeof numbers) != 0)
                return 1;
        }
    return 0;
}

hnbrdf_result hnbrdf_export_weights(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                                    hnbrdf_write_fn write, void *user, hnbrdf_error *error)
{
    const hnbrdf_model_desc *desc = &model->desc;
    hnbrdf_glsl_precision precision = options ? options->precision : HNBRDF_GLSL_FLOAT;
    if (!hnbrdf_glsl_precision_name(precision))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "export: precision is %d, expected 0 or 1",
                           (int)precision);
    if (desc->kind == HNBRDF_KIND_GGX)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "export: a ggx model has no weights to put into a buffer");
    int half = precision == HNBRDF_GLSL_HALF;
    int failed = write_header(desc, half, write, user);
    for (int layer = 0; layer <= desc->layers && !failed; layer++)
        failed = write_layer(desc, half, layer, write, user);
    if (failed)
        return hnbrdf_fail(error, HNBRDF_ERROR_IO, "export: writing the weights failed");
    return HNBRDF_OK;
}
