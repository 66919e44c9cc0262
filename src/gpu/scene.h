/* scene.h: one exported scene, to be run on Vulkan devices. */
#ifndef HNBRDF_GPU_SCENE_H
#define HNBRDF_GPU_SCENE_H

#include <stddef.h>

/* What is exported; the caller keeps it. */
typedef struct gpu_scene {
    const char *text;    /* of hnbrdf_export_shader(), standalone; any style and precision */
    const void *weights; /* of hnbrdf_export_weights(), for HNBRDF_GLSL_UNIFORM; else NULL */
    size_t weights_size;
} gpu_scene;

#endif
