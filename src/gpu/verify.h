/* verify.h: an exported scene on one Vulkan device against the C library, stage by stage. */
#ifndef HNBRDF_GPU_VERIFY_H
#define HNBRDF_GPU_VERIFY_H

#include "gpu/pairs.h"
#include "gpu/probe.h"
#include "gpu/scene.h"

/* "encoding", "network", "analytic", "value"; "exact", "fast". */
const char *gpu_stage_name(gpu_stage stage);
const char *gpu_build_name(gpu_build build);

/* One number of one pair. */
typedef struct gpu_place {
    gpu_pair_class class_of_pair;
    float pair[6];
    int component;
    float device, reference;
    double bound; /* on |device - reference| */
    double ulp;
} gpu_place;

/* Errors are in ulp of, and relative to, the reference, but where it is small of 2^-10 for f and
 * f_a (below that, what is left of f when the floor is subtracted has no digits of its own) and
 * of 1 for what goes in and out of the network (numbers around 1, of which absolute errors
 * count). Bounds know no such limit. */
typedef struct gpu_comparison {
    int applies;      /* 0: this kind of model has no such stage */
    size_t values;    /* compared */
    size_t identical; /* same bits */
    size_t outside;   /* beyond the bound; or not finite or negative where f must be neither */
    size_t unbounded; /* not compared: nothing can be promised there (extreme pairs) */
    double sum_ulp, worst_ulp, sum_relative, worst_relative;
    double worst_share; /* largest error/bound; infinite for any error where the bound is 0 */
    /* the first value outside of its bound if there is one, else the largest in ulp */
    gpu_place worst;
} gpu_comparison;

/* Sums over several comparisons of one stage. */
void gpu_comparison_add(gpu_comparison *sum, const gpu_comparison *more);

typedef struct gpu_verify_options {
    gpu_scene scene;
    hnbrdf_glsl_precision precision; /* of the scene */
    const int *materials;            /* indices of the exported materials, in order */
    int material_count;
    size_t pairs; /* per material */
    uint64_t seed;
    int without_timing;
    void (*progress)(void *user, double share); /* may be NULL */
    void *progress_user;
} gpu_verify_options;

typedef struct gpu_report {
    gpu_arithmetic arithmetic;
    gpu_timing timing; /* times are NaN if it was not asked for */
    /* every comparison within its bounds, and exp and log as accurate as the bounds assume */
    int within;
    int material_count;
    gpu_comparison (*comparisons)[GPU_BUILDS][GPU_STAGES]; /* [material_count] */
} gpu_report;

/* Fails if something could not be run; a shader that is wrong gives HNBRDF_OK and within = 0. */
hnbrdf_result gpu_verify(const gpu_device *device, const hnbrdf_model *model,
                         const gpu_verify_options *options, gpu_report *report,
                         hnbrdf_error *error);
void gpu_report_free(gpu_report *report);

#endif
