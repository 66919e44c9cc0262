/* reference.h: what the C library says of a set of direction pairs, every stage. */
#ifndef HNBRDF_GPU_REFERENCE_H
#define HNBRDF_GPU_REFERENCE_H

#include "gpu/bounds.h"
#include "gpu/verify.h"

/* `count` pairs of one material, for a shader of this precision: in half, network and value are
 * those of half.h. Stages keep 6, 6, 3 and 3 numbers a pair. */
typedef struct gpu_reference {
    hnbrdf_glsl_precision precision;
    size_t count;
    float *pairs; /* 6 each */
    gpu_pair_class *classes;
    float *stages[GPU_STAGES];
} gpu_reference;

int gpu_stage_stride(gpu_stage stage);

hnbrdf_result gpu_reference_open(size_t count, hnbrdf_glsl_precision precision,
                                 gpu_reference *reference, hnbrdf_error *error);
void gpu_reference_close(gpu_reference *reference);
/* Draws pairs and evaluates all stages. */
void gpu_reference_fill(const hnbrdf_model *model, const hnbrdf_material *material, hnbrdf_rng *rng,
                        gpu_reference *reference);

/* Compares what the device returned for each stage. HNBRDF_ERROR_FORMAT if bounds.c does not
 * reproduce the bits of the C library, in which case its bounds mean nothing. */
hnbrdf_result gpu_compare(const gpu_rules *rules, const hnbrdf_model *model,
                          const hnbrdf_material *material, const gpu_reference *reference,
                          const float *const device[GPU_STAGES],
                          gpu_comparison comparisons[GPU_STAGES], hnbrdf_error *error);

#endif
