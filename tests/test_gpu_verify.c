/* test_gpu_verify.c: exported shaders against the C library on every Vulkan device of this machine.
 * Skipped where there is no device or no glslangValidator. */
#include "gpu_support.h"
#include "sanitized.h"

#include "gpu/compile.h"
#include "gpu/verify.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static gpu_instance instance;
static gpu_device device;
static int validated;

static const hnbrdf_encoding DIRECTIONS = HNBRDF_ENCODING_DIRECTIONS,
                             HALF = HNBRDF_ENCODING_HALF_DIFFERENCE;

enum { PAIRS = SANITIZED ? 256 : 2048 };
static const gpu_validation VALIDATION = SANITIZED ? GPU_VALIDATED : GPU_VALIDATED_SYNC;

static gpu_stage stage_of_shaders = GPU_STAGE_COMPUTE;

static check_report verify_styled(const hnbrdf_model *model, const gpu_scene *scene,
                                  hnbrdf_glsl_precision precision)
{
    static const int all[SCENE_MATERIALS] = {0, 1, 2};
    const gpu_verify_options options = {
        .scene = *scene,
        .stage = stage_of_shaders,
        .check = {.precision = precision,
                  .materials = all,
                  .material_count = hnbrdf_model_material_count(model),
                  .pairs = PAIRS,
                  .seed = 3},
        .without_timing = 1};
    check_report report = {0};
    hnbrdf_error error = {""};
    if (gpu_verify(&device, model, &options, &report, &error))
        fail_msg("%s", error.text);
    return report;
}

static check_report verify(const hnbrdf_model *model, const char *scene)
{
    return verify_styled(model, &(gpu_scene){.text = scene}, HNBRDF_GLSL_FLOAT);
}

/* Over all materials. */
static check_comparison all_of(const check_report *report, int build, int stage)
{
    check_comparison sum = {0};
    for (int m = 0; m < report->material_count; m++)
        check_comparison_add(&sum, &report->comparisons[m][build][stage]);
    return sum;
}

static int exact_device(const check_arithmetic *a)
{
    return (!a->has_half || (a->exact_half && a->keeps_half_denormals)) && a->exact_basic &&
           a->exact_divide && a->exact_sqrt && a->keeps_denormals;
}

/* ---- What must hold -------------------------------------------------------------------------- */

static void check_one_stage(const check_report *report, int build, int stage)
{
    check_comparison sum = all_of(report, build, stage);
    const check_place *at = &sum.worst;
    if (!sum.applies)
        return;
    if (sum.outside)
        fail_msg(
            "%s %s: %zu of %zu outside: %.9g, C %.9g, bound %g, %s pair (%.9g %.9g %.9g) (%.9g "
            "%.9g %.9g)",
            check_build_name((check_build)build), check_stage_name((check_stage)stage), sum.outside,
            sum.values, (double)at->device, (double)at->reference, at->bound,
            check_pair_class_name(at->class_of_pair), (double)at->pair[0], (double)at->pair[1],
            (double)at->pair[2], (double)at->pair[3], (double)at->pair[4], (double)at->pair[5]);
    if (build == CHECK_BUILD_EXACT && stage == CHECK_STAGE_NETWORK &&
        report->arithmetic.exact_basic && report->arithmetic.keeps_denormals &&
        !report->arithmetic.has_half)
        assert_int_equal(sum.identical, sum.values);
    if (build == CHECK_BUILD_EXACT && exact_device(&report->arithmetic))
        assert_int_equal(sum.identical, sum.values);
    /* One pair in 64 is not finite and half of one in 32 below the horizon: the bounds must say
     * something about nearly all others. */
    assert_true(sum.unbounded * 16 < sum.values);
}

/* The shader of this scene is within the derived bounds at every stage; where the device's
 * operations are exact, the exact build has the bits of C from end to end. */
