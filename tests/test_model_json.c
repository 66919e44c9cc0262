/* test_model_json.c: the JSON reader takes what RFC 8259 allows, refuses the rest, and strings
 * survive being escaped. */
#include "core_support.h"

#include "base/json.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Reads one value from a block of exactly that size; returns what was expected, or NULL. */
static const char *refusal(const char *text, size_t size)
{
    hnbrdf_json json;
    char *copy = malloc(size ? size : 1);
    assert_non_null(copy);
    memcpy(copy, text, size);
    hnbrdf_json_begin(&json, copy, size);
    hnbrdf_json_skip(&json);
    const int finished = hnbrdf_json_finish(&json);
    assert_int_equal(finished, json.expected == NULL);
    assert_true(json.at >= copy && json.at <= copy + size);
    free(copy);
    return json.expected;
}

static void valid_texts_are_taken(void **state)
{
    static const char *const TEXTS[] = {"{}",
                                        "[]",
                                        " \t\r\n[ ] ",
                                        "{\"a\":1}",
                                        "{\"a\" : [1, 2.5, -0, 1e5, 1E-5, 0.1e+2] , \"b\":{}}",
                                        "true",
                                        "false",
                                        "null",
                                        "\"\"",
                                        "\"\\\"\\\\\\/\\b\\f\\n\\r\\t\\u00e9\"",
                                        "\"\\ud83c\\udfa8\"",
                                        "\"\xc3\xa9\xf0\x9f\x8e\xa8\"",
                                        "[[[[[]]]],{\"\":{\"\":[]}}]",
                                        "0",
                                        "-0.5",
                                        "[\"\x7f\"]"};
    (void)state;
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++) {
        const char *expected = refusal(TEXTS[i], strlen(TEXTS[i]));
        if (expected)
            fail_msg("%s: refused, expected %s", TEXTS[i], expected);
    }
}

static void invalid_texts_are_refused(void **state)
{
    static const char *const TEXTS[] = {"",
                                        " ",
                                        "{",
                                        "}",
                                        "[",
                                        "]",
                                        "{]",
                                        "[}",
                                        "[1",
                                        "[1,",
                                        "[1,]",
                                        "[,1]",
                                        "[1 2]",
                                        "{\"a\"}",
                                        "{\"a\":}",
                                        "{\"a\":1,}",
                                        "{,}",
                                        "{a:1}",
                                        "{1:1}",
                                        "{'a':1}",
                                        "{\"a\" 1}",
                                        "[1]]",
                                        "{}{}",
                                        "1 2",
                                        "tru",
                                        "True",
                                        "nul",
                                        "nan",
                                        "NaN",
                                        "inf",
                                        "Infinity",
                                        "-",
                                        "+1",
                                        "01",
                                        "-01",
                                        "1.",
                                        ".5",
                                        "1e",
                                        "1e+",
                                        "0x10",
                                        "1.e5",
                                        "\"",
                                        "\"a",
                                        "\"\\\"",
                                        "\"\\x41\"",
                                        "\"\\u12\"",
                                        "\"\\u12g4\"",
                                        "\"\\ud83c\"",
                                        "\"\\ud83cx\"",
                                        "\"\\ud83c\\n\"",
                                        "\"\\ud83c\\u0041\"",
                                        "\"\\udfa8\"",
                                        "\"\n\"",
                                        "\"\t\"",
                                        "\"\x1f\"",
                                        "\"\x80\"",
                                        "\"\xc3\"",
                                        "\"\xed\xa0\x80\"",
                                        "\"\xc0\xaf\"",
                                        "\"\xff\"",
                                        "[\"a\":1]",
                                        "{\"a\":1:2}",
                                        "/**/1",
                                        "[1]//",
                                        "\xef\xbb\xbf{}",
                                        "\v1"};
    (void)state;
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++)
        if (!refusal(TEXTS[i], strlen(TEXTS[i])))
            fail_msg("%s: taken, expected a refusal", TEXTS[i]);
    assert_non_null(refusal("\0", 1));
    assert_non_null(refusal("[\0]", 3));
    assert_non_null(refusal("\"\0\"", 3));
}

static void nesting_is_bounded_not_recursive(void **state)
{
    enum { DEEP = 1000000 };
    char *text = malloc(DEEP);
    (void)state;
    assert_non_null(text);
    memset(text, '[', DEEP);
    assert_string_equal(refusal(text, DEEP), "at most 64 levels of nesting");
    memset(text + 64, ']', 64);
    assert_null(refusal(text, 128));
    free(text);
}

