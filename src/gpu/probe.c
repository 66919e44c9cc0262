/* probe.c: runs shaders/probe.comp and compares every operation with C. */
#include "gpu/probe.h"

#include "check/probe.h"
#include "gpu/compile.h"
#include "gpu/compute.h"

#include <stdlib.h>

/* The texts of shaders/probe.comp and shaders/probe.glsl. */
extern const char hnbrdf_probe_comp[], hnbrdf_probe_glsl[];

enum {
    VALUES = CHECK_PROBE_COUNT,
    OPERANDS = CHECK_PROBE_OPERANDS,
    RESULTS = CHECK_PROBE_RESULTS,
    SLOTS = RESULTS / 4
};

static hnbrdf_result run(const gpu_device *device, const gpu_program *program, gpu_buffer *input,
                         gpu_buffer *output, const void *operands, size_t operand_bytes,
                         void *results, size_t result_bytes, hnbrdf_error *error)
{
    VkPipeline pipeline = VK_NULL_HANDLE;
    uint32_t count = VALUES;
    hnbrdf_result result = gpu_upload(device, input, operands, operand_bytes, error);
    if (!result)
        result = gpu_pipeline_open(device, program, 0, &pipeline, error);
    if (!result)
        result = gpu_dispatch(device, program, pipeline, &count, VALUES, 1, NULL, error);
    if (!result)
        result = gpu_download(device, output, results, result_bytes, error);
    vkDestroyPipeline(device->handle, pipeline, NULL);
    return result;
}

typedef struct job {
    const gpu_device *device;
    const uint32_t *spirv;
    size_t spirv_size;
} job;

static hnbrdf_result run_job(void *user, const float *operands, int count, float *results,
                             hnbrdf_error *error)
{
    const job *j = user;
    const size_t operand_bytes = sizeof *operands * OPERANDS * (size_t)count,
                 result_bytes = sizeof *results * RESULTS * (size_t)count;
    gpu_buffer input = {0}, output = {0};
    gpu_program program = {0};
    hnbrdf_result result = gpu_buffer_open(j->device, operand_bytes, &input, error);
    if (!result)
        result = gpu_buffer_open(j->device, result_bytes, &output, error);
    const gpu_buffer *const buffers[] = {&input, &output};
    if (!result)
        result = gpu_program_open(j->device, j->spirv, j->spirv_size, buffers, 2, sizeof(uint32_t),
                                  &program, error);
    program.slots = SLOTS;
    if (!result)
        result = run(j->device, &program, &input, &output, operands, operand_bytes, results,
                     result_bytes, error);
    gpu_program_close(j->device, &program);
    gpu_buffer_close(j->device, &input);
    gpu_buffer_close(j->device, &output);
    return result;
}

hnbrdf_result gpu_probe(const gpu_device *device, check_arithmetic *arithmetic, hnbrdf_error *error)
{
    uint32_t *spirv = NULL;
    job j = {.device = device};
    const gpu_include include = {"probe.glsl", hnbrdf_probe_glsl};
    hnbrdf_result result =
        gpu_compile(hnbrdf_probe_comp, &include, 1, NULL, &spirv, &j.spirv_size, error);
    j.spirv = spirv;
    if (!result)
        result = check_probe_run(run_job, &j, device->driver_id == VK_DRIVER_ID_MESA_LLVMPIPE,
                                 arithmetic, error);
    free(spirv);
    return result;
}
