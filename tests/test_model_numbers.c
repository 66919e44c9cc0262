/* test_model_numbers.c: tensors of other types than F32, as other programs write them, become the
 * nearest floats and are told of; what does not fit and what is no number is refused by name. */
#include "model_support.h"

#include "core/half.h"
#include "file/numbers.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- Files of other writers ------------------------------------------------------------------ */

static void put(bytes *b, const void *data, size_t size)
{
    assert_int_equal(write_bytes(b, data, size), 0);
}

static void put_number(bytes *to, const char *type, float value)
{
    uint32_t bits;
    unsigned char little[8];
    uint64_t wide;
    double exact = (double)value;
    size_t size = 4;
    memcpy(&bits, &value, sizeof bits);
    wide = bits;
    if (strcmp(type, "F16") == 0) {
        wide = hnbrdf_half_of(value);
        size = 2;
    } else if (strcmp(type, "BF16") == 0) {
        wide = bits >> 16;
        size = 2;
    } else if (strcmp(type, "F64") == 0) {
        memcpy(&wide, &exact, sizeof wide);
        size = 8;
    }
    for (size_t k = 0; k < size; k++)
        little[k] = (unsigned char)(wide >> 8 * k);
    put(to, little, size);
}

/* The same model with its tensors of these types in turn, NULL at the end. */
static bytes converted(const bytes *file, const char *const *types)
{
    bytes header = {NULL, 0}, data = {NULL, 0}, all = {NULL, 0};
    uint64_t length = 0;
    for (int k = 7; k >= 0; k--)
        length = length << 8 | file->data[k];
    char *text = malloc((size_t)length + 1), *at = text;
    assert_non_null(text);
    memcpy(text, file->data + 8, (size_t)length);
    text[length] = '\0';
    const char *const *type = types;
    for (char *entry; (entry = strstr(at, "\"dtype\":\"F32\"")); type += type[1] ? 1 : 0) {
        unsigned long begin = 0, end = 0;
        char *offsets = strstr(entry, "\"data_offsets\":["), now[128];
        assert_non_null(offsets);
        assert_int_equal(sscanf(offsets, "\"data_offsets\":[%lu,%lu]", &begin, &end), 2);
        size_t first = data.size;
        for (unsigned long k = begin; k < end; k += 4) {
            const double value = hnbrdf_number_read(HNBRDF_NUMBER_F32, file->data + 8 + length + k);
            put_number(&data, *type, (float)value);
        }
        put(&header, at, (size_t)(entry - at));
        snprintf(now, sizeof now, "\"dtype\":\"%s\"", *type);
        put(&header, now, strlen(now));
        entry += strlen("\"dtype\":\"F32\"");
        put(&header, entry, (size_t)(offsets - entry));
        snprintf(now, sizeof now, "\"data_offsets\":[%zu,%zu]", first, data.size);
        put(&header, now, strlen(now));
        at = strchr(offsets, ']') + 1;
    }
    put(&header, at, strlen(at));
    for (int k = 0; k < 8; k++) {
        unsigned char byte = (unsigned char)((uint64_t)header.size >> 8 * k);
        put(&all, &byte, 1);
    }
    put(&all, header.data, header.size);
    put(&all, data.data, data.size);
    free(text);
    free_bytes(&header);
    free_bytes(&data);
    return all;
}

typedef struct told {
    int count;
    char line[512];
} told;

static void hear(void *user, const char *line)
{
    told *t = user;
    t->count++;
    snprintf(t->line, sizeof t->line, "%s", line);
}

static hnbrdf_result load(const bytes *file, hnbrdf_model **model, told *t, hnbrdf_error *error)
{
    const hnbrdf_load_options options = {.notes = {hear, t}};
    error->text[0] = '\0';
    *t = (told){0};
    return hnbrdf_model_load_memory(file->data, file->size, &options, model, error);
}

/* A model whose numbers all of these types hold. */
static bytes coarse_file(void)
{
    static const char *const to_bf16[] = {"BF16", NULL};
    hnbrdf_model *model = example_model(3, HNBRDF_KIND_HYBRID, 7, 2, 3, 5, 0), *firm, *rounded;
    hnbrdf_material materials[5];
    hnbrdf_model_desc desc;
    hnbrdf_error error;
    told t;
    hnbrdf_model_describe(model, &desc);
    for (int k = 0; k < 5; k++) {
        materials[k] = desc.materials[k];
        for (int c = 0; c < 3; c++)
            materials[k].eta[c] = 1.25f + 0.5f * (float)c; /* not rounded to 1 */
        memset(&materials[k].fitted, 0, sizeof materials[k].fitted);
    }
    desc.materials = materials;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &firm, NULL), HNBRDF_OK);
    bytes exact = model_bytes(firm), cut = converted(&exact, to_bf16);
    if (load(&cut, &rounded, &t, &error))
        fail_msg("%s", error.text);
    bytes result = model_bytes(rounded);
    hnbrdf_model_free(model);
    hnbrdf_model_free(firm);
    hnbrdf_model_free(rounded);
    free_bytes(&exact);
    free_bytes(&cut);
    return result;
}

