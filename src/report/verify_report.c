/* verify_report.c: what `hnbrdf verify` found, as a table, CSV and JSON. */
#include "report/verify_report.h"

#include "base/text.h"
#include "base/write.h"
#include "hnbrdf/glsl.h"
#include "report/output.h"

#include <math.h>

int verification_passed(const verification *v)
{
    int passed = v->messages == 0;
    for (int d = 0; d < v->device_count; d++)
        passed = passed && !v->devices[d].failed.text[0] && v->devices[d].report.within;
    return passed;
}

static const char *material_name(const verification *v, int k)
{
    return hnbrdf_model_material_name(v->model, v->materials[k]);
}

static double mean(double sum, size_t count)
{
    return count > 0 ? sum / (double)count : 0.0;
}

/* ---- For people ------------------------------------------------------------------------------ */

static void print_arithmetic(const check_arithmetic *a, FILE *file)
{
    fprintf(file, "  arithmetic  + - * %s, / ", a->exact_basic ? "exact" : "NOT EXACT");
    fprintf(file, a->exact_divide ? "exact" : "within %.2g ulp", a->divide_ulp);
    fprintf(file, a->exact_sqrt ? ", sqrt exact" : ", sqrt within %.2g ulp", a->sqrt_ulp);
    fprintf(file,
            ", subnormals %s; built-in exp within %.3g ulp, log within %.2g near 1 (seen on %d "
            "values)\n",
            a->keeps_denormals     ? "kept"
            : a->flushes_denormals ? "flushed, operands and results alike"
                                   : "flushed in part",
            a->exp_ulp, a->log_error, a->values);
    if (a->exp_share > 1.0 || a->log_share > 1.0)
        fprintf(file,
                "  NOT WITHIN what the bounds assume of exp (%.3g times) or log (%.3g times)\n",
                a->exp_share, a->log_share);
}

static void print_half(const check_arithmetic *a, FILE *file)
{
    if (!a->has_half) {
        fputs(
            "  half        not offered by the device: single precision with the weights of half\n",
            file);
        return;
    }
    fprintf(file, "  half        conversion, + and * %s, subnormals %s\n",
            a->exact_half ? "exact" : "NOT EXACT", a->keeps_half_denormals ? "kept" : "flushed");
}

static void print_place(const check_place *place, const char *material, FILE *file)
{
    fprintf(file,
            "      worst at %s[%d], %s pair wi (%.9g %.9g %.9g) wo (%.9g %.9g %.9g): %.9g, C %.9g, "
            "bound %.3g\n",
            material, place->component, check_pair_class_name(place->class_of_pair),
            (double)place->pair[0], (double)place->pair[1], (double)place->pair[2],
            (double)place->pair[3], (double)place->pair[4], (double)place->pair[5],
            (double)place->device, (double)place->reference, place->bound);
}

/* A stage over all materials; the material of the worst place is told. */
static void print_stage(const verification *v, const check_report *report, check_build build,
                        check_stage stage, FILE *file)
{
    check_comparison all = {0};
    int worst = 0;
    for (int k = 0; k < report->material_count; k++) {
        const check_comparison *here = &report->comparisons[k][build][stage];
        if ((here->outside > 0 && all.outside == 0) ||
            (all.outside == 0 && here->worst_ulp > all.worst_ulp))
            worst = k;
        check_comparison_add(&all, here);
    }
    if (!all.applies)
        return;
    fprintf(file, "    %-6s %-9s %10zu %9.4f%% %10.3g %10.3g %10.2g %10.2g %9.3g  %s\n",
            check_build_name(build), check_stage_name(stage), all.values,
            100.0 * mean((double)all.identical, all.values), mean(all.sum_ulp, all.values),
            all.worst_ulp, mean(all.sum_relative, all.values), all.worst_relative, all.worst_share,
            all.outside ? "OUTSIDE" : "ok");
    if (all.outside)
        fprintf(file, "      %zu values outside of their bounds\n", all.outside);
    if (all.worst_ulp > 0.0)
        print_place(&all.worst, material_name(v, worst), file);
}

static void print_timing(const check_timing *timing, FILE *file)
{
    double alone = timing->value_ns - timing->copy_ns;
    if (isnan(alone))
        fputs(isnan(timing->compile_ms) ? "" : "  time        not measured\n", file);
    else if (alone > 0.0)
        fprintf(file, "  time        %.4g ns per evaluation: %.4g in all less %.4g for its buffers",
                alone, timing->value_ns, timing->copy_ns);
    else
        fprintf(file,
                "  time        %.4g ns per evaluation, not told apart from %.4g for its buffers",
                timing->value_ns, timing->copy_ns);
    if (!isnan(alone))
        fprintf(file, " (fast build, %d at once)\n", timing->evaluations);
    if (isnan(timing->compile_ms))
        return;
    fprintf(file, "  compiling   %.0f ms", timing->compile_ms);
    if (timing->spirv_bytes > 0)
        fprintf(file, " to %zu bytes of SPIR-V", timing->spirv_bytes);
    fprintf(file, ", %.0f ms to the end of the first %s\n", timing->first_ms,
            timing->spirv_bytes > 0 ? "dispatch" : "draw");
}

