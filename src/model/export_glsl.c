/* export_glsl.c: writes a model and the materials of a scene as one GLSL include.
 * What the scene does not need is not written: anisotropy, rotation, what the kind does not use. */
#include "core/error.h"
#include "core/frame.h"
#include "model/export_network.h"
#include "model/export_unpack.h"
#include "model/export_weights.h"

#include <string.h>

/* The text of shaders/hybrid_brdf.glsl; the build makes it from that file. */
extern const char hnbrdf_hybrid_brdf_glsl[];

/* ---- Sections -------------------------------------------------------------------------------- */

/* What the weights take in the shader or in its uniform block, which holds single precision alone. */
static size_t weight_bytes(const hnbrdf_scene *s)
{
    const hnbrdf_model_desc *desc = s->desc;
    if (s->style == HNBRDF_GLSL_UNIFORM)
        return (size_t)hnbrdf_layer_start(desc, desc->layers + 1) * 4 * sizeof(float);
    size_t single = (size_t)hnbrdf_layer_outputs(desc, desc->layers) * ((size_t)desc->hidden + 1);
    return s->precision == HNBRDF_GLSL_HALF ? 2 * (s->weights + single) : s->weights * sizeof(float);
}

static void put_heading(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    const hnbrdf_model_desc *desc = s->desc;
    hnbrdf_put(out,
               "// Written by hnbrdf " HNBRDF_VERSION_STRING "; export again rather than edit.\n//\n");
    hnbrdf_put(out, "//   kind       %s\n", hnbrdf_kind_name(desc->kind));
    if (hnbrdf_scene_has_network(s)) {
        hnbrdf_put(out, "//   network    %d", HNBRDF_ENCODING_SIZE + desc->latent);
        for (int k = 0; k < desc->layers; k++)
            hnbrdf_put(out, " -> %d", desc->hidden);
        hnbrdf_put(out, " -> %d (%dx%d)\n", desc->kind == HNBRDF_KIND_HYBRID ? 6 : 3, desc->hidden,
                   desc->layers);
        hnbrdf_put(out, "//   encoding   %s, then %d latent\n", hnbrdf_encoding_name(desc->encoding),
                   desc->latent);
        hnbrdf_put(out, "//   weights    %zu, %zu bytes, %s\n", s->weights, weight_bytes(s),
                   s->style == HNBRDF_GLSL_UNIFORM   ? "in a uniform block"
                   : s->style == HNBRDF_GLSL_COLUMNS ? "as constants in columns"
                                                     : "as constants");
        hnbrdf_put(out, "//   precision  %s\n",
                   s->precision == HNBRDF_GLSL_HALF ? "half in hidden layers, else single" : "single");
        hnbrdf_put(out, "//   cost       %zu multiplications per evaluation\n", s->multiplications);
    }
    hnbrdf_put(out, "//   materials  %d%s%s\n", s->count,
               s->anisotropic ? ", anisotropic" : ", isotropic", s->rotated ? ", rotated" : "");
    if (s->packing)
        hnbrdf_put_texel_summary(out, s->packing);
    hnbrdf_put(out,
               "//\n// f = hnbrdf_eval(hnbrdf_scene_material(HNBRDF_MATERIAL_%s), wi, wo), without the "
               "cosine.\n",
               s->names[0]);
    hnbrdf_put(out, "#ifndef HNBRDF_HYBRID_BRDF_GLSL\n#error \"include hybrid_brdf.glsl before this "
                    "file\"\n#endif\n\n");
}

/* For code that serves scenes of every kind. */
static void put_switches(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    static const char *const kinds[] = {"HYBRID", "NEURAL", "GGX"};
    hnbrdf_put(out, "#define HNBRDF_SCENE_%s\n", kinds[s->desc->kind]);
    if (hnbrdf_scene_has_network(s)) {
        char function[32];
        snprintf(function, sizeof function, "%s", hnbrdf_encoding_name(s->desc->encoding));
        for (char *c = function; *c; c++)
            *c = *c == '-' ? '_' : *c;
        hnbrdf_put(out, "#define HNBRDF_SCENE_ENCODE hnbrdf_encode_%s\n", function);
    }
    hnbrdf_put(out, "\n");
}

