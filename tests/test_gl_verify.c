/* test_gl_verify.c: exported shaders against the C library in every GL and GL ES context of this
 * machine, as fragment shaders. Skipped where there is none. */
#include "gpu_support.h"
#include "sanitized.h"

#include "gl/verify.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static gl_context context;

enum { PAIRS = SANITIZED ? 64 : 256 };

static const int ALL[SCENE_MATERIALS] = {0, 1, 2};
static const check_verify_options OPTIONS = {
    .materials = ALL, .material_count = SCENE_MATERIALS, .pairs = PAIRS, .seed = 5};

static const scene_shape ROTATED = {.encoding = HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
                                    .hidden = 8,
                                    .layers = 2,
                                    .latent = 5,
                                    .anisotropic = 1,
                                    .rotated = 1,
                                    .floor = 0.003f};
/* Units that do not fill their vectors; s, m and b that are read from the block. */
static const scene_shape UNEVEN = {.encoding = HNBRDF_ENCODING_ANGLES,
                                   .hidden = 7,
                                   .layers = 2,
                                   .latent = 3,
                                   .edited = 1,
                                   .scale = 1.7f,
                                   .shift = 0.5f};
static const scene_shape NEURAL = {.kind = HNBRDF_KIND_NEURAL,
                                   .encoding = HNBRDF_ENCODING_HALF_DIFFERENCE,
                                   .hidden = 4,
                                   .layers = 1,
                                   .latent = 2};
static const scene_shape GGX = {.kind = HNBRDF_KIND_GGX, .anisotropic = 1, .rotated = 1};

static int has_precise(void)
{
    return context.dialect == GL_DIALECT_450 || context.dialect == GL_DIALECT_ES_320;
}

/* Within the bounds at every stage; where the language keeps the order of operations and the device
 * rounds them as C does, the exact build has the bits of C but where a subnormal number is. */
static void check_report_holds(const check_report *report)
{
    const check_arithmetic *a = &report->arithmetic;
    int exact = a->exact_basic && a->exact_divide && a->exact_sqrt;
    assert_int_equal(report->ordered, has_precise());
    for (int build = 0; build < CHECK_BUILDS; build++)
        for (int stage = 0; stage < CHECK_STAGES; stage++) {
            check_comparison sum = {0};
            for (int m = 0; m < report->material_count; m++)
                check_comparison_add(&sum, &report->comparisons[m][build][stage]);
            if (sum.outside)
                fail_msg("%s %s %s: %zu of %zu outside: %.9g, C %.9g, bound %g, %s pair",
                         gl_dialect_name(context.dialect), check_build_name((check_build)build),
                         check_stage_name((check_stage)stage), sum.outside, sum.values,
                         (double)sum.worst.device, (double)sum.worst.reference, sum.worst.bound,
                         check_pair_class_name(sum.worst.class_of_pair));
            if (build == CHECK_BUILD_EXACT && has_precise() && exact)
                assert_int_equal(sum.identical, sum.values);
            assert_true(sum.unbounded * 8 <= sum.values);
        }
    assert_true(report->within);
}

static void holds(const scene_shape *shape, const hnbrdf_glsl_options *style)
{
    hnbrdf_model *model = scene_model(shape);
    hnbrdf_glsl_options options = *style;
    gl_verify_options verify = {.check = OPTIONS, .without_timing = 1};
    check_report report;
    hnbrdf_error error = {""};
    options.standalone = 1;
    char *text = styled_text(model, &options);
    float *weights = NULL;
    if (options.weights == HNBRDF_GLSL_UNIFORM)
        weights = scene_weights(model, &options, &verify.weights_size);
    verify.text = text;
    verify.weights = weights;
    verify.check.precision = options.precision;
    if (gl_verify(&context, model, &verify, &report, &error))
        fail_msg("%s", error.text);
    check_report_holds(&report);
    check_report_free(&report);
    free(text);
    free(weights);
    hnbrdf_model_free(model);
}

static void a_turned_hybrid_equals_c(void **state)
{
    (void)state;
    holds(&ROTATED, &(hnbrdf_glsl_options){.weights = HNBRDF_GLSL_COLUMNS});
}

/* Compiling is what takes time: each style and kind once, in another dialect. */
static void styles_and_kinds_equal_c(void **state)
{
    (void)state;
    switch (context.dialect) {
    case GL_DIALECT_330:
        holds(&UNEVEN, &(hnbrdf_glsl_options){.fixed = 1});
        break;
    case GL_DIALECT_450: /* each part of the library with a guard of its own, no comments */
        holds(&GGX, &(hnbrdf_glsl_options){.prefix = "hnbrdf", .without_comments = 1});
        break;
    case GL_DIALECT_ES_300: /* mediump */
        holds(&UNEVEN, &(hnbrdf_glsl_options){.precision = HNBRDF_GLSL_HALF});
        break;
    default: /* smaller than the hybrids, as ES 320 is GL 450 with other words */
        holds(&NEURAL, &(hnbrdf_glsl_options){0});
    }
}

/* ---- One program, several networks ----------------------------------------------------------- */

static void judge(gl_verifier *verifier, const hnbrdf_model *model, int expected)
{
    check_report report;
    hnbrdf_error error = {""};
    if (gl_verifier_check(verifier, model, &OPTIONS, &report, &error))
        fail_msg("%s", error.text);
    assert_int_equal(report.within, expected);
    if (expected)
        check_report_holds(&report);
    check_report_free(&report);
}

static void load(gl_verifier *verifier, const hnbrdf_model *model,
                 const hnbrdf_glsl_options *options)
{
    size_t size;
    hnbrdf_error error = {""};
    float *weights = scene_weights(model, options, &size);
    if (gl_verifier_load(verifier, weights, size, &error))
        fail_msg("%s", error.text);
    free(weights);
}

