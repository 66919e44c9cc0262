/* test_model_hostile.c: whatever the bytes of a model file are, loading ends with a model that
 * passes every check or with a result and one line that says where and why. Run it under ASan and
 * UBSan too. */
#include "model_support.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Loads from a block of exactly that size, so that AddressSanitizer sees a read behind it. On
 * failure the model must be untouched, the message one line, nothing leaked. */
static hnbrdf_result load(const unsigned char *data, size_t size, hnbrdf_error *error)
{
    counting count = {.fail_at = -1};
    const hnbrdf_load_options options = {.allocator = counting_allocator(&count)};
    unsigned char *copy = malloc(size ? size : 1);
    hnbrdf_model *model = NULL;
    assert_non_null(copy);
    if (size)
        memcpy(copy, data, size);
    error->text[0] = '\0';
    const hnbrdf_result result = hnbrdf_model_load_memory(copy, size, &options, &model, error);
    free(copy);
    if (result) {
        assert_null(model);
        assert_true(strlen(error->text) > 10);
        assert_null(strchr(error->text, '\n'));
    }
    /* No size in a file may make us ask for much more than the file has. */
    assert_true(count.largest <= 24 * size + 200000);
    hnbrdf_model_free(model);
    assert_int_equal(count.alive, 0);
    return result;
}

static void expect(const bytes *file, hnbrdf_result expected, const char *part)
{
    hnbrdf_error error;
    const hnbrdf_result result = load(file->data, file->size, &error);
    if (result != expected || (part && !strstr(error.text, part)))
        fail_msg("result %d \"%s\", expected %d with \"%s\"", (int)result, error.text,
                 (int)expected, part ? part : "");
}

/* The tests below spoil this one: hybrid 4x2, l = 2, 3 materials. */
enum { DATA_SIZE = 4 * (4 * 8 + 4 + 4 * 4 + 4 + 6 * 4 + 6 + 3 * (3 + 3 + 2 + 1 + 2)) };

static bytes good_file(void)
{
    hnbrdf_model *model = example_model(1, HNBRDF_KIND_HYBRID, 4, 2, 2, 3, 0);
    bytes b = model_bytes(model);
    hnbrdf_model_free(model);
    return b;
}

static void expect_replaced(const char *old, const char *new_text, hnbrdf_result expected,
                            const char *part)
{
    bytes good = good_file();
    bytes bad = with_replaced(&good, old, new_text);
    expect(&bad, expected, part);
    free_bytes(&good);
    free_bytes(&bad);
}

static void every_truncation_is_refused(void **state)
{
    bytes good = good_file();
    hnbrdf_error error;
    (void)state;
    for (size_t size = 0; size < good.size; size++) {
        const hnbrdf_result result = load(good.data, size, &error);
        if (result != HNBRDF_ERROR_FORMAT)
            fail_msg("%zu of %zu bytes: result %d \"%s\"", size, good.size, (int)result,
                     error.text);
    }
    assert_int_equal(load(good.data, good.size, &error), HNBRDF_OK);
    write_bytes(&good, "", 1);
    expect(&good, HNBRDF_ERROR_FORMAT, "expected all");
    free_bytes(&good);
}

static void absurd_header_lengths_are_refused(void **state)
{
    static const uint64_t LENGTHS[] = {0,          1,          UINT64_MAX,     (uint64_t)1 << 63,
                                       UINT32_MAX, 100000001u, UINT64_MAX - 7, UINT64_MAX - 8};
    bytes good = good_file();
    (void)state;
    for (size_t i = 0; i < sizeof LENGTHS / sizeof *LENGTHS; i++) {
        for (int k = 0; k < 8; k++)
            good.data[k] = (unsigned char)(LENGTHS[i] >> 8 * k);
        expect(&good, HNBRDF_ERROR_FORMAT, "give a header of");
    }
    free_bytes(&good);
}

