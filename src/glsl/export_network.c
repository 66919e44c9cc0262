/* export_network.c: the network of a scene as GLSL: declarations, inputs, and weights as
 * literals. */
#include "glsl/export_network.h"

#include "glsl/export_weights.h"
#include "glsl/half.h"

/* ---- Half precision ---------------------------------------------------------------------------
 * */

static int in_half(const hnbrdf_scene *s, int layer)
{
    return s->precision == HNBRDF_GLSL_HALF && layer < s->desc->layers;
}

static const char HALF_TYPES[] =
    "// Half precision where the language has it: float16_t in Vulkan GLSL, mediump in GLSL ES. "
    "Elsewhere,\n"
    "// or with HNBRDF_HALF_NATIVE defined as 0, single precision with the same weights.\n"
    "#ifndef HNBRDF_HALF_NATIVE\n"
    "#if defined(VULKAN) && defined(GL_EXT_shader_explicit_arithmetic_types_float16)\n"
    "#define HNBRDF_HALF_NATIVE 1\n"
    "#else\n"
    "#define HNBRDF_HALF_NATIVE 0\n"
    "#endif\n"
    "#endif\n"
    "#if HNBRDF_HALF_NATIVE == 1\n"
    "#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require\n"
    "#define HNBRDF_HALF float16_t // in declarations\n"
    "#define HNBRDF_HALF2 f16vec2\n"
    "#define HNBRDF_HALF3 f16vec3\n"
    "#define HNBRDF_HALF4 f16vec4\n"
    "#define HNBRDF_H float16_t // in expressions\n"
    "#define HNBRDF_H2 f16vec2\n"
    "#define HNBRDF_H3 f16vec3\n"
    "#define HNBRDF_H4 f16vec4\n"
    "#else\n"
    "#define HNBRDF_HALF mediump float\n"
    "#define HNBRDF_HALF2 mediump vec2\n"
    "#define HNBRDF_HALF3 mediump vec3\n"
    "#define HNBRDF_HALF4 mediump vec4\n"
    "#define HNBRDF_H float\n"
    "#define HNBRDF_H2 vec2\n"
    "#define HNBRDF_H3 vec3\n"
    "#define HNBRDF_H4 vec4\n"
    "#endif\n\n";

static const char *const SUFFIX[5] = {"", "", "2", "3", "4"};

/* The type of `width` numbers of a layer: in a declaration, in an expression. */
static void put_type(hnbrdf_printer *out, int half, int width)
{
    if (half)
        hnbrdf_put(out, "HNBRDF_HALF%s", SUFFIX[width]);
    else
        hnbrdf_put(out, "%s%s", width > 1 ? "vec" : "float", SUFFIX[width]);
}

static void put_constructor(hnbrdf_printer *out, int half, int width)
{
    if (half)
        hnbrdf_put(out, "HNBRDF_H%s", SUFFIX[width]);
    else
        put_type(out, 0, width);
}

/* HardGELU that ends at what the next layer can sum; as low as it goes, -0.1875, any layer can. */
static void put_half_unit(hnbrdf_printer *out, int width)
{
    hnbrdf_put(out, "HNBRDF_HALF%s hnbrdf_half_unit(HNBRDF_HALF%s x, HNBRDF_HALF x_limit)\n{\n",
               SUFFIX[width], SUFFIX[width]);
    hnbrdf_put(out,
               "    HNBRDF_PRECISE HNBRDF_HALF%s value_out =\n"
               "        x * clamp(x * HNBRDF_H(0.333251953) + HNBRDF_H(0.5), HNBRDF_H(0.0), "
               "HNBRDF_H(1.0));\n"
               "    return min(value_out, %s(x_limit));\n}\n\n",
               SUFFIX[width],
               width == 4   ? "HNBRDF_H4"
               : width == 3 ? "HNBRDF_H3"
               : width == 2 ? "HNBRDF_H2"
                            : "HNBRDF_H");
}

/* The largest size of inputs (layer 0) or of units of the layer before. */
static void put_limit(hnbrdf_printer *out, const hnbrdf_scene *s, int layer)
{
    if (s->style == HNBRDF_GLSL_UNIFORM)
        hnbrdf_put(out, "hnbrdf_weights[%d].%c", (3 + layer) / 4, "xyzw"[(3 + layer) % 4]);
    else
        hnbrdf_put_float(out, hnbrdf_half_limit(s->desc, layer));
}

/* i_0, i_1, z_0, ...: encoded directions and latent code in half precision, kept from
 * overflowing. */