static void print_device(const verification *v, const verified_device *device, FILE *file)
{
    if (device->index >= 0)
        fprintf(file, "%s device %d: ", device->api, device->index);
    else
        fprintf(file, "%s: ", device->api);
    fprintf(file, "%s, %s, %s\n", device->name, device->kind, device->driver);
    if (device->failed.text[0]) {
        fprintf(file, "  FAILED      %s\n\n", device->failed.text);
        return;
    }
    const check_report *report = &device->report;
    print_arithmetic(&report->arithmetic, file);
    if (v->precision == HNBRDF_GLSL_HALF)
        print_half(&report->arithmetic, file);
    if (!report->ordered)
        fputs("  order       of operations not kept: no `precise`, or no exact build\n", file);
    fprintf(file, "    %-6s %-9s %10s %10s %10s %10s %10s %10s %9s\n", "build", "stage", "values",
            "same bits", "mean ulp", "worst ulp", "mean rel.", "worst rel.", "of bound");
    for (int build = 0; build < CHECK_BUILDS; build++)
        for (int stage = 0; stage < CHECK_STAGES; stage++)
            print_stage(v, report, (check_build)build, (check_stage)stage, file);
    print_timing(&report->timing, file);
    fprintf(file, "  %s\n\n", report->within ? "within the bounds" : "NOT WITHIN THE BOUNDS");
}

void verification_print(const verification *v, FILE *file)
{
    fprintf(file, "%s: %d material%s, %zu direction pairs each, shader (%s, %s) against C%s\n\n",
            v->path, v->material_count, v->material_count == 1 ? "" : "s", v->pairs,
            hnbrdf_glsl_weights_name(v->weights), hnbrdf_glsl_precision_name(v->precision),
            v->precision == HNBRDF_GLSL_HALF ? " in half precision" : "");
    for (int d = 0; d < v->device_count; d++)
        print_device(v, &v->devices[d], file);
    fputs("ulp and relative errors: of the C value, where it is small of 2^-10 (analytic, value, "
          "density, weight) or 1 "
          "(encoding,\n"
          "network, direction). of bound: the largest error in terms of the bound derived for its "
          "pair. exact:\n"
          "HNBRDF_EXACT 1. density and weight: of C for the direction that the device drew.\n",
          file);
    if (v->validated)
        fprintf(file, "validation layer: %d message%s\n", v->messages, v->messages == 1 ? "" : "s");
}

/* ---- For programs ---------------------------------------------------------------------------- */

static void write_number(FILE *file, double value)
{
    char text[HNBRDF_NUMBER_TEXT];
    hnbrdf_format_float(text, sizeof text, (float)value);
    fputs(text, file);
}

static void write_row(const verification *v, const verified_device *device, int k,
                      check_build build, check_stage stage, FILE *file)
{
    const check_comparison *here = &device->report.comparisons[k][build][stage];
    const double numbers[] = {mean(here->sum_ulp, here->values), here->worst_ulp,
                              mean(here->sum_relative, here->values), here->worst_relative,
                              here->worst_share};
    if (!here->applies)
        return;
    hnbrdf_write_csv_text(file, device->name);
    putc(',', file);
    hnbrdf_write_csv_text(file, material_name(v, k));
    fprintf(file, ",%s,%s,%zu,%zu,%zu,%zu", check_build_name(build), check_stage_name(stage),
            here->values, here->identical, here->unbounded, here->outside);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        putc(',', file);
        write_number(file, numbers[i]);
    }
    int found = here->worst_ulp > 0.0;
    fprintf(file, ",%s", found ? check_pair_class_name(here->worst.class_of_pair) : "");
    for (int i = 0; i < 6; i++) {
        putc(',', file);
        if (found)
            write_number(file, (double)here->worst.pair[i]);
    }
    fprintf(file, ",%s\n", device->api);
}

void verification_write_csv(const void *what, FILE *file)
{
    const verification *v = what;
    fputs("device,material,build,stage,values,identical,unbounded,outside,mean_ulp,worst_ulp,mean_"
          "relative,"
          "worst_relative,worst_of_bound,worst_pair,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,api\n",
          file);
    for (int d = 0; d < v->device_count; d++)
        for (int k = 0; k < v->devices[d].report.material_count; k++)
            for (int build = 0; build < CHECK_BUILDS; build++)
                for (int stage = 0; stage < CHECK_STAGES; stage++)
                    write_row(v, &v->devices[d], k, (check_build)build, (check_stage)stage, file);
}

/* JSON has no number for what is not finite. */
static void write_member(FILE *file, const char *before, double value)
{
    fputs(before, file);
    if (isfinite(value))
        write_number(file, value);
    else
        fputs("null", file);
}

