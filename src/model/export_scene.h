/* export_scene.h: what is written of a model, shared by the files of the GLSL exporter. */
#ifndef HNBRDF_MODEL_EXPORT_SCENE_H
#define HNBRDF_MODEL_EXPORT_SCENE_H

#include "core/model.h"

enum { HNBRDF_MACRO_NAME_SIZE = HNBRDF_MAX_NAME + 32 };
typedef char hnbrdf_macro_name[HNBRDF_MACRO_NAME_SIZE]; /* what follows HNBRDF_MATERIAL_ */

typedef struct hnbrdf_scene {
    const hnbrdf_model_desc *desc;
    const int *indices; /* NULL: all materials in order */
    int count;
    int anisotropic, rotated; /* 1 if any of these materials is */
    size_t weights, multiplications;
    hnbrdf_macro_name *names;
} hnbrdf_scene;

#endif
