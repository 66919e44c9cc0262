/* test_export_brdf.c: .brdf files that hnbrdf writes are the same model when they are read back,
 * and a heading that says something else is refused with its line. */
#include "core_support.h"
#include "gpu_support.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const scene_shape SHAPES[] = {
    {.encoding = HNBRDF_ENCODING_DIRECTIONS, .hidden = 8, .layers = 2, .latent = 4, .scale = 0.5f},
    {.encoding = HNBRDF_ENCODING_ANGLES, .hidden = 9, .layers = 3, .latent = 16, .shift = -1.5f},
    {.encoding = HNBRDF_ENCODING_ANGLES_ANISOTROPIC,
     .hidden = 5,
     .layers = 1,
     .latent = 1,
     .anisotropic = 1,
     .rotated = 1,
     .edited = 1,
     .floor = 0.0025f},
    {.kind = HNBRDF_KIND_NEURAL,
     .encoding = HNBRDF_ENCODING_HALF_DIFFERENCE,
     .hidden = 6,
     .layers = 2,
     .latent = 12,
     .rotated = 1,
     .scale = 2.0f},
    {.kind = HNBRDF_KIND_GGX, .anisotropic = 1, .rotated = 1},
    {.kind = HNBRDF_KIND_GGX}};
enum { SHAPE_COUNT = sizeof SHAPES / sizeof *SHAPES, TEXT = 1 << 18 };

typedef struct text {
    char bytes[TEXT];
    size_t size;
} text;

static int append(void *user, const void *data, size_t size)
{
    text *to = user;
    assert_true(to->size + size < TEXT);
    memcpy(to->bytes + to->size, data, size);
    to->bytes[to->size += size] = '\0';
    return 0;
}

static void export(const hnbrdf_model *model, int material, text *to)
{
    hnbrdf_error error = {""};
    to->size = 0;
    const hnbrdf_glsl_options options = {
        .materials = &material, .material_count = 1, .language = HNBRDF_LANGUAGE_BRDF};
    if (hnbrdf_export_shader(model, &options, append, to, &error))
        fail_msg("%s", error.text);
}

static void assert_same_material(const hnbrdf_material *a, const hnbrdf_material *b,
                                 const hnbrdf_model_desc *desc)
{
    if (desc->kind != HNBRDF_KIND_NEURAL) {
        assert_same_bits(a->kd, b->kd, 3);
        assert_same_bits(a->eta, b->eta, 3);
        assert_same_bits(a->alpha, b->alpha, 2);
    }
    assert_same_bits(&a->rotation, &b->rotation, 1);
    assert_same_bits(a->latent, b->latent, desc->latent);
    assert_memory_equal(&a->lobes, &b->lobes, sizeof a->lobes);
    assert_int_equal(hnbrdf_material_is_edited(a), hnbrdf_material_is_edited(b));
    if (hnbrdf_material_is_edited(a))
        assert_memory_equal(&a->fitted, &b->fitted, sizeof a->fitted);
}

static void assert_same_model(const hnbrdf_model *a, const hnbrdf_model *b)
{
    hnbrdf_model_desc one, two;
    hnbrdf_model_describe(a, &one);
    hnbrdf_model_describe(b, &two);
    assert_int_equal(one.kind, two.kind);
    for (int m = 0; m < one.material_count; m++)
        assert_same_material(&one.materials[m], &two.materials[m], &one);
    if (one.kind == HNBRDF_KIND_GGX)
        return;
    assert_int_equal(one.encoding, two.encoding);
    assert_int_equal(one.latent, two.latent);
    assert_int_equal(one.hidden, two.hidden);
    assert_int_equal(one.layers, two.layers);
    assert_same_bits(&one.scale, &two.scale, 1);
    assert_same_bits(&one.shift, &two.shift, 1);
    assert_same_bits(&one.floor, &two.floor, 1);
    const int outputs = one.kind == HNBRDF_KIND_NEURAL ? 3 : 6;
    for (int k = 0; k <= one.layers; k++) {
        const int in = k == 0 ? 6 + one.latent : one.hidden,
                  out = k == one.layers ? outputs : one.hidden;
        assert_same_bits(one.weights[k], two.weights[k], in * out);
        assert_same_bits(one.biases[k], two.biases[k], out);
    }
}

static void written_files_are_the_model_again(void **state)
{
    (void)state;
    static text texts[SCENE_MATERIALS];
    for (int s = 0; s < SHAPE_COUNT; s++) {
        hnbrdf_model *model = scene_model(&SHAPES[s]), *again = NULL;
        hnbrdf_model_desc desc;
        const char *bytes[SCENE_MATERIALS];
        size_t sizes[SCENE_MATERIALS];
        hnbrdf_error error = {""};
        hnbrdf_model_describe(model, &desc);
        assert_int_equal(desc.material_count, SCENE_MATERIALS);
        for (int m = 0; m < SCENE_MATERIALS; m++) {
            export(model, m, &texts[m]);
            bytes[m] = texts[m].bytes;
            sizes[m] = texts[m].size;
        }
        if (hnbrdf_model_import_brdf(bytes, sizes, desc.names, SCENE_MATERIALS, NULL, &again,
                                     &error))
            fail_msg("%d: %s", s, error.text);
        assert_same_model(model, again);
        hnbrdf_model_free(again);
        hnbrdf_model_free(model);
    }
}

