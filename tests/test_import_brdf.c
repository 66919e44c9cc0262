/* test_import_brdf.c: published .brdf shaders become the model they write out, in any layout of
 * their text, and anything else is refused with its file and line. `test_import_brdf --write
 * DIRECTORY` writes the sample files of tests/data anew. */
#include "brdf_sample.h"
#include "fitted_support.h"

#include "core/network.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MAX_FILES = 4 };

static hnbrdf_material sample_material(uint64_t seed, const brdf_sample *s)
{
    rng r = rng_make(seed);
    hnbrdf_material m = random_material(&r, !s->anisotropic);
    m.rotation = 0;
    for (int i = s->latent; i < HNBRDF_MAX_LATENT; i++)
        m.latent[i] = 0;
    return m;
}

/* What the last import told of, line by line. */
static char notes[2048];

static void keep_note(void *user, const char *line)
{
    (void)user;
    const size_t length = strlen(notes);
    snprintf(notes + length, sizeof notes - length, "%s\n", line);
}

/* Imports from blocks of exactly their size. */
static hnbrdf_result import(const bytes *texts, int count, const hnbrdf_allocator *allocator,
                            hnbrdf_model **model, hnbrdf_error *error)
{
    static const char *const NAMES[MAX_FILES] = {"one", "two", "three", "four"};
    const char *blocks[MAX_FILES] = {NULL};
    size_t sizes[MAX_FILES] = {0};
    for (int i = 0; i < count; i++) {
        char *copy = malloc(texts[i].size ? texts[i].size : 1);
        assert_non_null(copy);
        if (texts[i].size)
            memcpy(copy, texts[i].data, texts[i].size);
        blocks[i] = copy;
        sizes[i] = texts[i].size;
    }
    error->text[0] = '\0';
    const hnbrdf_import_options options = {
        .allocator = allocator ? *allocator : (hnbrdf_allocator){0}, .notes = {keep_note, NULL}};
    notes[0] = '\0';
    const hnbrdf_result result =
        hnbrdf_model_import_brdf(blocks, sizes, NAMES, count, &options, model, error);
    for (int i = 0; i < count; i++)
        free((void *)blocks[i]);
    return result;
}

/* ---- What is imported ------------------------------------------------------------------------ */

static const struct {
    int hidden, layers, latent, anisotropic, dense, materials;
} SHAPES[] = {{32, 2, 4, 0, 0, 2}, {32, 2, 4, 1, 1, 2},  {16, 3, 4, 0, 1, 3},
              {8, 1, 3, 0, 1, 1},  {64, 4, 16, 1, 0, 1}, {12, 2, 5, 0, 1, 2},
              {4, 2, 0, 0, 0, 1},  {6, 2, 1, 1, 1, 1},   {7, 3, 8, 0, 0, 1}};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES };

static hnbrdf_model *import_sample(const brdf_sample *s, int materials)
{
    bytes texts[MAX_FILES] = {{NULL, 0}};
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    for (int i = 0; i < materials; i++) {
        const hnbrdf_material m = sample_material((uint64_t)i + 1, s);
        texts[i] = brdf_sample_text(s, &m);
    }
    if (import(texts, materials, NULL, &model, &error))
        fail_msg("%s", error.text);
    for (int i = 0; i < materials; i++)
        free_bytes(&texts[i]);
    return model;
}

static void make_shape(brdf_sample *s, int i)
{
    make_brdf_sample(s, (uint64_t)i + 1, SHAPES[i].hidden, SHAPES[i].layers, SHAPES[i].latent);
    s->anisotropic = SHAPES[i].anisotropic;
    s->dense = SHAPES[i].dense;
}

static void an_imported_model_is_what_the_text_says(void **state)
{
    static brdf_sample s;
    (void)state;
    for (int i = 0; i < SHAPE_COUNT; i++) {
        make_shape(&s, i);
        hnbrdf_model *model = import_sample(&s, SHAPES[i].materials);
        hnbrdf_model_desc desc;
        hnbrdf_model_describe(model, &desc);
        assert_int_equal(desc.kind, HNBRDF_KIND_HYBRID);
        assert_int_equal(desc.encoding, HNBRDF_ENCODING_DIRECTIONS);
        assert_int_equal(desc.hidden, s.hidden);
        assert_int_equal(desc.layers, s.layers);
        assert_int_equal(desc.latent, s.latent);
        assert_true(desc.scale == 0.75f && desc.shift == -1.25f && desc.floor == 0);
        for (int k = 0; k <= s.layers; k++) {
            const int in = brdf_sample_inputs(&s, k), out = brdf_sample_outputs(&s, k);
            assert_same_bits(desc.weights[k], s.weights[k], in * out);
            assert_same_bits(desc.biases[k], s.biases[k], out);
        }
        for (int m = 0; m < desc.material_count; m++) {
            const hnbrdf_material expected = as_fitted(sample_material((uint64_t)m + 1, &s));
            assert_memory_equal(&desc.materials[m], &expected, sizeof expected);
        }
        hnbrdf_model_free(model);
    }
}