static void tensors_of_any_float_type_give_the_same_model(void **state)
{
    static const char *const CHOICES[][4] = {
        {"F64", NULL}, {"BF16", NULL}, {"F16", NULL}, {"F32", "F16", "BF16", NULL}};
    static const char *const LINES[] = {
        "model in memory: 11 of 11 tensors were converted to F32, the first net.0.weight from F64",
        "model in memory: 11 of 11 tensors were converted to F32, the first net.0.weight from BF16",
        "model in memory: 11 of 11 tensors were converted to F32, the first net.0.weight from F16",
        "model in memory: 10 of 11 tensors were converted to F32, the first net.0.bias from F16"};
    bytes file = coarse_file();
    hnbrdf_model *model = NULL;
    hnbrdf_error error;
    told t;
    (void)state;
    assert_int_equal(load(&file, &model, &t, &error), HNBRDF_OK);
    assert_int_equal(t.count, 0);
    for (size_t k = 0; k < sizeof CHOICES / sizeof *CHOICES; k++) {
        bytes other = converted(&file, CHOICES[k]);
        hnbrdf_model *back = NULL;
        if (load(&other, &back, &t, &error))
            fail_msg("%s", error.text);
        assert_int_equal(t.count, 1);
        assert_string_equal(t.line, LINES[k]);
        assert_same_model(model, back);
        hnbrdf_model_free(back);
        /* Nobody needs to listen. */
        assert_int_equal(hnbrdf_model_load_memory(other.data, other.size, NULL, &back, NULL),
                         HNBRDF_OK);
        hnbrdf_model_free(back);
        free_bytes(&other);
    }
    hnbrdf_model_free(model);
    free_bytes(&file);
}

/* ---- Single numbers -------------------------------------------------------------------------- */

/* IEEE 754: sign, exponent, fraction, by their definition. */
static double decode(uint64_t bits, int exponent_bits, int fraction_bits)
{
    const int64_t bias = ((int64_t)1 << (exponent_bits - 1)) - 1;
    const int64_t exponent = (int64_t)(bits >> fraction_bits) & (2 * bias + 1);
    const double fraction = (double)(bits & (((uint64_t)1 << fraction_bits) - 1));
    const double unit = ldexp(1.0, -fraction_bits);
    const double size = exponent == 0 ? ldexp(fraction * unit, (int)(1 - bias))
                                      : ldexp(1 + fraction * unit, (int)(exponent - bias));
    return bits >> (exponent_bits + fraction_bits) ? -size : size;
}

static void every_short_number_is_exact(void **state)
{
    (void)state;
    for (uint32_t bits = 0; bits < 65536; bits++) {
        const unsigned char little[2] = {(unsigned char)bits, (unsigned char)(bits >> 8)};
        const double half = hnbrdf_number_read(HNBRDF_NUMBER_F16, little);
        const double brain = hnbrdf_number_read(HNBRDF_NUMBER_BF16, little);
        if ((bits & 0x7c00) != 0x7c00)
            assert_true(half == decode(bits, 5, 10));
        else
            assert_true(!isfinite(half));
        if ((bits & 0x7f80) != 0x7f80)
            assert_true(brain == decode(bits, 8, 7));
        else
            assert_true(!isfinite(brain));
    }
}

/* The file with one number of net.0.weight in F64. */
static hnbrdf_result load_double(double value, float *got, hnbrdf_error *error)
{
    static const char *const types[] = {"F64", NULL};
    bytes file = coarse_file(), wide = converted(&file, types);
    uint64_t length = 0, bits;
    hnbrdf_model *model = NULL;
    hnbrdf_model_desc desc;
    told t;
    for (int k = 7; k >= 0; k--)
        length = length << 8 | wide.data[k];
    memcpy(&bits, &value, sizeof bits);
    for (int k = 0; k < 8; k++)
        wide.data[8 + length + 5 * 8 + (uint64_t)k] = (unsigned char)(bits >> 8 * k);
    const hnbrdf_result result = load(&wide, &model, &t, error);
    if (!result) {
        hnbrdf_model_describe(model, &desc);
        *got = desc.weights[0][5];
    }
    hnbrdf_model_free(model);
    free_bytes(&file);
    free_bytes(&wide);
    return result;
}