static void model_holds_by(const hnbrdf_model *model, const hnbrdf_glsl_options *options)
{
    const hnbrdf_glsl_weights weights = options->weights;
    const hnbrdf_glsl_precision precision = options->precision;
    gpu_scene exported = {0};
    hnbrdf_glsl_options alone = *options;
    alone.standalone = 1;
    char *scene = styled_text(model, &alone);
    float *block = NULL;
    if (weights == HNBRDF_GLSL_UNIFORM)
        block = scene_weights(model, options, &exported.weights_size);
    exported.text = scene;
    exported.weights = block;
    check_report report = verify_styled(model, &exported, precision);
    for (int build = 0; build < CHECK_BUILDS; build++)
        for (int stage = 0; stage < CHECK_STAGES; stage++)
            check_one_stage(&report, build, stage);
    assert_true(report.within);
    check_report_free(&report);
    free(block);
    free(scene);
}

static void model_holds_as(const hnbrdf_model *model, hnbrdf_glsl_weights weights,
                           hnbrdf_glsl_precision precision)
{
    model_holds_by(model, &(hnbrdf_glsl_options){.weights = weights, .precision = precision});
}

static void model_holds(const hnbrdf_model *model)
{
    model_holds_as(model, HNBRDF_GLSL_CONSTANTS, HNBRDF_GLSL_FLOAT);
}

static void holds_as(const scene_shape *shape, hnbrdf_glsl_weights weights,
                     hnbrdf_glsl_precision precision)
{
    hnbrdf_model *model = scene_model(shape);
    model_holds_as(model, weights, precision);
    hnbrdf_model_free(model);
}

static void holds(const scene_shape *shape)
{
    holds_as(shape, HNBRDF_GLSL_CONSTANTS, HNBRDF_GLSL_FLOAT);
}

/* The first material alone: its numbers are constants that the device's compiler may fold into
 * others. */
static void holds_alone(const scene_shape *shape)
{
    hnbrdf_model *model = scene_model(shape), *alone = NULL;
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    desc.material_count = 1;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &alone, NULL), HNBRDF_OK);
    model_holds(alone);
    hnbrdf_model_free(alone);
    hnbrdf_model_free(model);
}

static void one_material_alone_equals_c(void **state)
{
    (void)state;
    holds_alone(
        &(scene_shape){.encoding = HALF, .hidden = 16, .layers = 2, .latent = 4, .floor = 0.003f});
    holds_alone(&(scene_shape){
        .encoding = DIRECTIONS, .hidden = 8, .layers = 2, .latent = 4, .scale = 2.3f});
    holds_alone(&(scene_shape){.kind = HNBRDF_KIND_GGX, .anisotropic = 1, .rotated = 1});
}

static void isotropic_hybrid_equals_c(void **state)
{
    (void)state;
    holds(
        &(scene_shape){.encoding = HALF, .hidden = 32, .layers = 2, .latent = 4, .floor = 0.003f});
}

static void published_form_equals_c(void **state)
{
    (void)state;
    holds(&(scene_shape){.encoding = DIRECTIONS,
                         .hidden = 32,
                         .layers = 2,
                         .latent = 4,
                         .scale = 2.3f,
                         .shift = -1.7f});
}

static void anisotropic_rotated_hybrid_equals_c(void **state)
{
    (void)state;
    holds(&(scene_shape){.encoding = HALF,
                         .hidden = 16,
                         .layers = 3,
                         .latent = 8,
                         .anisotropic = 1,
                         .rotated = 1,
                         .scale = 1.5f,
                         .floor = 0.002f});
    holds(&(scene_shape){.encoding = DIRECTIONS,
                         .hidden = 8,
                         .layers = 2,
                         .latent = 5,
                         .rotated = 1,
                         .shift = 0.25f});
}

static void encodings_by_angles_equal_c(void **state)
{
    (void)state;
    holds(&(scene_shape){.encoding = HNBRDF_ENCODING_ANGLES,
                         .hidden = 16,
                         .layers = 2,
                         .latent = 4,
                         .floor = 0.003f});
    holds(&(scene_shape){
        .encoding = HNBRDF_ENCODING_ANGLES_DIRECTED, .hidden = 16, .layers = 1, .latent = 4});
    holds(&(scene_shape){.encoding = HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
                         .hidden = 16,
                         .layers = 2,
                         .latent = 4,
                         .anisotropic = 1,
                         .rotated = 1,
                         .floor = 0.003f});
}

