/* export_network.c: the network of a scene as GLSL, weights as constants in unrolled expressions. */
#include "model/export_network.h"

/* The values of layer k are a0, a1, ... of the first hidden layer, b0, ... of the second. */
static void put_unit(hnbrdf_printer *out, int layer, int unit)
{
    hnbrdf_put(out, "%c%d", 'a' + layer, unit);
}

/* " + weight * input"; a weight of zero has no term. Breaks the line after every fourth. */
typedef struct sum {
    hnbrdf_printer *out;
    int terms;
} sum;

static int begin_term(sum *s, float weight)
{
    if (weight == 0.0f)
        return 0;
    hnbrdf_put(s->out, "%s%s", s->terms % 4 == 0 ? "\n        " : " ", weight < 0.0f ? "- " : "+ ");
    hnbrdf_put_float(s->out, weight < 0.0f ? -weight : weight);
    hnbrdf_put(s->out, " * ");
    s->terms++;
    return 1;
}

/* Sum of one row in the canonical order: bias, latent inputs, encoded directions or units. */
static void put_sum(hnbrdf_printer *out, const hnbrdf_scene *s, int layer, int row)
{
    static const char *const input[HNBRDF_ENCODING_SIZE] = {"x0.x", "x0.y", "x0.z",
                                                            "x1.x", "x1.y", "x1.z"};
    const hnbrdf_model_desc *desc = s->desc;
    int columns = hnbrdf_layer_inputs(desc, layer);
    const float *w = desc->weights[layer] + (size_t)row * (size_t)columns;
    sum terms = {out, 0};
    hnbrdf_put_float(out, desc->biases[layer][row]);
    if (layer > 0) {
        for (int i = 0; i < columns; i++)
            if (begin_term(&terms, w[i]))
                put_unit(out, layer - 1, i);
        return;
    }
    for (int i = 0; i < desc->latent; i++)
        if (begin_term(&terms, w[HNBRDF_ENCODING_SIZE + i]))
            hnbrdf_put(out, "m.latent%d.%c", i / 4, "xyzw"[i % 4]);
    for (int i = 0; i < HNBRDF_ENCODING_SIZE; i++)
        if (begin_term(&terms, w[i]))
            hnbrdf_put(out, "%s", input[i]);
}

void hnbrdf_put_network(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    const hnbrdf_model_desc *desc = s->desc;
    int hybrid = desc->kind == HNBRDF_KIND_HYBRID;
    hnbrdf_put(out,
               "// The network's outputs from the encoded directions x0, x1 and the latent code.\n");
    hnbrdf_put(out, "void hnbrdf_network(hnbrdf_material m, vec3 x0, vec3 x1, out vec3 c%s)\n{\n",
               hybrid ? ", out vec3 g" : "");
    for (int layer = 0; layer < desc->layers; layer++)
        for (int row = 0; row < desc->hidden; row++) {
            hnbrdf_put(out, "    HNBRDF_PRECISE float ");
            put_unit(out, layer, row);
            hnbrdf_put(out, " = hnbrdf_hard_gelu(");
            put_sum(out, s, layer, row);
            hnbrdf_put(out, ");\n");
        }
    for (int row = 0; row < hnbrdf_layer_outputs(desc, desc->layers); row++) {
        hnbrdf_put(out, "    HNBRDF_PRECISE float out%d = ", row);
        put_sum(out, s, desc->layers, row);
        hnbrdf_put(out, ";\n");
    }
    hnbrdf_put(out, "    c = vec3(out0, out1, out2);\n");
    if (hybrid)
        hnbrdf_put(out, "    g = vec3(out3, out4, out5);\n");
    hnbrdf_put(out, "}\n\n");
}
