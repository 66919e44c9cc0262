/* evaluate.h: the exported shader of a model on one device as a function: any material, any directions.
 */
#ifndef HNBRDF_GPU_EVALUATE_H
#define HNBRDF_GPU_EVALUATE_H

#include "gpu/scene.h"

/* Which shader. */
typedef struct gpu_style {
    hnbrdf_glsl_weights weights;
    hnbrdf_glsl_precision precision;
    gpu_build build;
} gpu_style;

typedef struct gpu_evaluator {
    const gpu_device *device;
    gpu_buffer inputs, values, weights;
    gpu_program program;
    VkPipeline analytic, value;
    float *packed;
    size_t capacity;
} gpu_evaluator;

/* Exports and compiles the model for at most `capacity` evaluations a run. The scene is made to read
 * every field of a material, so it is anisotropic and turned. */
hnbrdf_result gpu_evaluator_open(const gpu_device *device, const hnbrdf_model *model,
                                 const gpu_style *style, size_t capacity, gpu_evaluator *evaluator,
                                 hnbrdf_error *error);
void gpu_evaluator_close(gpu_evaluator *evaluator);

/* GPU_STAGE_ANALYTIC or GPU_STAGE_VALUE of one material: pairs is [count][6], wi then wo; values
 * [count][3]. */
hnbrdf_result gpu_evaluator_run(gpu_evaluator *evaluator, gpu_stage stage,
                                const hnbrdf_material *material, const float *pairs, size_t count,
                                float *values, hnbrdf_error *error);

#endif
