/* export_glsl.c: writes a model and the materials of a scene as one GLSL include.
 * What the scene does not need is not written: anisotropy, rotation, what the kind does not use. */
#include "core/error.h"
#include "core/frame.h"
#include "model/export_network.h"

#include <stdint.h>
#include <string.h>

/* The text of shaders/hybrid_brdf.glsl; the build makes it from that file. */
extern const char hnbrdf_hybrid_brdf_glsl[];

/* ---- The scene ------------------------------------------------------------------------------- */

static int material_index(const hnbrdf_scene *s, int k)
{
    return s->indices ? s->indices[k] : k;
}

static const hnbrdf_material *material_of(const hnbrdf_scene *s, int k)
{
    return &s->desc->materials[material_index(s, k)];
}

static int has_analytic(const hnbrdf_scene *s)
{
    return s->desc->kind != HNBRDF_KIND_NEURAL;
}

static int has_network(const hnbrdf_scene *s)
{
    return s->desc->kind != HNBRDF_KIND_GGX;
}

/* Latent codes are kept in as few vec4 as hold them. */
static int latent_vectors(const hnbrdf_scene *s)
{
    return has_network(s) ? (s->desc->latent + 3) / 4 : 0;
}

/* Also where the struct would be empty, which GLSL does not allow. */
static int has_rotation(const hnbrdf_scene *s)
{
    return s->rotated || !(has_analytic(s) || latent_vectors(s));
}

/* Letters, digits and single underscores, which GLSL does not reserve; at least one character. */
static void sanitise(const char *name, hnbrdf_macro_name text)
{
    size_t length = 0;
    for (; *name; name++) {
        unsigned char c = (unsigned char)*name;
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))
            text[length++] = (char)(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
        else if (length > 0 && text[length - 1] != '_')
            text[length++] = '_';
    }
    while (length > 0 && text[length - 1] == '_')
        length--;
    if (length == 0)
        text[length++] = 'X';
    text[length] = '\0';
}

/* A hash set of names by their numbers; free slots hold -1, `slots` is a power of two. */
static int claim(const hnbrdf_scene *s, int *table, size_t slots, int k)
{
    uint32_t hash = 2166136261u; /* FNV-1a */
    for (const char *c = s->names[k]; *c; c++)
        hash = (hash ^ (uint32_t)(unsigned char)*c) * 16777619u;
    size_t at = hash & (slots - 1);
    for (; table[at] >= 0; at = (at + 1) & (slots - 1))
        if (strcmp(s->names[table[at]], s->names[k]) == 0)
            return 0;
    table[at] = k;
    return 1;
}

/* Names of their own for all materials, and none for the last, which HNBRDF_MATERIAL_COUNT takes. */
static void name_materials(const hnbrdf_scene *s, int *table, size_t slots)
{
    for (size_t i = 0; i < slots; i++)
        table[i] = -1;
    strcpy(s->names[s->count], "COUNT");
    claim(s, table, slots, s->count);
    for (int k = 0; k < s->count; k++) {
        sanitise(s->desc->names[material_index(s, k)], s->names[k]);
        size_t length = strlen(s->names[k]);
        for (int attempt = 0; !claim(s, table, slots, k); attempt++)
            snprintf(s->names[k] + length, HNBRDF_MACRO_NAME_SIZE - length,
                     attempt > 0 ? "_%d_%d" : "_%d", k, attempt);
    }
}

static hnbrdf_result scene_make(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                                hnbrdf_scene *s, hnbrdf_error *error)
{
    memset(s, 0, sizeof *s);
    s->desc = &model->desc;
    s->indices = options ? options->materials : NULL;
    s->count = s->indices ? options->material_count : s->desc->material_count;
    if (s->count < 1 || s->count > HNBRDF_MAX_MATERIALS)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "export: %d materials, expected 1 to %d",
                           s->count, HNBRDF_MAX_MATERIALS);
    for (int k = 0; k < s->count; k++) {
        int index = material_index(s, k);
        if (index < 0 || index >= s->desc->material_count)
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "export: materials[%d] is %d, expected 0 to %d", k, index,
                               s->desc->material_count - 1);
        const hnbrdf_material *material = material_of(s, k);
        s->anisotropic |= material->alpha[0] != material->alpha[1];
        s->rotated |= material->rotation != 0.0f;
    }
    s->weights = hnbrdf_model_weight_count(model);
    s->multiplications = hnbrdf_model_multiplications(model);
    size_t slots = 4;
    while (slots < 2 * ((size_t)s->count + 1))
        slots *= 2;
    const hnbrdf_allocator *memory = &model->allocator;
    s->names = memory->allocate(memory->user, ((size_t)s->count + 1) * sizeof(hnbrdf_macro_name));
    int *table = memory->allocate(memory->user, slots * sizeof *table);
    if (s->names && table)
        name_materials(s, table, slots);
    else if (s->names)
        memory->release(memory->user, s->names);
    hnbrdf_result result = s->names && table ? HNBRDF_OK
                                             : hnbrdf_fail(error, HNBRDF_ERROR_MEMORY,
                                                           "export: no memory for %d names", s->count);
    if (table)
        memory->release(memory->user, table);
    return result;
}

/* ---- Sections -------------------------------------------------------------------------------- */

