/* test_glsl_export.c: what the exporter writes, read as text. */
#include "gpu_support.h"

#include "base/text.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const scene_shape PLAIN = {.encoding = HNBRDF_ENCODING_HALF_DIFFERENCE,
                                  .hidden = 8,
                                  .layers = 2,
                                  .latent = 4,
                                  .floor = 0.003f};

static char *export_shape(const scene_shape *shape)
{
    hnbrdf_model *model = scene_model(shape);
    char *text = scene_text(model, 0);
    hnbrdf_model_free(model);
    return text;
}

static int contains(const char *text, const char *part)
{
    return strstr(text, part) != NULL;
}

static int identifier(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

/* The text behind "{" of this function, up to the closing brace in the first column. */
static char *body_of(const char *text, const char *function)
{
    const char *begin = strstr(text, function);
    assert_non_null(begin);
    const char *end = strstr(begin, "\n}");
    assert_non_null(end);
    size_t length = (size_t)(end - begin);
    char *body = malloc(length + 1);
    assert_non_null(body);
    memcpy(body, begin, length);
    body[length] = '\0';
    return body;
}

/* ---- Numbers --------------------------------------------------------------------------------- */

/* GLSL ES has no conversion from int to float. */
static void every_literal_of_the_network_is_a_float(void **state)
{
    (void)state;
    char *text = export_shape(&PLAIN), *body = body_of(text, "void hnbrdf_network");
    int numbers = 0;
    for (const char *c = body + 1; *c; c++) {
        if (!isdigit((unsigned char)*c) || identifier(c[-1]) || c[-1] == '.')
            continue;
        size_t length = strspn(c, "0123456789.e");
        while (c[length - 1] == 'e')
            length += strspn(c + length, "+-0123456789");
        assert_true(memchr(c, '.', length) || memchr(c, 'e', length));
        numbers++;
        c += length - 1;
    }
    assert_int_equal(numbers, 8 * 10 + 8 + 8 * 8 + 8 + 6 * 8 + 6);
    free(body);
    free(text);
}

/* Every weight and bias, read back from the text in the canonical order, has the bits it had. */
static void numbers_read_back_with_the_same_bits(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&PLAIN);
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    char *text = scene_text(model, 0);
    const char *at = strstr(text, "a_0 = hnbrdf_hard_gelu(") + strlen("a_0 = hnbrdf_hard_gelu(");
    float expected[11] = {desc.biases[0][0]};
    for (int i = 0; i < 4; i++)
        expected[1 + i] = desc.weights[0][6 + i];
    for (int i = 0; i < 6; i++)
        expected[5 + i] = desc.weights[0][i];
    for (int i = 0; i < 11; i++) {
        float value = 0.0f;
        int negative = 0;
        for (; !isdigit((unsigned char)*at); at++)
            negative = *at == '-' || (negative && *at == ' ');
        at = hnbrdf_parse_float(at, at + 40, &value);
        assert_non_null(at);
        value = negative ? -value : value;
        assert_memory_equal(&value, &expected[i], sizeof value);
        at += strspn(at, " *");
        at += strspn(at, "abcdefghijklmnopqrstuvwxyz_0123456789."); /* the input it multiplies */
    }
    free(text);
    hnbrdf_model_free(model);
}

static void identical_models_give_identical_texts(void **state)
{
    (void)state;
    char *first = export_shape(&PLAIN), *second = export_shape(&PLAIN);
    assert_string_equal(first, second);
    free(first);
    free(second);
}

/* ---- What is there and what is not ----------------------------------------------------------- */

static void what_the_scene_does_not_need_is_left_out(void **state)
{
    (void)state;
    char *plain = export_shape(&PLAIN);
    assert_true(contains(plain, "float alpha;"));
    assert_false(contains(plain, "vec2 rotation"));
    assert_false(contains(plain, "hnbrdf_to_tangent"));
    assert_true(contains(plain, "vec3 exp_arg = c_net;"));
    free(plain);
    scene_shape shape = PLAIN;
    shape.anisotropic = shape.rotated = 1;
    shape.scale = 2.5f;
    shape.shift = -0.5f;
    char *rich = export_shape(&shape);
    assert_true(contains(rich, "vec2 alpha;"));
    assert_true(contains(rich, "vec2 rotation;"));
    assert_true(contains(rich, "hnbrdf_to_tangent(material_in.rotation, wi)"));
    assert_true(contains(rich, "vec3 exp_arg = 2.5 * c_net + -0.5;"));
    free(rich);
    char *ggx = export_shape(&(scene_shape){.kind = HNBRDF_KIND_GGX});
    assert_false(contains(ggx, "latent"));
    assert_false(contains(ggx, "hnbrdf_network"));
    free(ggx);
    char *neural = export_shape(
        &(scene_shape){.kind = HNBRDF_KIND_NEURAL, .hidden = 4, .layers = 1, .latent = 5});
    assert_false(contains(neural, " kd;"));
    assert_true(contains(neural, "vec4 latent1;"));
    assert_false(contains(neural, "vec4 latent2;"));
    free(neural);
}

