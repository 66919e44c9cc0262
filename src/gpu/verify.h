/* verify.h: an exported scene on one Vulkan device against the C library, stage by stage. */
#ifndef HNBRDF_GPU_VERIFY_H
#define HNBRDF_GPU_VERIFY_H

#include "check/reference.h"
#include "gpu/probe.h"
#include "gpu/scene.h"

/* "exact", "fast". */
const char *gpu_build_name(gpu_build build);

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
    check_arithmetic arithmetic;
    gpu_timing timing; /* times are NaN if it was not asked for */
    /* every comparison within its bounds, and exp and log as accurate as the bounds assume */
    int within;
    int material_count;
    check_comparison (*comparisons)[GPU_BUILDS][CHECK_STAGES]; /* [material_count] */
} gpu_report;

/* Fails if something could not be run; a shader that is wrong gives HNBRDF_OK and within = 0. */
hnbrdf_result gpu_verify(const gpu_device *device, const hnbrdf_model *model,
                         const gpu_verify_options *options, gpu_report *report,
                         hnbrdf_error *error);
void gpu_report_free(gpu_report *report);

#endif
