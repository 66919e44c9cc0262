/* test_glsl_strip.c: what an export leaves out changes no value, and makes the shader smaller. */
#include "gpu_run.h"
#include "gpu_support.h"

#include "check/pairs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRS = 2048 };

static const scene_shape PLAIN = {
    .encoding = HNBRDF_ENCODING_ANGLES, .hidden = 32, .layers = 2, .latent = 4, .floor = 0.003f};
static const scene_shape ROTATED = {.encoding = HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
                                    .hidden = 9, /* fills its last vector with one number */
                                    .layers = 3,
                                    .latent = 6,
                                    .anisotropic = 1,
                                    .rotated = 1,
                                    .scale = 1.5f};

/* ---- Values ---------------------------------------------------------------------------------- */

static const char EVAL[] = "void main() {\n"
                           "    uint k = gl_GlobalInvocationID.x;\n"
                           "    if (k < count)\n"
                           "        store3(3 * k, hnbrdf_eval(hnbrdf_scene_material(material), "
                           "in_vec3(6 * k), in_vec3(6 * k + 3)));\n"
                           "}\n";

/* The first two materials of gpu_support.c by their names. */
static const char NAMED[] = "void main() {\n"
                            "    uint k = gl_GlobalInvocationID.x;\n"
                            "    if (k >= count)\n        return;\n"
                            "    vec3 wi = in_vec3(6 * k), wo = in_vec3(6 * k + 3);\n"
                            "    store3(3 * k, material == 0 ? hnbrdf_eval_GOLD_PAINT(wi, wo) : "
                            "hnbrdf_eval_BLUE_FABRIC(wi, wo));\n"
                            "}\n";

static void draw_pairs(float *pairs)
{
    float pair[6] = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f};
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 5, 0);
    for (size_t k = 0; k < PAIRS; k++) {
        if (check_pair_draw(&rng, k, pair) ==
            CHECK_PAIR_NOT_FINITE) /* whose values nothing is promised of */
            memcpy(pair, (const float[6]){0.0f, 0.6f, 0.8f, 0.6f, 0.0f, 0.8f}, sizeof pair);
        memcpy(pairs + 6 * k, pair, sizeof pair);
    }
}

/* Every chosen material has, in the exact build, the bits that C has of the model it was taken
 * from. */
static void same_values(const scene_shape *shape, const hnbrdf_glsl_options *options,
                        const char *body)
{
    hnbrdf_model *model = scene_model(shape);
    static float pairs[PAIRS * 6], device[PAIRS * 3], c[PAIRS * 3];
    char *scene = gpu_run_export(model, options);
    draw_pairs(pairs);
    for (int m = 0; m < (options->materials ? options->material_count : 2); m++) {
        int index = options->materials ? options->materials[m] : m;
        gpu_run(scene, body, 1, m, PAIRS, pairs, PAIRS * 6, device, PAIRS * 3);
        gpu_run_c_begin();
        hnbrdf_eval_batch(model, hnbrdf_model_material(model, index), PAIRS, pairs, 24, pairs + 3,
                          24, c, 0);
        gpu_run_c_end();
        if (gpu_run_exact())
            gpu_run_assert_same("f", device, c, PAIRS * 3);
    }
    free(scene);
    hnbrdf_model_free(model);
}

static void evaluation_alone_has_the_values_of_c(void **state)
{
    (void)state;
    same_values(&PLAIN, &(hnbrdf_glsl_options){.only = HNBRDF_GLSL_EVAL}, EVAL);
}

static void fixed_materials_have_the_values_of_c(void **state)
{
    (void)state;
    const hnbrdf_glsl_options fixed = {.only = HNBRDF_GLSL_EVAL, .fixed = 1};
    same_values(&PLAIN, &fixed, EVAL);
    same_values(&ROTATED, &fixed, EVAL);
    same_values(&ROTATED, &fixed, NAMED);
    scene_shape edited = ROTATED;
    edited.edited = 1;
    same_values(&edited, &fixed, NAMED);
    same_values(&ROTATED, &(hnbrdf_glsl_options){.fixed = 1, .weights = HNBRDF_GLSL_COLUMNS}, EVAL);
    same_values(&(scene_shape){.kind = HNBRDF_KIND_GGX, .anisotropic = 1}, &fixed, NAMED);
    same_values(&(scene_shape){.kind = HNBRDF_KIND_NEURAL, .hidden = 6, .layers = 1, .latent = 5},
                &fixed, EVAL);
}

