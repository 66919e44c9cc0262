/* export_language.c: an exported text in another language than GLSL, made from the GLSL by
 * src/language. */
#include "glsl/export_language.h"

#include "base/error.h"
#include "base/memory.h"
#include "glsl/export_library.h"
#include "language/language.h"

#include <string.h>

/* ---- Memory ---------------------------------------------------------------------------------- */

int hnbrdf_grow(void *grown, const void *data, size_t size)
{
    hnbrdf_grown *to = (hnbrdf_grown *)grown;
    if (to->room - to->size < size) {
        const size_t room = 2 * to->room + size + 4096;
        char *text = (char *)hnbrdf_allocate(to->memory, room);
        if (!text)
            return 1;
        if (to->size > 0)
            memcpy(text, to->text, to->size);
        hnbrdf_release(to->memory, to->text);
        to->text = text;
        to->room = room;
    }
    memcpy(to->text + to->size, data, size);
    to->size += size;
    return 0;
}

/* ---- Languages ------------------------------------------------------------------------------- */

/* What stands on top of the shared part: how to use it in this language. */
#define HEADING(file, language, word, declaration)                                                 \
    "// " file ": the parts a hybrid neural-microfacet BRDF is made of (De Oliveira et al., EGSR " \
    "2026), in\n// " language ". Written by hnbrdf " HNBRDF_VERSION_STRING                         \
    " from hybrid_brdf.glsl; export again rather than edit.\n"                                     \
    "// It comes first, then what `hnbrdf export --language " word "` wrote for a scene:\n//\n"    \
    "//     " declaration " = hnbrdf_scene_material(HNBRDF_MATERIAL_NAME);\n"

#define MEANING                                                                               \
    "//\n// The same functions as in the C library, named alike and in the same order of "    \
    "operations. Frame and\n// units as there: n = +z, wi towards the light, wo towards the " \
    "viewer, f in 1/sr without the cosine.\n"

#define RADIANCE(type) \
    "//     " type " radiance = hnbrdf_eval(m, wi, wo) * light * max(wi.z, 0.0);\n"

static const char HLSL[] = HEADING("hybrid_brdf.hlsl", "HLSL of Shader Model 5.0 and newer", "hlsl",
                                   "hnbrdf_material m") RADIANCE("float3") MEANING;
static const char MSL[] = HEADING("hybrid_brdf.msl", "the Metal Shading Language", "msl",
                                  "hnbrdf_material m") RADIANCE("float3") MEANING;
static const char WGSL[] =
    HEADING("hybrid_brdf.wgsl", "WGSL", "wgsl", "let m") RADIANCE("let") MEANING;
static const char SLANG[] =
    HEADING("hybrid_brdf.slang", "Slang", "slang", "hnbrdf_material m") RADIANCE("float3") MEANING;

typedef struct language {
    const hnbrdf_dialect *dialect;
    const char *heading;
} language;

static language language_of(hnbrdf_shading_language which)
{
    switch (which) {
    case HNBRDF_LANGUAGE_HLSL:
        return (language){&hnbrdf_hlsl, HLSL};
    case HNBRDF_LANGUAGE_MSL:
        return (language){&hnbrdf_msl, MSL};
    case HNBRDF_LANGUAGE_SLANG:
        return (language){&hnbrdf_slang, SLANG};
    case HNBRDF_LANGUAGE_WGSL:
        return (language){&hnbrdf_wgsl, WGSL};
    case HNBRDF_LANGUAGE_BRDF:
        return (language){&hnbrdf_glsl_plain, ""};
    default:
        return (language){0};
    }
}

hnbrdf_result hnbrdf_write_language(const hnbrdf_grown *text, int with_library,
                                    const hnbrdf_glsl_options *options, hnbrdf_write_fn write,
                                    void *user, hnbrdf_error *error)
{
    const language to = language_of(options->language);
    const hnbrdf_source sources[] = {{.name = "hybrid_brdf.glsl",
                                      .text = hnbrdf_hybrid_brdf_glsl,
                                      .size = strlen(hnbrdf_hybrid_brdf_glsl)},
                                     {.name = "the exported text",
                                      .text = text->text,
                                      .size = text->size,
                                      .print = 1,
                                      .heading = with_library ? to.heading : NULL}};
    return hnbrdf_translate(with_library ? sources + 1 : sources, with_library ? 1 : 2, to.dialect,
                            options->exact != 0, text->memory, write, user, error);
}

hnbrdf_result hnbrdf_write_behind(const hnbrdf_grown *scene, const char *name, const char *glsl,
                                  const hnbrdf_glsl_options *options, hnbrdf_write_fn write,
                                  void *user, hnbrdf_error *error)
{
    const hnbrdf_source sources[] = {
        {.name = "the scene", .text = scene->text, .size = scene->size},
        {.name = name, .text = glsl, .size = strlen(glsl), .print = 1}};
    return hnbrdf_translate(sources, 2, language_of(options->language).dialect, options->exact != 0,
                            scene->memory, write, user, error);
}