static void other_files_are_refused_in_words(void **state)
{
    static const char *const HEADERS[] = {"",
                                          "[]",
                                          "{}",
                                          "{\"a\":1}",
                                          "{\"__metadata__\":[]}",
                                          "{\"__metadata__\":{\"a\":1}}",
                                          "null",
                                          " {}",
                                          "{} {}",
                                          "{\"a\":{}}",
                                          "{\"a\":[1]}",
                                          "{\"a\":null}",
                                          "{",
                                          "{\"a\"",
                                          "{\"a\":",
                                          "{\"a\":{\"dtype\"",
                                          "{\"\\ud800\":{}}",
                                          "{\"\x80\":{}}"};
    (void)state;
    for (size_t i = 0; i < sizeof HEADERS / sizeof *HEADERS; i++) {
        bytes b = file_with_header(HEADERS[i], 0);
        expect(&b, HNBRDF_ERROR_FORMAT, NULL);
        free_bytes(&b);
    }
    bytes text = {NULL, 0};
    write_bytes(&text, "P6 512 512 255 and so on, an image", 34);
    expect(&text, HNBRDF_ERROR_FORMAT, "not a safetensors file");
    free_bytes(&text);
}

static void deep_nesting_is_refused(void **state)
{
    enum { DEEP = 100000 };
    static char header[2 * DEEP + 16] = "{\"a\":";
    (void)state;
    for (int shape = 0; shape < 2; shape++) {
        strcpy(header, shape ? "{\"a\":{\"x\":" : "{\"a\":");
        memset(header + strlen(header), '[', DEEP);
        bytes b = file_with_header(header, 0);
        expect(&b, HNBRDF_ERROR_FORMAT, shape ? "64 levels" : "expected '{'");
        free_bytes(&b);
        memset(header, 0, sizeof header);
    }
}

static void spoiled_metadata_is_named(void **state)
{
    (void)state;
    expect_replaced("hnbrdf/1", "hnbrdf/2", HNBRDF_ERROR_UNSUPPORTED, "format is \"hnbrdf/2\"");
    expect_replaced("hnbrdf/1", "hnbrdf/10", HNBRDF_ERROR_UNSUPPORTED, "format is \"hnbrdf/10\"");
    expect_replaced("hnbrdf/1", "hnbrdf/1.7", HNBRDF_OK, NULL);
    expect_replaced("hnbrdf/1", "hnbrdf\\/1", HNBRDF_OK, NULL);
    expect_replaced("hnbrdf/1", "pt", HNBRDF_ERROR_FORMAT,
                    "format is \"pt\", expected \"hnbrdf/1\"");
    expect_replaced("\"format\"", "\"Format\"", HNBRDF_ERROR_FORMAT, "has no key format");
    expect_replaced("\"__metadata__\"", "\"net\"", HNBRDF_ERROR_FORMAT, "tensor net has no dtype");
    expect_replaced("hybrid", "hybird", HNBRDF_ERROR_FORMAT,
                    "kind is \"hybird\", expected hybrid, neural or ggx");
    expect_replaced("hybrid", "ggx", HNBRDF_ERROR_FORMAT,
                    "net.0.weight is not expected in a ggx model");
    expect_replaced("hybrid", "neural", HNBRDF_ERROR_FORMAT,
                    "net.2.weight has shape [6, 4], expected [3, 4]");
    expect_replaced("directions", "rusinkiewicz", HNBRDF_ERROR_FORMAT,
                    "encoding is \"rusinkiewicz\"");
    expect_replaced("\"encoding\"", "\"encodign\"", HNBRDF_ERROR_FORMAT, "has no key encoding");
    expect_replaced("\"kind\"", "\"format\"", HNBRDF_ERROR_FORMAT, "has the key format twice");
    expect_replaced("\"kind\"", "\"scale\":\"1,5\",\"kind\"", HNBRDF_ERROR_FORMAT,
                    "scale is \"1,5\", expected a decimal");
    expect_replaced("\"kind\"", "\"scale\":\"nan\",\"kind\"", HNBRDF_ERROR_FORMAT,
                    "scale is \"nan\"");
    expect_replaced("\"kind\"", "\"shift\":\"1e39\",\"kind\"", HNBRDF_ERROR_FORMAT,
                    "shift is \"1e39\"");
    expect_replaced("\"kind\"", "\"shift\":\"\",\"kind\"", HNBRDF_ERROR_FORMAT, "shift is \"\"");
    expect_replaced("\"kind\"", "\"scale\":\"0\",\"kind\"", HNBRDF_ERROR_FORMAT,
                    "scale is \"0\", expected a number that is not 0");
    expect_replaced("\"kind\"", "\"floor\":\"-1\",\"kind\"", HNBRDF_ERROR_FORMAT, "floor is -1");
    expect_replaced("\"kind\"", "\"scale\":1.5,\"kind\"", HNBRDF_ERROR_FORMAT,
                    "found '1', expected '\"'");
    expect_replaced("\"kind\"", "\"note\":\"kept by others\",\"kind\"", HNBRDF_OK, NULL);
    expect_replaced("{\"__metadata__\"", "{\"__metadata__\":{},\"__metadata__\"",
                    HNBRDF_ERROR_FORMAT, "appears twice");
}

