/* verify.c: shaders/parity.glsl with an exported scene in a GL context, in both builds. */
#include "gl/verify.h"

#include "check/parity.h"
#include "check/probe.h"
#include "gl/timed.h"

#include <string.h>

/* The texts of shaders/parity.glsl and shaders/probe.glsl. */
extern const char hnbrdf_parity_glsl[], hnbrdf_probe_glsl[];

static const char EXACT[] = "#define HNBRDF_EXACT 1\n";

static const char PARITY[] = GL_FRAME
    "void main()\n"
    "{\n"
    "    result = hnbrdf_parity(texel(0, 4), texel(1, 4), texel(2, 4), texel(3, 4), slot);\n"
    "}\n";
static const char PROBE[] = GL_FRAME "void main()\n"
                                     "{\n"
                                     "    result = hnbrdf_probe(texel(0, 1), slot);\n"
                                     "}\n";

/* ---- The probe ------------------------------------------------------------------------------- */

static hnbrdf_result run_probe(void *user, const float *operands, int count, float *results,
                               hnbrdf_error *error)
{
    const gl_verifier *s = user;
    /* of the scene only what its first part, hybrid_brdf.glsl, defines is used */
    const char *const texts[] = {EXACT, s->text, hnbrdf_probe_glsl, PROBE};
    gl_sheet sheet = {0};
    GLuint program = 0;
    hnbrdf_result result = gl_program_open(s->context, texts, 4, &program, error);
    if (!result)
        result = gl_sheet_open(s->context, 1, (size_t)count, &sheet, error);
    if (!result)
        result = gl_sheet_upload(s->context, &sheet, operands, (size_t)count, error);
    for (int slot = 0; slot < CHECK_PROBE_RESULTS / 4 && !result; slot++) {
        result = gl_draw(s->context, &sheet, program, slot, (size_t)count, error);
        if (!result)
            result = gl_sheet_download(s->context, &sheet, (size_t)count, results + 4 * slot,
                                       CHECK_PROBE_RESULTS, error);
    }
    gl_sheet_close(s->context, &sheet);
    s->context->f.DeleteProgram(program);
    return result;
}

static int is_llvmpipe(const gl_context *context)
{
    return strncmp(context->name, "llvmpipe", 8) == 0;
}

static hnbrdf_result probe(void *user, check_arithmetic *arithmetic, hnbrdf_error *error)
{
    const gl_verifier *s = user;
    return check_probe_run(run_probe, user, is_llvmpipe(s->context), arithmetic, error);
}

/* ---- The parity body ------------------------------------------------------------------------- */

static hnbrdf_result run(void *user, check_build build, const float *rows, size_t count,
                         float *outputs, int *has_run, hnbrdf_error *error)
{
    gl_verifier *s = user;
    *has_run = 1;
    hnbrdf_result result = gl_sheet_upload(s->context, &s->sheet, rows, count, error);
    for (int slot = 0; slot < CHECK_PARITY_SLOTS && !result; slot++) {
        result = gl_draw(s->context, &s->sheet, s->programs[build], slot, count, error);
        if (!result)
            result = gl_sheet_download(s->context, &s->sheet, count, outputs + 4 * slot,
                                       CHECK_PARITY_OUTPUTS, error);
    }
    return result;
}

static hnbrdf_result open_program(gl_verifier *s, check_build build, hnbrdf_error *error)
{
    const char *const texts[] = {build == CHECK_BUILD_EXACT ? EXACT : "", s->text,
                                 hnbrdf_parity_glsl, PARITY};
    hnbrdf_result result = gl_program_open(s->context, texts, 4, &s->programs[build], error);
    if (!result)
        gl_weights_use(s->context, s->programs[build]);
    return result;
}

hnbrdf_result gl_verifier_open(const gl_context *context, const char *text, size_t pairs,
                               gl_verifier *verifier, hnbrdf_error *error)
{
    gl_verifier s = {.context = context, .text = text};
    hnbrdf_result result = gl_sheet_open(context, CHECK_PARITY_INPUTS / 4, pairs, &s.sheet, error);
    for (int build = 0; build < CHECK_BUILDS && !result; build++)
        result = open_program(&s, (check_build)build, error);
    if (result)
        gl_verifier_close(&s);
    else
        *verifier = s;
    return result;
}

hnbrdf_result gl_verifier_load(gl_verifier *verifier, const void *weights, size_t size,
                               hnbrdf_error *error)
{
    verifier->context->f.DeleteBuffers(1, &verifier->weights);
    return gl_weights_open(verifier->context, weights, size, &verifier->weights, error);
}

hnbrdf_result gl_verifier_check(gl_verifier *verifier, const hnbrdf_model *model,
                                const check_verify_options *options, check_report *report,
                                hnbrdf_error *error)
{
    const check_runner runner = {.is_llvmpipe = is_llvmpipe(verifier->context),
                                 .probe = probe,
                                 .run = run,
                                 .user = verifier};
    return check_verify(&runner, model, options, report, error);
}

void gl_verifier_close(gl_verifier *verifier)
{
    if (!verifier->context)
        return;
    gl_sheet_close(verifier->context, &verifier->sheet);
    for (int build = 0; build < CHECK_BUILDS; build++)
        verifier->context->f.DeleteProgram(verifier->programs[build]);
    verifier->context->f.DeleteBuffers(1, &verifier->weights);
    memset(verifier, 0, sizeof *verifier);
}

hnbrdf_result gl_verify(const gl_context *context, const hnbrdf_model *model,
                        const gl_verify_options *options, check_report *report, hnbrdf_error *error)
{
    gl_verifier s = {0};
    check_timing timing;
    hnbrdf_result result = HNBRDF_OK;
    /* first, or the driver would have compiled before */
    if (!options->without_timing)
        result = gl_time_scene(context, options->text, options->weights, options->weights_size,
                               &timing, error);
    if (!result)
        result = gl_verifier_open(context, options->text, options->check.pairs, &s, error);
    if (!result && options->weights)
        result = gl_verifier_load(&s, options->weights, options->weights_size, error);
    if (!result)
        result = gl_verifier_check(&s, model, &options->check, report, error);
    if (!result && !options->without_timing)
        report->timing = timing;
    gl_verifier_close(&s);
    return result;
}
