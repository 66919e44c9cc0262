/* verify.h: an exported scene on one Vulkan device against the C library, stage by stage. */
#ifndef HNBRDF_GPU_VERIFY_H
#define HNBRDF_GPU_VERIFY_H

#include "check/verify.h"
#include "gpu/device.h"
#include "gpu/scene.h"

/* Where the shader runs. */
typedef enum gpu_stage {
    GPU_STAGE_COMPUTE = 0,
    GPU_STAGE_FRAGMENT /* an RGBA32F image that is drawn into; not timed */
} gpu_stage;

typedef struct gpu_verify_options {
    gpu_scene scene;
    gpu_stage stage;
    check_verify_options check;
    int without_timing;
} gpu_verify_options;

/* As check_verify(); needs glslangValidator. */
hnbrdf_result gpu_verify(const gpu_device *device, const hnbrdf_model *model,
                         const gpu_verify_options *options, check_report *report,
                         hnbrdf_error *error);

#endif
