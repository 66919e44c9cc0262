/* verify.c: shaders/verify.comp or verify.frag with an exported scene on one Vulkan device, in both
 * builds. */
#include "gpu/verify.h"

#include "base/error.h"
#include "check/parity.h"
#include "check/probe.h"
#include "gpu/compile.h"
#include "gpu/fragment.h"
#include "gpu/probe.h"
#include "gpu/probe_half.h"
#include "gpu/timed.h"

#include <stdlib.h>
#include <string.h>

/* The texts of shaders/verify.comp, verify.frag, verify.vert, parity.glsl and probe.glsl. */
extern const char hnbrdf_verify_comp[], hnbrdf_verify_frag[], hnbrdf_verify_vert[],
    hnbrdf_parity_glsl[], hnbrdf_probe_glsl[];

/* Everything that lives as long as one device is verified. */
typedef struct verifier {
    const gpu_device *device;
    const gpu_verify_options *options;
    gpu_buffer rows, outputs, weights;
    gpu_canvas canvas; /* of the fragment stage alone, as are the pixels of all slots */
    float *pixels;
    gpu_program programs[CHECK_BUILDS];
    VkPipeline pipelines[CHECK_BUILDS];
} verifier;

static hnbrdf_result open_buffers(verifier *s, hnbrdf_error *error)
{
    const gpu_scene *scene = &s->options->scene;
    const int fragment = s->options->stage == GPU_STAGE_FRAGMENT;
    size_t pairs = s->options->check.pairs;
    if (fragment && pairs < CHECK_PROBE_COUNT) /* which the probe needs */
        pairs = CHECK_PROBE_COUNT;
    hnbrdf_result result =
        gpu_buffer_open(s->device, pairs * CHECK_PARITY_INPUTS * sizeof(float), &s->rows, error);
    size_t size = pairs * CHECK_PARITY_OUTPUTS * sizeof(float);
    if (!result && fragment) {
        result = gpu_canvas_open(s->device, pairs, &s->canvas, error);
        size = CHECK_PARITY_SLOTS * gpu_canvas_size(&s->canvas);
        s->pixels = result ? NULL : malloc(size);
        if (!result && !s->pixels)
            result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "verify: out of memory");
    }
    if (!result)
        result = gpu_buffer_open(s->device, size, &s->outputs, error);
    if (!result && scene->weights)
        result =
            gpu_uniform_open(s->device, scene->weights, scene->weights_size, &s->weights, error);
    return result;
}

/* The shader of a stage with the scene. */
static hnbrdf_result compile(const verifier *s, check_build build, uint32_t **spirv, size_t *size,
                             hnbrdf_error *error)
{
    const gpu_include includes[] = {{"scene.glsl", s->options->scene.text},
                                    {"parity.glsl", hnbrdf_parity_glsl},
                                    {"probe.glsl", hnbrdf_probe_glsl}};
    const char *const defines[] = {
        build == CHECK_BUILD_EXACT ? "HNBRDF_EXACT=1" : "HNBRDF_EXACT=0",
        s->device->has_half ? "HNBRDF_HALF_NATIVE=1" : "HNBRDF_HALF_NATIVE=0", NULL};
    const int fragment = s->options->stage == GPU_STAGE_FRAGMENT;
    return gpu_compile_at(fragment ? "frag" : "comp",
                          fragment ? hnbrdf_verify_frag : hnbrdf_verify_comp, includes, 3, defines,
                          spirv, size, error);
}

static hnbrdf_result open_compute(verifier *s, check_build build, const uint32_t *spirv,
                                  size_t size, hnbrdf_error *error)
{
    const gpu_buffer *const buffers[] = {&s->rows, &s->outputs, &s->weights};
    gpu_program *program = &s->programs[build];
    hnbrdf_result result =
        gpu_program_open(s->device, spirv, size, buffers, s->options->scene.weights ? 3 : 2,
                         sizeof(uint32_t), program, error);
    program->slots = CHECK_PARITY_SLOTS;
    return result ? result : gpu_pipeline_open(s->device, program, 0, &s->pipelines[build], error);
}

typedef struct fragment_push {
    uint32_t count, width, slot;
} fragment_push;

static hnbrdf_result open_fragment(verifier *s, check_build build, const uint32_t *spirv,
                                   size_t size, hnbrdf_error *error)
{
    const gpu_buffer *const buffers[] = {&s->rows, &s->weights};
    gpu_program *program = &s->programs[build];
    uint32_t *vertex = NULL;
    size_t vertex_size = 0;
    hnbrdf_result result = gpu_program_open_at(s->device, VK_SHADER_STAGE_FRAGMENT_BIT, spirv, size,
                                               buffers, s->options->scene.weights ? 2 : 1,
                                               sizeof(fragment_push), program, error);
    if (!result)
        result =
            gpu_compile_at("vert", hnbrdf_verify_vert, NULL, 0, NULL, &vertex, &vertex_size, error);
    if (!result)
        result = gpu_canvas_pipeline(s->device, &s->canvas, program, vertex, vertex_size,
                                     &s->pipelines[build], error);
    free(vertex);
    return result;
}

