/* peer.c: a shader in the style of the published ones, to have a peer in every run of the
 * benchmark: mat4 times vec4 chains, literals of three decimals, the microfacet formulas written
 * out as they stand. */
#include "bench/bench.h"
#include "base/text_buffer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where the published style differs from ours, and nothing else: the network's inputs are the
 * directions, D and G1 are full fractions in the tangent of the angle, Fresnel is taken per
 * channel and squares with pow, HardGELU blends with mix and step. pow takes an absolute value:
 * of a negative one it is undefined. */
static const char formulas[] =
    "const float PI = 3.14159265;\n"
    "\n"
    "vec4 hardGeLU(vec4 x)\n"
    "{\n"
    "    vec4 middle = x * (x / 3.0 + 0.5);\n"
    "    return mix(mix(vec4(0.0), middle, step(vec4(-1.5), x)), x, step(vec4(1.5), x));\n"
    "}\n"
    "\n"
    "float tangent2(float cosine)\n"
    "{\n"
    "    return (1.0 - cosine * cosine) / (cosine * cosine);\n"
    "}\n"
    "\n"
    "float distribution(float cosine, float alpha)\n"
    "{\n"
    "    return pow(alpha, 2.0) / (PI * pow(cosine, 4.0) * pow(pow(alpha, 2.0) + tangent2(cosine), "
    "2.0));\n"
    "}\n"
    "\n"
    "float masking(float cosine, float alpha)\n"
    "{\n"
    "    return 2.0 / (1.0 + sqrt(1.0 + pow(alpha, 2.0) * tangent2(cosine)));\n"
    "}\n"
    "\n"
    "float fresnel(float eta, float c)\n"
    "{\n"
    "    float g = sqrt(pow(eta, 2.0) - 1.0 + pow(c, 2.0));\n"
    "    return 0.5 * pow(abs((g - c) / (g + c)), 2.0) *\n"
    "           (1.0 + pow(abs((c * (g + c) - 1.0) / (c * (g - c) + 1.0)), 2.0));\n"
    "}\n"
    "\n"
    "vec3 microfacet(hnbrdf_material m, vec3 wi, vec3 wo)\n"
    "{\n"
    "    vec3 h = normalize(wi + wo);\n"
    "    float c = dot(wi, h);\n"
    "    vec3 F = vec3(fresnel(m.eta.r, c), fresnel(m.eta.g, c), fresnel(m.eta.b, c));\n"
    "    float D = distribution(h.z, m.alpha);\n"
    "    float G = masking(wi.z, m.alpha) * masking(wo.z, m.alpha);\n"
    "    return m.kd / PI + F * D * G / (4.0 * wi.z * wo.z);\n"
    "}\n"
    "\n";

static const char evaluation[] = "vec3 hnbrdf_eval(hnbrdf_material m, vec3 wi, vec3 wo)\n"
                                 "{\n"
                                 "    if (wi.z <= 0.0 || wo.z <= 0.0)\n"
                                 "        return vec3(0.0);\n"
                                 "    vec3 neural_output, gate;\n"
                                 "    hnbrdf_network(m, wi, wo, neural_output, gate);\n";

/* ---- Numbers --------------------------------------------------------------------------------- */

static float rounded(float value)
{
    return (float)(round(1000.0 * (double)value) / 1000.0);
}

/* A material with three decimals, legal as it was. */
static hnbrdf_material rounded_material(const hnbrdf_material *m)
{
    hnbrdf_material made;
    hnbrdf_material_init(&made);
    for (int c = 0; c < 3; c++) {
        made.kd[c] = rounded(m->kd[c]);
        made.eta[c] = fmaxf(rounded(m->eta[c]), 1.001f);
    }
    made.alpha[0] = made.alpha[1] = fmaxf(rounded(m->alpha[0]), 0.001f); /* isotropic */
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        made.latent[i] = rounded(m->latent[i]);
    return made;
}

static void put_thousandths(hnbrdf_text_buffer *text, float value)
{
    long thousandths = lround(1000.0 * (double)value);
    hnbrdf_text_buffer_print(text, "%s%ld.%03ld", thousandths < 0 ? "-" : "",
                             labs(thousandths) / 1000, labs(thousandths) % 1000);
}

