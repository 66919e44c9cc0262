/* test_glsl_prefix.c: exports with a prefix: three networks of different kinds in one shader give
 * the values of C, and without one nothing of a text changes. */
#include "gpu_run.h"
#include "gpu_support.h"

#include "check/pairs.h"
#include "hnbrdf/measured.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRS = 512, SCENES = 3, WORDS = 8, RESULTS = 11 * SCENES };

static const scene_shape SHAPES[SCENES] = {
    {.encoding = HNBRDF_ENCODING_ANGLES, .hidden = 16, .layers = 2, .latent = 4, .floor = 0.003f},
    {.kind = HNBRDF_KIND_NEURAL,
     .encoding = HNBRDF_ENCODING_DIRECTIONS,
     .hidden = 9,
     .layers = 3,
     .latent = 5,
     .scale = 2.0f},
    {.kind = HNBRDF_KIND_GGX, .anisotropic = 1, .rotated = 1}};

/* f, a sample and a density of each. */
static const char BODY[] =
    "#define CALL(name, at)                                                                   \\\n"
    "    store3(at, name##_eval(name##_scene_material(material), wi, wo));                    \\\n"
    "    s = name##_sample(name##_scene_material(material), wo, u);                           \\\n"
    "    store3(at + 3, s.wi);                                                                \\\n"
    "    store3(at + 6, s.weight);                                                            \\\n"
    "    results[at + 9] = s.pdf;                                                             \\\n"
    "    results[at + 10] = name##_pdf(name##_scene_material(material), wi, wo);\n"
    "void main()\n"
    "{\n"
    "    uint k = gl_GlobalInvocationID.x;\n"
    "    if (k >= count)\n"
    "        return;\n"
    "    vec3 wi = in_vec3(8 * k), wo = in_vec3(8 * k + 3);\n"
    "    vec2 u = vec2(in_float(8 * k + 6), in_float(8 * k + 7));\n"
    "    hnbrdf_sample_result s;\n"
    "    CALL(gold, 33 * k)\n"
    "    CALL(Silk, 33 * k + 11)\n"
    "    CALL(hnbrdf, 33 * k + 22)\n"
    "}\n";

static void as_in_c(const hnbrdf_model *model, int material, const float *in, float *out)
{
    const hnbrdf_material *m = hnbrdf_model_material(model, material);
    hnbrdf_sample_result s;
    hnbrdf_eval(model, m, in, in + 3, out);
    hnbrdf_sample(model, m, in + 3, in + 6, &s);
    memcpy(out + 3, s.wi, sizeof s.wi);
    memcpy(out + 6, s.weight, sizeof s.weight);
    out[9] = s.pdf;
    out[10] = hnbrdf_pdf(model, m, in, in + 3);
}

static void draw_inputs(float *in)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 11, 0);
    for (int k = 0; k < PAIRS; k++) {
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, in + WORDS * k, in + WORDS * k + 3);
        in[WORDS * k + 6] = hnbrdf_rng_float(&rng);
        in[WORDS * k + 7] = hnbrdf_rng_float(&rng);
    }
}

static void three_networks_of_one_shader_are_those_of_c(void **state)
{
    (void)state;
    static const char *const prefixes[SCENES] = {"gold", "Silk", NULL};
    static float in[WORDS * PAIRS], device[RESULTS * PAIRS], expected[RESULTS * PAIRS];
    gpu_run_text all = {0};
    hnbrdf_model *models[SCENES];
    for (int i = 0; i < SCENES; i++) {
        models[i] = scene_model(&SHAPES[i]);
        const hnbrdf_glsl_options options = {
            .prefix = prefixes[i], .weights = i == 1 ? HNBRDF_GLSL_COLUMNS : HNBRDF_GLSL_CONSTANTS};
        char *text = gpu_run_export(models[i], &options);
        for (int twice = 0; twice < 2; twice++) /* the same again is left out */
            assert_int_equal(gpu_run_append(&all, text, strlen(text)), 0);
        free(text);
    }
    draw_inputs(in);
    for (int material = 0; material < SCENE_MATERIALS; material++) {
        gpu_run(all.bytes, BODY, 1, material, PAIRS, in, WORDS * PAIRS, device, RESULTS * PAIRS);
        gpu_run_c_begin();
        for (int k = 0; k < PAIRS; k++)
            for (int i = 0; i < SCENES; i++)
                as_in_c(models[i], material, in + WORDS * k, expected + RESULTS * k + 11 * i);
        gpu_run_c_end();
        if (gpu_run_exact())
            gpu_run_assert_same("a network of three", device, expected, RESULTS * PAIRS);
    }
    free(all.bytes);
    for (int i = 0; i < SCENES; i++)
        hnbrdf_model_free(models[i]);
}

/* hnbrdf is the prefix of a text without one. */
static void a_text_without_a_prefix_stays(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        hnbrdf_model *model = scene_model(&SHAPES[i]);
        char *plain = gpu_run_export(model, NULL);
        char *same = gpu_run_export(model, &(hnbrdf_glsl_options){.prefix = "hnbrdf"});
        assert_string_equal(plain, same);
        free(plain);
        free(same);
        hnbrdf_model_free(model);
    }
}

static void a_prefix_that_glsl_refuses_is_an_error(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "",    "1a", "_a",   "a_",       "a__b",     "a-b",
        "a b", "gl", "GL_x", "hnbrdf_x", "\xc3\xa4", "a1234567890123456789012345678901234567890"};
    hnbrdf_model *model = scene_model(&SHAPES[2]);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        gpu_run_text text = {0};
        hnbrdf_error error = {""};
        const hnbrdf_glsl_options options = {.prefix = wrong[i]};
        assert_int_equal(hnbrdf_export_shader(model, &options, gpu_run_append, &text, &error),
                         HNBRDF_ERROR_ARGUMENT);
        assert_non_null(strstr(error.text, "the prefix is"));
        assert_null(text.bytes);
    }
    hnbrdf_model_free(model);
}

/* What is left is code: no comment, no empty line, and everything else as it was. */
static void comments_can_be_left_out(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&SHAPES[0]);
    hnbrdf_glsl_options options = {.standalone = 1};
    char *with = gpu_run_export(model, &options);
    options.without_comments = 1;
    char *without = gpu_run_export(model, &options), *to = with;
    assert_null(strstr(without, "//"));
    assert_null(strstr(without, "\n\n"));
    assert_null(strstr(without, " \n"));
    for (const char *line = with; *line;) { /* the same by hand */
        size_t length = strcspn(line, "\n"), code = length;
        for (size_t i = 0; i + 1 < length && code == length; i++)
            code = line[i] == '/' && line[i + 1] == '/' ? i : code;
        while (code > 0 && line[code - 1] == ' ')
            code--;
        const char *next = line + length + 1;
        memmove(to, line, code);
        to += code;
        if (code > 0)
            *to++ = '\n';
        line = next;
    }
    *to = '\0';
    assert_string_equal(with, without);
    free(with);
    free(without);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_networks_of_one_shader_are_those_of_c),
        cmocka_unit_test(a_text_without_a_prefix_stays),
        cmocka_unit_test(a_prefix_that_glsl_refuses_is_an_error),
        cmocka_unit_test(comments_can_be_left_out),
    };
    return gpu_run_tests(tests, sizeof tests / sizeof tests[0]);
}