/* The matrices as printed, evaluated directly: bias, latent inputs, encoded directions, product by
 * product, which is what the core promises too: hence no tolerance. */
static void evaluate(const brdf_sample *s, const float *latent, const float x[6], float out[64])
{
    float values[64], sums[64];
    for (int k = 0; k <= s->layers; k++) {
        const int in = brdf_sample_inputs(s, k);
        for (int r = 0; r < brdf_sample_outputs(s, k); r++) {
            const float *row = s->weights[k] + r * in;
            float sum = s->biases[k][r];
            for (int c = 0; k == 0 && c < s->latent; c++)
                sum += row[6 + c] * latent[c];
            for (int c = 0; k == 0 && c < 6; c++)
                sum += row[c] * x[c];
            for (int c = 0; k > 0 && c < in; c++)
                sum += row[c] * values[c];
            sums[r] = k < s->layers ? hnbrdf_hard_gelu(sum) : sum;
        }
        memcpy(values, sums, sizeof values);
    }
    memcpy(out, values, 6 * sizeof *out);
}

static void an_imported_network_gives_the_values_of_the_shader(void **state)
{
    static brdf_sample s;
    rng r = rng_make(11);
    (void)state;
    for (int i = 0; i < SHAPE_COUNT; i++) {
        make_shape(&s, i);
        hnbrdf_model *model = import_sample(&s, 1);
        hnbrdf_model_desc desc;
        hnbrdf_model_describe(model, &desc);
        for (int k = 0; k < 200; k++) {
            float x[6], found[6], expected[64] = {0};
            direction_uniform(&r, x);
            direction_uniform(&r, x + 3);
            hnbrdf_network(&desc, desc.materials[0].latent, x, found);
            evaluate(&s, desc.materials[0].latent, x, expected);
            assert_same_bits(found, expected, 6);
        }
        hnbrdf_model_free(model);
    }
}

static void the_exponent_is_read_in_any_notation(void **state)
{
    static const struct {
        const char *text;
        float scale, shift;
    } CASES[] = {{"0.5*(neural_output) + -1.5", 0.5f, -1.5f},
                 {"0.5*(neural_output) - 1.5", 0.5f, -1.5f},
                 {"0.5 * neural_output - -1.5", 0.5f, 1.5f},
                 {"neural_output*0.5+1.5", 0.5f, 1.5f},
                 {"(neural_output)", 1, 0},
                 {"-2.0*(neural_output)", -2, 0},
                 {"1.5 + (0.5)*(neural_output)", 0.5f, 1.5f},
                 {"5e-1f*(neural_output) + (-1.5e0)", 0.5f, -1.5f}};
    static brdf_sample s;
    (void)state;
    make_brdf_sample(&s, 1, 4, 1, 2);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        hnbrdf_model_desc desc;
        s.exponent = CASES[i].text;
        hnbrdf_model *model = import_sample(&s, 1);
        hnbrdf_model_describe(model, &desc);
        if (desc.scale != CASES[i].scale || desc.shift != CASES[i].shift)
            fail_msg("%s: %g and %g", CASES[i].text, (double)desc.scale, (double)desc.shift);
        hnbrdf_model_free(model);
    }
}

