/* verify.c: shaders/verify.comp with an exported scene on one Vulkan device, in both builds. */
#include "gpu/verify.h"

#include "base/error.h"
#include "check/parity.h"
#include "gpu/compile.h"
#include "gpu/compute.h"
#include "gpu/probe.h"
#include "gpu/probe_half.h"
#include "gpu/timed.h"

#include <stdlib.h>

/* The texts of shaders/verify.comp and shaders/parity.glsl. */
extern const char hnbrdf_verify_comp[], hnbrdf_parity_glsl[];

/* Everything that lives as long as one device is verified. */
typedef struct verifier {
    const gpu_device *device;
    const gpu_verify_options *options;
    gpu_buffer rows, outputs, weights;
    gpu_program programs[CHECK_BUILDS];
    VkPipeline pipelines[CHECK_BUILDS];
} verifier;

static hnbrdf_result probe(void *user, check_arithmetic *arithmetic, hnbrdf_error *error)
{
    verifier *s = user;
    hnbrdf_result result = gpu_probe(s->device, arithmetic, error);
    if (!result && s->options->check.precision == HNBRDF_GLSL_HALF)
        result = gpu_probe_half(s->device, arithmetic, error);
    return result;
}

static hnbrdf_result open_buffers(verifier *s, hnbrdf_error *error)
{
    const gpu_scene *scene = &s->options->scene;
    const size_t pairs = s->options->check.pairs;
    hnbrdf_result result =
        gpu_buffer_open(s->device, pairs * CHECK_PARITY_INPUTS * sizeof(float), &s->rows, error);
    if (!result)
        result = gpu_buffer_open(s->device, pairs * CHECK_PARITY_OUTPUTS * sizeof(float),
                                 &s->outputs, error);
    if (!result && scene->weights)
        result =
            gpu_uniform_open(s->device, scene->weights, scene->weights_size, &s->weights, error);
    return result;
}

static hnbrdf_result open_program(verifier *s, check_build build, hnbrdf_error *error)
{
    const gpu_include includes[] = {{"scene.glsl", s->options->scene.text},
                                    {"parity.glsl", hnbrdf_parity_glsl}};
    const char *const defines[] = {
        build == CHECK_BUILD_EXACT ? "HNBRDF_EXACT=1" : "HNBRDF_EXACT=0",
        s->device->has_half ? "HNBRDF_HALF_NATIVE=1" : "HNBRDF_HALF_NATIVE=0", NULL};
    const gpu_buffer *const buffers[] = {&s->rows, &s->outputs, &s->weights};
    uint32_t *spirv = NULL;
    size_t size = 0;
    hnbrdf_result result =
        gpu_compile(hnbrdf_verify_comp, includes, 2, defines, &spirv, &size, error);
    if (!result)
        result =
            gpu_program_open(s->device, spirv, size, buffers, s->options->scene.weights ? 3 : 2,
                             sizeof(uint32_t), &s->programs[build], error);
    s->programs[build].slots = CHECK_PARITY_SLOTS;
    if (!result)
        result = gpu_pipeline_open(s->device, &s->programs[build], 0, &s->pipelines[build], error);
    free(spirv);
    return result;
}

static void close_verifier(verifier *s)
{
    for (int build = 0; build < CHECK_BUILDS; build++) {
        vkDestroyPipeline(s->device->handle, s->pipelines[build], NULL);
        gpu_program_close(s->device, &s->programs[build]);
    }
    gpu_buffer_close(s->device, &s->rows);
    gpu_buffer_close(s->device, &s->outputs);
    gpu_buffer_close(s->device, &s->weights);
}

static hnbrdf_result run(void *user, check_build build, const float *rows, size_t count,
                         float *outputs, int *has_run, hnbrdf_error *error)
{
    verifier *s = user;
    const uint32_t push = (uint32_t)count;
    *has_run = 1;
    hnbrdf_result result =
        gpu_upload(s->device, &s->rows, rows, count * CHECK_PARITY_INPUTS * sizeof(float), error);
    if (!result)
        result = gpu_dispatch(s->device, &s->programs[build], s->pipelines[build], &push, count, 1,
                              NULL, error);
    if (!result)
        result = gpu_download(s->device, &s->outputs, outputs,
                              count * CHECK_PARITY_OUTPUTS * sizeof(float), error);
    return result;
}

hnbrdf_result gpu_verify(const gpu_device *device, const hnbrdf_model *model,
                         const gpu_verify_options *options, check_report *report,
                         hnbrdf_error *error)
{
    verifier s = {.device = device, .options = options};
    const check_runner runner = {.is_llvmpipe = device->driver_id == VK_DRIVER_ID_MESA_LLVMPIPE,
                                 .probe = probe,
                                 .run = run,
                                 .user = &s};
    check_timing timing;
    hnbrdf_result result = HNBRDF_OK;
    /* first, or the driver would have compiled before */
    if (!options->without_timing)
        result = gpu_time_scene(device, &options->scene, &timing, error);
    if (!result)
        result = open_buffers(&s, error);
    for (int build = 0; build < CHECK_BUILDS && !result; build++)
        result = open_program(&s, (check_build)build, error);
    if (!result)
        result = check_verify(&runner, model, &options->check, report, error);
    if (!result && !options->without_timing)
        report->timing = timing;
    close_verifier(&s);
    return result;
}