static void the_heading_tells_what_is_inside(void **state)
{
    (void)state;
    char *text = export_shape(&PLAIN);
    assert_true(contains(text, "kind       hybrid"));
    assert_true(contains(text, "10 -> 8 -> 8 -> 6 (8x2)"));
    assert_true(contains(text, "half-difference"));
    assert_true(contains(text, "weights    214, 856 bytes"));
    free(text);
}

static void standalone_carries_the_library_first(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&PLAIN);
    char *text = scene_text(model, 1);
    const char *library = strstr(text, "#define HNBRDF_HYBRID_BRDF_GLSL");
    assert_non_null(library);
    assert_true(library < strstr(text, "struct hnbrdf_material"));
    assert_false(contains(text, "#version"));
    assert_false(contains(text, "#extension"));
    free(text);
    hnbrdf_model_free(model);
}

/* ---- Materials ------------------------------------------------------------------------------- */

static size_t times_in(const char *name, char *const *seen, size_t count)
{
    size_t same = 0;
    for (size_t i = 0; i < count; i++)
        same += strcmp(seen[i], name) == 0;
    return same;
}

static char *export_named(const char *const *names, int count)
{
    hnbrdf_material materials[8];
    for (int m = 0; m < count; m++)
        hnbrdf_material_init(&materials[m]);
    const hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = count, .materials = materials, .names = names};
    hnbrdf_model *model = NULL;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
    char *text = scene_text(model, 0);
    hnbrdf_model_free(model);
    return text;
}

/* Names that become one macro, none at all, or the name of the count. */
static void macro_names_are_valid_and_unique(void **state)
{
    (void)state;
    static const char *const names[8] = {"gold paint",   "gold-paint", "gold__paint",  "count",
                                         "\xe9\x87\x91", "-",          "gold paint 1", "7up\\"};
    char *text = export_named(names, 8), *seen[9];
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, "#define HNBRDF_MATERIAL_")) != NULL;) {
        at += strlen("#define ");
        size_t length = 0;
        while (identifier(at[length]))
            length++;
        assert_true(count < 9);
        seen[count] = strndup(at, length);
        assert_true(at[length] == ' ');
        assert_false(contains(seen[count], "__"));
        assert_int_equal(times_in(seen[count], seen, count), 0);
        count++;
    }
    assert_int_equal(count, 9);
    assert_string_equal(seen[8], "HNBRDF_MATERIAL_COUNT");
    while (count > 0)
        free(seen[--count]);
    assert_false(contains(text, "\\\n")); /* would continue the line */
    free(text);
}

/* ---- Failures -------------------------------------------------------------------------------- */

typedef struct limited {
    size_t left;
} limited;

static int write_limited(void *user, const void *data, size_t size)
{
    limited *to = user;
    (void)data;
    if (size > to->left)
        return 1;
    to->left -= size;
    return 0;
}

static void bad_indices_are_refused_before_anything_is_written(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&PLAIN);
    const int wrong[][2] = {{0, 3}, {-1, 0}, {2, 1 << 30}};
    for (int i = 0; i < 3; i++) {
        hnbrdf_error error = {""};
        limited nothing = {0};
        const hnbrdf_glsl_options options = {.materials = wrong[i], .material_count = 2};
        assert_int_equal(hnbrdf_export_shader(model, &options, write_limited, &nothing, &error),
                         HNBRDF_ERROR_ARGUMENT);
        assert_true(contains(error.text, "expected 0 to 2"));
    }
    const hnbrdf_glsl_options none = {.materials = wrong[0], .material_count = 0};
    assert_int_equal(hnbrdf_export_shader(model, &none, write_limited, NULL, NULL),
                     HNBRDF_ERROR_ARGUMENT);
    hnbrdf_model_free(model);
}

static void languages_have_names_and_what_is_none_is_refused(void **state)
{
    static const char *const names[] = {"glsl", "hlsl", "msl", "wgsl", "slang", "brdf"};
    enum { COUNT = sizeof names / sizeof *names };
    hnbrdf_shading_language language = HNBRDF_LANGUAGE_SLANG;
    hnbrdf_model *model = scene_model(&PLAIN);
    (void)state;
    for (int k = 0; k < COUNT; k++) {
        assert_string_equal(hnbrdf_shading_language_name((hnbrdf_shading_language)k), names[k]);
        assert_int_equal(hnbrdf_shading_language_from_name(names[k], &language), 1);
        assert_int_equal(language, k);
        assert_int_equal(hnbrdf_shading_language_weights(language),
                         k == HNBRDF_LANGUAGE_GLSL || k == HNBRDF_LANGUAGE_BRDF
                             ? HNBRDF_GLSL_CONSTANTS
                             : HNBRDF_GLSL_COLUMNS);
    }
    assert_null(hnbrdf_shading_language_name((hnbrdf_shading_language)COUNT));
    assert_null(hnbrdf_shading_language_name((hnbrdf_shading_language)-1));
    assert_int_equal(hnbrdf_shading_language_from_name("GLSL", &language), 0);
    assert_int_equal(language, HNBRDF_LANGUAGE_BRDF);
    const hnbrdf_glsl_options wrong[] = {{.language = (hnbrdf_shading_language)COUNT},
                                         {.exact = 1}};
    for (int k = 0; k < 2; k++) {
        limited nothing = {0};
        assert_int_equal(hnbrdf_export_shader(model, &wrong[k], write_limited, &nothing, NULL),
                         HNBRDF_ERROR_ARGUMENT);
    }
    hnbrdf_model_free(model);
}