/* The weights of another network, loaded into the program that is there, give that network's
 * values, and no longer those of the one before. */
static void weights_are_exchanged_in_a_program(void **state)
{
    (void)state;
    if (context.dialect == GL_DIALECT_ES_320) /* what GL 450 and ES 300 have between them */
        skip();
    const hnbrdf_glsl_options options = {.weights = HNBRDF_GLSL_UNIFORM, .standalone = 1};
    hnbrdf_model *model = scene_model(&UNEVEN), *other = NULL;
    hnbrdf_model_desc desc;
    gl_verifier verifier;
    hnbrdf_error error = {""};
    hnbrdf_model_describe(model, &desc);
    float bias[6] = {-1.0f, 0.25f, -2.0f, 0.5f, 1.0f, -0.5f};
    desc.biases[2] = bias;
    desc.scale = 0.9f;
    desc.floor = 0.002f;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &other, NULL), HNBRDF_OK);
    char *text = styled_text(model, &options);
    if (gl_verifier_open(&context, text, PAIRS, &verifier, &error))
        fail_msg("%s", error.text);
    load(&verifier, model, &options);
    judge(&verifier, model, 1);
    load(&verifier, other, &options);
    judge(&verifier, other, 1);
    judge(&verifier, model, 0);
    load(&verifier, model, &options);
    judge(&verifier, model, 1);
    gl_verifier_close(&verifier);
    free(text);
    hnbrdf_model_free(other);
    hnbrdf_model_free(model);
}

/* No compiler unrolls the loops over a block, which took llvmpipe a minute: each build is compiled,
 * drawn and compared within 3 s of CPU time; half of that is usual. */
static void loops_over_a_block_stay_loops(void **state)
{
    (void)state;
    const scene_shape shape = {
        .encoding = HNBRDF_ENCODING_ANGLES, .hidden = 32, .layers = 2, .latent = 4};
    const hnbrdf_glsl_options options = {.weights = HNBRDF_GLSL_UNIFORM, .standalone = 1};
    if (SANITIZED || context.dialect != GL_DIALECT_330)
        return;
    hnbrdf_model *model = scene_model(&shape);
    char *text = styled_text(model, &options);
    gl_verifier verifier;
    hnbrdf_error error = {""};
    const clock_t started = clock();
    if (gl_verifier_open(&context, text, PAIRS, &verifier, &error))
        fail_msg("%s", error.text);
    load(&verifier, model, &options);
    judge(&verifier, model, 1);
    const double seconds = (double)(clock() - started) / CLOCKS_PER_SEC;
    gl_verifier_close(&verifier);
    free(text);
    hnbrdf_model_free(model);
    printf("%s: %.2f s for both builds\n", gl_dialect_name(context.dialect), seconds);
    if (seconds > 3.0 * CHECK_BUILDS)
        fail_msg("compiling and drawing took %.1f s", seconds);
}

/* ---- Errors ---------------------------------------------------------------------------------- */

static void a_shader_that_does_not_compile_is_one_line(void **state)
{
    (void)state;
    gl_verifier verifier;
    hnbrdf_error error = {""};
    assert_int_equal(
        gl_verifier_open(&context, "int first = 1;\nint is_float = 1.5;\n", 64, &verifier, &error),
        HNBRDF_ERROR_FORMAT);
    assert_null(strchr(error.text, '\n'));
    assert_non_null(strstr(error.text, gl_dialect_name(context.dialect)));
    assert_non_null(strstr(error.text, "fragment shader: "));
    assert_non_null(strstr(error.text, "rror"));
}

static void a_block_that_is_too_large_is_refused(void **state)
{
    (void)state;
    static const char bytes[1];
    GLuint buffer = 0;
    hnbrdf_error error = {""};
    assert_int_equal(gl_weights_open(&context, bytes, SIZE_MAX / 4, &buffer, &error),
                     HNBRDF_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.text, "this device takes up to"));
}

static int run_on(const gl_instance *instance, int display, gl_dialect dialect)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_turned_hybrid_equals_c),
        cmocka_unit_test(styles_and_kinds_equal_c),
        cmocka_unit_test(weights_are_exchanged_in_a_program),
        cmocka_unit_test(loops_over_a_block_stay_loops),
        cmocka_unit_test(a_shader_that_does_not_compile_is_one_line),
        cmocka_unit_test(a_block_that_is_too_large_is_refused),
    };
    hnbrdf_error error = {""};
    if (gl_context_open(instance, display, dialect, &context, &error)) {
        printf("parity: glsl | %s | - | skipped: %s\n", gl_dialect_name(dialect), error.text);
        return 0;
    }
    printf("%s: %s, %s\n", gl_dialect_name(dialect), context.name, context.version);
    int failed = cmocka_run_group_tests_name(gl_dialect_name(dialect), tests, NULL, NULL);
    if (!failed)
        printf("parity: glsl | %s | %s | executed\n", gl_dialect_name(dialect), context.name);
    gl_context_close(&context);
    return failed;
}

int main(void)
{
    gl_instance instance;
    int failed = 0;
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1); /* what compiling takes is measured */
    /* Kept loaded, or LeakSanitizer cannot tell what the driver still holds from a leak. */
    dlopen("swrast_dri.so", RTLD_NOW | RTLD_NODELETE);
    gl_open(&instance);
    int none = instance.count == 0;
    if (none)
        printf("skipped: no EGL display\n");
    for (int display = 0; display < instance.count; display++)
        for (int dialect = 0; dialect < GL_DIALECTS; dialect++)
            failed += run_on(&instance, display, (gl_dialect)dialect);
    gl_close(&instance);
    return none ? 77 : failed;
}