static void whole_numbers_are_exact_or_refused(void **state)
{
    static const struct {
        const char *text;
        int good;
        uint64_t value;
    } CASES[] = {{"0", 1, 0},
                 {"7", 1, 7},
                 {"18446744073709551615", 1, UINT64_MAX},
                 {"18446744073709551616", 0, 0},
                 {"99999999999999999999999", 0, 0},
                 {"-1", 0, 0},
                 {"01", 0, 0},
                 {"1.0", 0, 0},
                 {"1e3", 0, 0},
                 {"\"1\"", 0, 0},
                 {"", 0, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        hnbrdf_json json;
        uint64_t value = 12345;
        hnbrdf_json_begin(&json, CASES[i].text, strlen(CASES[i].text));
        if (hnbrdf_json_integer(&json, &value) != CASES[i].good)
            fail_msg("%s", CASES[i].text);
        assert_true(value == (CASES[i].good ? CASES[i].value : 12345));
    }
}

static hnbrdf_json_text string_of(const char *literal)
{
    hnbrdf_json json;
    hnbrdf_json_text text = {NULL, NULL};
    hnbrdf_json_begin(&json, literal, strlen(literal));
    assert_true(hnbrdf_json_string(&json, &text));
    return text;
}

static void strings_are_unescaped_to_utf8(void **state)
{
    char to[64];
    const hnbrdf_json_text text =
        string_of("\"\\\"\\\\\\/\\b\\f\\n\\r\\t \\u0041\\u00e9\\u20AC\\uD83C\\uDFA8\\u0000.\"");
    const char expected[] = "\"\\/\b\f\n\r\t A\xc3\xa9\xe2\x82\xac\xf0\x9f\x8e\xa8\0.";
    (void)state;
    assert_int_equal(hnbrdf_json_unescape(text, to), sizeof expected - 1);
    assert_memory_equal(to, expected, sizeof expected - 1);
}

static void comparison_sees_through_escapes(void **state)
{
    (void)state;
    assert_true(hnbrdf_json_equals(string_of("\"dtype\""), "dtype"));
    assert_true(hnbrdf_json_equals(string_of("\"\\u0064type\""), "dtype"));
    assert_true(hnbrdf_json_equals(string_of("\"\\u00e9\""), "\xc3\xa9"));
    assert_false(hnbrdf_json_equals(string_of("\"dtyp\""), "dtype"));
    assert_false(hnbrdf_json_equals(string_of("\"dtypes\""), "dtype"));
    assert_false(hnbrdf_json_equals(string_of("\"dtype\\u0000\""), "dtype"));
    assert_true(hnbrdf_json_equals(string_of("\"\""), ""));
}

typedef struct buffer {
    char text[4096];
    size_t size;
} buffer;

static int append(void *user, const void *data, size_t size)
{
    buffer *b = user;
    assert_true(b->size + size < sizeof b->text);
    memcpy(b->text + b->size, data, size);
    b->size += size;
    return 0;
}

static void any_string_survives_escaping(void **state)
{
    rng r = rng_make(6);
    (void)state;
    for (int i = 0; i < 20000; i++) {
        char plain[64], back[256];
        buffer b = {"\"", 1};
        const size_t length = rng_u32(&r) % sizeof plain;
        hnbrdf_json json;
        hnbrdf_json_text text;
        for (size_t k = 0; k < length; k++)
            plain[k] = (char)(rng_u32(&r) % 128);
        assert_int_equal(hnbrdf_json_escape(plain, length, append, &b), 0);
        append(&b, "\"", 1);
        hnbrdf_json_begin(&json, b.text, b.size);
        assert_true(hnbrdf_json_string(&json, &text));
        assert_true(hnbrdf_json_finish(&json));
        assert_int_equal(hnbrdf_json_unescape(text, back), length);
        assert_memory_equal(back, plain, length);
    }
}

static void after_a_failure_nothing_moves(void **state)
{
    hnbrdf_json json;
    hnbrdf_json_text text;
    uint64_t value;
    (void)state;
    hnbrdf_json_begin(&json, "true 12 \"a\" {", 13);
    assert_false(hnbrdf_json_open(&json, '{'));
    const char *at = json.at;
    assert_false(hnbrdf_json_skip(&json));
    assert_false(hnbrdf_json_integer(&json, &value));
    assert_false(hnbrdf_json_string(&json, &text));
    assert_false(hnbrdf_json_more(&json, '}'));
    assert_false(hnbrdf_json_open(&json, '{'));
    assert_false(hnbrdf_json_finish(&json));
    assert_ptr_equal(json.at, at);
    assert_string_equal(json.expected, "'{'");
}

static void what_is_shown_is_cut_between_characters(void **state)
{
    char literal[128] = "\"";
    (void)state;
    for (int i = 0; i < 40; i++)
        strcat(literal, "\xc3\xa9");
    strcat(literal, "\"");
    assert_int_equal(hnbrdf_json_shown(string_of(literal)), 60);
    memmove(literal + 2, literal + 1, strlen(literal));
    literal[1] = 'a';
    assert_int_equal(hnbrdf_json_shown(string_of(literal)), 59);
    assert_int_equal(hnbrdf_json_shown(string_of("\"abc\"")), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(valid_texts_are_taken),
        cmocka_unit_test(invalid_texts_are_refused),
        cmocka_unit_test(nesting_is_bounded_not_recursive),
        cmocka_unit_test(whole_numbers_are_exact_or_refused),
        cmocka_unit_test(strings_are_unescaped_to_utf8),
        cmocka_unit_test(comparison_sees_through_escapes),
        cmocka_unit_test(any_string_survives_escaping),
        cmocka_unit_test(after_a_failure_nothing_moves),
        cmocka_unit_test(what_is_shown_is_cut_between_characters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
