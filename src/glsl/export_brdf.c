/* export_brdf.c: one material as a file of BRDF Explorer. Its parameters are sliders there: kd, eta
 * and alpha edit the whole material, as hnbrdf_eval() does in C. */
#include "glsl/export_brdf.h"

#include "base/error.h"
#include "base/memory.h"
#include "core/compose.h"
#include "glsl/export_language.h"
#include "glsl/export_library.h"
#include "glsl/export_network.h"
#include "glsl/published.h"

#include <math.h>

static const hnbrdf_material *material_of(const hnbrdf_scene *s)
{
    return hnbrdf_scene_material(s, 0);
}

/* ---- Heading and parameters ------------------------------------------------------------------ */

static void put_numbers(hnbrdf_printer *out, const float *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        hnbrdf_put(out, " ");
        hnbrdf_put_float(out, numbers[i]);
    }
}

static void put_key(hnbrdf_printer *out, const char *key, const float *numbers, int count)
{
    hnbrdf_put(out, "# hnbrdf/1 %s", key);
    put_numbers(out, numbers, count);
    hnbrdf_put(out, "\n");
}

static void put_keys(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    const hnbrdf_model_desc *desc = s->desc;
    const hnbrdf_material *m = material_of(s);
    hnbrdf_put(out, "# hnbrdf/1 kind %s\n", hnbrdf_kind_name(desc->kind));
    if (hnbrdf_scene_has_network(s)) {
        hnbrdf_put(out, "# hnbrdf/1 encoding %s\n", hnbrdf_encoding_name(desc->encoding));
        put_key(out, "scale", &desc->scale, 1);
        put_key(out, "shift", &desc->shift, 1);
        put_key(out, "floor", &desc->floor, 1);
    }
    if (hnbrdf_material_is_edited(m)) {
        hnbrdf_put(out, "# hnbrdf/1 fitted");
        put_numbers(out, m->fitted.kd, 3);
        put_numbers(out, m->fitted.eta, 3);
        put_numbers(out, m->fitted.alpha, 2);
        hnbrdf_put(out, "\n");
    }
    if (hnbrdf_has_energy(&m->energy)) {
        const float ramp[2] = {m->energy.horizon, m->energy.slope};
        put_key(out, "energy", ramp, 2);
    }
    if (m->lobes.scale[0] != 0.0f || m->lobes.scale[1] != 0.0f) {
        hnbrdf_put(out, "# hnbrdf/1 lobes");
        put_numbers(out, m->lobes.scale, HNBRDF_LOBES);
        put_numbers(out, m->lobes.share[0], HNBRDF_LOBES * HNBRDF_LOBE_KNOTS);
        hnbrdf_put(out, "\n");
    }
}

static void put_parameter(hnbrdf_printer *out, const char *name, float low, float high, float value)
{
    const float range[3] = {low, high, value};
    hnbrdf_put(out, "float %s", name);
    put_numbers(out, range, 3);
    hnbrdf_put(out, "\n");
}

/* One number of the latent code, its slider as wide as the materials of the model. */
static void put_latent(hnbrdf_printer *out, const hnbrdf_scene *s, int i)
{
    char name[16] = "latent_0";
    float most = 1.0f;
    for (int k = 0; k < s->desc->material_count; k++)
        most = fmaxf(most, ceilf(fabsf(s->desc->materials[k].latent[i])));
    name[7] = (char)('0' + i % 10);
    if (i > 9) {
        name[7] = (char)('0' + i / 10);
        name[8] = (char)('0' + i % 10);
        name[9] = '\0';
    }
    put_parameter(out, name, -most, most, material_of(s)->latent[i]);
}

static void put_analytic_parameters(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    static const char *const diffuse[] = {"diffuse_r", "diffuse_g", "diffuse_b"};
    static const char *const eta[] = {"eta_r", "eta_g", "eta_b"};
    const hnbrdf_material *m = material_of(s);
    for (int c = 0; c < 3; c++)
        put_parameter(out, diffuse[c], 0.0f, 1.0f, m->kd[c]);
    for (int c = 0; c < 3; c++)
        put_parameter(out, eta[c], 1.0001f, fmaxf(10.0f, ceilf(m->eta[c])), m->eta[c]);
    if (s->anisotropic) {
        put_parameter(out, "alpha_x", HNBRDF_MIN_ALPHA, 1.0f, m->alpha[0]);
        put_parameter(out, "alpha_y", HNBRDF_MIN_ALPHA, 1.0f, m->alpha[1]);
    } else {
        put_parameter(out, "alpha", HNBRDF_MIN_ALPHA, 1.0f, m->alpha[0]);
    }
}