static void line_endings_and_tabs_do_not_matter(void **state)
{
    static brdf_sample s;
    hnbrdf_material m;
    hnbrdf_model *plain, *other = NULL;
    hnbrdf_error error;
    bytes wide = {NULL, 0};
    (void)state;
    make_brdf_sample(&s, 1, 8, 2, 4);
    m = sample_material(1, &s);
    plain = import_sample(&s, 1);
    bytes text = brdf_sample_text(&s, &m);
    for (size_t i = 0; i < text.size; i++) {
        const char c = (char)text.data[i];
        write_bytes(&wide,
                    c == '\n'  ? "\r\n"
                    : c == ' ' ? "\t "
                               : (const char *)&c,
                    c == '\n' || c == ' ' ? 2 : 1);
    }
    assert_int_equal(import(&wide, 1, NULL, &other, &error), HNBRDF_OK);
    assert_same_model(plain, other);
    free_bytes(&text);
    free_bytes(&wide);
    hnbrdf_model_free(plain);
    hnbrdf_model_free(other);
}

/* ---- Values out of range --------------------------------------------------------------------- */

/* A text of 4x1 whose line for `parameter` says `value`. */
static bytes with_value(const char *parameter, const char *value, int anisotropic)
{
    static brdf_sample s;
    char line[64];
    make_brdf_sample(&s, 1, 4, 1, 2);
    s.anisotropic = anisotropic;
    const hnbrdf_material m = sample_material(1, &s);
    bytes text = brdf_sample_text(&s, &m), result = {NULL, 0};
    snprintf(line, sizeof line, "float %s ", parameter);
    const char *all = (const char *)text.data, *at = strstr(all, line);
    assert_non_null(at);
    const char *end = strchr(at, '\n');
    write_bytes(&result, all, (size_t)(at - all) + strlen(line));
    write_bytes(&result, "0 1 ", 4);
    write_bytes(&result, value, strlen(value));
    write_bytes(&result, end, text.size - (size_t)(end - all));
    free_bytes(&text);
    return result;
}

static void values_a_little_out_of_range_are_moved_and_told(void **state)
{
    static const struct {
        const char *parameter, *value;
        int anisotropic;
        size_t offset; /* of what it sets */
        float expected;
        const char *note;
    } CASES[] = {
        {"diffuse_r", "1.0000001", 0, offsetof(hnbrdf_material, kd[0]), 1,
         "diffuse_r of one is 1.0000001, taken as 1, the largest there is"},
        {"diffuse_b", "1.01", 0, offsetof(hnbrdf_material, kd[2]), 1, "diffuse_b of one is 1.01, "},
        {"alpha", "1.005", 0, offsetof(hnbrdf_material, alpha[1]), 1,
         "alpha of one is 1.005, taken as 1, the largest there is"},
        {"alpha_y", "1.005", 1, offsetof(hnbrdf_material, alpha[1]), 1,
         "alpha_y of one is 1.005, "},
        {"alpha", "1e-6", 0, offsetof(hnbrdf_material, alpha[0]), HNBRDF_MIN_ALPHA,
         "is 1e-06, taken as 0.0001, the smallest that evaluation uses"},
        {"alpha_x", "0", 1, offsetof(hnbrdf_material, alpha[0]), HNBRDF_MIN_ALPHA,
         "alpha_x of one is 0, taken as 0.0001"},
        {"eta_g", "1.0", 0, offsetof(hnbrdf_material, eta[1]), 1.00000012f,
         "eta_g of one is 1, taken as 1.0000001, the smallest above 1"},
        {"diffuse_r", "1", 0, offsetof(hnbrdf_material, kd[0]), 1, NULL},
        {"alpha", "1", 0, offsetof(hnbrdf_material, alpha[0]), 1, NULL},
    };
    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        bytes text = with_value(CASES[k].parameter, CASES[k].value, CASES[k].anisotropic);
        hnbrdf_model *model = NULL;
        hnbrdf_error error;
        float value;
        if (import(&text, 1, NULL, &model, &error) != HNBRDF_OK)
            fail_msg("%s", error.text);
        const char *material = (const char *)hnbrdf_model_material(model, 0);
        memcpy(&value, material + CASES[k].offset, sizeof value);
        assert_true(value == CASES[k].expected);
        if (CASES[k].note ? !strstr(notes, CASES[k].note) || strncmp(notes, "one: line ", 10) != 0
                          : notes[0] != '\0')
            fail_msg("\"%s\", expected \"%s\"", notes, CASES[k].note ? CASES[k].note : "");
        assert_true(!notes[0] || strchr(notes, '\n') == notes + strlen(notes) - 1); /* one line */
        free_bytes(&text);
        hnbrdf_model_free(model);
    }
}