static void put_heading(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    const hnbrdf_model_desc *desc = s->desc;
    hnbrdf_put(out,
               "// Written by hnbrdf " HNBRDF_VERSION_STRING "; export again rather than edit.\n//\n");
    hnbrdf_put(out, "//   kind       %s\n", hnbrdf_kind_name(desc->kind));
    if (has_network(s)) {
        hnbrdf_put(out, "//   network    %d", HNBRDF_ENCODING_SIZE + desc->latent);
        for (int k = 0; k < desc->layers; k++)
            hnbrdf_put(out, " -> %d", desc->hidden);
        hnbrdf_put(out, " -> %d (%dx%d)\n", desc->kind == HNBRDF_KIND_HYBRID ? 6 : 3, desc->hidden,
                   desc->layers);
        hnbrdf_put(out, "//   encoding   %s, then %d latent\n", hnbrdf_encoding_name(desc->encoding),
                   desc->latent);
        hnbrdf_put(out, "//   weights    %zu, %zu bytes\n", s->weights, s->weights * sizeof(float));
        hnbrdf_put(out, "//   cost       %zu multiplications per evaluation\n", s->multiplications);
    }
    hnbrdf_put(out, "//   materials  %d%s%s\n", s->count,
               s->anisotropic ? ", anisotropic" : ", isotropic", s->rotated ? ", rotated" : "");
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
    if (has_network(s)) {
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
    if (has_analytic(s)) {
        hnbrdf_put(out, "    vec3 kd;       // diffuse albedo\n");
        hnbrdf_put(out, "    vec3 eta;      // index of refraction, above 1\n");
        hnbrdf_put(out, s->anisotropic
                            ? "    vec2 alpha;    // GGX roughness along x and y, at least 1e-4\n"
                            : "    float alpha;   // GGX roughness, at least 1e-4\n");
    }
    if (has_rotation(s))
        hnbrdf_put(out, "    vec2 rotation; // cosine and sine of the tangent frame's angle\n");
    for (int v = 0; v < latent_vectors(s); v++)
        hnbrdf_put(out, "    vec4 latent%d;\n", v);
    hnbrdf_put(out, "};\n\n");
}

static void put_material(hnbrdf_printer *out, const hnbrdf_scene *s, const hnbrdf_material *material)
{
    const char *comma = "";
    hnbrdf_put(out, "hnbrdf_material(");
    if (has_analytic(s)) {
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
    if (has_rotation(s)) {
        hnbrdf_frame frame = hnbrdf_frame_of(material);
        hnbrdf_put(out, "%s", comma);
        hnbrdf_put_vector(out, 2, (const float[2]){frame.cosine, frame.sine}, 2);
        comma = ", ";
    }
    for (int v = 0; v < latent_vectors(s); v++) {
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
                   s->desc->names[material_index(s, k)]);
    hnbrdf_put(out, "#define HNBRDF_MATERIAL_COUNT %d\n\n", s->count);
    hnbrdf_put(out, "// Any number outside of [0, HNBRDF_MATERIAL_COUNT) stands for the last one.\n");
    hnbrdf_put(out, "hnbrdf_material hnbrdf_scene_material(int index)\n{\n");
    for (int k = 0; k < s->count; k++) {
        if (k + 1 < s->count)
            hnbrdf_put(out, "    if (index == %d)\n    ", k);
        hnbrdf_put(out, "    return ");
        put_material(out, s, material_of(s, k));
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
    hnbrdf_put(out, "    HNBRDF_PRECISE vec3 exponent = ");
    if (s->desc->scale != 1.0f) {
        hnbrdf_put_float(out, s->desc->scale);
        hnbrdf_put(out, " * ");
    }
    hnbrdf_put(out, "c");
    if (s->desc->shift != 0.0f) {
        hnbrdf_put(out, " + ");
        hnbrdf_put_float(out, s->desc->shift);
    }
    hnbrdf_put(out, ";\n");
}

static void put_analytic(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    if (has_analytic(s)) {
        hnbrdf_put(out, "// f_a before it is clamped to what f may be.\n");
        hnbrdf_put(out, "vec3 hnbrdf_analytic(hnbrdf_material m, hnbrdf_pair p)\n{\n");
        hnbrdf_put(out, "    float specular = hnbrdf_specular(p, %s);\n",
                   s->anisotropic ? "m.alpha" : "vec2(m.alpha)");
        hnbrdf_put(out, "    return hnbrdf_microfacet(m.kd, m.eta, p.c, specular);\n}\n\n");
    }
    hnbrdf_put(out, "// f_a alone: Lambert + GGX, the cheapest level of detail%s.\n",
               has_analytic(s) ? "" : "; this kind of model has none");
    hnbrdf_put(out, "vec3 hnbrdf_eval_analytic(hnbrdf_material m, vec3 wi, vec3 wo)\n{\n");
    if (has_analytic(s)) {
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
    if (!has_network(s)) {
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
    hnbrdf_put_float(out, s->desc->floor);
    hnbrdf_put(out, ");\n}\n");
}

hnbrdf_result hnbrdf_export_glsl(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                                 hnbrdf_write_fn write, void *user, hnbrdf_error *error)
{
    hnbrdf_scene s;
    hnbrdf_result result = scene_make(model, options, &s, error);
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
    put_pair(&out, &s);
    if (has_network(&s))
        hnbrdf_put_network(&out, &s);
    put_analytic(&out, &s);
    put_eval(&out, &s);
    hnbrdf_put_flush(&out);
    model->allocator.release(model->allocator.user, s.names);
    if (out.failed)
        return hnbrdf_fail(error, HNBRDF_ERROR_IO, "export: writing the shader failed");
    return HNBRDF_OK;
}