/* The correction carried along; the first material is not edited, and has the bits it has
 * alone. */
static void edited_hybrids_equal_c(void **state)
{
    (void)state;
    for (int encoding = 0; encoding <= HNBRDF_ENCODING_ANGLES_AZIMUTHS; encoding++)
        holds(&(scene_shape){.encoding = (hnbrdf_encoding)encoding,
                             .hidden = 8,
                             .layers = 2,
                             .latent = 4,
                             .anisotropic = encoding % 2,
                             .rotated = encoding % 2,
                             .edited = 1,
                             .floor = 0.003f});
}

static void edited_hybrids_of_every_style_equal_c(void **state)
{
    (void)state;
    const scene_shape shape = {.encoding = HNBRDF_ENCODING_ANGLES,
                               .hidden = 8,
                               .layers = 1,
                               .latent = 3,
                               .edited = 1,
                               .scale = 1.5f,
                               .floor = 0.002f};
    const scene_shape unedited = {
        .encoding = HNBRDF_ENCODING_ANGLES, .hidden = 8, .layers = 1, .latent = 3};
    hnbrdf_model *model = scene_model(&shape), *plain = scene_model(&unedited);
    model_holds_by(model, &(hnbrdf_glsl_options){.fixed = 1});
    model_holds_by(model, &(hnbrdf_glsl_options){.weights = HNBRDF_GLSL_UNIFORM,
                                                 .precision = HNBRDF_GLSL_HALF});
    model_holds_by(plain, &(hnbrdf_glsl_options){.editable = 1});
    hnbrdf_model_free(model);
    hnbrdf_model_free(plain);
}

static void neural_equals_c(void **state)
{
    (void)state;
    holds(&(scene_shape){.kind = HNBRDF_KIND_NEURAL,
                         .encoding = HALF,
                         .hidden = 16,
                         .layers = 2,
                         .latent = 12,
                         .floor = 0.001f});
    holds(&(scene_shape){.kind = HNBRDF_KIND_NEURAL,
                         .encoding = DIRECTIONS,
                         .hidden = 64,
                         .layers = 1,
                         .latent = 16,
                         .rotated = 1});
}

static void ggx_equals_c(void **state)
{
    (void)state;
    holds(&(scene_shape){.kind = HNBRDF_KIND_GGX});
    holds(&(scene_shape){.kind = HNBRDF_KIND_GGX, .anisotropic = 1, .rotated = 1});
}

static void smallest_and_deepest_networks_equal_c(void **state)
{
    (void)state;
    holds(&(scene_shape){.encoding = HALF, .hidden = 1, .layers = 1, .latent = 1});
    holds(&(scene_shape){.encoding = HALF, .hidden = 8, .layers = 4, .latent = 4});
}

/* Units and latent codes that do not fill their vectors; s, m and b that are read from the
 * buffer. */
static const scene_shape UNEVEN = {.encoding = HNBRDF_ENCODING_ANGLES,
                                   .hidden = 11,
                                   .layers = 2,
                                   .latent = 5,
                                   .scale = 1.7f,
                                   .shift = 0.5f};
static const scene_shape UNEVEN_NEURAL = {.kind = HNBRDF_KIND_NEURAL,
                                          .encoding = HNBRDF_ENCODING_HALF_DIFFERENCE,
                                          .hidden = 6,
                                          .layers = 3,
                                          .latent = 2};

static void columns_equal_c(void **state)
{
    (void)state;
    holds_as(&UNEVEN, HNBRDF_GLSL_COLUMNS, HNBRDF_GLSL_FLOAT);
    holds_as(&UNEVEN_NEURAL, HNBRDF_GLSL_COLUMNS, HNBRDF_GLSL_FLOAT);
}

static void a_uniform_block_equals_c(void **state)
{
    (void)state;
    holds_as(&UNEVEN, HNBRDF_GLSL_UNIFORM, HNBRDF_GLSL_FLOAT);
    holds_as(&UNEVEN_NEURAL, HNBRDF_GLSL_UNIFORM, HNBRDF_GLSL_FLOAT);
}