static void put_half_inputs(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "    float x_limit = ");
    put_limit(out, s, 0);
    hnbrdf_put(out, ";\n");
    for (int i = 0; i < 2; i++)
        hnbrdf_put(out,
                   "    HNBRDF_HALF3 i_%d = HNBRDF_H3(hnbrdf_clamp(x_%d, -x_limit, x_limit));\n", i,
                   i);
    for (int v = 0; v < (s->desc->latent + 3) / 4; v++)
        hnbrdf_put(
            out,
            "    HNBRDF_HALF4 z_%d = HNBRDF_H4(hnbrdf_clamp(material_in.latent%d.xyz, -x_limit, "
            "x_limit),\n"
            "                                 hnbrdf_clamp(material_in.latent%d.w, "
            "-x_limit, x_limit));\n",
            v, v, v);
}

/* ---- What all styles share ------------------------------------------------------------------- */

void hnbrdf_put_constant(hnbrdf_printer *out, const hnbrdf_scene *s, int which)
{
    const float numbers[3] = {s->desc->scale, s->desc->shift, s->desc->floor};
    if (s->style == HNBRDF_GLSL_UNIFORM)
        hnbrdf_put(out, "hnbrdf_weights[0].%c", "xyz"[which]);
    else
        hnbrdf_put_float(out, numbers[which]);
}

/* ---- Literals: units one by one, or four at a time ------------------------------------------- */

/* Units of one statement: the last layer has three, c and then g. */
static int step_of(const hnbrdf_scene *s, int layer)
{
    return s->style != HNBRDF_GLSL_COLUMNS ? 1 : layer < s->desc->layers ? 4 : 3;
}

static int width_at(const hnbrdf_scene *s, int layer, int row)
{
    int left = hnbrdf_layer_outputs(s->desc, layer) - row, most = step_of(s, layer);
    return left < most ? left : most;
}

/* The values of layer k are a_0, a_1, ... of the first hidden layer, b_0, ... of the second; of
 * four at a time a_0 is the first group. */
static void put_unit(hnbrdf_printer *out, const hnbrdf_scene *s, int layer, int unit)
{
    if (s->style != HNBRDF_GLSL_COLUMNS) {
        hnbrdf_put(out, "%c_%d", 'a' + layer, unit);
        return;
    }
    hnbrdf_put(out, "%c_%d", 'a' + layer, unit / 4);
    if (width_at(s, 0, unit / 4 * 4) > 1)
        hnbrdf_put(out, ".%c", "xyzw"[unit % 4]);
}

/* A number, or several as one vector. */
static void put_numbers(hnbrdf_printer *out, int half, int width, const float *numbers)
{
    if (half || width > 1) {
        put_constructor(out, half, width);
        hnbrdf_put(out, "(");
    }
    for (int i = 0; i < width; i++) {
        hnbrdf_put_bytes(out, ", ", i > 0 ? 2 : 0);
        hnbrdf_put_float(out, numbers[i]);
    }
    if (half || width > 1)
        hnbrdf_put(out, ")");
}

typedef struct sum {
    hnbrdf_printer *out;
    int half, width, terms;
} sum;

/* " + weights * "; weights of zero have no term. Breaks the line after every fourth. */
static int begin_term(sum *s, float *weights)
{
    int zeros = 0, minus = s->width == 1 && weights[0] < 0.0f;
    for (int i = 0; i < s->width; i++)
        zeros += weights[i] == 0.0f;
    if (zeros == s->width)
        return 0;
    if (minus)
        weights[0] = -weights[0];
    hnbrdf_put(s->out, "%s%s", s->terms % 4 == 0 || s->width > 1 ? "\n        " : " ",
               minus ? "- " : "+ ");
    put_numbers(s->out, s->half, s->width, weights);
    hnbrdf_put(s->out, " * ");
    s->terms++;
    return 1;
}

/* The bias of some rows. A folded one holds the latent code too: of the only material as numbers.
 * */
static void put_bias(hnbrdf_printer *out, const hnbrdf_scene *s, int layer, int row, int width)
{
    float numbers[4] = {0.0f};
    if (layer == 0 && hnbrdf_scene_bias_vectors(s) > 0) {
        hnbrdf_put(out, "material_in.bias_%d.%.*s", row / 4, width, &"xyzw"[row % 4]);
        return;
    }
    for (int r = 0; r < width; r++)
        numbers[r] = layer == 0 ? s->first[row + r] : s->desc->biases[layer][row + r];
    for (int r = 0; r < width && in_half(s, layer); r++)
        numbers[r] = hnbrdf_half_bias(s->desc, layer, numbers[r]);
    put_numbers(out, in_half(s, layer), width, numbers);
}

