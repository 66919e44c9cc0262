/* verify.c: runs an exported scene on one Vulkan device, in both builds, and compares it with C. */
#include "gpu/verify.h"

#include "core/error.h"
#include "gpu/compile.h"
#include "gpu/compute.h"
#include "gpu/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* The texts of shaders/verify.comp and shaders/hybrid_brdf.glsl. */
extern const char hnbrdf_verify_comp[], hnbrdf_hybrid_brdf_glsl[];

enum { TIMED_EVALUATIONS = 1 << 17, PIPELINES = GPU_STAGES + 1 };

const char *gpu_stage_name(gpu_stage stage)
{
    static const char *const names[GPU_STAGES] = {"encoding", "network", "analytic", "value"};
    return names[stage];
}

const char *gpu_build_name(gpu_build build)
{
    return build == GPU_BUILD_EXACT ? "exact" : "fast";
}

static double milliseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

typedef struct push_constants {
    uint32_t count;
    int32_t material;
} push_constants;

/* Everything that lives as long as one device is verified. */
typedef struct verifier {
    const gpu_device *device;
    const hnbrdf_model *model;
    const gpu_verify_options *options;
    gpu_report *report;
    hnbrdf_error *error;
    gpu_buffer directions, encoded, values;
    gpu_program programs[GPU_BUILDS];
    VkPipeline pipelines[GPU_BUILDS][PIPELINES];
    gpu_reference reference;
    float *device_values[GPU_STAGES];
} verifier;

static size_t evaluations(const verifier *s)
{
    size_t timed = s->options->without_timing ? 0 : TIMED_EVALUATIONS;
    return s->options->pairs > timed ? s->options->pairs : timed;
}

static hnbrdf_result open_buffers(verifier *s)
{
    size_t bytes = evaluations(s) * 6 * sizeof(float);
    gpu_buffer *const buffers[] = {&s->directions, &s->encoded, &s->values};
    for (int i = 0; i < 3; i++) {
        hnbrdf_result result = gpu_buffer_open(s->device, bytes, buffers[i], s->error);
        if (result)
            return result;
    }
    for (int stage = 0; stage < GPU_STAGES; stage++) {
        size_t stride = (size_t)gpu_stage_stride((gpu_stage)stage) * sizeof(float);
        s->device_values[stage] = calloc(s->options->pairs, stride);
        if (!s->device_values[stage])
            return hnbrdf_fail(s->error, HNBRDF_ERROR_MEMORY, "verify: no memory for %zu pairs",
                               s->options->pairs);
    }
    return gpu_reference_open(s->options->pairs, &s->reference, s->error);
}

static hnbrdf_result open_program(verifier *s, gpu_build build)
{
    const gpu_include includes[] = {{"hybrid_brdf.glsl", hnbrdf_hybrid_brdf_glsl},
                                    {"scene.glsl", s->options->scene}};
    const gpu_buffer *const buffers[] = {&s->directions, &s->encoded, &s->values};
    uint32_t *spirv = NULL;
    size_t size = 0;
    double started = milliseconds();
    hnbrdf_result result = gpu_compile(hnbrdf_verify_comp, includes, 2,
                                       build == GPU_BUILD_EXACT ? "HNBRDF_EXACT=1" : "HNBRDF_EXACT=0",
                                       &spirv, &size, s->error);
    s->report->timing.compile_ms = milliseconds() - started; /* the fast build comes last */
    s->report->timing.spirv_bytes = size;
    if (!result)
        result = gpu_program_open(s->device, spirv, size, buffers, 3, sizeof(push_constants),
                                  &s->programs[build], s->error);
    free(spirv);
    for (int stage = 0; stage < PIPELINES && !result; stage++)
        if (stage != GPU_STAGE_VALUE || build != GPU_BUILD_FAST) /* which is timed on its own, below */
            result = gpu_pipeline_open(s->device, &s->programs[build], stage,
                                       &s->pipelines[build][stage], s->error);
    return result;
}

