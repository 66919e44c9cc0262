/* gpu_support.h: models with pseudo-random weights as large as trained ones, and exported texts. */
#ifndef HNBRDF_TESTS_GPU_SUPPORT_H
#define HNBRDF_TESTS_GPU_SUPPORT_H

#include "hnbrdf/glsl.h"

enum { SCENE_MATERIALS = 3 };

/* What a scene is made of; zero is an isotropic hybrid 0x0: set at least hidden and layers. */
typedef struct scene_shape {
    hnbrdf_kind kind;
    hnbrdf_encoding encoding;
    int hidden, layers, latent;
    int anisotropic, rotated, edited; /* edited: all but the first material */
    float scale, shift, floor;
} scene_shape;

/* Ends the test if it cannot be made. */
hnbrdf_model *scene_model(const scene_shape *shape);

/* The exported include, malloc'ed. */
char *scene_text(const hnbrdf_model *model, int standalone);
char *styled_text(const hnbrdf_model *model, const hnbrdf_glsl_options *options);

/* The bytes of the uniform block, malloc'ed; *size of them. */
float *scene_weights(const hnbrdf_model *model, const hnbrdf_glsl_options *options, size_t *size);

#endif