static void spoiled_names_are_named(void **state)
{
    static const char LIST[] = "[\\\"m0\\\", \\\"m1\\\", \\\"m2\\\"]";
    (void)state;
    expect_replaced(LIST, "", HNBRDF_ERROR_FORMAT, "materials, byte 0 of the list: expected '['");
    expect_replaced(LIST, "[]", HNBRDF_ERROR_FORMAT, "holds 0 materials, expected 1 to 65536");
    expect_replaced(LIST, "[\\\"a\\\", \\\"b\\\"]", HNBRDF_ERROR_FORMAT,
                    "material.kd has shape [3, 3], expected [2, 3]");
    expect_replaced(LIST, "[\\\"a\\\", \\\"b\\\", \\\"b\\\"]", HNBRDF_ERROR_FORMAT,
                    "two materials are named b");
    expect_replaced(LIST, "[\\\"a\\\", \\\"b\\\", 3]", HNBRDF_ERROR_FORMAT, "expected '\"'");
    expect_replaced(LIST, "[\\\"a\\\", \\\"b\\\", \\\"c\\\"", HNBRDF_ERROR_FORMAT,
                    "expected ',' or ']'");
    expect_replaced(LIST, "[\\\"a\\\", \\\"b\\\", \\\"c\\\"] x", HNBRDF_ERROR_FORMAT,
                    "expected the end");
    expect_replaced(LIST, "[\\\"a\\\", \\\"b\\\", \\\"\\\"]", HNBRDF_ERROR_FORMAT,
                    "name of material 2 is empty");
    expect_replaced(LIST, "[\\\"a\\\", \\\"b\\\", \\\"\\\\u0000c\\\"]", HNBRDF_ERROR_FORMAT,
                    "name of material 2 has a control character");
    expect_replaced(LIST, "[\\\"a\\\", \\\"b\\\", \\\"\\\\n\\\"]", HNBRDF_ERROR_FORMAT,
                    "control character");
    expect_replaced(LIST, "[\\\"a\\\", \\\"b\\\", \\\"\\\\u00e9\\\"]", HNBRDF_OK, NULL);
    expect_replaced("\"materials\"", "\"anything\"", HNBRDF_OK, NULL); /* material_0 ... */
}