static void values_far_out_of_range_are_refused(void **state)
{
    static const char *const CASES[][3] = {
        {"diffuse_r", "1.0101", "kd[0] is 1.0101, expected 0 to 1"},
        {"diffuse_g", "-1e-6", "kd[1] is -1e-06, expected 0 to 1"},
        {"alpha", "1.0101", "alpha[0] is 1.0101"},
        {"alpha", "-1e-6", "alpha[0] is -1e-06"},
        {"eta_b", "0.99999", "eta[2] is 0.99999, expected above 1"},
        {"diffuse_r", "-0.5", "kd[0] is -0.5"}};
    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        bytes text = with_value(CASES[k][0], CASES[k][1], 0);
        hnbrdf_model *model = NULL;
        hnbrdf_error error;
        assert_int_equal(import(&text, 1, NULL, &model, &error), HNBRDF_ERROR_FORMAT);
        if (strncmp(error.text, "one: ", 5) != 0 || !strstr(error.text, CASES[k][2]))
            fail_msg("\"%s\", expected \"%s\"", error.text, CASES[k][2]);
        assert_string_equal(notes, "");
        free_bytes(&text);
    }
}

/* ---- Names ----------------------------------------------------------------------------------- */

static void published_names_become_those_of_the_measurements(void **state)
{
    static const struct {
        const char *path, *name;
        int published;
    } CASES[] = {{"shaders/RGL/Ours_ld4_32x2_aurora_white_rgb.brdf", "aurora_white", 1},
                 {"Ours_ld16_64x3_alum-bronze.brdf", "alum-bronze", 1},
                 {"Ours_ld4_32x2_x_rgb_rgb.brdf", "x_rgb", 1},
                 {"Ours_ld4_32x2_my.best.brdf", "my.best", 1},
                 {"Ours_ld4_32x2_rgb.brdf", "rgb", 1},
                 {"Ours_ld4_32x2__rgb.brdf", "_rgb", 1},
                 {"aurora_white_rgb.brdf", "aurora_white_rgb", 0},
                 {"Ours_ld4_32x2_.brdf", "Ours_ld4_32x2_", 0},
                 {"Ours_ld4_32x2.brdf", "Ours_ld4_32x2", 0},
                 {"Ours_32x2_gold.brdf", "Ours_32x2_gold", 0},
                 {"Ours_ld_32x2_gold.brdf", "Ours_ld_32x2_gold", 0},
                 {"Ours_ld4_32x_gold.brdf", "Ours_ld4_32x_gold", 0},
                 {"ours_ld4_32x2_gold.brdf", "ours_ld4_32x2_gold", 0},
                 {"not_Ours_ld4_32x2_gold_rgb.brdf", "not_Ours_ld4_32x2_gold_rgb", 0},
                 {"Neural_ld4_32x2_gold.brdf", "Neural_ld4_32x2_gold", 0},
                 {"a.b/gold", "gold", 0},
                 {".brdf", ".brdf", 0}};
    char name[64];
    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        assert_int_equal(hnbrdf_import_name(CASES[k].path, name, sizeof name), CASES[k].published);
        assert_string_equal(name, CASES[k].name);
    }
    memset(name, 'z', sizeof name);
    hnbrdf_import_name("gold.brdf", name, 3);
    assert_string_equal(name, "go");
    assert_int_equal(name[3], 'z');
    hnbrdf_import_name("gold.brdf", NULL, 0);
}

static void messages_call_texts_by_their_files(void **state)
{
    static const char *const names[] = {"gold"}, *const files[] = {"shaders/gold.brdf"};
    const hnbrdf_import_options options = {.files = files};
    const char *const texts[] = {"analytic"};
    const size_t sizes[] = {8};
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    (void)state;
    assert_int_equal(hnbrdf_model_import_brdf(texts, sizes, names, 1, &options, &model, &error),
                     HNBRDF_ERROR_FORMAT);
    assert_memory_equal(error.text, "shaders/gold.brdf: has no parameter", 35);
}

static void what_is_no_shader_is_named(void **state)
{
    static const char *const CASES[][2] = {
        {"\x76\x2f\x31\x01\x02", "one: an OpenEXR picture, expected a published .brdf"},
        {"tensor_file", "measured data in a tensor file"},
        {"<?xml version=\"1.0\"?>", "an XML text"},
        {"PK\3\4", "a zip archive"}};
    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        const bytes file = {(unsigned char *)(uintptr_t)CASES[k][0], strlen(CASES[k][0])};
        hnbrdf_model *model = NULL;
        hnbrdf_error error;
        assert_int_equal(import(&file, 1, NULL, &model, &error), HNBRDF_ERROR_FORMAT);
        if (!strstr(error.text, CASES[k][1]))
            fail_msg("\"%s\", expected \"%s\"", error.text, CASES[k][1]);
    }
}