static void put_numbers(hnbrdf_text_buffer *text, const char *type, const float *values, int count,
                        int given)
{
    hnbrdf_text_buffer_print(text, "%s(", type);
    for (int k = 0; k < count; k++) {
        hnbrdf_text_buffer_print(text, "%s", k ? ", " : "");
        put_thousandths(text, k < given ? values[k] : 0.0f);
    }
    hnbrdf_text_buffer_print(text, ")");
}

/* ---- The network ----------------------------------------------------------------------------- */

static int inputs_of(const hnbrdf_model_desc *desc, int layer)
{
    return layer == 0 ? 6 + desc->latent : desc->hidden;
}

static int outputs_of(const hnbrdf_model_desc *desc, int layer)
{
    return layer == desc->layers ? 6 : desc->hidden;
}

/* mat4(...) * fL_B: `rows` rows from `row` on, four columns or what is left of them; column by
 * column. */
static void put_product(hnbrdf_text_buffer *text, const hnbrdf_model_desc *desc, int layer, int row,
                        int rows, int block)
{
    int inputs = inputs_of(desc, layer), columns = inputs - 4 * block;
    columns = columns < 4 ? columns : 4;
    if (columns == 1)
        hnbrdf_text_buffer_print(text, "vec%d(", rows);
    else if (columns == 4 && rows == 4)
        hnbrdf_text_buffer_print(text, "mat4(");
    else
        hnbrdf_text_buffer_print(text, "mat%dx%d(", columns, rows);
    for (int k = 0; k < rows * columns; k++) {
        hnbrdf_text_buffer_print(text, "%s", k ? ", " : "");
        put_thousandths(text,
                        desc->weights[layer][(row + k % rows) * inputs + 4 * block + k / rows]);
    }
    hnbrdf_text_buffer_print(text, ") * f%d_%d + ", layer, block);
}

static void put_rows(hnbrdf_text_buffer *text, const hnbrdf_model_desc *desc, int layer, int row,
                     int rows)
{
    int hidden = layer < desc->layers;
    char type[8];
    snprintf(type, sizeof type, "vec%d", rows);
    hnbrdf_text_buffer_print(text, "    %s f%d_%d = %s", type, layer + 1, row / 4,
                             hidden ? "hardGeLU(" : "");
    for (int block = 0; 4 * block < inputs_of(desc, layer); block++)
        put_product(text, desc, layer, row, rows, block);
    put_numbers(text, type, desc->biases[layer] + row, rows, rows);
    hnbrdf_text_buffer_print(text, "%s", hidden ? ");\n" : ";\n");
}

/* The inputs in blocks of four: wi, wo, then the latent code. */
static void put_inputs(hnbrdf_text_buffer *text, const hnbrdf_model_desc *desc)
{
    static const char *const directions[] = {"wi.x", "wi.y", "wi.z", "wo.x", "wo.y", "wo.z"};
    int count = inputs_of(desc, 0);
    for (int k = 0; k < count; k++) {
        int left = count - k < 4 ? count - k : 4;
        if (k % 4 == 0 && left > 1)
            hnbrdf_text_buffer_print(text, "    vec%d f0_%d = vec%d(", left, k / 4, left);
        else if (k % 4 == 0)
            hnbrdf_text_buffer_print(text, "    float f0_%d = (", k / 4);
        if (k < 6)
            hnbrdf_text_buffer_print(text, "%s", directions[k]);
        else
            hnbrdf_text_buffer_print(text, "m.latent%d.%c", (k - 6) / 4, "xyzw"[(k - 6) % 4]);
        hnbrdf_text_buffer_print(text, "%s", k % 4 == 3 || k + 1 == count ? ");\n" : ", ");
    }
}

static void put_network(hnbrdf_text_buffer *text, const hnbrdf_model_desc *desc)
{
    int last = desc->layers + 1;
    hnbrdf_text_buffer_print(
        text, "void hnbrdf_network(hnbrdf_material m, vec3 wi, vec3 wo, out vec3 c, out vec3 "
              "g)\n{\n");
    put_inputs(text, desc);
    for (int layer = 0; layer <= desc->layers; layer++)
        for (int row = 0; row < outputs_of(desc, layer); row += 4)
            put_rows(text, desc, layer, row, outputs_of(desc, layer) - row < 4 ? 2 : 4);
    hnbrdf_text_buffer_print(text, "    c = f%d_0.xyz;\n    g = vec3(f%d_0.w, f%d_1);\n}\n\n", last,
                             last, last);
}