static void spoiled_tensors_are_named(void **state)
{
    (void)state;
    expect_replaced("net.2.bias", "net.1.bias", HNBRDF_ERROR_FORMAT, "net.1.bias appears twice");
    expect_replaced("net.2.bias", "net.9.bias", HNBRDF_ERROR_LIMIT,
                    "net.9.bias: expected at most 4 hidden layers");
    expect_replaced("net.2.bias", "net.2.b", HNBRDF_ERROR_FORMAT, "net.2.bias is missing");
    expect_replaced("net.1.weight", "net.3.weight", HNBRDF_ERROR_FORMAT,
                    "has no tensor net.1.weight");
    expect_replaced("net.0.weight", "a", HNBRDF_ERROR_FORMAT, "has no tensor net.0.weight");
    expect_replaced("net.2.weight", "net.3.weight", HNBRDF_ERROR_FORMAT,
                    "net.1.weight has shape [4, 4], expected [6, 4]");
    expect_replaced("material.kd", "material.kD", HNBRDF_ERROR_FORMAT, "material.kd is missing");
    expect_replaced("material.latent", "material.z", HNBRDF_ERROR_FORMAT,
                    "material.latent is missing");
    expect_replaced("material.rotation", "material.theta", HNBRDF_OK, NULL);
    expect_replaced("F32", "F16", HNBRDF_ERROR_FORMAT,
                    "span 128 bytes, expected 64 for 32 numbers of 2 bytes");
    expect_replaced("\"F32\"", "32", HNBRDF_ERROR_FORMAT, "found '3', expected '\"'");
    expect_replaced("\"dtype\":\"F32\",", "", HNBRDF_ERROR_FORMAT, "has no dtype");
    expect_replaced("\"dtype\"", "\"shape\":[4,8],\"dtype\"", HNBRDF_ERROR_FORMAT,
                    "shape appears twice");
    expect_replaced("\"dtype\"", "\"quantised\":{\"no\":[false]},\"dtype\"", HNBRDF_OK, NULL);
    expect_replaced("[4,8]", "[8,4]", HNBRDF_ERROR_FORMAT,
                    "net.0.weight has shape [8, 4], expected [hidden, 6 + latent]");
    expect_replaced("[4,8]", "[32]", HNBRDF_ERROR_FORMAT,
                    "has shape [32], expected [hidden, 6 + latent]");
    expect_replaced("[4,8]", "[4,2,2,2,1]", HNBRDF_ERROR_FORMAT, "has shape [4, 2, 2, 2, ...]");
    expect_replaced("[4,8]", "[]", HNBRDF_ERROR_FORMAT, "expected 4 for 1 numbers");
    expect_replaced("[4,8]", "[4,9]", HNBRDF_ERROR_FORMAT, "span 128 bytes, expected 144");
    expect_replaced("[4,8]", "[4,-8]", HNBRDF_ERROR_FORMAT, "found '-', expected a whole number");
    expect_replaced("[4,8]", "[4,8.0]", HNBRDF_ERROR_FORMAT, "expected a whole number");
    expect_replaced("[4,8]", "[4294967296,4294967296]", HNBRDF_ERROR_FORMAT,
                    "product of its shape is above");
    expect_replaced("[4,8]", "[4611686018427387904,1]", HNBRDF_ERROR_FORMAT,
                    "product of its shape is above");
    expect_replaced("[4,8]", "[4611686018427387912,4]", HNBRDF_ERROR_FORMAT,
                    "product of its shape is above");
    expect_replaced("[4,8]", "[18446744073709551616]", HNBRDF_ERROR_FORMAT,
                    "expected a whole number");
    expect_replaced("[0,128]", "[0,127]", HNBRDF_ERROR_FORMAT, "span 127 bytes");
    expect_replaced("[0,128]", "[128,0]", HNBRDF_ERROR_FORMAT, "expected a range within");
    expect_replaced("[0,128]", "[4,132]", HNBRDF_ERROR_FORMAT,
                    "begins at byte 4 of the data, expected 0");
    expect_replaced("[0,128]", "[18446744073709551615,127]", HNBRDF_ERROR_FORMAT,
                    "expected a range within");
    expect_replaced("[0,128]", "[0,18446744073709551615]", HNBRDF_ERROR_FORMAT,
                    "expected a range within");
    expect_replaced("[0,128]", "[128]", HNBRDF_ERROR_FORMAT,
                    "data_offsets has 1 numbers, expected 2");
    expect_replaced("[0,128]", "[0,128,256]", HNBRDF_ERROR_FORMAT, "data_offsets has 3 numbers");
    expect_replaced("[128,144]", "[124,140]", HNBRDF_ERROR_FORMAT,
                    "begins at byte 124 of the data, expected 128");
}

/* Unknown tensors of any type are passed over, wherever they lie, as long as they lie somewhere. */
static void unknown_tensors_must_lie_within_the_data(void **state)
{
    static const struct {
        const char *entry;
        int data; /* bytes added at the end */
        hnbrdf_result result;
        const char *part;
    } CASES[] = {
        {"\"x\":{\"dtype\":\"I64\",\"shape\":[1],\"data_offsets\":[476,484]},", 8, HNBRDF_OK, NULL},
        {"\"x\":{\"dtype\":\"F8_NEW\",\"shape\":[2,2],\"data_offsets\":[476,480]},", 4, HNBRDF_OK,
         NULL},
        {"\"x\":{\"dtype\":\"F32\",\"shape\":[0],\"data_offsets\":[0,0]},", 0, HNBRDF_OK, NULL},
        {"\"x\":{\"dtype\":\"I64\",\"shape\":[1],\"data_offsets\":[468,476]},", 0,
         HNBRDF_ERROR_FORMAT, "begins at byte"},
        {"\"x\":{\"dtype\":\"I64\",\"shape\":[1],\"data_offsets\":[476,484]},", 0,
         HNBRDF_ERROR_FORMAT, "tensor x"},
        {"\"x\":{\"dtype\":\"I64\",\"shape\":[1],\"data_offsets\":[477,485]},", 9,
         HNBRDF_ERROR_FORMAT, "begins at byte 477"},
    };
    bytes good = good_file();
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[256];
        snprintf(text, sizeof text, "%s\"net.0.weight\"", CASES[i].entry);
        bytes b = with_replaced(&good, "\"net.0.weight\"", text);
        for (int k = 0; k < CASES[i].data; k++)
            write_bytes(&b, "", 1);
        expect(&b, CASES[i].result, CASES[i].part);
        free_bytes(&b);
    }
    free_bytes(&good);
}