static void one_fixed_material_has_the_values_of_c(void **state)
{
    (void)state;
    const int second = 1, first = 0;
    const hnbrdf_glsl_options one = {
        .materials = &second, .material_count = 1, .only = HNBRDF_GLSL_EVAL, .fixed = 1};
    const hnbrdf_glsl_options other = {
        .materials = &first, .material_count = 1, .only = HNBRDF_GLSL_EVAL_SAMPLE, .fixed = 1};
    same_values(&PLAIN, &one, EVAL);
    same_values(&ROTATED, &other, EVAL);
    same_values(&(scene_shape){.kind = HNBRDF_KIND_NEURAL, .hidden = 6, .layers = 1, .latent = 5},
                &one, EVAL);
}

/* ---- Size ------------------------------------------------------------------------------------ */

enum {
    OP_NAME = 5,
    OP_LINE = 8,
    OP_FUNCTION = 54,
    OP_FUNCTION_END = 56,
    OP_LABEL = 248,
    HEADER_WORDS = 5
};

/* Whether the function with this id belongs to the network. */
static int is_network(const uint32_t *spirv, size_t words, uint32_t id)
{
    for (size_t at = HEADER_WORDS; at < words; at += spirv[at] >> 16)
        if ((spirv[at] & 0xffff) == OP_NAME && spirv[at + 1] == id) {
            const char *name = (const char *)&spirv[at + 2];
            return strncmp(name, "hnbrdf_network", 14) == 0 ||
                   strncmp(name, "hnbrdf_hard_gelu", 16) == 0;
        }
    return 0;
}

/* Instructions in the bodies of all functions but the network's. */
static size_t outside_the_network(const char *scene, const char *body, size_t *bytes)
{
    uint32_t *spirv = gpu_run_compile(scene, body, 0, bytes);
    size_t count = 0, words = *bytes / 4;
    int inside = 0;
    for (size_t at = HEADER_WORDS; at < words; at += spirv[at] >> 16) {
        uint32_t op = spirv[at] & 0xffff;
        assert_true(spirv[at] >> 16 > 0);
        if (op == OP_FUNCTION)
            inside = !is_network(spirv, words, spirv[at + 2]);
        count += (size_t)(inside && op != OP_LABEL && op != OP_LINE);
        if (op == OP_FUNCTION_END)
            inside = 0;
    }
    free(spirv);
    return count;
}

/* All that the full shader can do. */
static const char EVAL_AND_SAMPLE[] =
    "void main() {\n"
    "    uint k = gl_GlobalInvocationID.x;\n"
    "    if (k >= count)\n        return;\n"
    "    hnbrdf_material m = hnbrdf_scene_material(material);\n"
    "    vec3 wo = in_vec3(6 * k);\n"
    "    hnbrdf_sample_result r = hnbrdf_sample(m, wo, in_vec3(6 * k + 3).xy);\n"
    "    store3(3 * k, hnbrdf_eval(m, r.wi, wo) * hnbrdf_pdf(m, r.wi, wo) + r.weight);\n"
    "}\n";

/* The full shader serves anisotropic and rotated materials that may change, and samples. */
static char *full_scene(const hnbrdf_model *model)
{
    hnbrdf_packing packing;
    assert_int_equal(hnbrdf_packing_init(model, NULL, 0, HNBRDF_TEXEL_RGBA16F, &packing, NULL),
                     HNBRDF_OK);
    packing.anisotropic = packing.rotated = 1;
    return gpu_run_export(model, &(hnbrdf_glsl_options){.packing = &packing});
}

static void an_isotropic_scene_that_only_evaluates_is_smaller(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&PLAIN);
    const int first = 0;
    const hnbrdf_glsl_options options = {
        .materials = &first, .material_count = 1, .only = HNBRDF_GLSL_EVAL, .fixed = 1};
    char *full = full_scene(model), *stripped = gpu_run_export(model, &options);
    size_t full_bytes, eval_bytes, stripped_bytes;
    size_t all = outside_the_network(full, EVAL_AND_SAMPLE, &full_bytes);
    size_t eval = outside_the_network(full, EVAL, &eval_bytes);
    size_t least = outside_the_network(stripped, EVAL, &stripped_bytes);
    printf("SPIR-V outside of the network: full shader %zu instructions (%zu bytes in all), "
           "evaluation "
           "with the "
           "full shader %zu (%zu), stripped %zu (%zu)\n",
           all, full_bytes, eval, eval_bytes, least, stripped_bytes);
    assert_true((double)least <= 0.75 * (double)all); /* the bar */
    assert_true(least < eval && stripped_bytes < eval_bytes);
    free(full);
    free(stripped);
    hnbrdf_model_free(model);
}

