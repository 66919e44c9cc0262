/* evaluate.h: the exported shader of a model on one device as a function: any material, any
 * directions. */
#ifndef HNBRDF_GPU_EVALUATE_H
#define HNBRDF_GPU_EVALUATE_H

#include "check/verify.h"
#include "gpu/compute.h"
#include "gpu/scene.h"
#include "hnbrdf/glsl.h"

/* Which shader. */
typedef struct gpu_style {
    hnbrdf_glsl_weights weights;
    hnbrdf_glsl_precision precision;
    check_build build;
} gpu_style;

/* What is asked of it, and how many numbers come of each pair. */
typedef enum gpu_evaluation {
    GPU_EVALUATE_ANALYTIC = 0, /* hnbrdf_eval_analytic(): 3 */
    GPU_EVALUATE_VALUE,        /* hnbrdf_eval(): 3 */
    GPU_EVALUATE_PDF,          /* hnbrdf_pdf(): 1 */
    /* hnbrdf_sample(): wi, weight, pdf, then hnbrdf_pdf() of that wi: 8 */
    GPU_EVALUATE_SAMPLE,
    GPU_EVALUATIONS
} gpu_evaluation;
enum { GPU_EVALUATION_NUMBERS = 8 };

typedef struct gpu_evaluator {
    const gpu_device *device;
    const hnbrdf_model *model;
    gpu_buffer inputs, values, weights;
    gpu_program program;
    VkPipeline pipelines[GPU_EVALUATIONS];
    float *packed;
    size_t capacity;
} gpu_evaluator;

/* Exports and compiles the model, which must outlive the evaluator, for at most `capacity`
 * evaluations a run. The scene is made to read every field of a material, so it is anisotropic
 * and turned. */
hnbrdf_result gpu_evaluator_open(const gpu_device *device, const hnbrdf_model *model,
                                 const gpu_style *style, size_t capacity, gpu_evaluator *evaluator,
                                 hnbrdf_error *error);
void gpu_evaluator_close(gpu_evaluator *evaluator);

/* One material; pairs is [count][6], wi then wo, and u [count][3], random numbers. */
hnbrdf_result gpu_evaluator_run(gpu_evaluator *evaluator, gpu_evaluation what,
                                const hnbrdf_material *material, const float *pairs, const float *u,
                                size_t count, float (*values)[GPU_EVALUATION_NUMBERS],
                                hnbrdf_error *error);

#endif
