/* peer.c: a shader in the style of the published ones, to have a peer in every run of the
 * benchmark: mat4 times vec4 chains, literals of three decimals, the microfacet formulas written
 * out as they stand. */
#include "bench/bench.h"
#include "base/text_buffer.h"
#include "core/model.h"
#include "glsl/published.h"

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

/* ---- The text -------------------------------------------------------------------------------- */

/* wi, wo, then the latent code. */
static void put_input(hnbrdf_printer *out, const hnbrdf_model_desc *desc, int i)
{
    static const char *const directions[] = {"wi.x", "wi.y", "wi.z", "wo.x", "wo.y", "wo.z"};
    (void)desc;
    if (i < HNBRDF_ENCODING_SIZE)
        hnbrdf_put(out, "%s", directions[i]);
    else
        hnbrdf_put(out, "m.latent%d.%c", (i - 6) / 4, "xyzw"[(i - 6) % 4]);
}

static void put_network(hnbrdf_printer *out, const hnbrdf_model_desc *desc)
{
    int last = desc->layers + 1;
    hnbrdf_put(out, "void hnbrdf_network(hnbrdf_material m, vec3 wi, vec3 wo, out vec3 c, out vec3 "
                    "g)\n{\n");
    hnbrdf_put_published_network(out, desc, put_input);
    hnbrdf_put(out, "    c = f%d_0.xyz;\n    g = vec3(f%d_0.w, f%d_1);\n}\n\n", last, last, last);
}

static void put_materials(hnbrdf_printer *out, const hnbrdf_model_desc *desc, int materials)
{
    int vectors = (desc->latent + 3) / 4;
    hnbrdf_put(out, "struct hnbrdf_material { vec3 kd; vec3 eta; float alpha;");
    for (int v = 0; v < vectors; v++)
        hnbrdf_put(out, " vec4 latent%d;", v);
    hnbrdf_put(out, " };\n\nhnbrdf_material hnbrdf_scene_material(int index)\n{\n");
    for (int k = 0; k < materials; k++) {
        const hnbrdf_material *m = &desc->materials[k];
        if (k + 1 < materials)
            hnbrdf_put(out, "    if (index == %d)\n    ", k);
        hnbrdf_put(out, "    return hnbrdf_material(");
        hnbrdf_put_vector(out, 3, m->kd, 3);
        hnbrdf_put(out, ", ");
        hnbrdf_put_vector(out, 3, m->eta, 3);
        hnbrdf_put(out, ", ");
        hnbrdf_put_float(out, m->alpha[0]);
        for (int v = 0; v < vectors; v++) {
            hnbrdf_put(out, ", ");
            hnbrdf_put_vector(out, 4, m->latent + 4 * v, desc->latent - 4 * v);
        }
        hnbrdf_put(out, ");\n");
    }
    hnbrdf_put(out, "}\n\n");
}

char *bench_peer_shader(const hnbrdf_model_desc *desc, int materials)
{
    hnbrdf_text_buffer text = {0};
    hnbrdf_printer out = {.write = hnbrdf_text_buffer_append, .user = &text};
    hnbrdf_model *peer = bench_peer_model(desc);
    if (!peer)
        return NULL;
    hnbrdf_put(&out, "#define HNBRDF_SCENE_HYBRID\n");
    put_materials(&out, &peer->desc, materials);
    hnbrdf_put_bytes(&out, formulas, strlen(formulas));
    put_network(&out, &peer->desc);
    hnbrdf_put_bytes(&out, evaluation, strlen(evaluation));
    hnbrdf_put(&out, "    neural_output = exp(");
    hnbrdf_put_float(&out, peer->desc.scale);
    hnbrdf_put(&out, " * neural_output + ");
    hnbrdf_put_float(&out, peer->desc.shift);
    hnbrdf_put(&out,
               ");\n    return neural_output + microfacet(m, wi, wo) / (1.0 + exp(-gate));\n}\n");
    hnbrdf_put_flush(&out);
    hnbrdf_model_free(peer);
    return hnbrdf_text_buffer_take(&text);
}

/* ---- The numbers ----------------------------------------------------------------------------- */

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
        size_t rows = (size_t)hnbrdf_layer_outputs(desc, k);
        made.weights[k] = round_all(desc->weights[k], rows * (size_t)hnbrdf_layer_inputs(desc, k));
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
