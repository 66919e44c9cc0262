/* export_scene.h: what is written of a model, shared by the files of the GLSL exporter. */
#ifndef HNBRDF_GLSL_EXPORT_SCENE_H
#define HNBRDF_GLSL_EXPORT_SCENE_H

#include "core/model.h"
#include "glsl/macro_names.h"
#include "hnbrdf/glsl.h"

typedef struct hnbrdf_scene {
    const hnbrdf_model *model;
    const hnbrdf_model_desc *desc;
    hnbrdf_glsl_only only;
    const char *prefix; /* NULL: hnbrdf */
    int parts;          /* 1: hybrid_brdf.glsl is in the text, each part of it with its guard */
    int whole;          /* 1: all of it, for whatever else is in the same shader */
    int fixed;          /* 1: materials are constants */
    /* 1: their latent codes are in the first layer's bias; not for half or loaded weights */
    int folded;
    const hnbrdf_packing *packing; /* NULL: no materials from textures */
    const int *indices;            /* NULL: all materials in order */
    int energy;                    /* 1: some material conserves energy */
    int count;
    int edited;                     /* 1: corrections are carried along by edits */
    int anisotropic, rotated;       /* 1 if any of these materials is, or the packing stores it */
    float first[HNBRDF_MAX_HIDDEN]; /* bias of the first layer; of a single material: folded */
    size_t weights, multiplications;
    hnbrdf_glsl_weights style;
    hnbrdf_glsl_precision precision;
    hnbrdf_macro_name *names;
} hnbrdf_scene;

/* Checks everything there is to check of the options. Release names with the model's allocator. */
hnbrdf_result hnbrdf_scene_make(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                                hnbrdf_scene *s, hnbrdf_error *error);

/* Material k of the scene: its number in the model, itself. */
int hnbrdf_scene_index(const hnbrdf_scene *s, int k);
const hnbrdf_material *hnbrdf_scene_material(const hnbrdf_scene *s, int k);

/* What is behind hnbrdf_encode_ in the name of its encoding's function. */
void hnbrdf_scene_encoding(const hnbrdf_scene *s, char *name, size_t size);

/* The function that makes the pair its network sees of an edited material's. */
const char *hnbrdf_scene_seen_function(const hnbrdf_scene *s);

int hnbrdf_scene_has_analytic(const hnbrdf_scene *s);
int hnbrdf_scene_has_network(const hnbrdf_scene *s);
int hnbrdf_scene_has_sampling(const hnbrdf_scene *s);
/* Latent codes are kept in as few vec4 as hold them; a fixed scene keeps the folded biases in their
 * place, but for one material, whose folded biases stand in the network. */
int hnbrdf_scene_latent_vectors(const hnbrdf_scene *s);
int hnbrdf_scene_bias_vectors(const hnbrdf_scene *s);
/* Also where the struct would be empty, which GLSL does not allow. */
int hnbrdf_scene_has_rotation(const hnbrdf_scene *s);

#endif
