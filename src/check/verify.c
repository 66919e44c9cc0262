/* verify.c: draws what a shader is asked, has it run in both builds, and compares it with C. */
#include "check/verify.h"

#include "base/error.h"
#include "check/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *check_build_name(check_build build)
{
    return build == CHECK_BUILD_EXACT ? "exact" : "fast";
}

typedef struct verifier {
    const check_runner *runner;
    const hnbrdf_model *model;
    const check_verify_options *options;
    check_report *report;
    hnbrdf_error *error;
    check_reference reference;
    float (*rows)[CHECK_PARITY_INPUTS], (*outputs)[CHECK_PARITY_OUTPUTS];
    float *stages[CHECK_STAGES];
} verifier;

static hnbrdf_result open_verifier(verifier *s)
{
    const size_t pairs = s->options->pairs;
    s->rows = calloc(pairs, sizeof *s->rows);
    s->outputs = calloc(pairs, sizeof *s->outputs);
    int complete = s->rows && s->outputs;
    for (int stage = 0; stage < CHECK_STAGES; stage++) {
        size_t stride = (size_t)check_stage_stride((check_stage)stage) * sizeof(float);
        s->stages[stage] = calloc(pairs, stride);
        complete = complete && s->stages[stage];
    }
    return complete ? check_reference_open(pairs, s->options->precision, &s->reference, s->error)
                    : hnbrdf_fail(s->error, HNBRDF_ERROR_MEMORY, "verify: no memory for %zu pairs",
                                  pairs);
}

static void close_verifier(verifier *s)
{
    check_reference_close(&s->reference);
    for (int stage = 0; stage < CHECK_STAGES; stage++)
        free(s->stages[stage]);
    free(s->rows);
    free(s->outputs);
}

static check_rules rules_of(const verifier *s, check_build build, int ordered)
{
    const check_arithmetic *arithmetic = &s->report->arithmetic;
    const int is_llvmpipe = s->runner->is_llvmpipe;
    return build == CHECK_BUILD_FAST ? check_rules_fast(arithmetic, is_llvmpipe)
           : ordered                 ? check_rules_exact(arithmetic)
                                     : check_rules_unordered(arithmetic);
}

static hnbrdf_result verify_build(verifier *s, const hnbrdf_material *material, check_build build,
                                  check_comparison comparisons[CHECK_STAGES])
{
    int has_run = 1;
    const size_t pairs = s->options->pairs;
    hnbrdf_result result = s->runner->run(s->runner->user, build, s->rows[0], pairs, s->outputs[0],
                                          &has_run, s->error);
    if (result || !has_run)
        return result;
    int ordered =
        check_parity_stages((const float(*)[CHECK_PARITY_OUTPUTS])s->outputs, pairs, s->stages) &&
        !s->runner->is_unordered;
    if (build == CHECK_BUILD_EXACT)
        s->report->ordered = ordered;
    const check_rules rules = rules_of(s, build, ordered);
    result = check_compare(&rules, s->model, material, &s->reference,
                           (const float *const *)s->stages, comparisons, s->error);
    for (int stage = 0; stage < CHECK_STAGES; stage++)
        s->report->within = s->report->within && comparisons[stage].outside == 0;
    return result;
}

void check_material_rows(const hnbrdf_model *model, const check_verify_options *options, int k,
                         check_reference *reference, float (*rows)[CHECK_PARITY_INPUTS])
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, options->seed, (uint64_t)k);
    check_reference_fill(model, hnbrdf_model_material(model, options->materials[k]), &rng,
                         reference);
    check_parity_rows(reference, k, rows);
}

static hnbrdf_result verify_material(verifier *s, int k)
{
    const hnbrdf_material *material = hnbrdf_model_material(s->model, s->options->materials[k]);
    hnbrdf_result result = HNBRDF_OK;
    check_material_rows(s->model, s->options, k, &s->reference, s->rows);
    for (int build = 0; build < CHECK_BUILDS && !result; build++)
        result = verify_build(s, material, (check_build)build, s->report->comparisons[k][build]);
    return result;
}

static hnbrdf_result run_verifier(verifier *s)
{
    check_report *report = s->report;
    hnbrdf_result result = s->runner->probe(s->runner->user, &report->arithmetic, s->error);
    if (!result)
        result = open_verifier(s);
    report->within = report->arithmetic.exp_share <= 1.0 && report->arithmetic.log_share <= 1.0;
    for (int k = 0; k < s->options->material_count && !result; k++) {
        result = verify_material(s, k);
        if (s->options->progress)
            s->options->progress(s->options->progress_user, (k + 1.0) / s->options->material_count);
    }
    return result;
}

hnbrdf_result check_verify(const check_runner *runner, const hnbrdf_model *model,
                           const check_verify_options *options, check_report *report,
                           hnbrdf_error *error)
{
    check_report made = {.material_count = options->material_count,
                         .timing = {.value_ns = (double)NAN,
                                    .copy_ns = (double)NAN,
                                    .compile_ms = (double)NAN,
                                    .first_ms = (double)NAN}};
    made.comparisons = calloc((size_t)options->material_count, sizeof *made.comparisons);
    if (!made.comparisons)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "verify: no memory for %d materials",
                           options->material_count);
    verifier s = {
        .runner = runner, .model = model, .options = options, .report = &made, .error = error};
    hnbrdf_result result = run_verifier(&s);
    close_verifier(&s);
    if (result)
        check_report_free(&made);
    else
        *report = made;
    return result;
}

void check_report_free(check_report *report)
{
    free(report->comparisons);
    memset(report, 0, sizeof *report);
}
