/* timed.h: exported scenes on one Vulkan device, compiled and ready to be timed again and again. */
#ifndef HNBRDF_GPU_TIMED_H
#define HNBRDF_GPU_TIMED_H

#include "check/verify.h"
#include "gpu/compute.h"
#include "gpu/scene.h"

/* Also the values of WORK in shaders/bench.comp. */
typedef enum gpu_work {
    GPU_WORK_VALUE = 0,
    GPU_WORK_NETWORK, /* not for kind ggx, nor for what has no network function of its own */
    GPU_WORK_COPY
} gpu_work;

/* Pairs of directions and room for their values. */
typedef struct gpu_timed_buffers {
    gpu_buffer directions, values;
    uint32_t count;
} gpu_timed_buffers;

/* Uniform random directions above the horizon, always the same. */
hnbrdf_result gpu_timed_buffers_open(const gpu_device *device, uint32_t count,
                                     gpu_timed_buffers *buffers, hnbrdf_error *error);
void gpu_timed_buffers_close(const gpu_device *device, gpu_timed_buffers *buffers);

typedef struct gpu_timed {
    gpu_program program;
    gpu_buffer weights; /* if the scene has them in a buffer */
    VkPipeline pipeline;
    double compile_ms;  /* GLSL to SPIR-V */
    double first_ms;    /* pipeline and first dispatch; less if the driver keeps a cache */
    size_t spirv_bytes; /* of the shader with nothing but this work in it */
} gpu_timed;

/* The scene's text is standalone, with hnbrdf_scene_material() and hnbrdf_eval(), as exports are.
 * */
hnbrdf_result gpu_timed_open(const gpu_device *device, const gpu_timed_buffers *buffers,
                             const gpu_scene *scene, gpu_work work, gpu_timed *timed,
                             hnbrdf_error *error);
void gpu_timed_close(const gpu_device *device, gpu_timed *timed);

/* Nanoseconds that `repeats` dispatches over all pairs took on the device; NaN without
 * timestamps. */
hnbrdf_result gpu_timed_run(const gpu_device *device, const gpu_timed_buffers *buffers,
                            const gpu_timed *timed, int repeats, double *ns, hnbrdf_error *error);

/* The fast build of the scene's first material: the best of a few runs of at least 5 ms each. */
hnbrdf_result gpu_time_scene(const gpu_device *device, const gpu_scene *scene, check_timing *timing,
                             hnbrdf_error *error);

/* The first `count` pairs of directions (wi, wo) and what the last run made of them; tests look at
 * that. */
hnbrdf_result gpu_timed_download(const gpu_device *device, gpu_timed_buffers *buffers,
                                 uint32_t count, float (*pairs)[6], float (*values)[3],
                                 hnbrdf_error *error);

#endif