static void a_stripped_text_has_only_what_it_calls(void **state)
{
    (void)state;
    static const char *const gone[] = {"hnbrdf_encode_directions",
                                       "hnbrdf_encode_half_difference",
                                       "hnbrdf_to_tangent",
                                       "hnbrdf_sincos_turn",
                                       "hnbrdf_draw_ggx",
                                       "hnbrdf_compose_neural",
                                       "hnbrdf_sample",
                                       "hnbrdf_density",
                                       "hnbrdf_fresnel_dielectric",
                                       ".kd,",
                                       "latent0",
                                       "// ----"};
    hnbrdf_model *model = scene_model(&PLAIN);
    hnbrdf_glsl_options options = {.standalone = 1, .only = HNBRDF_GLSL_EVAL, .fixed = 1};
    char *text = gpu_run_export(model, &options);
    for (size_t i = 0; i < sizeof gone / sizeof gone[0]; i++)
        if (strstr(text, gone[i]))
            fail_msg("%s is still there", gone[i]);
    assert_non_null(strstr(text, "\nvec3 hnbrdf_finish("));
    assert_non_null(strstr(text, "//   left out   anisotropy, rotation, materials that change"));
    free(text);
    hnbrdf_model_free(model);
}

/* Nothing of edits is in the text of a scene that has none and does not ask. */
static void edits_are_written_for_edited_materials_alone(void **state)
{
    (void)state;
    scene_shape edited = PLAIN;
    edited.edited = 1;
    hnbrdf_model *plain = scene_model(&PLAIN), *changed = scene_model(&edited);
    const int first = 0;
    for (int fixed = 0; fixed < 2; fixed++)
        for (int standalone = 0; standalone < 2; standalone++) {
            hnbrdf_glsl_options options = {.standalone = standalone, .fixed = fixed};
            char *texts[4];
            texts[0] = gpu_run_export(plain, &options);
            options.editable = 1;
            texts[1] = gpu_run_export(plain, &options);
            options.editable = 0;
            texts[2] = gpu_run_export(changed, &options);
            options.materials = &first; /* which is as it was fitted */
            options.material_count = 1;
            texts[3] = gpu_run_export(changed, &options);
            const int wanted[4] = {0, !fixed, 1, 0};
            for (int k = 0; k < 4; k++) {
                assert_int_equal(strstr(texts[k], "hnbrdf_edit") != NULL, wanted[k]);
                assert_int_equal(strstr(texts[k], "hnbrdf_warp") != NULL, wanted[k]);
                free(texts[k]);
            }
        }
    hnbrdf_model_free(plain);
    hnbrdf_model_free(changed);
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&PLAIN);
    hnbrdf_packing packing;
    hnbrdf_error error = {""};
    assert_int_equal(hnbrdf_packing_init(model, NULL, 0, HNBRDF_TEXEL_RGBA8, &packing, NULL),
                     HNBRDF_OK);
    hnbrdf_glsl_options options = {.fixed = 1, .packing = &packing};
    assert_int_equal(hnbrdf_export_shader(model, &options, gpu_run_append, NULL, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "textures"));
    options = (hnbrdf_glsl_options){.only = (hnbrdf_glsl_only)7};
    assert_int_equal(hnbrdf_export_shader(model, &options, gpu_run_append, NULL, &error),
                     HNBRDF_ERROR_ARGUMENT);
    packing.latent = 3;
    options = (hnbrdf_glsl_options){.packing = &packing};
    assert_int_equal(hnbrdf_export_shader(model, &options, gpu_run_append, NULL, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "3 latent"));
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(evaluation_alone_has_the_values_of_c),
        cmocka_unit_test(fixed_materials_have_the_values_of_c),
        cmocka_unit_test(one_fixed_material_has_the_values_of_c),
        cmocka_unit_test(an_isotropic_scene_that_only_evaluates_is_smaller),
        cmocka_unit_test(a_stripped_text_has_only_what_it_calls),
        cmocka_unit_test(edits_are_written_for_edited_materials_alone),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    return gpu_run_tests(tests, sizeof tests / sizeof tests[0]);
}