static hnbrdf_result open_program(verifier *s, check_build build, hnbrdf_error *error)
{
    uint32_t *spirv = NULL;
    size_t size = 0;
    hnbrdf_result result = compile(s, build, &spirv, &size, error);
    if (!result)
        result = s->options->stage == GPU_STAGE_FRAGMENT
                     ? open_fragment(s, build, spirv, size, error)
                     : open_compute(s, build, spirv, size, error);
    free(spirv);
    return result;
}

static void close_verifier(verifier *s)
{
    for (int build = 0; build < CHECK_BUILDS; build++) {
        vkDestroyPipeline(s->device->handle, s->pipelines[build], NULL);
        gpu_program_close(s->device, &s->programs[build]);
    }
    gpu_canvas_close(s->device, &s->canvas);
    free(s->pixels);
    gpu_buffer_close(s->device, &s->rows);
    gpu_buffer_close(s->device, &s->outputs);
    gpu_buffer_close(s->device, &s->weights);
}

static hnbrdf_result dispatch(verifier *s, check_build build, size_t count, float *outputs,
                              hnbrdf_error *error)
{
    const uint32_t push = (uint32_t)count;
    hnbrdf_result result = gpu_dispatch(s->device, &s->programs[build], s->pipelines[build], &push,
                                        count, 1, NULL, error);
    return result ? result
                  : gpu_download(s->device, &s->outputs, outputs,
                                 count * CHECK_PARITY_OUTPUTS * sizeof(float), error);
}

/* A picture a slot, from `first` on; outputs[count][4 * slots]. */
static hnbrdf_result draw(verifier *s, check_build build, uint32_t first, uint32_t slots,
                          size_t count, float *outputs, hnbrdf_error *error)
{
    const size_t size = gpu_canvas_size(&s->canvas);
    hnbrdf_result result = HNBRDF_OK;
    for (uint32_t i = 0; i < slots && !result; i++) {
        const fragment_push push = {(uint32_t)count, GPU_CANVAS_WIDTH, first + i};
        result = gpu_canvas_draw(s->device, &s->canvas, &s->programs[build], s->pipelines[build],
                                 &push, &s->outputs, i * size, error);
    }
    if (!result)
        result = gpu_download(s->device, &s->outputs, s->pixels, slots * size, error);
    for (size_t i = 0; i < slots && !result; i++)
        for (size_t k = 0; k < count; k++)
            memcpy(outputs + 4 * (k * slots + i), s->pixels + i * (size / sizeof(float)) + 4 * k,
                   4 * sizeof(float));
    return result;
}

static hnbrdf_result draw_probe(void *user, const float *operands, int count, float *results,
                                hnbrdf_error *error)
{
    verifier *s = user;
    const size_t size = (size_t)count * CHECK_PROBE_OPERANDS * sizeof(float);
    hnbrdf_result result = gpu_upload(s->device, &s->rows, operands, size, error);
    return result ? result
                  : draw(s, CHECK_BUILD_EXACT, CHECK_PARITY_SLOTS, CHECK_PROBE_RESULTS / 4,
                         (size_t)count, results, error);
}

/* In the stage that is verified: Mesa llvmpipe keeps subnormal numbers in compute shaders alone. */
static hnbrdf_result probe(void *user, check_arithmetic *arithmetic, hnbrdf_error *error)
{
    verifier *s = user;
    const int llvmpipe = s->device->driver_id == VK_DRIVER_ID_MESA_LLVMPIPE;
    hnbrdf_result result = s->options->stage == GPU_STAGE_FRAGMENT
                               ? check_probe_run(draw_probe, s, llvmpipe, arithmetic, error)
                               : gpu_probe(s->device, arithmetic, error);
    if (!result && s->options->check.precision == HNBRDF_GLSL_HALF)
        result = gpu_probe_half(s->device, arithmetic, error);
    return result;
}

static hnbrdf_result run(void *user, check_build build, const float *rows, size_t count,
                         float *outputs, int *has_run, hnbrdf_error *error)
{
    verifier *s = user;
    *has_run = 1;
    hnbrdf_result result =
        gpu_upload(s->device, &s->rows, rows, count * CHECK_PARITY_INPUTS * sizeof(float), error);
    if (result)
        return result;
    return s->options->stage == GPU_STAGE_FRAGMENT
               ? draw(s, build, 0, CHECK_PARITY_SLOTS, count, outputs, error)
               : dispatch(s, build, count, outputs, error);
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
    const int timed = !options->without_timing && options->stage == GPU_STAGE_COMPUTE;
    check_timing timing;
    hnbrdf_result result = HNBRDF_OK;
    /* first, or the driver would have compiled before */
    if (timed)
        result = gpu_time_scene(device, &options->scene, &timing, error);
    if (!result)
        result = open_buffers(&s, error);
    for (int build = 0; build < CHECK_BUILDS && !result; build++)
        result = open_program(&s, (check_build)build, error);
    if (!result)
        result = check_verify(&runner, model, &options->check, report, error);
    if (!result && timed)
        report->timing = timing;
    close_verifier(&s);
    return result;
}