static void put_parameters(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    const char *name = s->desc->names[hnbrdf_scene_index(s, 0)];
    hnbrdf_put(out, "analytic\n\n# %.400s\n", name);
    hnbrdf_put(out, "# Written by hnbrdf " HNBRDF_VERSION_STRING
                    ". L, V, N, X, Y of length 1; f in 1/sr, without the cosine.\n");
    put_keys(out, s);
    hnbrdf_put(out, "\n::begin parameters\n");
    if (hnbrdf_scene_has_analytic(s))
        put_analytic_parameters(out, s);
    if (s->rotated)
        put_parameter(out, "rotation", -3.1415927f, 3.1415927f, material_of(s)->rotation);
    for (int i = 0; hnbrdf_scene_has_network(s) && i < s->desc->latent; i++)
        put_latent(out, s, i);
    hnbrdf_put(out, "::end parameters\n");
}

/* ---- Functions ------------------------------------------------------------------------------- */

static const char ACTIVATION[] = "vec2 hardGeLU(vec2 x)\n{\n    return hnbrdf_hard_gelu(x);\n}\n\n"
                                 "vec3 hardGeLU(vec3 x)\n{\n    return hnbrdf_hard_gelu(x);\n}\n\n"
                                 "vec4 hardGeLU(vec4 x)\n{\n    return hnbrdf_hard_gelu(x);\n}\n\n";

/* The encoded directions, then the latent code. */
static void put_input(hnbrdf_printer *out, const hnbrdf_model_desc *desc, int i)
{
    (void)desc;
    if (i < HNBRDF_ENCODING_SIZE)
        hnbrdf_put(out, "x%d.%c", i / 3, "xyz"[i % 3]);
    else
        hnbrdf_put(out, "latent_%d", i - HNBRDF_ENCODING_SIZE);
}

static void put_network(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int hybrid = s->desc->kind == HNBRDF_KIND_HYBRID, last = s->desc->layers + 1;
    hnbrdf_put(out, ACTIVATION);
    hnbrdf_put(out, "void mlp_eval(vec3 x0, vec3 x1, out vec3 c%s)\n{\n",
               hybrid ? ", out vec3 g" : "");
    hnbrdf_put_published_network(out, s->desc, put_input);
    if (hybrid)
        hnbrdf_put(out, "    c = f%d_0.xyz;\n    g = vec3(f%d_0.w, f%d_1);\n}\n\n", last, last,
                   last);
    else
        hnbrdf_put(out, "    c = f%d_0;\n}\n\n", last);
}

static void put_pair(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "    vec3 wi = vec3(dot(L, X), dot(L, Y), dot(L, N));\n"
                    "    vec3 wo = vec3(dot(V, X), dot(V, Y), dot(V, N));\n"
                    "    if (!(wi.z > 0.0 && wo.z > 0.0))\n        return vec3(0.0);\n");
    if (s->rotated)
        hnbrdf_put(out, "    vec2 turn = vec2(cos(rotation), sin(rotation));\n"
                        "    wi = hnbrdf_to_tangent(turn, wi);\n"
                        "    wo = hnbrdf_to_tangent(turn, wo);\n");
    hnbrdf_put(out, "    hnbrdf_pair p = hnbrdf_pair_make(wi, wo);\n");
    if (hnbrdf_scene_has_analytic(s))
        hnbrdf_put(out,
                   "    vec3 kd = vec3(diffuse_r, diffuse_g, diffuse_b);\n"
                   "    vec3 eta = vec3(eta_r, eta_g, eta_b);\n"
                   "    vec2 a = %s;\n",
                   s->anisotropic ? "vec2(alpha_x, alpha_y)" : "vec2(alpha)");
}

/* hnbrdf_fitted(...): what the sliders stood at when the network was fitted. */
static void put_fitted(hnbrdf_printer *out, const hnbrdf_material *m)
{
    int edited = hnbrdf_material_is_edited(m);
    hnbrdf_put(out, "    hnbrdf_fitted at = hnbrdf_fitted(");
    hnbrdf_put_vector(out, 3, edited ? m->fitted.kd : m->kd, 3);
    hnbrdf_put(out, ", ");
    hnbrdf_put_vector(out, 3, edited ? m->fitted.eta : m->eta, 3);
    hnbrdf_put(out, ", ");
    hnbrdf_put_vector(out, 2, edited ? m->fitted.alpha : m->alpha, 2);
    hnbrdf_put(out, ");\n");
}

static void put_hybrid(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    put_fitted(out, material_of(s));
    hnbrdf_put(
        out,
        "    hnbrdf_edit edit = hnbrdf_edit_make(kd, eta, a, at);\n"
        "    vec3 specular = hnbrdf_fresnel_dielectric(eta, p.cos_d) * hnbrdf_specular(p, a);\n"
        "    vec3 edited = edit.kd_carried + specular;\n"
        "    float part = hnbrdf_specular_part(specular, edit.kd_carried);\n"
        "    hnbrdf_pair seen = %s(p, hnbrdf_warped(p, edit.warp_by, part));\n"
        "    vec3 fitted = hnbrdf_microfacet_fitted(p, seen, edit);\n",
        hnbrdf_scene_seen_function(s));
}