static void put_material_struct(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "struct hnbrdf_material {\n");
    if (hnbrdf_scene_has_analytic(s)) {
        hnbrdf_put(out, "    vec3 kd;       // diffuse albedo\n");
        hnbrdf_put(out, "    vec3 eta;      // index of refraction, above 1\n");
        hnbrdf_put(out, s->anisotropic
                            ? "    vec2 alpha;    // GGX roughness along x and y, at least 1e-4\n"
                            : "    float alpha;   // GGX roughness, at least 1e-4\n");
    }
    if (hnbrdf_scene_has_rotation(s))
        hnbrdf_put(out, "    vec2 rotation; // cosine and sine of the tangent frame's angle\n");
    for (int v = 0; v < hnbrdf_scene_latent_vectors(s); v++)
        hnbrdf_put(out, "    vec4 latent%d;\n", v);
    hnbrdf_put(out, "};\n\n");
}

static void put_material(hnbrdf_printer *out, const hnbrdf_scene *s, const hnbrdf_material *material)
{
    const char *comma = "";
    hnbrdf_put(out, "hnbrdf_material(");
    if (hnbrdf_scene_has_analytic(s)) {
        hnbrdf_put_vector(out, 3, material->kd, 3);
        hnbrdf_put(out, ", ");
        hnbrdf_put_vector(out, 3, material->eta, 3);
        hnbrdf_put(out, ", ");
        if (s->anisotropic)
            hnbrdf_put_vector(out, 2, material->alpha, 2);
        else
            hnbrdf_put_float(out, material->alpha[0]);
        comma = ", ";
    }
    if (hnbrdf_scene_has_rotation(s)) {
        hnbrdf_frame frame = hnbrdf_frame_of(material);
        hnbrdf_put(out, "%s", comma);
        hnbrdf_put_vector(out, 2, (const float[2]){frame.cosine, frame.sine}, 2);
        comma = ", ";
    }
    for (int v = 0; v < hnbrdf_scene_latent_vectors(s); v++) {
        hnbrdf_put(out, "%s", comma);
        hnbrdf_put_vector(out, 4, material->latent + 4 * v, s->desc->latent - 4 * v);
        comma = ", ";
    }
    hnbrdf_put(out, ")");
}

static void put_materials(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    for (int k = 0; k < s->count; k++)
        hnbrdf_put(out, "#define HNBRDF_MATERIAL_%s %d // \"%s\"\n", s->names[k], k,
                   s->desc->names[hnbrdf_scene_index(s, k)]);
    hnbrdf_put(out, "#define HNBRDF_MATERIAL_COUNT %d\n\n", s->count);
    hnbrdf_put(out, "// Any number outside of [0, HNBRDF_MATERIAL_COUNT) stands for the last one.\n");
    hnbrdf_put(out, "hnbrdf_material hnbrdf_scene_material(int index)\n{\n");
    for (int k = 0; k < s->count; k++) {
        if (k + 1 < s->count)
            hnbrdf_put(out, "    if (index == %d)\n    ", k);
        hnbrdf_put(out, "    return ");
        put_material(out, s, hnbrdf_scene_material(s, k));
        hnbrdf_put(out, ";\n");
    }
    hnbrdf_put(out, "}\n\n");
}

/* Both directions into the tangent frame, as far as any material is turned. */
static void put_pair(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "// Both directions in the tangent frame of the material.\n");
    hnbrdf_put(out, "hnbrdf_pair hnbrdf_scene_pair(hnbrdf_material m, vec3 wi, vec3 wo)\n{\n");
    hnbrdf_put(out, s->rotated
                        ? "    return hnbrdf_pair_make(hnbrdf_to_tangent(m.rotation, wi),\n"
                          "                            hnbrdf_to_tangent(m.rotation, wo));\n}\n\n"
                        : "    return hnbrdf_pair_make(wi, wo);\n}\n\n");
}

static const char HORIZON[] = "    if (!(wi.z > 0.0 && wo.z > 0.0))\n        return vec3(0.0);\n"
                              "    hnbrdf_pair p = hnbrdf_scene_pair(m, wi, wo);\n";

