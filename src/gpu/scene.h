/* scene.h: one exported scene on one Vulkan device: compiled, run, timed. */
#ifndef HNBRDF_GPU_SCENE_H
#define HNBRDF_GPU_SCENE_H

#include "check/reference.h"
#include "gpu/compute.h"
#include "hnbrdf/glsl.h"

/* What is exported; the caller keeps it. */
typedef struct gpu_scene {
    const char *text;    /* of hnbrdf_export_shader(), not standalone; any style and precision */
    const void *weights; /* of hnbrdf_export_weights(), for HNBRDF_GLSL_UNIFORM; else NULL */
    size_t weights_size;
} gpu_scene;

enum { GPU_PIPELINES = CHECK_STAGES + 1 };

typedef enum gpu_build {
    GPU_BUILD_EXACT = 0, /* HNBRDF_EXACT 1 */
    GPU_BUILD_FAST,      /* built-in exp and log, contraction allowed */
    GPU_BUILDS
} gpu_build;

/* The buffers every program of a scene works on: wi and wo, 6 floats a pair; 6 encoded; up to 6
 * results; and the weights, if the scene has them in a buffer. */
typedef struct gpu_scene_buffers {
    gpu_buffer directions, encoded, values, weights;
    int has_weights;
} gpu_scene_buffers;

hnbrdf_result gpu_scene_buffers_open(const gpu_device *device, const gpu_scene *scene, size_t pairs,
                                     gpu_scene_buffers *buffers, hnbrdf_error *error);
void gpu_scene_buffers_close(const gpu_device *device, gpu_scene_buffers *buffers);

/* The shader in one build; half precision is native where the device has it. *compile_ms and
 * *spirv_bytes, each of which may be NULL, receive what GLSL to SPIR-V took and gave. */
hnbrdf_result gpu_scene_program(const gpu_device *device, const gpu_scene *scene, gpu_build build,
                                const gpu_scene_buffers *buffers, gpu_program *program,
                                double *compile_ms, size_t *spirv_bytes, hnbrdf_error *error);

/* Runs a stage over the first `pairs` of the buffers, `repeats` times; ns as for gpu_dispatch(). */
hnbrdf_result gpu_scene_run(const gpu_device *device, const gpu_program *program,
                            VkPipeline pipeline, int material, size_t pairs, int repeats,
                            double *ns, hnbrdf_error *error);

typedef struct gpu_timing {
    int evaluations; /* per measurement */
    double value_ns,
        copy_ns;       /* of one evaluation; of its buffer traffic alone. NaN without timestamps */
    double compile_ms; /* GLSL to SPIR-V */
    double first_ms;   /* pipeline and first dispatch; less if the driver keeps a cache */
    size_t spirv_bytes;
} gpu_timing;

/* The fast build of the scene's first material on uniform pairs: the best of a few runs of at
 * least 5 ms each. */
hnbrdf_result gpu_time_scene(const gpu_device *device, const gpu_scene *scene, uint64_t seed,
                             gpu_timing *timing, hnbrdf_error *error);

#endif