static void half_equals_half_in_c(void **state)
{
    (void)state;
    holds_as(&UNEVEN, HNBRDF_GLSL_CONSTANTS, HNBRDF_GLSL_HALF);
    holds_as(&UNEVEN_NEURAL, HNBRDF_GLSL_COLUMNS, HNBRDF_GLSL_HALF);
    holds_as(&UNEVEN, HNBRDF_GLSL_UNIFORM, HNBRDF_GLSL_HALF);
}

/* The same as fragment shaders: drivers round otherwise there, and are asked how. */
static void fragment_shaders_equal_c(void **state)
{
    (void)state;
    stage_of_shaders = GPU_STAGE_FRAGMENT;
    holds_as(&UNEVEN, HNBRDF_GLSL_UNIFORM, HNBRDF_GLSL_FLOAT);
    holds_as(&UNEVEN_NEURAL, HNBRDF_GLSL_COLUMNS, HNBRDF_GLSL_HALF);
    holds(&(scene_shape){.kind = HNBRDF_KIND_GGX, .anisotropic = 1, .rotated = 1});
    stage_of_shaders = GPU_STAGE_COMPUTE;
    printf("parity: glsl | Vulkan fragment | %s | executed\n", device.properties.deviceName);
}

/* The shader of one network with the bytes of another of its size. */
static void one_uniform_shader_serves_other_networks(void **state)
{
    (void)state;
    const hnbrdf_glsl_options options = {.weights = HNBRDF_GLSL_UNIFORM, .standalone = 1};
    hnbrdf_model *model = scene_model(&UNEVEN), *other = NULL;
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    float bias[6] = {-1.0f, 0.25f, -2.0f, 0.5f, 1.0f, -0.5f};
    desc.biases[2] = bias;
    desc.scale = 0.9f;
    desc.floor = 0.002f;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &other, NULL), HNBRDF_OK);
    gpu_scene exported = {0};
    char *scene = styled_text(model, &options);
    float *block = scene_weights(other, &options, &exported.weights_size);
    exported.text = scene;
    exported.weights = block;
    check_report report = verify_styled(other, &exported, HNBRDF_GLSL_FLOAT);
    assert_true(report.within);
    check_report_free(&report);
    report =
        verify_styled(model, &exported, HNBRDF_GLSL_FLOAT); /* and not the one it was written for */
    assert_false(report.within);
    check_report_free(&report);
    free(block);
    free(scene);
    hnbrdf_model_free(other);
    hnbrdf_model_free(model);
}

/* ---- What must not pass ---------------------------------------------------------------------- */

/* The text with the first number behind `marker` moved: up by one float, or by 1 %. */
static char *plant(const char *scene, const char *marker, int one_ulp)
{
    const char *at = strstr(scene, marker);
    assert_non_null(at);
    at += strlen(marker) + strspn(at + strlen(marker), "+- "); /* the sign may stand apart */
    char *after, number[32];
    float value = strtof(at, &after);
    assert_true(after > at && value != 0.0f);
    snprintf(number, sizeof number, "%.9e",
             (double)(one_ulp ? nextafterf(value, INFINITY) : value * 1.01f));
    size_t size = strlen(scene) + sizeof number;
    char *changed = malloc(size);
    assert_non_null(changed);
    snprintf(changed, size, "%.*s%s%s", (int)(at - scene), scene, number, after);
    return changed;
}

static void is_found(const char *marker, int one_ulp, int stage)
{
    hnbrdf_model *model = scene_model(
        &(scene_shape){.encoding = HALF, .hidden = 16, .layers = 2, .latent = 4, .floor = 0.003f});
    char *scene = scene_text(model, 1), *changed = plant(scene, marker, one_ulp);
    check_report report = verify(model, changed);
    check_comparison found = all_of(&report, CHECK_BUILD_EXACT, stage);
    /* A device that divides inexactly may hide an ulp of the analytic part; the network never
     * does. */
    if (exact_device(&report.arithmetic) || stage == CHECK_STAGE_NETWORK) {
        assert_false(report.within);
        assert_true(found.outside > 0);
        assert_true(found.worst.ulp > 0.0);
    }
    check_report_free(&report);
    free(scene);
    free(changed);
    hnbrdf_model_free(model);
}