static void write_json_comparison(const verification *v, const verified_device *device, int k,
                                  check_build build, check_stage stage, int *first, FILE *file)
{
    const check_comparison *here = &device->report.comparisons[k][build][stage];
    if (!here->applies)
        return;
    fprintf(file, "%s\n        {\"material\": ", *first ? "" : ",");
    *first = 0;
    hnbrdf_write_json_text(file, material_name(v, k));
    fprintf(file,
            ", \"build\": \"%s\", \"stage\": \"%s\", \"values\": %zu, \"identical\": %zu, "
            "\"unbounded\": %zu,"
            " \"outside\": %zu",
            check_build_name(build), check_stage_name(stage), here->values, here->identical,
            here->unbounded, here->outside);
    write_member(file, ", \"mean_ulp\": ", mean(here->sum_ulp, here->values));
    write_member(file, ", \"worst_ulp\": ", here->worst_ulp);
    write_member(file, ", \"mean_relative\": ", mean(here->sum_relative, here->values));
    write_member(file, ", \"worst_relative\": ", here->worst_relative);
    write_member(file, ", \"worst_of_bound\": ", here->worst_share);
    fputs("}", file);
}

static void write_json_report(const verification *v, const verified_device *device, FILE *file)
{
    const check_report *report = &device->report;
    const check_arithmetic *a = &report->arithmetic;
    fprintf(
        file,
        ",\n      \"arithmetic\": {\"exact_basic\": %s, \"exact_divide\": %s, \"exact_sqrt\": %s, "
        "\"keeps_subnormals\": %s, \"flushes_subnormals\": %s",
        a->exact_basic ? "true" : "false", a->exact_divide ? "true" : "false",
        a->exact_sqrt ? "true" : "false", a->keeps_denormals ? "true" : "false",
        a->flushes_denormals ? "true" : "false");
    fprintf(file, ", \"has_half\": %s, \"exact_half\": %s", a->has_half ? "true" : "false",
            a->exact_half ? "true" : "false");
    fprintf(file, ", \"ordered\": %s", report->ordered ? "true" : "false");
    write_member(file, ", \"divide_ulp\": ", a->divide_ulp);
    write_member(file, ", \"sqrt_ulp\": ", a->sqrt_ulp);
    write_member(file, ", \"exp_ulp\": ", a->exp_ulp);
    write_member(file, ", \"log_error_near_1\": ", a->log_error);
    fputs("},\n      \"comparisons\": [", file);
    int first = 1;
    for (int k = 0; k < report->material_count; k++)
        for (int build = 0; build < CHECK_BUILDS; build++)
            for (int stage = 0; stage < CHECK_STAGES; stage++)
                write_json_comparison(v, device, k, (check_build)build, (check_stage)stage, &first,
                                      file);
    write_member(file, "],\n      \"ns_per_evaluation\": ",
                 report->timing.value_ns - report->timing.copy_ns);
    write_member(file, ", \"ns_with_buffers\": ", report->timing.value_ns);
    write_member(file, ", \"ns_buffers\": ", report->timing.copy_ns);
    write_member(file, ",\n      \"compile_ms\": ", report->timing.compile_ms);
    write_member(file, ", \"first_dispatch_ms\": ", report->timing.first_ms);
    fprintf(file, ", \"spirv_bytes\": %zu", report->timing.spirv_bytes);
}

void verification_write_json(const void *what, FILE *file)
{
    const verification *v = what;
    fputs("{\"model\": ", file);
    hnbrdf_write_json_text(file, v->path);
    fprintf(file,
            ",\n  \"weights\": \"%s\", \"precision\": \"%s\",\n  \"passed\": %s, \"pairs\": %zu, "
            "\"validated\": %s, \"validation_messages\": %d,\n  \"devices\": [",
            hnbrdf_glsl_weights_name(v->weights), hnbrdf_glsl_precision_name(v->precision),
            verification_passed(v) ? "true" : "false", v->pairs, v->validated ? "true" : "false",
            v->messages);
    for (int d = 0; d < v->device_count; d++) {
        const verified_device *device = &v->devices[d];
        fprintf(file, "%s\n    {\"index\": %d, \"api\": \"%s\", \"name\": ", d ? "," : "",
                device->index, device->api);
        hnbrdf_write_json_text(file, device->name);
        fprintf(file, ", \"kind\": \"%s\", \"driver\": ", device->kind);
        hnbrdf_write_json_text(file, device->driver);
        fputs(", \"error\": ", file);
        if (device->failed.text[0])
            hnbrdf_write_json_text(file, device->failed.text);
        else
            fputs("null", file);
        fprintf(file, ", \"within\": %s", device->report.within ? "true" : "false");
        if (!device->failed.text[0])
            write_json_report(v, device, file);
        fputs("}", file);
    }
    fputs("]}\n", file);
}
