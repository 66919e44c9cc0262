/* export_glsl.c: writes a model and the materials of a scene as one GLSL include.
 * What the scene does not need is not written: anisotropy, rotation, what the kind does not use. */
#include "base/error.h"
#include "base/memory.h"
#include "glsl/export_brdf.h"
#include "glsl/export_evaluate.h"
#include "glsl/export_filter.h"
#include "glsl/export_language.h"
#include "glsl/export_library.h"
#include "glsl/export_material.h"
#include "glsl/export_network.h"
#include "glsl/export_unpack.h"
#include "glsl/export_weights.h"
#include "hnbrdf/glsl.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* ---- Sections -------------------------------------------------------------------------------- */

/* What the weights take in the shader or in its uniform block, which holds single precision
 * alone. */
static size_t weight_bytes(const hnbrdf_scene *s)
{
    const hnbrdf_model_desc *desc = s->desc;
    if (s->style == HNBRDF_GLSL_UNIFORM)
        return (size_t)hnbrdf_layer_start(desc, desc->layers + 1) * 4 * sizeof(float);
    size_t single = (size_t)hnbrdf_layer_outputs(desc, desc->layers) * ((size_t)desc->hidden + 1);
    return s->precision == HNBRDF_GLSL_HALF ? 2 * (s->weights + single)
                                            : s->weights * sizeof(float);
}

/* "name, " for each of a list of which some are there; the last without comma. */
typedef struct listed {
    const char *name;
    int there;
} listed;

static void put_list(hnbrdf_printer *out, const char *title, const listed *list, int count)
{
    int written = 0;
    for (int i = 0; i < count; i++)
        if (list[i].there)
            hnbrdf_put(out, "%s%s", written++ > 0 ? ", " : title, list[i].name);
    if (written > 0)
        hnbrdf_put(out, "\n");
}

static void put_contents(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    int analytic = hnbrdf_scene_has_analytic(s), everything = s->only == HNBRDF_GLSL_EVERYTHING;
    const listed contents[] = {{"hnbrdf_eval", 1},
                               {"hnbrdf_eval_NAME", s->fixed},
                               {"hnbrdf_eval_analytic", everything},
                               {"hnbrdf_sample", hnbrdf_scene_has_sampling(s)},
                               {"hnbrdf_sample_direction", hnbrdf_scene_has_sampling(s)},
                               {"hnbrdf_pdf", hnbrdf_scene_has_sampling(s)},
                               {"the same with _world", 1},
                               {"hnbrdf_material_unpack", s->packing != NULL}};
    const listed left_out[] = {{"anisotropy", analytic && !s->anisotropic},
                               {"rotation", !s->rotated},
                               {"materials that change", s->fixed},
                               {"latent code (in the first bias)", s->folded},
                               {"the analytic part alone", analytic && !everything},
                               {"sampling", !hnbrdf_scene_has_sampling(s)}};
    put_list(out, "//   contains   ", contents, 8);
    put_list(out, "//   left out   ", left_out, 6);
}

static void put_heading(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    const hnbrdf_model_desc *desc = s->desc;
    hnbrdf_put(out, "// Written by hnbrdf " HNBRDF_VERSION_STRING
                    ". Export again rather than edit.\n//\n");
    hnbrdf_put(out, "//   kind       %s\n", hnbrdf_kind_name(desc->kind));
    if (hnbrdf_scene_has_network(s)) {
        hnbrdf_put(out, "//   network    %d", HNBRDF_ENCODING_SIZE + desc->latent);
        for (int k = 0; k < desc->layers; k++)
            hnbrdf_put(out, " -> %d", desc->hidden);
        hnbrdf_put(out, " -> %d (%dx%d)\n", desc->kind == HNBRDF_KIND_HYBRID ? 6 : 3, desc->hidden,
                   desc->layers);
        hnbrdf_put(out, "//   encoding   %s, then %d latent\n",
                   hnbrdf_encoding_name(desc->encoding), desc->latent);
        hnbrdf_put(out, "//   weights    %zu, %zu bytes, %s\n", s->weights, weight_bytes(s),
                   s->style == HNBRDF_GLSL_UNIFORM   ? "in a uniform block"
                   : s->style == HNBRDF_GLSL_COLUMNS ? "as constants in columns"
                                                     : "as constants");
        hnbrdf_put(out, "//   precision  %s\n",
                   s->precision == HNBRDF_GLSL_HALF ? "half in hidden layers, else single"
                                                    : "single");
        hnbrdf_put(out, "//   cost       %zu multiplications per evaluation\n", s->multiplications);
    }
    hnbrdf_put(out, "//   materials  %d%s%s%s\n", s->count,
               s->anisotropic ? ", anisotropic" : ", isotropic", s->rotated ? ", rotated" : "",
               s->edited ? ", edited with their corrections" : "");
    if (s->packing)
        hnbrdf_put_texel_summary(out, s->packing);
    put_contents(out, s);
    hnbrdf_put(
        out,
        "//\n// f = hnbrdf_eval(hnbrdf_scene_material(HNBRDF_MATERIAL_%s), wi, wo), without the "
        "cosine.\n",
        s->names[0]);
    hnbrdf_put(out, "\n");
}