/* ---- The whole ------------------------------------------------------------------------------- */

static void put_materials(hnbrdf_text_buffer *text, const hnbrdf_model_desc *desc, int materials)
{
    int vectors = (desc->latent + 3) / 4;
    hnbrdf_text_buffer_print(text, "struct hnbrdf_material { vec3 kd; vec3 eta; float alpha;");
    for (int v = 0; v < vectors; v++)
        hnbrdf_text_buffer_print(text, " vec4 latent%d;", v);
    hnbrdf_text_buffer_print(text, " };\n\nhnbrdf_material hnbrdf_scene_material(int index)\n{\n");
    for (int k = 0; k < materials; k++) {
        const hnbrdf_material m = rounded_material(&desc->materials[k]);
        if (k + 1 < materials)
            hnbrdf_text_buffer_print(text, "    if (index == %d)\n    ", k);
        hnbrdf_text_buffer_print(text, "    return hnbrdf_material(");
        put_numbers(text, "vec3", m.kd, 3, 3);
        put_numbers(text, ", vec3", m.eta, 3, 3);
        put_numbers(text, ", float", m.alpha, 1, 1);
        for (int v = 0; v < vectors; v++)
            put_numbers(text, ", vec4", m.latent + 4 * v, 4, desc->latent - 4 * v);
        hnbrdf_text_buffer_print(text, ");\n");
    }
    hnbrdf_text_buffer_print(text, "}\n\n");
}

char *bench_peer_shader(const hnbrdf_model_desc *desc, int materials)
{
    hnbrdf_text_buffer text = {0};
    hnbrdf_text_buffer_print(&text, "#define HNBRDF_SCENE_HYBRID\n");
    put_materials(&text, desc, materials);
    hnbrdf_text_buffer_append(&text, formulas, strlen(formulas));
    put_network(&text, desc);
    hnbrdf_text_buffer_append(&text, evaluation, strlen(evaluation));
    hnbrdf_text_buffer_print(&text, "    neural_output = exp(");
    put_thousandths(&text, desc->scale);
    hnbrdf_text_buffer_print(&text, " * neural_output + ");
    put_thousandths(&text, desc->shift);
    hnbrdf_text_buffer_print(
        &text, ");\n    return neural_output + microfacet(m, wi, wo) / (1.0 + exp(-gate));\n}\n");
    return hnbrdf_text_buffer_take(&text);
}

static float *round_all(const float *values, size_t count)
{
    float *made = malloc(count * sizeof *made);
    for (size_t k = 0; made && k < count; k++)
        made[k] = rounded(values[k]);
    return made;
}

hnbrdf_model *bench_peer_model(const hnbrdf_model_desc *desc)
{
    hnbrdf_model_desc made = *desc;
    hnbrdf_model *model = NULL;
    hnbrdf_material *materials = malloc((size_t)desc->material_count * sizeof *materials);
    int complete = materials != NULL;
    made.encoding = HNBRDF_ENCODING_DIRECTIONS;
    made.floor = 0.0f;
    made.scale = rounded(desc->scale);
    made.shift = rounded(desc->shift);
    made.materials = materials;
    for (int k = 0; materials && k < desc->material_count; k++)
        materials[k] = rounded_material(&desc->materials[k]);
    for (int k = 0; k <= desc->layers; k++) {
        size_t rows = (size_t)outputs_of(desc, k);
        made.weights[k] = round_all(desc->weights[k], rows * (size_t)inputs_of(desc, k));
        made.biases[k] = round_all(desc->biases[k], rows);
        complete = complete && made.weights[k] && made.biases[k];
    }
    if (complete && hnbrdf_model_create(&made, NULL, &model, NULL) != HNBRDF_OK)
        model = NULL;
    for (int k = 0; k <= desc->layers; k++) {
        free((void *)made.weights[k]);
        free((void *)made.biases[k]);
    }
    free(materials);
    return model;
}