/* BRDF Explorer passes such lines over, also in the shader. */
static void nothing_of_the_shader_begins_with_a_hash(void **state)
{
    (void)state;
    static text file;
    for (int s = 0; s < SHAPE_COUNT; s++) {
        hnbrdf_model *model = scene_model(&SHAPES[s]);
        export(model, 0, &file);
        const char *shader = strstr(file.bytes, "::begin shader\n");
        assert_non_null(shader);
        for (const char *line = shader; line; line = strchr(line, '\n')) {
            line += strspn(line, " \t\n");
            assert_true(*line != '#');
        }
        assert_non_null(strstr(shader, "\nvec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)\n"));
        assert_null(strstr(shader, "HNBRDF_EXP"));
        assert_null(strstr(shader, "HNBRDF_PRECISE"));
        hnbrdf_model_free(model);
    }
}

static void what_a_file_cannot_hold_is_refused(void **state)
{
    (void)state;
    static text file;
    hnbrdf_model *model = scene_model(&SHAPES[0]);
    hnbrdf_error error = {""};
    hnbrdf_glsl_options options = {.language = HNBRDF_LANGUAGE_BRDF};
    file.size = 0;
    assert_int_equal(hnbrdf_export_shader(model, &options, append, &file, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_string_equal(error.text, "export: 3 materials, expected one: a .brdf file holds one");
    const int one = 1;
    options.materials = &one;
    options.material_count = 1;
    options.precision = HNBRDF_GLSL_HALF;
    assert_int_equal(hnbrdf_export_shader(model, &options, append, &file, &error),
                     HNBRDF_ERROR_ARGUMENT);
    options.precision = HNBRDF_GLSL_FLOAT;
    options.fixed = 1;
    assert_int_equal(hnbrdf_export_shader(model, &options, append, &file, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(file.size, 0);
    hnbrdf_model_free(model);
}

/* ---- Headings -------------------------------------------------------------------------------- */

/* The file with `from` replaced by `to`, read as the only one, or beside the file as it is. */
static void refused(const text *file, const char *from, const char *to, int beside,
                    const char *message)
{
    static text changed;
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    const char *at = strstr(file->bytes, from);
    assert_non_null(at);
    changed.size = 0;
    append(&changed, file->bytes, (size_t)(at - file->bytes));
    append(&changed, to, strlen(to));
    append(&changed, at + strlen(from), file->size - (size_t)(at - file->bytes) - strlen(from));
    const char *const texts[] = {file->bytes, changed.bytes}, *const names[] = {"a", "b"};
    const size_t sizes[] = {file->size, changed.size};
    assert_int_not_equal(hnbrdf_model_import_brdf(texts + !beside, sizes + !beside, names + !beside,
                                                  beside ? 2 : 1, NULL, &model, &error),
                         HNBRDF_OK);
    assert_string_equal(error.text, message);
    assert_null(model);
}

static void wrong_headings_are_refused_with_their_line(void **state)
{
    (void)state;
    static text file;
    hnbrdf_model *model = scene_model(&SHAPES[2]);
    export(model, 1, &file);
    refused(&file, "kind hybrid", "kind hybird", 0,
            "b: line 5: found ' hybird', expected hybrid, neural or ggx");
    refused(&file, "kind hybrid", "kind hybrid neural", 0,
            "b: line 5: found 'neural', expected the end of the line");
    refused(&file, "kind hybrid", "kind neural", 0,
            "b: mlp_eval has 2 layers and 6 outputs, expected at least 2 layers and 3 outputs");
    refused(&file, "kind hybrid", "kind ggx", 0,
            "b: mlp_eval has 2 layers and 6 outputs, expected none of a ggx material");
    refused(&file, "encoding angles-anisotropic", "encoding polar", 0,
            "b: line 6: found ' polar', expected the name of an encoding");
    refused(&file, "# hnbrdf/1 scale", "# hnbrdf/1 size", 0,
            "b: line 7: found 'size 1.0', expected kind, encoding, scale, shift, floor, fitted, "
            "lobes or energy");
    refused(&file, "floor 0.00249999994", "floor none", 0,
            "b: line 9: found 'none', expected a number");
    refused(&file, "floor 0.00249999994", "floor 0.5", 1,
            "b: is hybrid, encoding angles-anisotropic, floor 0.5, expected hybrid, "
            "angles-anisotropic, 0.00249999994 as in a");
    refused(&file, "# hnbrdf/1 scale 1.0", "# hnbrdf/1 scale 0", 0,
            "b: exp(S*(neural_output) + M) has S 0, expected another number");
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(written_files_are_the_model_again),
        cmocka_unit_test(nothing_of_the_shader_begins_with_a_hash),
        cmocka_unit_test(what_a_file_cannot_hold_is_refused),
        cmocka_unit_test(wrong_headings_are_refused_with_their_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