static void a_failing_write_is_reported_wherever_it_happens(void **state)
{
    (void)state;
    hnbrdf_model *model = scene_model(&PLAIN);
    char *text = scene_text(model, 1);
    size_t size = strlen(text);
    const hnbrdf_glsl_options options = {.standalone = 1};
    for (size_t room = 0; room < size; room += 997) {
        limited to = {room};
        assert_int_equal(hnbrdf_export_shader(model, &options, write_limited, &to, NULL),
                         HNBRDF_ERROR_IO);
    }
    limited enough = {size};
    assert_int_equal(hnbrdf_export_shader(model, &options, write_limited, &enough, NULL),
                     HNBRDF_OK);
    assert_int_equal(enough.left, 0);
    free(text);
    hnbrdf_model_free(model);
}

/* ---- The material of an index ---------------------------------------------------------------- */

static const char *next_line(const char *line)
{
    const char *end = strchr(line, '\n');
    return end ? end + 1 : NULL;
}

/* The line behind this `if` and what it holds. */
static const char *skip_if(const char *line)
{
    const char *end = strchr(line, '\n');
    int depth = end[-1] == '{';
    if (!depth)
        return next_line(end + 1);
    for (line = end + 1; depth > 0; line = next_line(line)) {
        end = strchr(line, '\n');
        depth += (end[-1] == '{') - (end[-1] == '}');
    }
    return line;
}

/* kd.r of the material that the function's text returns for this index. */
static double returned(const char *body, int index)
{
    int place = index;
    const char *line = strstr(body, "{\n") + 2;
    while (line) {
        int number;
        double kd;
        const char *text = line + strspn(line, " ");
        if (sscanf(text, "int material_place = material_index < 0 ? %d", &number) == 1)
            place = index < 0 ? number : index;
        if (sscanf(text, "return hnbrdf_material(vec3(%lf", &kd) == 1)
            return kd;
        line = sscanf(text, "if (material_place < %d", &number) == 1 && place >= number
                   ? skip_if(line)
                   : next_line(line);
    }
    fail_msg("no material for %d", index);
    return 0.0;
}

static void every_index_has_its_material(void **state)
{
    enum { MOST = 64 };
    hnbrdf_material materials[MOST];
    char texts[MOST][8];
    const char *names[MOST];
    (void)state;
    for (int k = 0; k < MOST; k++) {
        hnbrdf_material_init(&materials[k]);
        materials[k].kd[0] = (float)(k + 1) / 128.0f;
        snprintf(texts[k], sizeof texts[k], "m%d", k);
        names[k] = texts[k];
    }
    for (int count = 1; count <= MOST; count += count < 9 ? 1 : 11) {
        hnbrdf_model *model;
        const hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_GGX,
                                        .material_count = count,
                                        .materials = materials,
                                        .names = names};
        assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
        char *text = scene_text(model, 0);
        char *body = body_of(text, "hnbrdf_material hnbrdf_scene_material(int");
        for (int index = -2; index < count + 2; index++) {
            const int stands_for = index < 0 || index >= count ? count - 1 : index;
            assert_true(returned(body, index) == (stands_for + 1) / 128.0);
        }
        free(body);
        free(text);
        hnbrdf_model_free(model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_literal_of_the_network_is_a_float),
        cmocka_unit_test(numbers_read_back_with_the_same_bits),
        cmocka_unit_test(identical_models_give_identical_texts),
        cmocka_unit_test(what_the_scene_does_not_need_is_left_out),
        cmocka_unit_test(the_heading_tells_what_is_inside),
        cmocka_unit_test(standalone_carries_the_library_first),
        cmocka_unit_test(macro_names_are_valid_and_unique),
        cmocka_unit_test(bad_indices_are_refused_before_anything_is_written),
        cmocka_unit_test(languages_have_names_and_what_is_none_is_refused),
        cmocka_unit_test(a_failing_write_is_reported_wherever_it_happens),
        cmocka_unit_test(every_index_has_its_material),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
