/* timed.c: exported scenes on one Vulkan device, compiled and ready to be timed again and again. */
#include "gpu/timed.h"

#include "base/clock.h"
#include "base/error.h"
#include "gpu/compile.h"
#include "hnbrdf/measured.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The text of shaders/bench.comp. */
extern const char hnbrdf_bench_comp[];

typedef struct push_constants {
    uint32_t count;
    int32_t material;
} push_constants;

/* ---- Buffers --------------------------------------------------------------------------------- */

static hnbrdf_result upload_directions(const gpu_device *device, gpu_timed_buffers *buffers,
                                       hnbrdf_error *error)
{
    size_t size = buffers->count * 6 * sizeof(float);
    float *pairs = malloc(size);
    if (!pairs)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "timing: no memory for %lu pairs",
                           (unsigned long)buffers->count);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (uint32_t k = 0; k < buffers->count; k++)
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, pairs + 6 * k, pairs + 6 * k + 3);
    hnbrdf_result result = gpu_upload(device, &buffers->directions, pairs, size, error);
    free(pairs);
    return result;
}

hnbrdf_result gpu_timed_buffers_open(const gpu_device *device, uint32_t count,
                                     gpu_timed_buffers *buffers, hnbrdf_error *error)
{
    memset(buffers, 0, sizeof *buffers);
    buffers->count = count;
    hnbrdf_result result =
        gpu_buffer_open(device, count * 6 * sizeof(float), &buffers->directions, error);
    if (!result)
        result = gpu_buffer_open(device, count * 3 * sizeof(float), &buffers->values, error);
    if (!result)
        result = upload_directions(device, buffers, error);
    if (result)
        gpu_timed_buffers_close(device, buffers);
    return result;
}

void gpu_timed_buffers_close(const gpu_device *device, gpu_timed_buffers *buffers)
{
    gpu_buffer_close(device, &buffers->directions);
    gpu_buffer_close(device, &buffers->values);
}

/* ---- Scenes ---------------------------------------------------------------------------------- */

static hnbrdf_result open_program(const gpu_device *device, const gpu_timed_buffers *buffers,
                                  const gpu_scene *scene, gpu_work work, gpu_timed *timed,
                                  hnbrdf_error *error)
{
    static const char *const works[] = {"WORK=0", "WORK=1", "WORK=2"};
    const char *const defines[] = {
        works[work], device->has_half ? "HNBRDF_HALF_NATIVE=1" : "HNBRDF_HALF_NATIVE=0", NULL};
    const gpu_include include = {"scene.glsl", scene->text};
    const gpu_buffer *const bound[] = {&buffers->directions, &buffers->values, &timed->weights};
    uint32_t *spirv = NULL;
    double started = hnbrdf_seconds();
    hnbrdf_result result =
        gpu_compile(hnbrdf_bench_comp, &include, 1, defines, &spirv, &timed->spirv_bytes, error);
    timed->compile_ms = 1e3 * (hnbrdf_seconds() - started);
    if (!result && scene->weights)
        result =
            gpu_uniform_open(device, scene->weights, scene->weights_size, &timed->weights, error);
    if (!result)
        result = gpu_program_open(device, spirv, timed->spirv_bytes, bound, scene->weights ? 3 : 2,
                                  sizeof(push_constants), &timed->program, error);
    free(spirv);
    return result;
}

/* What a renderer waits for before the first picture: drivers compile here or at the first
 * dispatch. */
static hnbrdf_result open_pipeline(const gpu_device *device, gpu_timed *timed, hnbrdf_error *error)
{
    push_constants push = {1, 0};
    double started = hnbrdf_seconds();
    hnbrdf_result result = gpu_pipeline_open(device, &timed->program, 0, &timed->pipeline, error);
    if (!result)
        result = gpu_dispatch(device, &timed->program, timed->pipeline, &push, 1, 1, NULL, error);
    timed->first_ms = 1e3 * (hnbrdf_seconds() - started);
    return result;
}

hnbrdf_result gpu_timed_open(const gpu_device *device, const gpu_timed_buffers *buffers,
                             const gpu_scene *scene, gpu_work work, gpu_timed *timed,
                             hnbrdf_error *error)
{
    memset(timed, 0, sizeof *timed);
    hnbrdf_result result = open_program(device, buffers, scene, work, timed, error);
    if (!result)
        result = open_pipeline(device, timed, error);
    if (result)
        gpu_timed_close(device, timed);
    return result;
}

void gpu_timed_close(const gpu_device *device, gpu_timed *timed)
{
    vkDestroyPipeline(device->handle, timed->pipeline, NULL);
    timed->pipeline = VK_NULL_HANDLE;
    gpu_program_close(device, &timed->program);
    gpu_buffer_close(device, &timed->weights);
}

hnbrdf_result gpu_timed_run(const gpu_device *device, const gpu_timed_buffers *buffers,
                            const gpu_timed *timed, int repeats, double *ns, hnbrdf_error *error)
{
    push_constants push = {buffers->count, 0};
    return gpu_dispatch(device, &timed->program, timed->pipeline, &push, buffers->count, repeats,
                        ns, error);
}

hnbrdf_result gpu_timed_download(const gpu_device *device, gpu_timed_buffers *buffers,
                                 uint32_t count, float (*pairs)[6], float (*values)[3],
                                 hnbrdf_error *error)
{
    hnbrdf_result result =
        gpu_download(device, &buffers->directions, pairs, count * sizeof *pairs, error);
    return result ? result
                  : gpu_download(device, &buffers->values, values, count * sizeof *values, error);
}

/* ---- One scene ------------------------------------------------------------------------------- */

enum { EVALUATIONS = 1 << 17, RUNS = 3, MOST_REPEATS = 1024 };

static hnbrdf_result time_work(const gpu_device *device, const gpu_timed_buffers *buffers,
                               const gpu_timed *timed, double *ns, hnbrdf_error *error)
{
    hnbrdf_result result = HNBRDF_OK;
    double best = (double)INFINITY;
    int repeats = 1;
    for (int run = 0; run < RUNS && !result;) {
        double total = (double)NAN;
        result = gpu_timed_run(device, buffers, timed, repeats, &total, error);
        if (total < 5e6 && repeats < MOST_REPEATS) {
            repeats *= 4;
            continue;
        }
        best = fmin(best, isnan(total) ? (double)INFINITY : total / repeats / buffers->count);
        run++;
    }
    *ns = best < (double)INFINITY ? best : (double)NAN;
    return result;
}

hnbrdf_result gpu_time_scene(const gpu_device *device, const gpu_scene *scene, check_timing *timing,
                             hnbrdf_error *error)
{
    gpu_timed_buffers buffers = {0};
    gpu_timed value = {0}, copy = {0};
    check_timing made = {.evaluations = EVALUATIONS};
    hnbrdf_result result = gpu_timed_buffers_open(device, EVALUATIONS, &buffers, error);
    if (!result)
        result = gpu_timed_open(device, &buffers, scene, GPU_WORK_VALUE, &value, error);
    made.compile_ms = value.compile_ms;
    made.first_ms = value.first_ms;
    made.spirv_bytes = value.spirv_bytes;
    if (!result)
        result = gpu_timed_open(device, &buffers, scene, GPU_WORK_COPY, &copy, error);
    if (!result)
        result = time_work(device, &buffers, &value, &made.value_ns, error);
    if (!result)
        result = time_work(device, &buffers, &copy, &made.copy_ns, error);
    gpu_timed_close(device, &value);
    gpu_timed_close(device, &copy);
    gpu_timed_buffers_close(device, &buffers);
    if (!result)
        *timing = made;
    return result;
}
