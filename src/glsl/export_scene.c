/* export_scene.c: which materials of a model are written, and what they need. */
#include "glsl/export_scene.h"

#include "base/error.h"
#include "core/compose.h"
#include "glsl/export_filter.h"

#include <stdio.h>
#include <string.h>

int hnbrdf_scene_index(const hnbrdf_scene *s, int k)
{
    return s->indices ? s->indices[k] : k;
}

const hnbrdf_material *hnbrdf_scene_material(const hnbrdf_scene *s, int k)
{
    return &s->desc->materials[hnbrdf_scene_index(s, k)];
}

void hnbrdf_scene_encoding(const hnbrdf_scene *s, char *name, size_t size)
{
    snprintf(name, size, "%s", hnbrdf_encoding_name(s->desc->encoding));
    for (char *c = name; *c; c++)
        *c = *c == '-' ? '_' : *c;
}

const char *hnbrdf_scene_seen_function(const hnbrdf_scene *s)
{
    if (s->desc->encoding == HNBRDF_ENCODING_DIRECTIONS)
        return "hnbrdf_turn_pair";
    return s->desc->encoding == HNBRDF_ENCODING_ANGLES_AZIMUTHS ? "hnbrdf_incline_along"
                                                                : "hnbrdf_incline_pair";
}

int hnbrdf_scene_has_analytic(const hnbrdf_scene *s)
{
    return s->desc->kind != HNBRDF_KIND_NEURAL;
}

int hnbrdf_scene_has_network(const hnbrdf_scene *s)
{
    return s->desc->kind != HNBRDF_KIND_GGX;
}

int hnbrdf_scene_has_sampling(const hnbrdf_scene *s)
{
    return s->only != HNBRDF_GLSL_EVAL;
}

int hnbrdf_scene_latent_vectors(const hnbrdf_scene *s)
{
    return hnbrdf_scene_has_network(s) && !s->folded ? (s->desc->latent + 3) / 4 : 0;
}

int hnbrdf_scene_bias_vectors(const hnbrdf_scene *s)
{
    return s->folded && s->count > 1 ? (s->desc->hidden + 3) / 4 : 0;
}

int hnbrdf_scene_has_rotation(const hnbrdf_scene *s)
{
    int fields = hnbrdf_scene_has_analytic(s) + hnbrdf_scene_latent_vectors(s) +
                 hnbrdf_scene_bias_vectors(s);
    return s->rotated || fields == 0;
}

static hnbrdf_result use_packing(hnbrdf_scene *s, const hnbrdf_packing *packing,
                                 hnbrdf_error *error)
{
    int latent = hnbrdf_scene_has_network(s) ? s->desc->latent : 0;
    if (!packing)
        return HNBRDF_OK;
    if (packing->latent != latent || packing->analytic != hnbrdf_scene_has_analytic(s))
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "export: the packing stores %d latent numbers and %s analytic part, the model "
            "has %d and %s",
            packing->latent, packing->analytic ? "an" : "no", latent,
            hnbrdf_scene_has_analytic(s) ? "one" : "none");
    s->packing = packing;
    s->edited = packing->edited && s->desc->kind == HNBRDF_KIND_HYBRID;
    s->anisotropic = packing->anisotropic;
    s->rotated = packing->rotated;
    s->energy = packing->energy;
    return hnbrdf_packing_check(packing, error);
}

static void set_first_bias(hnbrdf_scene *s)
{
    hnbrdf_prepared prepared;
    if (!hnbrdf_scene_has_network(s))
        return;
    hnbrdf_prepare(s->model, hnbrdf_scene_material(s, 0), &prepared);
    memcpy(s->first, s->folded && s->count == 1 ? prepared.first : s->desc->biases[0],
           (size_t)s->desc->hidden * sizeof *s->first);
}

hnbrdf_result hnbrdf_scene_make(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                                hnbrdf_scene *s, hnbrdf_error *error)
{
    memset(s, 0, sizeof *s);
    s->model = model;
    s->desc = &model->desc;
    s->style = options ? options->weights : HNBRDF_GLSL_CONSTANTS;
    s->precision = options ? options->precision : HNBRDF_GLSL_FLOAT;
    if (!hnbrdf_glsl_weights_name(s->style) || !hnbrdf_glsl_precision_name(s->precision))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "export: weights %d, precision %d, expected 0 to 2 and 0 to 1",
                           (int)s->style, (int)s->precision);
    s->prefix = options ? options->prefix : NULL;
    if (s->prefix && !hnbrdf_prefix_is_valid(s->prefix))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "export: the prefix is \"%.60s\", expected a letter, then letters, "
                           "digits and single underscores, at most %d, and not gl or hnbrdf_",
                           s->prefix, HNBRDF_MAX_PREFIX);
    s->whole = s->prefix && options->standalone && options->language != HNBRDF_LANGUAGE_GLSL;
    s->parts = s->prefix && options->standalone && !s->whole;
    s->only = options ? options->only : HNBRDF_GLSL_EVERYTHING;
    s->fixed = options && options->fixed;
    s->folded = s->fixed && hnbrdf_scene_has_network(s) && s->style != HNBRDF_GLSL_UNIFORM &&
                s->precision == HNBRDF_GLSL_FLOAT;
    if (s->only < HNBRDF_GLSL_EVERYTHING || s->only > HNBRDF_GLSL_EVAL_SAMPLE)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "export: only is %d, expected 0 to %d",
                           (int)s->only, (int)HNBRDF_GLSL_EVAL_SAMPLE);
    if (s->fixed && options->packing)
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "export: materials from textures change, a fixed scene's do not: found both");
    hnbrdf_result result = use_packing(s, options ? options->packing : NULL, error);
    if (result)
        return result;
    const int hybrid = s->desc->kind == HNBRDF_KIND_HYBRID;
    s->edited |= hybrid && options && options->editable && !s->fixed;
    s->indices = options ? options->materials : NULL;
    s->count = s->indices ? options->material_count : s->desc->material_count;
    if (s->count < 1 || s->count > HNBRDF_MAX_MATERIALS)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "export: %d materials, expected 1 to %d",
                           s->count, HNBRDF_MAX_MATERIALS);
    for (int k = 0; k < s->count; k++) {
        int index = hnbrdf_scene_index(s, k);
        if (index < 0 || index >= s->desc->material_count)
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                               "export: materials[%d] is %d, expected 0 to %d", k, index,
                               s->desc->material_count - 1);
        const hnbrdf_material *material = hnbrdf_scene_material(s, k);
        s->anisotropic |= material->alpha[0] != material->alpha[1];
        s->rotated |= material->rotation != 0.0f;
        s->edited |= hybrid && hnbrdf_material_is_edited(material);
        s->energy |= hnbrdf_has_energy(&material->energy);
    }
    s->weights = hnbrdf_model_weight_count(model);
    s->multiplications = hnbrdf_model_multiplications(model);
    if (s->folded) {
        s->weights -= (size_t)s->desc->hidden * (size_t)s->desc->latent;
        s->multiplications -= (size_t)s->desc->hidden * (size_t)s->desc->latent;
    }
    set_first_bias(s);
    const hnbrdf_allocator *memory = &model->allocator;
    s->names =
        (hnbrdf_macro_name *)memory->allocate(memory->user, (size_t)s->count * sizeof *s->names);
    if (!s->names)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "export: no memory for %d names", s->count);
    result = hnbrdf_macro_names(model, s->indices, s->count, s->names, error);
    if (result)
        memory->release(memory->user, s->names);
    return result;
}