static void doubles_go_to_the_nearest_float(void **state)
{
    static const struct {
        double given;
        float expected;
    } CASES[] = {
        {1 + 0x1p-24, 1},                      /* half way: to the even one */
        {1 + 0x1p-24 + 0x1p-50, 1 + 0x1p-23f}, /* just above */
        {1 + 3 * 0x1p-24, 1 + 0x1p-22f},       /* half way again */
        {-0x1.fffffe8p127, -FLT_MAX},          /* rounds down to the largest */
        {0x1p-150, 0},                         /* half of the smallest: to the even one */
        {0x1.8p-150, 0x1p-149f},               /* above half of it */
        {1e-300, 0},                           /* far below */
    };
    hnbrdf_error error;
    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        float got = -1;
        if (load_double(CASES[k].given, &got, &error))
            fail_msg("%s", error.text);
        assert_true(got == CASES[k].expected);
    }
}

static void numbers_that_do_not_fit_are_refused_by_their_place(void **state)
{
    static const struct {
        double given;
        const char *expected;
    } CASES[] = {
        {1e39, "tensor net.0.weight holds 1e+39 at index 5, expected finite numbers that fit"},
        {-0x1.ffffffp127, "tensor net.0.weight holds -3.40282e+38 at index 5"}, /* rounds up */
        {(double)INFINITY, "tensor net.0.weight holds an infinity at index 5, expected finite"},
        {(double)NAN, "tensor net.0.weight holds nan at index 5, expected finite"},
    };
    hnbrdf_error error;
    float got;
    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        assert_int_equal(load_double(CASES[k].given, &got, &error), HNBRDF_ERROR_FORMAT);
        if (!strstr(error.text, CASES[k].expected))
            fail_msg("\"%s\", expected \"%s\"", error.text, CASES[k].expected);
    }
}

/* ---- What is no number, and no model --------------------------------------------------------- */

static void other_types_are_refused_by_name(void **state)
{
    static const char *const TYPES[] = {"I8",   "U8",  "I16",     "U16",     "I32", "U32",
                                        "I64",  "U64", "BOOL",    "F8_E4M3", "F4",  "f32",
                                        "F128", "C64", "F8_E5M2", "F32 "};
    bytes file = coarse_file();
    (void)state;
    for (size_t k = 0; k < sizeof TYPES / sizeof *TYPES; k++) {
        char now[64], expected[96];
        hnbrdf_model *model = NULL;
        hnbrdf_error error;
        told t;
        snprintf(now, sizeof now, "\"dtype\":\"%s\"", TYPES[k]);
        snprintf(expected, sizeof expected,
                 "tensor net.0.weight: dtype is %s, expected F32, F16, BF16 or F64", TYPES[k]);
        bytes other = with_replaced(&file, "\"dtype\":\"F32\"", now);
        assert_int_equal(load(&other, &model, &t, &error), HNBRDF_ERROR_UNSUPPORTED);
        if (!strstr(error.text, expected))
            fail_msg("\"%s\", expected \"%s\"", error.text, expected);
        free_bytes(&other);
    }
    free_bytes(&file);
}

static void what_people_take_for_a_model_is_named(void **state)
{
    static const struct {
        const char *content, *expected;
    } CASES[] = {
        {"{\"metadata\": {\"total_size\": 9}, \"weight_map\": {\"net.0.weight\": \"a-1-of-2\"}}",
         "the index of a model in several files"},
        {"\n <!DOCTYPE HTML PUBLIC \"-//W3C//DTD HTML 4.01//EN\">", "an HTML page"},
        {"\xef\xbb\xbf<html><body>404</body></html>", "an HTML page"},
        {"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 9\n", "Git LFS"},
        {"PK\3\4 archive of PyTorch", "a zip archive"},
        {"\x1f\x8b packed", "compressed by gzip"},
        {"GGUF and more", "a GGUF model"},
        {"analytic\n\n::begin parameters\n", "a published .brdf shader"},
        {"tensor_file", "measured data in a tensor file"},
        {"#?RADIANCE\nFORMAT", "a Radiance picture"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        const bytes file = {(unsigned char *)(uintptr_t)CASES[k].content, strlen(CASES[k].content)};
        hnbrdf_model *model = NULL;
        hnbrdf_error error;
        told t;
        assert_int_equal(load(&file, &model, &t, &error), HNBRDF_ERROR_FORMAT);
        if (!strstr(error.text, CASES[k].expected) || !strstr(error.text, "safetensors"))
            fail_msg("\"%s\", expected \"%s\"", error.text, CASES[k].expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tensors_of_any_float_type_give_the_same_model),
        cmocka_unit_test(every_short_number_is_exact),
        cmocka_unit_test(doubles_go_to_the_nearest_float),
        cmocka_unit_test(numbers_that_do_not_fit_are_refused_by_their_place),
        cmocka_unit_test(other_types_are_refused_by_name),
        cmocka_unit_test(what_people_take_for_a_model_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