/* For code that serves scenes of every kind. */
static void put_switches(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    static const char *const kinds[] = {"HYBRID", "NEURAL", "GGX"};
    hnbrdf_put(out, "#define HNBRDF_SCENE_%s\n", kinds[s->desc->kind]);
    if (s->edited)
        hnbrdf_put(out, "#define HNBRDF_SCENE_EDITED\n");
    if (hnbrdf_scene_has_network(s)) {
        char function[32];
        snprintf(function, sizeof function, "%s", hnbrdf_encoding_name(s->desc->encoding));
        for (char *c = function; *c; c++)
            *c = *c == '-' ? '_' : *c;
        hnbrdf_put(out, "#define HNBRDF_SCENE_ENCODE hnbrdf_encode_%s\n", function);
    }
    hnbrdf_put(out, "\n");
}

static void put_body(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    put_switches(out, s);
    hnbrdf_put_material_struct(out, s);
    hnbrdf_put_materials(out, s);
    if (s->packing)
        hnbrdf_put_unpack(out, s);
    if (hnbrdf_scene_has_network(s))
        hnbrdf_put_network(out, s);
    hnbrdf_put_evaluate(out, s);
}

/* FNV-1a. */
static int hash_bytes(void *user, const void *data, size_t size)
{
    uint32_t *hash = (uint32_t *)user;
    const unsigned char *bytes = (const unsigned char *)data;
    for (size_t i = 0; i < size; i++)
        *hash = (*hash ^ bytes[i]) * 16777619u;
    return 0;
}

/* The same text twice is there once, another one under the same names is an error that says so. */
static void put_scene(hnbrdf_printer *out, const hnbrdf_scene *s)
{
    uint32_t hash = 2166136261u;
    hnbrdf_printer hashed = {.write = hash_bytes, .user = &hash};
    put_body(&hashed, s);
    hnbrdf_put_flush(&hashed);
    hnbrdf_put(out, "#ifndef HNBRDF_SCENE_%08X_GLSL\n#define HNBRDF_SCENE_%08X_GLSL\n",
               (unsigned)hash, (unsigned)hash);
    hnbrdf_put(out, "#ifdef HNBRDF_SCENE\n"
                    "#error two exported texts with the same names: export one with --prefix NAME\n"
                    "#endif\n#define HNBRDF_SCENE\n");
    if (!s->parts)
        hnbrdf_put(out, "#ifndef HNBRDF_HYBRID_BRDF_GLSL\n"
                        "#error include hybrid_brdf.glsl before this file\n#endif\n");
    hnbrdf_put(out, "\n");
    put_body(out, s);
    hnbrdf_put(out, "\n#endif\n");
}

/* The GLSL that was asked for: what it holds, hybrid_brdf.glsl if it is standalone, the scene. */
static void put_text(hnbrdf_printer *out, const hnbrdf_scene *s, const hnbrdf_glsl_options *options)
{
    const int with_library = options && (options->standalone || options->library);
    const int alone = options && options->library;
    if (!alone)
        put_heading(out, s);
    if (with_library && options->exact && options->language == HNBRDF_LANGUAGE_GLSL)
        hnbrdf_put(out, "#define HNBRDF_EXACT 1\n");
    if (alone) {
        hnbrdf_put_bytes(out, hnbrdf_hybrid_brdf_glsl, strlen(hnbrdf_hybrid_brdf_glsl));
    } else {
        if (with_library) {
            hnbrdf_put_library(out, s, put_scene);
            hnbrdf_put(out, "\n");
        }
        put_scene(out, s);
    }
    hnbrdf_put_flush(out);
}