/* The exponent s c + m; a scale of 1 and a shift of 0 change no bit and are left out. */
static void put_exponent(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int loaded = s->style == HNBRDF_GLSL_UNIFORM;
    hnbrdf_put(out, "    HNBRDF_PRECISE vec3 exponent = ");
    if (loaded || s->desc->scale != 1.0f) {
        hnbrdf_put_constant(out, s, 0);
        hnbrdf_put(out, " * ");
    }
    hnbrdf_put(out, "c");
    if (loaded || s->desc->shift != 0.0f) {
        hnbrdf_put(out, " + ");
        hnbrdf_put_constant(out, s, 1);
    }
    hnbrdf_put(out, ";\n");
}

static void put_analytic(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    if (hnbrdf_scene_has_analytic(s)) {
        hnbrdf_put(out, "// f_a before it is clamped to what f may be.\n");
        hnbrdf_put(out, "vec3 hnbrdf_analytic(hnbrdf_material m, hnbrdf_pair p)\n{\n");
        hnbrdf_put(out, "    float specular = hnbrdf_specular(p, %s);\n",
                   s->anisotropic ? "m.alpha" : "vec2(m.alpha)");
        hnbrdf_put(out, "    return hnbrdf_microfacet(m.kd, m.eta, p.c, specular);\n}\n\n");
    }
    hnbrdf_put(out, "// f_a alone: Lambert + GGX, the cheapest level of detail%s.\n",
               hnbrdf_scene_has_analytic(s) ? "" : "; this kind of model has none");
    hnbrdf_put(out, "vec3 hnbrdf_eval_analytic(hnbrdf_material m, vec3 wi, vec3 wo)\n{\n");
    if (hnbrdf_scene_has_analytic(s)) {
        hnbrdf_put(out, "%s", HORIZON);
        hnbrdf_put(out, "    return hnbrdf_finish(hnbrdf_analytic(m, p));\n}\n\n");
    } else {
        hnbrdf_put(out, "    return vec3(0.0);\n}\n\n");
    }
}

static void put_eval(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    hnbrdf_put(out, "// f(wi, wo) in 1/sr without the cosine; 0 below the horizon.\n");
    hnbrdf_put(out, "vec3 hnbrdf_eval(hnbrdf_material m, vec3 wi, vec3 wo)\n{\n");
    if (!hnbrdf_scene_has_network(s)) {
        hnbrdf_put(out, "    return hnbrdf_eval_analytic(m, wi, wo);\n}\n");
        return;
    }
    int hybrid = s->desc->kind == HNBRDF_KIND_HYBRID;
    hnbrdf_put(out, "%s", HORIZON);
    hnbrdf_put(out, "    vec3 x0, x1, c%s;\n", hybrid ? ", g" : "");
    hnbrdf_put(out, "    HNBRDF_SCENE_ENCODE(p, x0, x1);\n");
    hnbrdf_put(out, "    hnbrdf_network(m, x0, x1, c%s);\n", hybrid ? ", g" : "");
    put_exponent(out, s);
    hnbrdf_put(out, hybrid ? "    return hnbrdf_compose_hybrid(exponent, g, hnbrdf_analytic(m, p), "
                           : "    return hnbrdf_compose_neural(exponent, ");
    hnbrdf_put_constant(out, s, 2);
    hnbrdf_put(out, ");\n}\n");
}

hnbrdf_result hnbrdf_export_glsl(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                                 hnbrdf_write_fn write, void *user, hnbrdf_error *error)
{
    hnbrdf_scene s;
    hnbrdf_result result = hnbrdf_scene_make(model, options, &s, error);
    if (result)
        return result;
    hnbrdf_printer out = {.write = write, .user = user};
    if (options && options->standalone) {
        hnbrdf_put_bytes(&out, hnbrdf_hybrid_brdf_glsl, strlen(hnbrdf_hybrid_brdf_glsl));
        hnbrdf_put(&out, "\n");
    }
    put_heading(&out, &s);
    put_switches(&out, &s);
    put_material_struct(&out, &s);
    put_materials(&out, &s);
    if (s.packing)
        hnbrdf_put_unpack(&out, &s);
    put_pair(&out, &s);
    if (hnbrdf_scene_has_network(&s))
        hnbrdf_put_network(&out, &s);
    put_analytic(&out, &s);
    put_eval(&out, &s);
    hnbrdf_put_flush(&out);
    model->allocator.release(model->allocator.user, s.names);
    if (out.failed)
        return hnbrdf_fail(error, HNBRDF_ERROR_IO, "export: writing the shader failed");
    return HNBRDF_OK;
}