static void close_verifier(verifier *s)
{
    for (int build = 0; build < GPU_BUILDS; build++) {
        for (int stage = 0; stage < PIPELINES; stage++)
            vkDestroyPipeline(s->device->handle, s->pipelines[build][stage], NULL);
        gpu_program_close(s->device, &s->programs[build]);
    }
    gpu_buffer_close(s->device, &s->directions);
    gpu_buffer_close(s->device, &s->encoded);
    gpu_buffer_close(s->device, &s->values);
    gpu_reference_close(&s->reference);
    for (int stage = 0; stage < GPU_STAGES; stage++)
        free(s->device_values[stage]);
}

/* ---- Comparing ------------------------------------------------------------------------------- */

static int stage_exists(const verifier *s, int stage)
{
    hnbrdf_kind kind = s->model->desc.kind;
    return stage == GPU_STAGE_VALUE ||
           (stage == GPU_STAGE_ANALYTIC ? kind != HNBRDF_KIND_NEURAL : kind != HNBRDF_KIND_GGX);
}

static hnbrdf_result run_stages(verifier *s, gpu_build build, int material)
{
    push_constants push = {(uint32_t)s->options->pairs, material};
    hnbrdf_result result = HNBRDF_OK;
    for (int stage = 0; stage < GPU_STAGES && !result; stage++) {
        size_t bytes = s->options->pairs * (size_t)gpu_stage_stride((gpu_stage)stage) * sizeof(float);
        if (!stage_exists(s, stage))
            continue;
        result = gpu_dispatch(s->device, &s->programs[build], s->pipelines[build][stage], &push,
                              s->options->pairs, 1, NULL, s->error);
        if (!result)
            result = gpu_download(s->device, &s->values, s->device_values[stage], bytes, s->error);
    }
    return result;
}

static hnbrdf_result verify_material(verifier *s, const gpu_rules rules[GPU_BUILDS], int k)
{
    const hnbrdf_material *material = hnbrdf_model_material(s->model, s->options->materials[k]);
    size_t bytes = s->options->pairs * 6 * sizeof(float);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, s->options->seed, (uint64_t)k);
    gpu_reference_fill(s->model, material, &rng, &s->reference);
    hnbrdf_result result = gpu_upload(s->device, &s->directions, s->reference.pairs, bytes, s->error);
    if (!result)
        result = gpu_upload(s->device, &s->encoded, s->reference.stages[GPU_STAGE_ENCODING], bytes,
                            s->error);
    for (int build = 0; build < GPU_BUILDS && !result; build++) {
        gpu_comparison *comparisons = s->report->comparisons[k][build];
        result = run_stages(s, (gpu_build)build, k);
        if (!result)
            result = gpu_compare(&rules[build], s->model, material, &s->reference,
                                 (const float *const *)s->device_values, comparisons, s->error);
        for (int stage = 0; stage < GPU_STAGES; stage++)
            s->report->within = s->report->within && comparisons[stage].outside == 0;
    }
    return result;
}

/* ---- Timing ---------------------------------------------------------------------------------- */

enum { TIMED_RUNS = 3 };

/* Nanoseconds of one evaluation: the best of a few runs of at least 5 ms each. */
static hnbrdf_result time_stage(verifier *s, int stage, double *ns)
{
    push_constants push = {TIMED_EVALUATIONS, 0};
    const gpu_program *program = &s->programs[GPU_BUILD_FAST];
    VkPipeline pipeline = s->pipelines[GPU_BUILD_FAST][stage];
    hnbrdf_result result = HNBRDF_OK;
    double best = (double)INFINITY;
    int repeats = 1;
    for (int run = 0; run < TIMED_RUNS && !result;) {
        double total;
        result = gpu_dispatch(s->device, program, pipeline, &push, TIMED_EVALUATIONS, repeats, &total,
                              s->error);
        if (total < 5e6 && repeats < 1024) {
            repeats *= 4;
            continue;
        }
        best = fmin(best, isnan(total) ? (double)INFINITY : total / repeats / TIMED_EVALUATIONS);
        run++;
    }
    *ns = best < (double)INFINITY ? best : (double)NAN;
    return result;
}

