/* verify.c: runs an exported scene on one Vulkan device, in both builds, and compares it with C. */
#include "gpu/verify.h"

#include "base/error.h"
#include "gpu/probe_half.h"
#include "check/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *gpu_build_name(gpu_build build)
{
    return build == GPU_BUILD_EXACT ? "exact" : "fast";
}

/* Everything that lives as long as one device is verified. */
typedef struct verifier {
    const gpu_device *device;
    const hnbrdf_model *model;
    const gpu_verify_options *options;
    gpu_report *report;
    hnbrdf_error *error;
    gpu_scene_buffers buffers;
    gpu_program programs[GPU_BUILDS];
    VkPipeline pipelines[GPU_BUILDS][CHECK_STAGES];
    check_reference reference;
    float *device_values[CHECK_STAGES];
} verifier;

static hnbrdf_result open_buffers(verifier *s)
{
    hnbrdf_result result = gpu_scene_buffers_open(s->device, &s->options->scene, s->options->pairs,
                                                  &s->buffers, s->error);
    for (int stage = 0; stage < CHECK_STAGES && !result; stage++) {
        size_t stride = (size_t)check_stage_stride((check_stage)stage) * sizeof(float);
        s->device_values[stage] = calloc(s->options->pairs, stride);
        if (!s->device_values[stage])
            result = hnbrdf_fail(s->error, HNBRDF_ERROR_MEMORY, "verify: no memory for %zu pairs",
                                 s->options->pairs);
    }
    return result ? result
                  : check_reference_open(s->options->pairs, s->options->precision, &s->reference,
                                         s->error);
}

static hnbrdf_result open_program(verifier *s, gpu_build build)
{
    hnbrdf_result result = gpu_scene_program(s->device, &s->options->scene, build, &s->buffers,
                                             &s->programs[build], NULL, NULL, s->error);
    for (int stage = 0; stage < CHECK_STAGES && !result; stage++)
        result = gpu_pipeline_open(s->device, &s->programs[build], stage,
                                   &s->pipelines[build][stage], s->error);
    return result;
}

static void close_verifier(verifier *s)
{
    for (int build = 0; build < GPU_BUILDS; build++) {
        for (int stage = 0; stage < CHECK_STAGES; stage++)
            vkDestroyPipeline(s->device->handle, s->pipelines[build][stage], NULL);
        gpu_program_close(s->device, &s->programs[build]);
    }
    gpu_scene_buffers_close(s->device, &s->buffers);
    check_reference_close(&s->reference);
    for (int stage = 0; stage < CHECK_STAGES; stage++)
        free(s->device_values[stage]);
}

/* ---- Comparing ------------------------------------------------------------------------------- */

static int stage_exists(const verifier *s, int stage)
{
    hnbrdf_kind kind = s->model->desc.kind;
    return stage == CHECK_STAGE_VALUE ||
           (stage == CHECK_STAGE_ANALYTIC ? kind != HNBRDF_KIND_NEURAL : kind != HNBRDF_KIND_GGX);
}

static hnbrdf_result run_stages(verifier *s, gpu_build build, int material)
{
    hnbrdf_result result = HNBRDF_OK;
    for (int stage = 0; stage < CHECK_STAGES && !result; stage++) {
        size_t bytes =
            s->options->pairs * (size_t)check_stage_stride((check_stage)stage) * sizeof(float);
        if (!stage_exists(s, stage))
            continue;
        result = gpu_scene_run(s->device, &s->programs[build], s->pipelines[build][stage], material,
                               s->options->pairs, 1, NULL, s->error);
        if (!result)
            result = gpu_download(s->device, &s->buffers.values, s->device_values[stage], bytes,
                                  s->error);
    }
    return result;
}

static hnbrdf_result verify_material(verifier *s, const check_rules rules[GPU_BUILDS], int k)
{
    const hnbrdf_material *material = hnbrdf_model_material(s->model, s->options->materials[k]);
    size_t bytes = s->options->pairs * 6 * sizeof(float);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, s->options->seed, (uint64_t)k);
    check_reference_fill(s->model, material, &rng, &s->reference);
    hnbrdf_result result =
        gpu_upload(s->device, &s->buffers.directions, s->reference.pairs, bytes, s->error);
    if (!result)
        result = gpu_upload(s->device, &s->buffers.encoded,
                            s->reference.stages[CHECK_STAGE_ENCODING], bytes, s->error);
    for (int build = 0; build < GPU_BUILDS && !result; build++) {
        check_comparison *comparisons = s->report->comparisons[k][build];
        result = run_stages(s, (gpu_build)build, k);
        if (!result)
            result = check_compare(&rules[build], s->model, material, &s->reference,
                                   (const float *const *)s->device_values, comparisons, s->error);
        for (int stage = 0; stage < CHECK_STAGES; stage++)
            s->report->within = s->report->within && comparisons[stage].outside == 0;
    }
    return result;
}

/* ---- All of it ------------------------------------------------------------------------------- */

static hnbrdf_result run_verifier(verifier *s)
{
    gpu_report *report = s->report;
    hnbrdf_result result = gpu_probe(s->device, &report->arithmetic, s->error);
    if (!result && s->options->precision == HNBRDF_GLSL_HALF)
        result = gpu_probe_half(s->device, &report->arithmetic, s->error);
    /* first, or the driver would have compiled before */
    if (!result && !s->options->without_timing)
        result = gpu_time_scene(s->device, &s->options->scene, s->options->seed, &report->timing,
                                s->error);
    if (!result)
        result = open_buffers(s);
    for (int build = 0; build < GPU_BUILDS && !result; build++)
        result = open_program(s, (gpu_build)build);
    if (result)
        return result;
    const check_rules rules[GPU_BUILDS] = {
        check_rules_exact(&report->arithmetic),
        check_rules_fast(&report->arithmetic, s->device->driver_id == VK_DRIVER_ID_MESA_LLVMPIPE)};
    report->within = report->arithmetic.exp_share <= 1.0 && report->arithmetic.log_share <= 1.0;
    for (int k = 0; k < s->options->material_count && !result; k++) {
        result = verify_material(s, rules, k);
        if (s->options->progress)
            s->options->progress(s->options->progress_user, (k + 1.0) / s->options->material_count);
    }
    return result;
}

hnbrdf_result gpu_verify(const gpu_device *device, const hnbrdf_model *model,
                         const gpu_verify_options *options, gpu_report *report, hnbrdf_error *error)
{
    gpu_report made = {.material_count = options->material_count,
                       .timing = {.value_ns = (double)NAN,
                                  .copy_ns = (double)NAN,
                                  .compile_ms = (double)NAN,
                                  .first_ms = (double)NAN}};
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