/* Through what the options ask for; 1 where writing failed. */
static int write_text(const hnbrdf_scene *s, const hnbrdf_glsl_options *options,
                      hnbrdf_write_fn write, void *user)
{
    const int strip = options && options->without_comments;
    hnbrdf_renamer renamer = {.write = write, .user = user, .prefix = s->prefix};
    hnbrdf_stripper stripper = {.write = s->prefix ? hnbrdf_rename : write,
                                .user = s->prefix ? &renamer : user};
    hnbrdf_printer out = {.write = strip ? hnbrdf_strip : stripper.write,
                          .user = strip ? &stripper : stripper.user};
    put_text(&out, s, options);
    return out.failed || (s->prefix && hnbrdf_rename_end(&renamer));
}

static hnbrdf_result write_glsl(const hnbrdf_scene *s, const hnbrdf_glsl_options *options,
                                hnbrdf_write_fn write, void *user, hnbrdf_error *error)
{
    if (write_text(s, options, write, user))
        return hnbrdf_fail(error, HNBRDF_ERROR_IO, "export: writing the shader failed");
    return HNBRDF_OK;
}

static hnbrdf_result write_translated(const hnbrdf_scene *s, const hnbrdf_glsl_options *options,
                                      const hnbrdf_allocator *memory, hnbrdf_write_fn write,
                                      void *user, hnbrdf_error *error)
{
    hnbrdf_grown text = {.memory = memory};
    const int failed = write_text(s, options, hnbrdf_grow, &text);
    const hnbrdf_result result =
        failed ? hnbrdf_fail_memory(error, 2 * text.room, "a shader")
               : hnbrdf_write_language(&text, options->standalone || options->library, options,
                                       write, user, error);
    hnbrdf_release(memory, text.text);
    return result;
}

static hnbrdf_result check_language(const hnbrdf_glsl_options *options, hnbrdf_error *error)
{
    if (!options)
        return HNBRDF_OK;
    if (!hnbrdf_shading_language_name(options->language))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "export: language %d is unknown",
                           (int)options->language);
    if (options->exact && options->language == HNBRDF_LANGUAGE_GLSL && !options->standalone &&
        !options->library)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "export: in GLSL an exact build is chosen in hybrid_brdf.glsl: expected "
                           "a standalone text, or HNBRDF_EXACT 1 before the include");
    if (options->library && options->language == HNBRDF_LANGUAGE_BRDF)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "export: a .brdf file is whole, expected no shared part of its own");
    return HNBRDF_OK;
}

hnbrdf_result hnbrdf_export_shader(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                                   hnbrdf_write_fn write, void *user, hnbrdf_error *error)
{
    hnbrdf_scene s = {0};
    hnbrdf_allocator memory;
    hnbrdf_result result = check_language(options, error);
    if (!result)
        result = hnbrdf_choose_allocator(model ? &model->allocator : NULL, &memory, error);
    if (result)
        return result;
    const int library = options && options->library;
    if (!library)
        result = hnbrdf_scene_make(model, options, &s, error);
    if (result)
        return result;
    const hnbrdf_shading_language language = options ? options->language : HNBRDF_LANGUAGE_GLSL;
    if (language == HNBRDF_LANGUAGE_GLSL)
        result = write_glsl(&s, options, write, user, error);
    else if (language == HNBRDF_LANGUAGE_BRDF)
        result = hnbrdf_write_brdf(&s, options, &memory, write, user, error);
    else
        result = write_translated(&s, options, &memory, write, user, error);
    hnbrdf_release(&memory, s.names);
    return result;
}

hnbrdf_result hnbrdf_export_behind(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                                   const char *name, const char *glsl, hnbrdf_write_fn write,
                                   void *user, hnbrdf_error *error)
{
    if (options->language == HNBRDF_LANGUAGE_GLSL)
        return write(user, glsl, strlen(glsl))
                   ? hnbrdf_fail(error, HNBRDF_ERROR_IO, "export: writing %s failed", name)
                   : HNBRDF_OK;
    hnbrdf_grown scene = {.memory = &model->allocator};
    hnbrdf_glsl_options before = *options;
    before.language = HNBRDF_LANGUAGE_GLSL;
    before.standalone = 1;
    before.exact = 0; /* the translation defines it */
    hnbrdf_result result = hnbrdf_export_shader(model, &before, hnbrdf_grow, &scene, error);
    if (!result)
        result = hnbrdf_write_behind(&scene, name, glsl, options, write, user, error);
    hnbrdf_release(&model->allocator, scene.text);
    return result;
}
