/* timed.c: what an exported scene costs in a GL context. */
#include "gl/timed.h"

#include "base/clock.h"
#include "base/error.h"
#include "check/parity.h"
#include "gl/draw.h"
#include "hnbrdf/measured.h"

#include <math.h>
#include <stdlib.h>

/* The value of the first material, and what reading and writing costs. */
static const char VALUE[] =
    GL_FRAME "void main()\n"
             "{\n"
             "    vec4 a = texel(0, 4), b = texel(1, 4);\n"
             "    vec3 f = hnbrdf_eval(hnbrdf_scene_material(slot), a.yzw, b.xyz);\n"
             "    result = vec4(f, 0.0);\n"
             "}\n";
static const char COPY[] = GL_FRAME "void main()\n"
                                    "{\n"
                                    "    vec4 a = texel(0, 4), b = texel(1, 4);\n"
                                    "    result = vec4(a.yzw + b.xyz, float(slot));\n"
                                    "}\n";

enum { EVALUATIONS = 1 << 17, RUNS = 3 };

static hnbrdf_result fill_sheet(const gl_context *context, gl_sheet *sheet, hnbrdf_error *error)
{
    float *rows = calloc(EVALUATIONS, CHECK_PARITY_INPUTS * sizeof *rows);
    if (!rows)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory", context->name);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (size_t k = 0; k < EVALUATIONS; k++)
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, rows + CHECK_PARITY_INPUTS * k + 1,
                            rows + CHECK_PARITY_INPUTS * k + 4);
    hnbrdf_result result = gl_sheet_upload(context, sheet, rows, EVALUATIONS, error);
    free(rows);
    return result;
}

/* The best of a few draws, in ns an evaluation; *first_ms is of the first, of one row. */
static hnbrdf_result time_draws(const gl_context *context, const gl_sheet *sheet, GLuint program,
                                double *ns, double *first_ms, hnbrdf_error *error)
{
    double started = hnbrdf_seconds(), best = (double)INFINITY;
    hnbrdf_result result = gl_draw(context, sheet, program, 0, 1, error);
    *first_ms = 1e3 * (hnbrdf_seconds() - started);
    for (int run = 0; run < RUNS && !result; run++) {
        started = hnbrdf_seconds();
        result = gl_draw(context, sheet, program, 0, EVALUATIONS, error);
        best = fmin(best, 1e9 * (hnbrdf_seconds() - started) / EVALUATIONS);
    }
    *ns = best;
    return result;
}

hnbrdf_result gl_time_scene(const gl_context *context, const char *text, const void *weights,
                            size_t weights_size, check_timing *timing, hnbrdf_error *error)
{
    const char *const value_texts[] = {text, VALUE};
    const char *const copy_texts[] = {text, COPY};
    check_timing made = {.evaluations = EVALUATIONS};
    gl_sheet sheet = {0};
    GLuint value = 0, copy = 0, buffer = 0;
    double ignored, started = hnbrdf_seconds();
    hnbrdf_result result = gl_program_open(context, value_texts, 2, &value, error);
    made.compile_ms = 1e3 * (hnbrdf_seconds() - started);
    gl_weights_use(context, value);
    if (!result && weights)
        result = gl_weights_open(context, weights, weights_size, &buffer, error);
    if (!result)
        result = gl_program_open(context, copy_texts, 2, &copy, error);
    if (!result)
        result = gl_sheet_open(context, CHECK_PARITY_INPUTS / 4, EVALUATIONS, &sheet, error);
    if (!result)
        result = fill_sheet(context, &sheet, error);
    if (!result)
        result = time_draws(context, &sheet, value, &made.value_ns, &made.first_ms, error);
    if (!result)
        result = time_draws(context, &sheet, copy, &made.copy_ns, &ignored, error);
    gl_sheet_close(context, &sheet);
    context->f.DeleteProgram(value);
    context->f.DeleteProgram(copy);
    context->f.DeleteBuffers(1, &buffer);
    *timing = made;
    return result;
}