/* The factor on f of a material that conserves energy. */
static void put_energy(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    const hnbrdf_energy *energy = &material_of(s)->energy;
    const float ramp[2] = {energy->horizon, energy->slope};
    if (!hnbrdf_has_energy(energy))
        return;
    hnbrdf_put(out, "hnbrdf_energy_factor(");
    hnbrdf_put_vector(out, 2, ramp, 2);
    hnbrdf_put(out, ", wi.z, wo.z) * ");
}

/* Behind the network: exp(s c + m) and the rest. */
static void put_composition(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int hybrid = s->desc->kind == HNBRDF_KIND_HYBRID;
    hnbrdf_put(out, "    vec3 exponent = ");
    hnbrdf_put_constant(out, s, 0);
    hnbrdf_put(out, " * c + ");
    hnbrdf_put_constant(out, s, 1);
    hnbrdf_put(out, ";\n    return ");
    put_energy(out, s);
    hnbrdf_put(out, "%s",
               hybrid ? "hnbrdf_compose_edited(exponent, g, edited, fitted, edit.kd_added, "
                      : "hnbrdf_compose_neural(exponent, ");
    hnbrdf_put_constant(out, s, 2);
    hnbrdf_put(out, ");\n}\n");
}

static void put_functions(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int hybrid = s->desc->kind == HNBRDF_KIND_HYBRID, network = hnbrdf_scene_has_network(s);
    char function[32] = "";
    if (network) {
        hnbrdf_scene_encoding(s, function, sizeof function);
        put_network(out, s);
    }
    hnbrdf_put(out, "vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)\n{\n");
    put_pair(out, s);
    if (!network) {
        hnbrdf_put(out, "    return ");
        put_energy(out, s);
        hnbrdf_put(out, "hnbrdf_finish(hnbrdf_microfacet(kd, eta, p.cos_d, "
                        "hnbrdf_specular(p, a)));\n}\n");
        return;
    }
    if (hybrid)
        put_hybrid(out, s);
    hnbrdf_put(out, "    vec3 x0, x1, c%s;\n", hybrid ? ", g" : "");
    hnbrdf_put(out, "    hnbrdf_encode_%s(%s, x0, x1);\n", function, hybrid ? "seen" : "p");
    hnbrdf_put(out, "    mlp_eval(x0, x1, c%s);\n", hybrid ? ", g" : "");
    put_composition(out, s);
}

/* ---- The file -------------------------------------------------------------------------------- */

static hnbrdf_result check(const hnbrdf_scene *s, const hnbrdf_glsl_options *options,
                           hnbrdf_error *error)
{
    const int plain = !s->fixed && !s->packing && !s->prefix && !options->without_comments &&
                      s->style != HNBRDF_GLSL_UNIFORM && s->precision == HNBRDF_GLSL_FLOAT;
    if (s->count != 1)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "export: %d materials, expected one: a .brdf file holds one", s->count);
    if (!plain)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "export: a .brdf file has single precision, weights as constants and a "
                           "material that changes, expected no option for anything else");
    if (hnbrdf_scene_has_network(s) && s->desc->hidden < 2)
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "export: a network of one unit, expected at least two: .brdf files "
                           "have vectors");
    return HNBRDF_OK;
}

/* What is needed of the shared part, its directives resolved. */
static hnbrdf_result write_library(const hnbrdf_scene *s, const hnbrdf_glsl_options *options,
                                   const hnbrdf_allocator *memory, hnbrdf_write_fn write,
                                   void *user, hnbrdf_error *error)
{
    hnbrdf_grown text = {.memory = memory};
    hnbrdf_printer out = {.write = hnbrdf_grow, .user = &text};
    hnbrdf_put_library(&out, s, put_functions);
    hnbrdf_put_flush(&out);
    const hnbrdf_result result = out.failed
                                     ? hnbrdf_fail_memory(error, 2 * text.room, "a shader")
                                     : hnbrdf_write_language(&text, 1, options, write, user, error);
    hnbrdf_release(memory, text.text);
    return result;
}

hnbrdf_result hnbrdf_write_brdf(const hnbrdf_scene *s, const hnbrdf_glsl_options *options,
                                const hnbrdf_allocator *memory, hnbrdf_write_fn write, void *user,
                                hnbrdf_error *error)
{
    hnbrdf_scene one = *s;
    hnbrdf_printer out = {.write = write, .user = user};
    hnbrdf_result result = check(s, options, error);
    if (result)
        return result;
    one.only = HNBRDF_GLSL_EVAL;
    put_parameters(&out, &one);
    hnbrdf_put(&out, "\n::begin shader\n");
    hnbrdf_put_flush(&out);
    result = write_library(&one, options, memory, write, user, error);
    if (result)
        return result;
    hnbrdf_put(&out, "\n");
    put_functions(&out, &one);
    hnbrdf_put(&out, "::end shader\n");
    hnbrdf_put_flush(&out);
    if (out.failed)
        return hnbrdf_fail(error, HNBRDF_ERROR_IO, "export: writing the shader failed");
    return HNBRDF_OK;
}
