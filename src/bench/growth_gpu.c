/* growth_gpu.c: how shaders grow: text to SPIR-V, the driver's compilation, bytes, evaluation. */
#include "base/error.h"
#include "bench/growth.h"

#ifdef HNBRDF_WITH_VULKAN
#include "base/clock.h"
#include "base/text_buffer.h"
#include "base/threads.h"
#include "gpu/compile.h"
#include "gpu/timed.h"
#include "hnbrdf/glsl.h"

#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum { EVALUATIONS = 1 << 14, COSTS = 4, MOST_MATERIALS = 1000 };

typedef struct shader_device {
    gpu_instance instance;
    gpu_device device;
    gpu_timed_buffers buffers;
    int is_open, is_cpu;
    char name[BENCH_NAME];
} shader_device;

static hnbrdf_result open_device(shader_device *on, const char *which, hnbrdf_error *error)
{
    hnbrdf_result result = gpu_open(GPU_NOT_VALIDATED, &on->instance, error);
    const int index = strcmp(which, "all") == 0 ? 0 : atoi(which);
    if (!result && index >= on->instance.count)
        result = hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                             "--device %s: expected none or a number below %d (hnbrdf verify "
                             "--list)",
                             which, on->instance.count);
    if (!result)
        result = gpu_device_open(&on->instance, index, &on->device, error);
    if (result)
        return result;
    on->is_open = 1;
    on->is_cpu = on->device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    const char *device = on->device.properties.deviceName, *bracket = strstr(device, " (");
    snprintf(on->name, sizeof on->name, "vulkan:%.*s", bracket ? (int)(bracket - device) : 80,
             device);
    return gpu_timed_buffers_open(&on->device, EVALUATIONS, &on->buffers, error);
}

static void close_device(shader_device *on)
{
    if (on->is_open) {
        gpu_timed_buffers_close(&on->device, &on->buffers);
        gpu_device_close(&on->device);
    }
    if (on->instance.handle)
        gpu_close(&on->instance);
}

/* The least of a few runs, the buffers' part included. */
static hnbrdf_result time_evaluation(const shader_device *on, const gpu_timed *timed, int runs,
                                     double *ns, hnbrdf_error *error)
{
    *ns = INFINITY;
    for (int k = 0; k < runs; k++) {
        double device = (double)NAN, used = -hnbrdf_process_seconds();
        hnbrdf_result result = gpu_timed_run(&on->device, &on->buffers, timed, 1, &device, error);
        used += hnbrdf_process_seconds();
        if (result)
            return result;
        *ns = fmin(*ns, (on->is_cpu ? 1e9 * used / hnbrdf_processors() : device) / EVALUATIONS);
    }
    return HNBRDF_OK;
}

/* Of programs that have ended: the compiler. */
static double children_seconds(void)
{
    struct rusage used;
    if (getrusage(RUSAGE_CHILDREN, &used))
        return (double)NAN;
    return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/* costs: ms of text to SPIR-V, its bytes, ms of pipeline and first run, ns of an evaluation; ms of
 * processors, whatever else the machine does. */
static hnbrdf_result measure(const shader_device *on, const growth *g, const growth_shape *shape,
                             double costs[COSTS], double *work, hnbrdf_error *error)
{
    hnbrdf_model *model;
    hnbrdf_text_buffer text = {0};
    const hnbrdf_glsl_options options = {.standalone = 1};
    hnbrdf_result result = bench_growth_model(shape, &model, error);
    if (result)
        return result;
    *work = (double)hnbrdf_model_weight_count(model) + shape->materials * (9.0 + shape->latent);
    result = hnbrdf_export_shader(model, &options, hnbrdf_text_buffer_append, &text, error);
    hnbrdf_model_free(model);
    costs[0] = costs[2] = costs[3] = INFINITY;
    for (int run = 0; run < (g->quick ? 1 : 3) && !result; run++) {
        const gpu_scene scene = {.text = text.bytes};
        gpu_timed timed;
        double ns = (double)NAN, own = -hnbrdf_process_seconds(), children = -children_seconds();
        result = gpu_timed_open(&on->device, &on->buffers, &scene, GPU_WORK_VALUE, &timed, error);
        own += hnbrdf_process_seconds();
        children += children_seconds();
        if (result)
            break;
        result = time_evaluation(on, &timed, g->quick ? 1 : 10, &ns, error);
        costs[0] = fmin(costs[0], 1e3 * children);
        costs[1] = (double)timed.spirv_bytes;
        costs[2] = fmin(costs[2], 1e3 * own);
        costs[3] = fmin(costs[3], ns);
        gpu_timed_close(&on->device, &timed);
    }
    free(text.bytes);
    return result;
}

static hnbrdf_result by_axis(growth *g, const shader_device *on, growth_axis axis,
                             const bench_watch *watch, hnbrdf_error *error)
{
    static const char *const whats[COSTS] = {"shader, GLSL to SPIR-V", "shader, SPIR-V",
                                             "shader, pipeline and first run",
                                             "shader, evaluation"};
    static const char *const units[COSTS] = {"ms", "bytes", "ms", "ns"};
    growth_series *series[COSTS];
    growth_shape shape;
    hnbrdf_result result = HNBRDF_OK;
    for (int c = 0; c < COSTS; c++)
        series[c] = bench_growth_add(g, whats[c], units[c], bench_growth_axis_name(axis));
    for (int k = 0; !result && bench_growth_shape(g, axis, k, &shape); k++) {
        double costs[COSTS], work;
        if (shape.materials > MOST_MATERIALS) /* beyond, materials belong into textures */
            break;
        result = bench_show(watch, "shaders", ((int)axis + 0.2 * k) / GROWTH_AXES, "", error);
        if (!result)
            result = measure(on, g, &shape, costs, &work, error);
        for (int c = 0; c < COSTS && !result; c++)
            bench_growth_point(series[c], bench_growth_size(axis, &shape), costs[c],
                               c == 3 && axis == GROWTH_MATERIALS ? 1.0 : work);
    }
    return result;
}

hnbrdf_result bench_growth_gpu(growth *g, const bench_growth_options *options, hnbrdf_error *error)
{
    shader_device on = {.is_open = 0};
    if (strcmp(options->device, "none") == 0)
        return HNBRDF_OK;
    if (!gpu_compiler_found()) {
        if (options->watch.warn)
            options->watch.warn(options->watch.user, "no glslangValidator (Debian: apt-get install "
                                                     "glslang-tools), so no shaders");
        return HNBRDF_OK;
    }
    hnbrdf_result result = open_device(&on, options->device, error);
    snprintf(g->device, sizeof g->device, "%s", on.name);
    for (growth_axis axis = GROWTH_H; axis < GROWTH_AXES && !result; axis++)
        result = by_axis(g, &on, axis, &options->watch, error);
    close_device(&on);
    return result;
}

#else

hnbrdf_result bench_growth_gpu(growth *g, const bench_growth_options *options, hnbrdf_error *error)
{
    (void)g;
    (void)options;
    (void)error;
    return HNBRDF_OK;
}

#endif