static void networks_beyond_the_limits_are_refused(void **state)
{
    (void)state;
    for (int wide = 0; wide < 2; wide++) {
        char header[512];
        const int rows = wide ? 65 : 4, columns = wide ? 10 : 23, size = 4 * rows * columns;
        snprintf(header, sizeof header,
                 "{\"__metadata__\":{\"format\":\"hnbrdf/"
                 "1\",\"kind\":\"hybrid\",\"encoding\":\"directions\"},"
                 "\"net.0.weight\":{\"dtype\":\"F32\",\"shape\":[%d,%d],\"data_offsets\":[0,%d]},"
                 "\"net.1.weight\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[%d,%d]}}",
                 rows, columns, size, size, size + 4);
        bytes b = file_with_header(header, (size_t)size + 4);
        expect(&b, HNBRDF_ERROR_LIMIT, "expected at most [64, 22]");
        free_bytes(&b);
    }
}

static void put_float(bytes *file, size_t offset_from_end, uint32_t bits)
{
    for (int k = 0; k < 4; k++)
        file->data[file->size - offset_from_end + (size_t)k] = (unsigned char)(bits >> 8 * k);
}

static void numbers_that_are_not_finite_or_out_of_range_are_named(void **state)
{
    /* The data end with kd 36, eta 36, alpha 24, rotation 12 and latent 24 bytes. */
    static const struct {
        size_t from_end;
        uint32_t bits;
        const char *part;
    } CASES[] = {
        {DATA_SIZE, 0x7fc00000, "net.0.weight holds nan at index 0"},
        {DATA_SIZE - 128 + 4, 0x7f800000, "net.0.weight holds an infinity at index 31"},
        {132 + 4, 0xff800000, "net.2.bias holds an infinity at index 5"},
        {132, 0x7f800001, "material.kd holds nan at index 0"},
        {4, 0xffffffff, "material.latent holds nan at index 5"},
        {132, 0x40000000, "material 0 (m0): kd"}, /* 2 */
        {96, 0x3f800000, "material 0 (m0): eta"}, /* 1 */
        {60 - 8, 0, "material 1 (m1): alpha"},    /* 0 */
        {36 - 8, 0x7f800000, "material.rotation holds an infinity at index 2"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        bytes b = good_file();
        put_float(&b, CASES[i].from_end, CASES[i].bits);
        expect(&b, HNBRDF_ERROR_FORMAT, CASES[i].part);
        free_bytes(&b);
    }
}

static void a_neural_model_needs_no_analytic_parameters(void **state)
{
    static const char *const NAMES[] = {"material.kd", "material.eta", "material.alpha"};
    hnbrdf_model *model = example_model(1, HNBRDF_KIND_NEURAL, 4, 1, 3, 2, 0), *back = NULL;
    bytes b = model_bytes(model);
    hnbrdf_material standard;
    (void)state;
    for (int i = 0; i < 3; i++) {
        bytes less = with_replaced(&b, NAMES[i], "another.tensor");
        free_bytes(&b);
        b = less;
        less = with_replaced(&b, "another.tensor", i == 0 ? "x" : i == 1 ? "y" : "z");
        free_bytes(&b);
        b = less;
    }
    hnbrdf_material_init(&standard);
    assert_int_equal(hnbrdf_model_load_memory(b.data, b.size, NULL, &back, NULL), HNBRDF_OK);
    assert_memory_equal(hnbrdf_model_material(back, 1)->kd, standard.kd, sizeof standard.kd);
    assert_memory_equal(hnbrdf_model_material(back, 1)->eta, standard.eta, sizeof standard.eta);
    assert_memory_equal(hnbrdf_model_material(back, 1)->alpha, standard.alpha,
                        sizeof standard.alpha);
    assert_memory_equal(hnbrdf_model_material(back, 1)->latent,
                        hnbrdf_model_material(model, 1)->latent, sizeof standard.latent);
    hnbrdf_model_free(back);
    hnbrdf_model_free(model);
    free_bytes(&b);
}

static void a_file_without_names_gets_numbered_ones(void **state)
{
    hnbrdf_model *back = NULL;
    bytes good = good_file();
    bytes b = with_replaced(&good, "\"materials\"", "\"m\"");
    (void)state;
    assert_int_equal(hnbrdf_model_load_memory(b.data, b.size, NULL, &back, NULL), HNBRDF_OK);
    assert_string_equal(hnbrdf_model_material_name(back, 0), "material_0");
    assert_string_equal(hnbrdf_model_material_name(back, 2), "material_2");
    hnbrdf_model_free(back);
    free_bytes(&good);
    free_bytes(&b);
}

static void control_characters_never_reach_a_message(void **state)
{
    hnbrdf_error error;
    bytes good = good_file();
    bytes b = with_replaced(&good, "net.2.bias", "net.2.b\\u001b[31m");
    (void)state;
    assert_int_equal(load(b.data, b.size, &error), HNBRDF_ERROR_FORMAT);
    for (const char *at = error.text; *at; at++)
        assert_true((unsigned char)*at >= 0x20);
    free_bytes(&good);
    free_bytes(&b);
}

/* A few random bytes changed, mostly in the header, sometimes a piece cut out or doubled. What
 * loads must be a sound model: saved and loaded again it is the same. */
static void random_damage_never_gives_an_unsound_model(void **state)
{
    static const char LETTERS[] = "{}[]\",:\\u0123456789-+.eEtfn /\x80\xff";
    bytes good = good_file();
    rng r = rng_make(7);
    int loaded = 0;
    (void)state;
    for (int i = 0; i < 20000; i++) {
        bytes b = {NULL, 0};
        hnbrdf_error error;
        const int changes = 1 + (int)(rng_u32(&r) % 3);
        write_bytes(&b, good.data, good.size);
        for (int k = 0; k < changes; k++) {
            const size_t place = rng_u32(&r) % (rng_u32(&r) % 4 ? b.size - DATA_SIZE : b.size);
            b.data[place] = rng_u32(&r) % 2
                                ? (unsigned char)LETTERS[rng_u32(&r) % (sizeof LETTERS - 1)]
                                : (unsigned char)rng_u32(&r);
        }
        if (rng_u32(&r) % 8 == 0) {
            const size_t place = rng_u32(&r) % b.size, length = rng_u32(&r) % (b.size - place);
            memmove(b.data + place, b.data + place + length, b.size - place - length);
            b.size -= rng_u32(&r) % 2 ? length : 0;
        }
        if (load(b.data, b.size, &error) == HNBRDF_OK) {
            hnbrdf_model *model = NULL, *back = NULL;
            assert_int_equal(hnbrdf_model_load_memory(b.data, b.size, NULL, &model, NULL),
                             HNBRDF_OK);
            bytes again = model_bytes(model);
            assert_int_equal(hnbrdf_model_load_memory(again.data, again.size, NULL, &back, NULL),
                             HNBRDF_OK);
            assert_same_model(model, back);
            free_bytes(&again);
            hnbrdf_model_free(model);
            hnbrdf_model_free(back);
            loaded++;
        }
        free_bytes(&b);
    }
    assert_true(loaded > 0 && loaded < 20000); /* the damage is neither nothing nor everything */
    free_bytes(&good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_truncation_is_refused),
        cmocka_unit_test(absurd_header_lengths_are_refused),
        cmocka_unit_test(other_files_are_refused_in_words),
        cmocka_unit_test(deep_nesting_is_refused),
        cmocka_unit_test(spoiled_metadata_is_named),
        cmocka_unit_test(spoiled_names_are_named),
        cmocka_unit_test(spoiled_tensors_are_named),
        cmocka_unit_test(unknown_tensors_must_lie_within_the_data),
        cmocka_unit_test(networks_beyond_the_limits_are_refused),
        cmocka_unit_test(numbers_that_are_not_finite_or_out_of_range_are_named),
        cmocka_unit_test(a_neural_model_needs_no_analytic_parameters),
        cmocka_unit_test(a_file_without_names_gets_numbered_ones),
        cmocka_unit_test(control_characters_never_reach_a_message),
        cmocka_unit_test(random_damage_never_gives_an_unsound_model),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