static hnbrdf_result time_evaluations(verifier *s)
{
    gpu_timing *timing = &s->report->timing;
    timing->evaluations = TIMED_EVALUATIONS;
    float *pairs = calloc(TIMED_EVALUATIONS, 6 * sizeof *pairs);
    if (!pairs)
        return hnbrdf_fail(s->error, HNBRDF_ERROR_MEMORY, "verify: no memory for timing");
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, s->options->seed, 0);
    for (size_t k = 0; k < TIMED_EVALUATIONS; k++)
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, pairs + 6 * k, pairs + 6 * k + 3);
    hnbrdf_result result =
        gpu_upload(s->device, &s->directions, pairs, TIMED_EVALUATIONS * 6 * sizeof *pairs, s->error);
    free(pairs);
    if (!result)
        result = time_stage(s, GPU_STAGE_VALUE, &timing->value_ns);
    if (!result)
        result = time_stage(s, GPU_STAGE_COPY, &timing->copy_ns);
    return result;
}

/* What a renderer waits for before the first picture: drivers compile here or at the first dispatch. */
static hnbrdf_result open_timed_pipeline(verifier *s)
{
    push_constants push = {1, 0};
    const gpu_program *program = &s->programs[GPU_BUILD_FAST];
    VkPipeline *pipeline = &s->pipelines[GPU_BUILD_FAST][GPU_STAGE_VALUE];
    double started = milliseconds();
    hnbrdf_result result = gpu_pipeline_open(s->device, program, GPU_STAGE_VALUE, pipeline, s->error);
    if (!result)
        result = gpu_dispatch(s->device, program, *pipeline, &push, 1, 1, NULL, s->error);
    s->report->timing.first_ms = milliseconds() - started;
    return result;
}

/* ---- All of it ------------------------------------------------------------------------------- */

static hnbrdf_result run_verifier(verifier *s)
{
    gpu_report *report = s->report;
    hnbrdf_result result = gpu_probe(s->device, &report->arithmetic, s->error);
    if (!result)
        result = open_buffers(s);
    for (int build = 0; build < GPU_BUILDS && !result; build++)
        result = open_program(s, (gpu_build)build);
    if (!result)
        result = open_timed_pipeline(s);
    if (result)
        return result;
    const gpu_rules rules[GPU_BUILDS] = {gpu_rules_exact(&report->arithmetic),
                                         gpu_rules_fast(&report->arithmetic, s->device->driver_id)};
    report->within = report->arithmetic.exp_share <= 1.0 && report->arithmetic.log_share <= 1.0;
    for (int k = 0; k < s->options->material_count && !result; k++) {
        result = verify_material(s, rules, k);
        if (s->options->progress)
            s->options->progress(s->options->progress_user, (k + 1.0) / s->options->material_count);
    }
    if (!result && !s->options->without_timing)
        result = time_evaluations(s);
    return result;
}

hnbrdf_result gpu_verify(const gpu_device *device, const hnbrdf_model *model,
                         const gpu_verify_options *options, gpu_report *report, hnbrdf_error *error)
{
    gpu_report made = {.material_count = options->material_count,
                       .timing = {.value_ns = (double)NAN, .copy_ns = (double)NAN}};
    made.comparisons = calloc((size_t)options->material_count, sizeof *made.comparisons);
    if (!made.comparisons)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "verify: no memory for %d materials",
                           options->material_count);
    verifier s = {
        .device = device, .model = model, .options = options, .report = &made, .error = error};
    hnbrdf_result result = run_verifier(&s);
    close_verifier(&s);
    if (result)
        gpu_report_free(&made);
    else
        *report = made;
    return result;
}

void gpu_report_free(gpu_report *report)
{
    free(report->comparisons);
    memset(report, 0, sizeof *report);
}