/* ---- Files of one dataset -------------------------------------------------------------------- */

static void expect_pair(const brdf_sample *a, const brdf_sample *b, const char *part)
{
    const hnbrdf_material m = sample_material(1, a);
    bytes texts[2] = {brdf_sample_text(a, &m), brdf_sample_text(b, &m)};
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    const hnbrdf_result result = import(texts, 2, NULL, &model, &error);
    if (result != HNBRDF_ERROR_FORMAT || strncmp(error.text, "two: ", 5) != 0 ||
        !strstr(error.text, part))
        fail_msg("result %d \"%s\", expected \"two: ... %s\"", (int)result, error.text, part);
    assert_null(model);
    free_bytes(&texts[0]);
    free_bytes(&texts[1]);
}

static void files_with_different_networks_are_told_apart(void **state)
{
    static brdf_sample a, b;
    (void)state;
    make_brdf_sample(&a, 1, 8, 2, 2);
    b = a;
    b.weights[1][5 * 8 + 3] = 0.25f;
    expect_pair(&a, &b, "layer 1: weight of output 5, input 3 is 0.25, expected ");
    b = a;
    b.biases[2][4] = -1;
    expect_pair(&a, &b, "layer 2: bias of output 4, input 0 is -1, expected ");
    b = a;
    b.exponent = "0.75*(neural_output) + -1.5";
    expect_pair(&a, &b, "M -1.5, expected 0.75 and -1.25 as in one");
    make_brdf_sample(&b, 1, 12, 2, 2);
    expect_pair(&a, &b, "is 12x2 with 8 inputs, expected 8x2");
    make_brdf_sample(&b, 1, 8, 3, 2);
    expect_pair(&a, &b, "is 8x3");
    make_brdf_sample(&b, 1, 8, 2, 3);
    expect_pair(&a, &b, "with 9 inputs");
}

