/* export_loops.c: the network of a scene as loops over a uniform block, for weights loaded at run
 * time.
 *
 * On llvmpipe nearly all of the time is in the loads: a weight at an index that is not constant is
 * fetched once a lane, however the loops are nested or the units are kept. Constant indices bring a
 * branch for every number instead, run no faster and compile far longer. */
#include "glsl/export_network.h"
#include "glsl/export_weights.h"

static const char BLOCK[] =
    "// The weights: the bytes that `hnbrdf export --weights-out` writes, laid out as told in "
    "hnbrdf/glsl.h. Any\n"
    "// network of the same kind, encoding and size. HNBRDF_LOOP and HNBRDF_LOOP_START keep a loop "
    "a loop: unrolled,\n"
    "// such a shader takes a compiler minutes. Where there is no attribute for that, loops start "
    "at what a number of\n"
    "// the block makes of it, one that is never negative: at 0.\n"
    "#ifndef HNBRDF_WEIGHTS_SET\n"
    "#define HNBRDF_WEIGHTS_SET 0\n"
    "#endif\n"
    "#ifndef HNBRDF_WEIGHTS_BINDING\n"
    "#define HNBRDF_WEIGHTS_BINDING 0\n"
    "#endif\n"
    "#ifndef HNBRDF_WEIGHTS_LAYOUT\n"
    "#ifdef VULKAN\n"
    "#define HNBRDF_WEIGHTS_LAYOUT layout(std140, set = HNBRDF_WEIGHTS_SET, "
    "binding = HNBRDF_WEIGHTS_BINDING)\n"
    "#else\n"
    "#define HNBRDF_WEIGHTS_LAYOUT layout(std140)\n"
    "#endif\n"
    "#endif\n"
    "#ifndef HNBRDF_LOOP\n"
    "#if defined(VULKAN) && defined(GL_EXT_control_flow_attributes)\n"
    "#extension GL_EXT_control_flow_attributes : require\n"
    "#define HNBRDF_LOOP [[dont_unroll]]\n"
    "#define HNBRDF_LOOP_START(loaded) 0\n"
    "#else\n"
    "#define HNBRDF_LOOP\n"
    "#endif\n"
    "#endif\n"
    "#ifndef HNBRDF_LOOP_START\n"
    "#define HNBRDF_LOOP_START(loaded) int((loaded) < 0.0)\n"
    "#endif\n";

void hnbrdf_put_weights_block(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put_bytes(out, BLOCK, sizeof BLOCK - 1);
    hnbrdf_put(
        out, "HNBRDF_WEIGHTS_LAYOUT uniform hnbrdf_weights_block { vec4 hnbrdf_weights[%d]; };\n\n",
        hnbrdf_layer_start(s->desc, s->desc->layers + 1));
}

/* One column of weights, counted from behind the bias at `at`, times what follows. */
static void put_term(hnbrdf_printer *out, int half, const char *before, int column)
{
    hnbrdf_put(out, half ? "%s%d]) * " : "%s%d] * ", before, 1 + column);
}

static void put_first_inputs(hnbrdf_printer *out, const hnbrdf_scene *s, int half)
{
    for (int i = 0; i < hnbrdf_layer_inputs(s->desc, 0); i++) {
        put_term(out, half,
                 half ? "        sum_4 += HNBRDF_H4(hnbrdf_weights[row_at + "
                      : "        sum_4 += hnbrdf_weights[row_at + ",
                 i);
        hnbrdf_put_input(out, s, i);
        hnbrdf_put(out, ";\n");
    }
}

/* Four units of the layer before at a time. */
static void put_units(hnbrdf_printer *out, const hnbrdf_scene *s, int layer, int half)
{
    const char *type = half ? "HNBRDF_HALF4" : "vec4";
    int single = s->precision == HNBRDF_GLSL_HALF && !half;
    hnbrdf_put(out, "        HNBRDF_LOOP for (int i_4 = loop_start; i_4 < %d; i_4++) {\n",
               (s->desc->hidden + 3) / 4);
    hnbrdf_put(out,
               single ? "            %s u_4 = vec4(u_%d[i_4]);\n"
                      : "            %s u_4 = u_%d[i_4];\n",
               type, layer - 1);
    for (int i = 0; i < 4; i++) {
        put_term(out, half,
                 half ? "            sum_4 += HNBRDF_H4(hnbrdf_weights[row_at + 4 * i_4 + "
                      : "            sum_4 += hnbrdf_weights[row_at + 4 * i_4 + ",
                 i);
        hnbrdf_put(out, "u_4.%c;\n", "xyzw"[i]);
    }
    hnbrdf_put(out, "        }\n");
}

static void put_layer(hnbrdf_printer *out, const hnbrdf_scene *s, int layer)
{
    int hidden = layer < s->desc->layers, half = hidden && s->precision == HNBRDF_GLSL_HALF;
    int groups = hnbrdf_layer_groups(s->desc, layer);
    const char *type = half ? "HNBRDF_HALF4" : "vec4";
    hnbrdf_put(out, "    %s u_%d[%d];\n", type, layer, groups);
    hnbrdf_put(out, "    HNBRDF_LOOP for (int r = loop_start; r < %d; r++) {\n", groups);
    hnbrdf_put(out, "        int row_at = %d + %d * r;\n", hnbrdf_layer_start(s->desc, layer),
               1 + hnbrdf_layer_columns(s->desc, layer));
    hnbrdf_put(out,
               half ? "        HNBRDF_PRECISE %s sum_4 = HNBRDF_H4(hnbrdf_weights[row_at]);\n"
                    : "        HNBRDF_PRECISE %s sum_4 = hnbrdf_weights[row_at];\n",
               type);
    if (layer == 0)
        put_first_inputs(out, s, half);
    else
        put_units(out, s, layer, half);
    if (half)
        hnbrdf_put(out,
                   "        u_%d[r] = hnbrdf_half_unit(sum_4, HNBRDF_H(hnbrdf_weights[%d].%c));\n",
                   layer, (4 + layer) / 4, "xyzw"[(4 + layer) % 4]);
    else
        hnbrdf_put(out,
                   hidden ? "        u_%d[r] = hnbrdf_hard_gelu(sum_4);\n"
                          : "        u_%d[r] = sum_4;\n",
                   layer);
    hnbrdf_put(out, "    }\n");
}

void hnbrdf_put_loops(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int layers = s->desc->layers;
    hnbrdf_put(out, "    int loop_start = HNBRDF_LOOP_START(hnbrdf_weights[0].w);\n");
    for (int layer = 0; layer <= layers; layer++)
        put_layer(out, s, layer);
    hnbrdf_put(out, "    c_net = u_%d[0].xyz;\n", layers);
    if (s->desc->kind == HNBRDF_KIND_HYBRID)
        hnbrdf_put(out, "    g_net = vec3(u_%d[0].w, u_%d[1].xy);\n", layers, layers);
}