static void a_changed_weight_is_found(void **state)
{
    (void)state;
    is_found("a_3 = hnbrdf_hard_gelu(", 0, CHECK_STAGE_NETWORK);
    is_found(" * a_1 ", 0, CHECK_STAGE_NETWORK);
}

static void one_ulp_of_one_number_is_found(void **state)
{
    (void)state;
    is_found("float out_4 = ", 1, CHECK_STAGE_NETWORK);
    is_found("hnbrdf_material(vec3(", 1, CHECK_STAGE_ANALYTIC);
}

static void a_shader_that_does_not_compile_is_an_error(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&(scene_shape){.kind = HNBRDF_KIND_GGX});
    static const int first[] = {0};
    const gpu_verify_options options = {
        .scene = {.text = "int is_float = 1.0;\n"},
        .check = {.materials = first, .material_count = 1, .pairs = 64}};
    check_report report = {0};
    hnbrdf_error error = {""};
    assert_int_equal(gpu_verify(&device, model, &options, &report, &error), HNBRDF_ERROR_FORMAT);
    assert_non_null(strstr(error.text, "ERROR"));
    hnbrdf_model_free(model);
}

static void validation_layer_says_nothing(void **state)
{
    (void)state;
    if (!validated)
        skip();
    assert_int_equal(instance.messages, 0);
}

/* ---- Running --------------------------------------------------------------------------------- */

static int run_on(int index)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(isotropic_hybrid_equals_c),
        cmocka_unit_test(published_form_equals_c),
        cmocka_unit_test(anisotropic_rotated_hybrid_equals_c),
        cmocka_unit_test(encodings_by_angles_equal_c),
        cmocka_unit_test(one_material_alone_equals_c),
        cmocka_unit_test(edited_hybrids_equal_c),
        cmocka_unit_test(edited_hybrids_of_every_style_equal_c),
        cmocka_unit_test(neural_equals_c),
        cmocka_unit_test(ggx_equals_c),
        cmocka_unit_test(smallest_and_deepest_networks_equal_c),
        cmocka_unit_test(columns_equal_c),
        cmocka_unit_test(a_uniform_block_equals_c),
        cmocka_unit_test(half_equals_half_in_c),
        cmocka_unit_test(fragment_shaders_equal_c),
        cmocka_unit_test(one_uniform_shader_serves_other_networks),
        cmocka_unit_test(a_changed_weight_is_found),
        cmocka_unit_test(one_ulp_of_one_number_is_found),
        cmocka_unit_test(a_shader_that_does_not_compile_is_an_error),
        cmocka_unit_test(validation_layer_says_nothing),
    };
    hnbrdf_error error = {""};
    printf("device %d: %s\n", index, instance.properties[index].deviceName);
    if (gpu_device_open(&instance, index, &device, &error)) {
        printf("%s\n", error.text);
        return 1;
    }
    int failed =
        cmocka_run_group_tests_name(instance.properties[index].deviceName, tests, NULL, NULL);
    gpu_device_close(&device);
    if (!failed)
        printf("parity: glsl | Vulkan compute | %s | executed\n",
               instance.properties[index].deviceName);
    return failed;
}

int main(void)
{
    hnbrdf_error error = {""};
    int failed = 0;
    if (!gpu_compiler_found()) {
        printf("skipped: no glslangValidator\n");
        return 77;
    }
    /* Kept loaded, or LeakSanitizer cannot tell what the driver still holds from a leak. */
    dlopen("libvulkan_lvp.so", RTLD_NOW | RTLD_NODELETE);
    validated = gpu_open(VALIDATION, &instance, &error) == HNBRDF_OK;
    if (!validated)
        printf("without validation: %s\n", error.text);
    if (!validated && gpu_open(GPU_NOT_VALIDATED, &instance, &error)) {
        printf("%s\n", error.text);
        return 1;
    }
    if (instance.count == 0)
        printf("skipped: no Vulkan device\n");
    for (int i = 0; i < instance.count; i++)
        failed += run_on(i);
    int none = instance.count == 0;
    gpu_close(&instance);
    return none ? 77 : failed;
}