static void two_materials_need_two_names(void **state)
{
    static const char *const NAMES[] = {"same", "same"};
    static brdf_sample s;
    hnbrdf_material m;
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    (void)state;
    make_brdf_sample(&s, 1, 4, 1, 2);
    m = sample_material(1, &s);
    bytes text = brdf_sample_text(&s, &m);
    const char *const texts[] = {(const char *)text.data, (const char *)text.data};
    const size_t sizes[] = {text.size, text.size};
    assert_int_equal(hnbrdf_model_import_brdf(texts, sizes, NAMES, 2, NULL, &model, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_model_import_brdf(texts, sizes, NAMES, 0, NULL, &model, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_model_import_brdf(texts, sizes, NAMES, 65537, NULL, &model, &error),
                     HNBRDF_ERROR_LIMIT);
    assert_int_equal(hnbrdf_model_import_brdf(NULL, sizes, NAMES, 1, NULL, &model, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_null(model);
    free_bytes(&text);
}

/* ---- Refusals -------------------------------------------------------------------------------- */

static bytes replaced(const bytes *text, const char *old, const char *new_text)
{
    for (size_t i = 0; i + strlen(old) <= text->size; i++) {
        if (memcmp(text->data + i, old, strlen(old)) == 0) {
            bytes b = {NULL, 0};
            write_bytes(&b, text->data, i);
            write_bytes(&b, new_text, strlen(new_text));
            write_bytes(&b, text->data + i + strlen(old), text->size - i - strlen(old));
            return b;
        }
    }
    fail_msg("no \"%s\" in the sample", old);
    return *text;
}

/* 8x2, l = 2: every weight is 0.5, every bias 0.25, so that places in the text are known. */
static bytes plain_text(int dense)
{
    static brdf_sample s;
    hnbrdf_material m;
    make_brdf_sample(&s, 1, 8, 2, 2);
    s.dense = dense;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 64; i++) {
            s.weights[k][i] = 0.5f;
            s.biases[k][i] = 0.25f;
        }
    hnbrdf_material_init(&m);
    m.latent[0] = m.latent[1] = 0;
    return brdf_sample_text(&s, &m);
}

static void refuses(const char *old, const char *new_text, hnbrdf_result expected, const char *part)
{
    bytes good = plain_text(0), bad = replaced(&good, old, new_text);
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    const hnbrdf_result result = import(&bad, 1, NULL, &model, &error);
    if (result != expected || strncmp(error.text, "one: ", 5) != 0 || !strstr(error.text, part))
        fail_msg("%s -> %s: result %d \"%s\", expected %d with \"%s\"", old, new_text, (int)result,
                 error.text, (int)expected, part);
    assert_null(model);
    free_bytes(&good);
    free_bytes(&bad);
}

static void wrong_parameters_are_named(void **state)
{
    const hnbrdf_result format = HNBRDF_ERROR_FORMAT;
    (void)state;
    refuses("diffuse_g", "diffuse_x", format, "no parameter line for diffuse_g");
    refuses("eta_b 1.0 10.0", "eta_b 1.0", format, "no parameter line for eta_b");
    refuses("float eta_b", "float eta_r", format, "found eta_r again, expected it once");
    refuses("eta_r 1.0 10.0 1.5", "eta_r 1.0 10.0 0.99", format, "eta");
    refuses("diffuse_r 0.0 1.0 0.5", "diffuse_r 0.0 1.0 1.5", format, "kd");
    refuses("alpha 0.0001 1.0 0.5", "alpha 0.0001 1.0 -0.5", format, "alpha");
    refuses("alpha 0.0001 1.0 0.5", "alpha 0.0001 1.0 1.5", format, "alpha");
    refuses("float alpha ", "float alpha_x ", format,
            "lines for alpha_x, expected alpha, or alpha_x and alpha_y");
    refuses("float alpha ", "float roughness ", format, "no alpha, expected alpha");
    refuses("latent_0", "latent_2", format, "no parameter line for latent_0, but a later one");
    refuses("float latent_1", "float gamma2", format, "mlp_eval has 8 inputs, expected 7");
    refuses("latent_1", "latent_16", HNBRDF_ERROR_LIMIT,
            "found latent_16, expected at most latent_15");
}

static void wrong_networks_are_named(void **state)
{
    const hnbrdf_result format = HNBRDF_ERROR_FORMAT;
    (void)state;
    refuses("mlp_eval(vec3 wi, vec3 wo, out vec3 c, out vec3 g)\n{", "mlp(vec3 wi)\n{", format,
            "no function mlp_eval");
    refuses("vec3 BRDF(", "void mlp_eval() {} vec3 BRDF(", format,
            "expected one function mlp_eval");
    refuses("hardGeLU(mat", "sin(mat", format, "found sin, expected hardGeLU as the activation");
    refuses("vec4 f1_1 = hardGeLU(mat", "vec4 f1_1 = (mat", format,
            "found (, expected the name of a vector");
    refuses("mat4(0.5, 0.5", "mat4(0.5", format, "expected ',' and more numbers");
    refuses("mat4(0.5, 0.5", "mat4(0.5, 0.5, 0.5", format, "expected ')' after the last number");
    refuses("mat4(0.5, 0.5", "mat4(0.5, x", format, "found x, expected a number");
    refuses("mat4(0.5, 0.5", "mat4(0.5, 1e40", format, "expected a number");
    refuses("* f0_0 +", "f0_0 +", format, "expected '*' after a matrix");
    refuses("* f0_0 +", "* f0_0 *", format, "expected '+', '-' or ')' of hardGeLU");
    refuses("* f0_1 +", "* f0_0 +", format, "4 columns are multiplied by f0_0");
    refuses("* f1_1 +", "* f7_1 +", format, "multiplied by f7_1");
    refuses("+ vec4(0.25, ", "+ vec4(0.25) + vec4(0.25, ", format, "after a second vector");
    refuses("+ vec4(0.25, 0.25, 0.25, 0.25)", "+ vec2(0.25,0.25)", format, "more or fewer rows");
    refuses("vec4 f2_1 = hardGeLU(mat4", "vec4 f2_1 = mat4", format, "expected '+', '-' or ';'");
    refuses("vec2 f3_1",
            "vec2 unused; vec2 f3_1 = mat4x2(0,0,0,0,0,0,0,0) * f2_0 + vec2(0,0); vec2 f3_2",
            format, "f3_1 multiplies 4 inputs, expected all 8");
    refuses(
        "vec2 f3_1 = mat4x2",
        "vec3 f3_1 = mat4x3(0,0,0,0,0,0,0,0,0,0,0,0) * f2_0 + mat4x3(0,0,0,0,0,0,0,0,0,0,0,0) * "
        "f2_1; vec2 f3_2 = mat4x2",
        HNBRDF_ERROR_UNSUPPORTED, "9 outputs, expected at least 2 layers and 6 outputs");
    refuses("neural_output = exp(", "neural_output = sin(", format,
            "has no line neural_output = exp(");
    refuses("exp(0.75*(neural_output)", "exp(0.75*(other)", format,
            "found other, expected a number, or neural_output once");
    refuses("exp(0.75*(neural_output)", "exp(0.75", format, "expected exp(S*(neural_output) + M)");
    refuses("exp(0.75*(neural_output)", "exp(0.0*(neural_output)", format, "has S 0");
}

static void layers_beyond_the_limits_are_refused(void **state)
{
    static brdf_sample s;
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    bytes text = {NULL, 0};
    hnbrdf_material m;
    (void)state;
    make_brdf_sample(&s, 1, 64, 4, 16);
    m = sample_material(1, &s);
    text = brdf_sample_text(&s, &m);
    bytes wide =
        replaced(&text, "vec4 f2_0",
                 "vec4 f1_16 = hardGeLU(mat4(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0) * f0_0); vec4 f2_0");
    assert_int_equal(import(&wide, 1, NULL, &model, &error), HNBRDF_ERROR_LIMIT);
    assert_non_null(strstr(error.text, "expected at most 64"));
    free_bytes(&wide);
    free_bytes(&text);

    const char *deep =
        "float diffuse_r 0 1 0\nvoid mlp_eval(vec3 x) {\n"
        "vec2 a = hardgelu(mat2(0,0,0,0) * x); vec2 b = hardgelu(mat2(0,0,0,0) * a);\n"
        "vec2 c = hardgelu(mat2(0,0,0,0) * b); vec2 d = hardgelu(mat2(0,0,0,0) * c);\n"
        "vec2 e = hardgelu(mat2(0,0,0,0) * d); vec2 f = mat2(0,0,0,0) * e; }";
    write_bytes(&text, deep, strlen(deep));
    assert_int_equal(import(&text, 1, NULL, &model, &error), HNBRDF_ERROR_LIMIT);
    assert_non_null(strstr(error.text, "line 5: found one more layer, expected at most 4 hidden"));
    assert_null(model);
    free_bytes(&text);
}

static void every_truncation_and_random_damage_is_survived(void **state)
{
    static const char LETTERS[] = "(){};,.*+-=0123456789efvmatx_/ \n\x80";
    rng r = rng_make(12);
    (void)state;
    for (int dense = 0; dense < 2; dense++) {
        bytes good = plain_text(dense);
        hnbrdf_error error;
        int imported = 0;
        for (size_t size = 0; size < good.size; size += 1 + size / 200) {
            hnbrdf_model *model = NULL;
            bytes cut = {good.data, size};
            if (import(&cut, 1, NULL, &model, &error) == HNBRDF_OK)
                imported++;
            else
                assert_true(strlen(error.text) > 10);
            hnbrdf_model_free(model);
        }
        assert_true(imported < 60); /* only the last lines, after neural_output, can be missing */
        for (int i = 0; i < 2000; i++) {
            bytes bad = {NULL, 0};
            hnbrdf_model *model = NULL;
            write_bytes(&bad, good.data, good.size);
            for (unsigned k = rng_u32(&r) % 3 + 1; k > 0; k--)
                bad.data[rng_u32(&r) % bad.size] =
                    (unsigned char)LETTERS[rng_u32(&r) % (sizeof LETTERS - 1)];
            if (import(&bad, 1, NULL, &model, &error) != HNBRDF_OK) {
                assert_null(model);
                assert_true(strlen(error.text) > 10);
                assert_null(strchr(error.text, '\n'));
            }
            hnbrdf_model_free(model);
            free_bytes(&bad);
        }
        free_bytes(&good);
    }
}

static void every_failed_allocation_is_reported_without_a_leak(void **state)
{
    bytes text = plain_text(0);
    hnbrdf_result result = HNBRDF_ERROR_MEMORY;
    long k;
    (void)state;
    for (k = 0; result == HNBRDF_ERROR_MEMORY && k < 10; k++) {
        counting count = {.fail_at = k};
        const hnbrdf_allocator allocator = counting_allocator(&count);
        hnbrdf_model *model = NULL;
        hnbrdf_error error;
        result = import(&text, 1, &allocator, &model, &error);
        assert_int_equal(result == HNBRDF_OK, model != NULL);
        hnbrdf_model_free(model);
        assert_int_equal(count.alive, 0);
    }
    assert_int_equal(result, HNBRDF_OK);
    assert_int_equal(k, 3); /* the import, the model, then none */
    free_bytes(&text);
}

/* ---- tests/data ------------------------------------------------------------------------------ */

/* Two materials of one dataset, small enough to be read. */
static const char *const DATA_FILES[] = {"sample_brushed.brdf", "sample_plain.brdf"};

static bytes data_text(int i)
{
    static brdf_sample s;
    make_brdf_sample(&s, 42, 8, 2, 4);
    s.anisotropic = i == 0;
    s.dense = i == 1;
    hnbrdf_material m = {.kd = {0.25f, 0.125f, 0.0625f},
                         .eta = {1.5f, 1.75f, 2.0f},
                         .alpha = {0.25f, i == 0 ? 0.0625f : 0.25f},
                         .latent = {0.5f, -0.25f, 0.125f, (float)i}};
    return brdf_sample_text(&s, &m);
}

static void the_sample_files_are_what_this_test_writes(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        char path[1024], buffer[4096];
        bytes expected = data_text(i), found = {NULL, 0};
        size_t count;
        snprintf(path, sizeof path, "%s/%s", HNBRDF_TEST_DATA, DATA_FILES[i]);
        FILE *file = fopen(path, "rb");
        assert_non_null(file);
        while ((count = fread(buffer, 1, sizeof buffer, file)) > 0)
            write_bytes(&found, buffer, count);
        fclose(file);
        assert_int_equal(found.size, expected.size);
        assert_memory_equal(found.data, expected.data, found.size);
        free_bytes(&expected);
        free_bytes(&found);
    }
}

static void the_sample_files_are_one_dataset(void **state)
{
    bytes texts[2] = {data_text(0), data_text(1)};
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    (void)state;
    if (import(texts, 2, NULL, &model, &error))
        fail_msg("%s", error.text);
    assert_int_equal(hnbrdf_model_material_count(model), 2);
    assert_int_equal(hnbrdf_model_weight_count(model), 10 * 8 + 8 + 8 * 8 + 8 + 8 * 6 + 6);
    hnbrdf_model_free(model);
    free_bytes(&texts[0]);
    free_bytes(&texts[1]);
}

static int write_samples(const char *directory)
{
    int failed = 0;
    for (int i = 0; i < 2; i++) {
        char path[1024];
        bytes text = data_text(i);
        snprintf(path, sizeof path, "%s/%s", directory, DATA_FILES[i]);
        FILE *file = fopen(path, "wb");
        failed |= !file || fwrite(text.data, 1, text.size, file) != text.size;
        failed |= !file || fclose(file) != 0;
        free_bytes(&text);
    }
    return failed;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_imported_model_is_what_the_text_says),
        cmocka_unit_test(an_imported_network_gives_the_values_of_the_shader),
        cmocka_unit_test(the_exponent_is_read_in_any_notation),
        cmocka_unit_test(line_endings_and_tabs_do_not_matter),
        cmocka_unit_test(values_a_little_out_of_range_are_moved_and_told),
        cmocka_unit_test(values_far_out_of_range_are_refused),
        cmocka_unit_test(published_names_become_those_of_the_measurements),
        cmocka_unit_test(messages_call_texts_by_their_files),
        cmocka_unit_test(what_is_no_shader_is_named),
        cmocka_unit_test(files_with_different_networks_are_told_apart),
        cmocka_unit_test(two_materials_need_two_names),
        cmocka_unit_test(wrong_parameters_are_named),
        cmocka_unit_test(wrong_networks_are_named),
        cmocka_unit_test(layers_beyond_the_limits_are_refused),
        cmocka_unit_test(every_truncation_and_random_damage_is_survived),
        cmocka_unit_test(every_failed_allocation_is_reported_without_a_leak),
        cmocka_unit_test(the_sample_files_are_what_this_test_writes),
        cmocka_unit_test(the_sample_files_are_one_dataset),
    };
    if (argc == 3 && strcmp(argv[1], "--write") == 0)
        return write_samples(argv[2]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