/* Sums of some rows in the canonical order: bias, latent inputs, encoded directions or units. */
static void put_sum(hnbrdf_printer *out, const hnbrdf_scene *s, int layer, int row, int width)
{
    const hnbrdf_model_desc *desc = s->desc;
    int columns = hnbrdf_layer_inputs(desc, layer), half = in_half(s, layer);
    const float *w = desc->weights[layer] + (size_t)row * (size_t)columns;
    sum terms = {out, half, width, 0};
    float numbers[4];
    put_bias(out, s, layer, row, width);
    for (int i = layer == 0 && s->folded ? desc->latent : 0; i < columns; i++) {
        for (int r = 0; r < width; r++)
            numbers[r] = w[r * columns + hnbrdf_summed_column(desc, layer, i)];
        for (int r = 0; r < width && half; r++)
            numbers[r] = hnbrdf_half_weight(desc, layer, numbers[r]);
        if (!begin_term(&terms, numbers))
            continue;
        if (layer == 0)
            hnbrdf_put_input(out, s, i);
        else /* what the last layer sums in single precision was made single before */
            put_unit(out, s, s->precision == HNBRDF_GLSL_HALF && !half ? desc->layers : layer - 1,
                     i);
    }
}

static void put_hidden_layer(hnbrdf_printer *out, const hnbrdf_scene *s, int layer)
{
    int half = in_half(s, layer), step = step_of(s, layer);
    for (int row = 0; row < s->desc->hidden; row += step) {
        int width = width_at(s, layer, row);
        hnbrdf_put(out, "    HNBRDF_PRECISE ");
        put_type(out, half, width);
        hnbrdf_put(out, " %c_%d = %s(", 'a' + layer, row / step,
                   half ? "hnbrdf_half_unit" : "hnbrdf_hard_gelu");
        put_sum(out, s, layer, row, width);
        if (half) {
            hnbrdf_put(out, ", HNBRDF_H(");
            put_limit(out, s, layer + 1);
            hnbrdf_put(out, ")");
        }
        hnbrdf_put(out, ");\n");
    }
}

/* The units of the last hidden layer in single precision, for its sums. */
static void put_single(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int layer = s->desc->layers, step = step_of(s, layer - 1);
    for (int row = 0; row < s->desc->hidden; row += step) {
        int width = width_at(s, layer - 1, row);
        hnbrdf_put(out, "    ");
        put_type(out, 0, width);
        hnbrdf_put(out, " %c_%d = ", 'a' + layer, row / step);
        put_type(out, 0, width);
        hnbrdf_put(out, "(%c_%d);\n", 'a' + layer - 1, row / step);
    }
}

static void put_outputs(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int layer = s->desc->layers, step = step_of(s, layer),
        hybrid = s->desc->kind == HNBRDF_KIND_HYBRID;
    for (int row = 0; row < hnbrdf_layer_outputs(s->desc, layer); row += step) {
        hnbrdf_put(out, "    HNBRDF_PRECISE ");
        put_type(out, 0, step);
        hnbrdf_put(out, " out_%d = ", row / step);
        put_sum(out, s, layer, row, step);
        hnbrdf_put(out, ";\n");
    }
    hnbrdf_put(out,
               step == 3 ? "    c_net = out_0;\n" : "    c_net = vec3(out_0, out_1, out_2);\n");
    if (hybrid)
        hnbrdf_put(out,
                   step == 3 ? "    g_net = out_1;\n" : "    g_net = vec3(out_3, out_4, out_5);\n");
}

static void put_literals(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    for (int layer = 0; layer < s->desc->layers; layer++)
        put_hidden_layer(out, s, layer);
    if (s->precision == HNBRDF_GLSL_HALF)
        put_single(out, s);
    put_outputs(out, s);
}

/* ---- All of it ------------------------------------------------------------------------------- */

/* hnbrdf_hard_gelu() or its half form for the vectors that the style computes in. */
static void put_activations(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int last = s->style == HNBRDF_GLSL_COLUMNS ? s->desc->hidden % 4 : 0;
    int width = s->style == HNBRDF_GLSL_CONSTANTS ? 1 : 4;
    if (s->precision == HNBRDF_GLSL_HALF) {
        if (width == 1 || s->style == HNBRDF_GLSL_UNIFORM || s->desc->hidden >= 4)
            put_half_unit(out, width);
        if (last > 0)
            put_half_unit(out, last);
    }
}

void hnbrdf_put_network(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    if (s->precision == HNBRDF_GLSL_HALF)
        hnbrdf_put_bytes(out, HALF_TYPES, sizeof HALF_TYPES - 1);
    if (s->style == HNBRDF_GLSL_UNIFORM)
        hnbrdf_put_weights_block(out, s);
    put_activations(out, s);
    hnbrdf_put(
        out,
        "// The network's outputs from the encoded directions x_0, x_1 and the latent code.\n");
    hnbrdf_put(out,
               "void hnbrdf_network(hnbrdf_material material_in, vec3 x_0, vec3 x_1, out vec3 "
               "c_net%s)\n{\n",
               s->desc->kind == HNBRDF_KIND_HYBRID ? ", out vec3 g_net" : "");
    if (s->precision == HNBRDF_GLSL_HALF)
        put_half_inputs(out, s);
    if (s->style == HNBRDF_GLSL_UNIFORM)
        hnbrdf_put_loops(out, s);
    else
        put_literals(out, s);
    hnbrdf_put(out, "}\n\n");
}
