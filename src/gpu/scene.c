/* scene.c: one exported scene on one Vulkan device: compiled, run, timed. */
#include "gpu/scene.h"

#include "base/clock.h"
#include "base/error.h"
#include "gpu/compile.h"
#include "hnbrdf/measured.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The texts of shaders/verify.comp and shaders/hybrid_brdf.glsl. */
extern const char hnbrdf_verify_comp[], hnbrdf_hybrid_brdf_glsl[];

enum { TIMED_EVALUATIONS = 1 << 17, TIMED_RUNS = 3, MOST_REPEATS = 1024 };

typedef struct push_constants {
    uint32_t count;
    int32_t material;
} push_constants;

hnbrdf_result gpu_scene_buffers_open(const gpu_device *device, const gpu_scene *scene, size_t pairs,
                                     gpu_scene_buffers *buffers, hnbrdf_error *error)
{
    gpu_buffer *const storage[] = {&buffers->directions, &buffers->encoded, &buffers->values};
    hnbrdf_result result = HNBRDF_OK;
    memset(buffers, 0, sizeof *buffers);
    for (int i = 0; i < 3 && !result; i++)
        result = gpu_buffer_open(device, pairs * 6 * sizeof(float), storage[i], error);
    buffers->has_weights = scene->weights != NULL;
    if (buffers->has_weights && !result)
        result =
            gpu_uniform_open(device, scene->weights, scene->weights_size, &buffers->weights, error);
    if (result)
        gpu_scene_buffers_close(device, buffers);
    return result;
}

void gpu_scene_buffers_close(const gpu_device *device, gpu_scene_buffers *buffers)
{
    gpu_buffer_close(device, &buffers->directions);
    gpu_buffer_close(device, &buffers->encoded);
    gpu_buffer_close(device, &buffers->values);
    gpu_buffer_close(device, &buffers->weights);
}

hnbrdf_result gpu_scene_program(const gpu_device *device, const gpu_scene *scene, gpu_build build,
                                const gpu_scene_buffers *buffers, gpu_program *program,
                                double *compile_ms, size_t *spirv_bytes, hnbrdf_error *error)
{
    const gpu_include includes[] = {{"hybrid_brdf.glsl", hnbrdf_hybrid_brdf_glsl},
                                    {"scene.glsl", scene->text}};
    const char *const defines[] = {
        build == GPU_BUILD_EXACT ? "HNBRDF_EXACT=1" : "HNBRDF_EXACT=0",
        device->has_half ? "HNBRDF_HALF_NATIVE=1" : "HNBRDF_HALF_NATIVE=0", NULL};
    const gpu_buffer *const all[] = {&buffers->directions, &buffers->encoded, &buffers->values,
                                     &buffers->weights};
    uint32_t *spirv = NULL;
    size_t size = 0;
    double started = hnbrdf_seconds();
    hnbrdf_result result =
        gpu_compile(hnbrdf_verify_comp, includes, 2, defines, &spirv, &size, error);
    if (compile_ms)
        *compile_ms = 1e3 * (hnbrdf_seconds() - started);
    if (spirv_bytes)
        *spirv_bytes = size;
    if (!result)
        result = gpu_program_open(device, spirv, size, all, buffers->has_weights ? 4 : 3,
                                  sizeof(push_constants), program, error);
    free(spirv);
    return result;
}

hnbrdf_result gpu_scene_run(const gpu_device *device, const gpu_program *program,
                            VkPipeline pipeline, int material, size_t pairs, int repeats,
                            double *ns, hnbrdf_error *error)
{
    push_constants push = {(uint32_t)pairs, material};
    return gpu_dispatch(device, program, pipeline, &push, pairs, repeats, ns, error);
}

/* ---- Timing ---------------------------------------------------------------------------------- */

typedef struct timer {
    const gpu_device *device;
    gpu_scene_buffers buffers;
    gpu_program program;
    VkPipeline value, copy;
    hnbrdf_error *error;
} timer;

static hnbrdf_result time_pipeline(timer *t, VkPipeline pipeline, double *ns)
{
    hnbrdf_result result = HNBRDF_OK;
    double best = (double)INFINITY;
    int repeats = 1;
    for (int run = 0; run < TIMED_RUNS && !result;) {
        double total;
        result = gpu_scene_run(t->device, &t->program, pipeline, 0, TIMED_EVALUATIONS, repeats,
                               &total, t->error);
        if (total < 5e6 && repeats < MOST_REPEATS) {
            repeats *= 4;
            continue;
        }
        best = fmin(best, isnan(total) ? (double)INFINITY : total / repeats / TIMED_EVALUATIONS);
        run++;
    }
    *ns = best < (double)INFINITY ? best : (double)NAN;
    return result;
}

static hnbrdf_result upload_pairs(timer *t, uint64_t seed)
{
    const size_t bytes = TIMED_EVALUATIONS * 6 * sizeof(float);
    float *pairs = malloc(bytes);
    if (!pairs)
        return hnbrdf_fail(t->error, HNBRDF_ERROR_MEMORY, "timing: no memory for %zu bytes", bytes);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, seed, 0);
    for (size_t k = 0; k < TIMED_EVALUATIONS; k++)
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, pairs + 6 * k, pairs + 6 * k + 3);
    hnbrdf_result result = gpu_upload(t->device, &t->buffers.directions, pairs, bytes, t->error);
    free(pairs);
    return result;
}

/* What a renderer waits for before the first picture: drivers compile here or at the first
 * dispatch. */
static hnbrdf_result open_timed_pipeline(timer *t, double *first_ms)
{
    double started = hnbrdf_seconds();
    hnbrdf_result result =
        gpu_pipeline_open(t->device, &t->program, CHECK_STAGE_VALUE, &t->value, t->error);
    if (!result)
        result = gpu_scene_run(t->device, &t->program, t->value, 0, 1, 1, NULL, t->error);
    *first_ms = 1e3 * (hnbrdf_seconds() - started);
    return result;
}

static hnbrdf_result run_timer(timer *t, const gpu_scene *scene, uint64_t seed, gpu_timing *timing)
{
    hnbrdf_result result =
        gpu_scene_buffers_open(t->device, scene, TIMED_EVALUATIONS, &t->buffers, t->error);
    if (!result)
        result = gpu_scene_program(t->device, scene, GPU_BUILD_FAST, &t->buffers, &t->program,
                                   &timing->compile_ms, &timing->spirv_bytes, t->error);
    if (!result)
        result = open_timed_pipeline(t, &timing->first_ms);
    if (!result)
        result = gpu_pipeline_open(t->device, &t->program, CHECK_STAGE_COPY, &t->copy, t->error);
    if (!result)
        result = upload_pairs(t, seed);
    if (!result)
        result = time_pipeline(t, t->value, &timing->value_ns);
    if (!result)
        result = time_pipeline(t, t->copy, &timing->copy_ns);
    return result;
}

hnbrdf_result gpu_time_scene(const gpu_device *device, const gpu_scene *scene, uint64_t seed,
                             gpu_timing *timing, hnbrdf_error *error)
{
    timer t = {.device = device, .error = error};
    gpu_timing made = {.evaluations = TIMED_EVALUATIONS};
    hnbrdf_result result = run_timer(&t, scene, seed, &made);
    vkDestroyPipeline(device->handle, t.value, NULL);
    vkDestroyPipeline(device->handle, t.copy, NULL);
    gpu_program_close(device, &t.program);
    gpu_scene_buffers_close(device, &t.buffers);
    if (!result)
        *timing = made;
    return result;
}
