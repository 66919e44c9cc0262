/* stability.c: the exported shaders on Vulkan devices as backends of `hnbrdf stability`. */
#include "gpu/stability.h"

#include "base/error.h"
#include "gpu/compile.h"
#include "gpu/evaluate.h"
#include "gpu/probe.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Division may err by 2.5 ulp in Vulkan, square roots by more: 5 times correct rounding. exp may
 * by 3 + 2|x| ulp: at an exponent of 5, 13 times ours; and what log loses goes through the
 * network. */
static const double FAST = 5.0, FAST_VALUE = 10.0;

typedef struct shader {
    const gpu_device *device;
    gpu_style style;
    gpu_evaluator evaluator;
} shader;

struct stability_gpus {
    gpu_instance instance;
    gpu_device devices[GPU_MAX_DEVICES];
    int device_count;
    shader shaders[STABILITY_GPU_BACKENDS];
    int shader_count;
};

static hnbrdf_result begin(stability_backend *backend, const hnbrdf_model *model,
                           hnbrdf_error *error)
{
    shader *s = backend->user;
    return gpu_evaluator_open(s->device, model, &s->style, STABILITY_BLOCK, &s->evaluator, error);
}

static void end(stability_backend *backend)
{
    shader *s = backend->user;
    gpu_evaluator_close(&s->evaluator);
}

static hnbrdf_result run(stability_backend *backend, stability_stage stage,
                         const stability_block *block,
                         float values[STABILITY_BLOCK][STABILITY_NUMBERS], hnbrdf_error *error)
{
    static const gpu_evaluation evaluations[STABILITY_STAGES] = {
        GPU_EVALUATE_ANALYTIC, GPU_EVALUATE_VALUE, GPU_EVALUATE_PDF, GPU_EVALUATE_SAMPLE};
    shader *s = backend->user;
    return gpu_evaluator_run(&s->evaluator, evaluations[stage], &block->material, block->pairs[0],
                             block->u[0], STABILITY_BLOCK, values, error);
}

static void add(stability_gpus *gpus, const gpu_device *device, const check_arithmetic *arithmetic,
                gpu_style style, stability_backend *backends)
{
    if (gpus->shader_count == STABILITY_GPU_BACKENDS)
        return;
    shader *s = &gpus->shaders[gpus->shader_count];
    int half = style.precision == HNBRDF_GLSL_HALF;
    int rounds = arithmetic->exact_basic && arithmetic->exact_divide && arithmetic->exact_sqrt;
    int flushes = arithmetic->flushes_denormals, keeps = arithmetic->keeps_denormals;
    int exact = style.build == CHECK_BUILD_EXACT && rounds && (keeps || flushes);
    s->device = device;
    s->style = style;
    stability_backend *b = &backends[gpus->shader_count++];
    *b = (stability_backend){.stages = (1 << STABILITY_STAGES) - 1,
                             .loosen = exact ? 1.0 : FAST,
                             .loosen_value = half    ? (double)INFINITY
                                             : exact ? 1.0
                                                     : FAST_VALUE,
                             .state = flushes ? STABILITY_FLUSH : STABILITY_NEAREST,
                             .exact = exact,
                             .begin = begin,
                             .run = run,
                             .end = end,
                             .user = s};
    snprintf(b->name, sizeof b->name, "glsl %s%s%s, %.48s",
             half                               ? "half"
             : style.build == CHECK_BUILD_EXACT ? "exact"
                                                : "fast",
             style.weights ? " " : "", style.weights ? hnbrdf_glsl_weights_name(style.weights) : "",
             device->properties.deviceName);
}

static hnbrdf_result add_device(stability_gpus *gpus, int index, int styles,
                                stability_backend *backends, hnbrdf_error *error)
{
    gpu_device *device = &gpus->devices[gpus->device_count];
    check_arithmetic arithmetic;
    hnbrdf_result result = gpu_device_open(&gpus->instance, index, device, error);
    if (result)
        return result;
    gpus->device_count++;
    result = gpu_probe(device, &arithmetic, error);
    for (int w = 0; w <= (styles ? (int)HNBRDF_GLSL_UNIFORM : 0) && !result; w++) {
        const hnbrdf_glsl_weights weights = (hnbrdf_glsl_weights)w;
        add(gpus, device, &arithmetic, (gpu_style){weights, HNBRDF_GLSL_FLOAT, CHECK_BUILD_EXACT},
            backends);
        if (w == HNBRDF_GLSL_CONSTANTS)
            add(gpus, device, &arithmetic,
                (gpu_style){weights, HNBRDF_GLSL_FLOAT, CHECK_BUILD_FAST}, backends);
        if (device->has_half)
            add(gpus, device, &arithmetic, (gpu_style){weights, HNBRDF_GLSL_HALF, CHECK_BUILD_FAST},
                backends);
    }
    return result;
}

hnbrdf_result stability_gpus_open(const char *text, int styles, stability_gpus **gpus,
                                  stability_backend *backends, int *count, char note[128],
                                  hnbrdf_error *error)
{
    char *end_of_number;
    long number = strtol(text, &end_of_number, 10);
    int all = strcmp(text, "all") == 0, none = strcmp(text, "none") == 0;
    *count = 0;
    *gpus = NULL;
    if (!all && !none && (end_of_number == text || *end_of_number))
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "--device: found '%s', expected a number, all or none", text);
    if (!none) /* who asks for none need not be told */
        snprintf(note, 128, "no GPU: glslangValidator is not installed");
    if (none || !gpu_compiler_found())
        return HNBRDF_OK;
    stability_gpus *opened = calloc(1, sizeof *opened);
    if (!opened)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    hnbrdf_result result = gpu_open(GPU_NOT_VALIDATED, &opened->instance, error);
    if (result != HNBRDF_OK) {
        free(opened);
        return result;
    }
    *gpus = opened;
    snprintf(note, 128, opened->instance.count ? "" : "no GPU: no Vulkan device found");
    if (!all && (number < 0 || number >= opened->instance.count))
        return hnbrdf_fail(error, HNBRDF_ERROR_UNSUPPORTED,
                           "--device %ld: this machine has %d devices (hnbrdf verify --list)",
                           number, opened->instance.count);
    for (int i = 0; i < opened->instance.count && result == HNBRDF_OK; i++)
        if (all || i == number)
            result = add_device(opened, i, styles, backends, error);
    if (result == HNBRDF_OK)
        *count = opened->shader_count;
    return result;
}

void stability_gpus_close(stability_gpus *gpus)
{
    if (!gpus)
        return;
    for (int d = 0; d < gpus->device_count; d++)
        gpu_device_close(&gpus->devices[d]);
    gpu_close(&gpus->instance);
    free(gpus);
}
