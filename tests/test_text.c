/* test_text.c: numbers as text agree with the C library's in the C locale, and survive the way
 * back. */
#include "core_support.h"

#include "base/text.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static float float_of(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static double double_of(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint64_t rng_u64(rng *r)
{
    return (uint64_t)rng_u32(r) << 32 | rng_u32(r);
}

/* Parses from a block of exactly that size, so that AddressSanitizer sees a read behind it. */
static const char *parse_exact(const char *text, double *value, size_t *used)
{
    const size_t length = strlen(text);
    char *copy = malloc(length ? length : 1);
    assert_non_null(copy);
    memcpy(copy, text, length);
    const char *end = hnbrdf_parse_double(copy, copy + length, value);
    *used = end ? (size_t)(end - copy) : 0;
    free(copy);
    return end;
}

static void every_float_survives_nine_digits(void **state)
{
    rng r = rng_make(1);
    (void)state;
    for (int i = 0; i < 2100000; i++) { /* two million as weights are, then any bits */
        const float value = i < 2000000 ? ldexpf(rng_float(&r) - 0.5f, -(int)(rng_u32(&r) % 16))
                                        : float_of(rng_u32(&r));
        char text[HNBRDF_NUMBER_TEXT];
        float back = 0;
        if (!isfinite(value))
            continue;
        const int length = hnbrdf_format_float(text, sizeof text, value);
        if (hnbrdf_parse_float(text, text + length, &back) != text + length ||
            memcmp(&back, &value, sizeof value) != 0)
            fail_msg("%a became %s became %a", (double)value, text, (double)back);
    }
}

static void floats_are_printed_as_the_c_locale_does(void **state)
{
    rng r = rng_make(2);
    char text[HNBRDF_NUMBER_TEXT], expected[64];
    (void)state;
    for (int i = 0; i < 40000; i++) {
        const float value = float_of(rng_u32(&r));
        if (!isfinite(value))
            continue;
        assert_int_equal(hnbrdf_format_float(text, sizeof text, value),
                         snprintf(expected, sizeof expected, "%.9g", (double)value));
        assert_string_equal(text, expected);
    }
    hnbrdf_format_float(text, sizeof text, INFINITY);
    assert_string_equal(text, "inf");
    hnbrdf_format_float(text, sizeof text, -INFINITY);
    assert_string_equal(text, "-inf");
    hnbrdf_format_float(text, sizeof text, NAN);
    assert_string_equal(text, "nan");
}

static void every_double_survives_seventeen_digits(void **state)
{
    rng r = rng_make(3);
    (void)state;
    for (int i = 0; i < 40000; i++) {
        const double value = double_of(rng_u64(&r));
        char text[HNBRDF_NUMBER_TEXT];
        double back = 0;
        if (!isfinite(value))
            continue;
        const int length = hnbrdf_format_double(text, sizeof text, value);
        if (hnbrdf_parse_double(text, text + length, &back) != text + length ||
            memcmp(&back, &value, sizeof value) != 0)
            fail_msg("%a became %s became %a", value, text, back);
    }
}

/* strtod and strtof of the C library round correctly; the test runs in the C locale. */
static void agrees(const char *text)
{
    const char *end = text + strlen(text);
    const double expected = strtod(text, NULL);
    const float expected_float = strtof(text, NULL);
    double value = 0;
    float value_float = 0;
    if (isinf(expected))
        assert_null(hnbrdf_parse_double(text, end, &value));
    else if (hnbrdf_parse_double(text, end, &value) != end || value != expected)
        fail_msg("%.60s: %a, expected %a", text, value, expected);
    if (isinf(expected_float))
        assert_null(hnbrdf_parse_float(text, end, &value_float));
    else if (hnbrdf_parse_float(text, end, &value_float) != end || value_float != expected_float)
        fail_msg("%.60s: %a, expected %a", text, (double)value_float, (double)expected_float);
}

static void any_decimal_is_rounded_once(void **state)
{
    rng r = rng_make(4);
    char text[128];
    (void)state;
    for (int i = 0; i < 40000; i++) {
        const unsigned long long high = rng_u32(&r) % 1000, low = rng_u64(&r) >> rng_u32(&r) % 64;
        snprintf(text, sizeof text, "%llu.%llue%d", high, low, (int)(rng_u32(&r) % 700) - 350);
        agrees(text);
        snprintf(text, sizeof text, "%u.%09ue%d", rng_u32(&r) % 10, rng_u32(&r) % 1000000000,
                 (int)(rng_u32(&r) % 90) - 50);
        agrees(text);
    }
}

/* Where rounding is hardest: the midpoint of two neighbours in full, and a little beside it. */
static void midpoints_are_rounded_to_even(void **state)
{
    rng r = rng_make(5);
    char text[1400];
    (void)state;
    for (int i = 0; i < 1500; i++) {
        const uint64_t bits = rng_u64(&r) >> (i % 3 == 0 ? 12 : 1);
        const double low = double_of(bits), high = nextafter(low, INFINITY);
        const float low_float = float_of((uint32_t)bits >> (i % 3 == 0 ? 10 : 1));
        const float high_float = nextafterf(low_float, INFINITY);
        if (isfinite(high)) { /* the sum of neighbours is one bit longer: exact in long double */
            snprintf(text, sizeof text, "%.1150Le", ((long double)low + high) / 2);
            agrees(text);
            char *exponent = strchr(text, 'e'); /* a digit far behind: just above */
            *(exponent - 1) = '1';
            agrees(text);
        }
        if (isfinite(high_float)) {
            snprintf(text, sizeof text, "%.200e", ((double)low_float + (double)high_float) / 2);
            agrees(text);
        }
    }
}

static void long_and_extreme_numbers_are_read(void **state)
{
    static const char *const TEXTS[] = {"0",
                                        "-0",
                                        "0.0e0",
                                        "1e0",
                                        "1E+2",
                                        "1e-2",
                                        ".5",
                                        "5.",
                                        "+1.5",
                                        "00001.500",
                                        "1e22",
                                        "1e23",
                                        "9007199254740993",
                                        "9007199254740993.00000000000000000000000000000001",
                                        "4.9e-324",
                                        "2.4e-324",
                                        "2.5e-324",
                                        "1e-400",
                                        "1e-99999999999999999999",
                                        "0e99999999999999999999",
                                        "1.7976931348623157e308",
                                        "1.7976931348623158e308",
                                        "1.7976931348623159e308",
                                        "1e309",
                                        "1e99999999999999999999",
                                        "3.4028235e38",
                                        "3.4028235677973366e38",
                                        "3.4028236e38",
                                        "1.17549435e-38",
                                        "7e-46",
                                        "7.1e-46",
                                        "2.2250738585072011e-308",
                                        "8.5e-1"};
    char text[3000];
    (void)state;
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++)
        agrees(TEXTS[i]);
    memset(text, '0', sizeof text);
    text[1] = '.';
    strcpy(text + 2900, "125e2899");
    agrees(text); /* 12.5 with 2898 zeros before it */
    memset(text, '7', 2500);
    strcpy(text + 2500, "e-2499");
    agrees(text);
}

static void numbers_end_where_the_grammar_does(void **state)
{
    static const struct {
        const char *text;
        size_t used; /* 0: no number */
    } CASES[] = {{"", 0},     {"-", 0},     {"+", 0},     {".", 0},    {"-.", 0},    {"e5", 0},
                 {".e5", 0},  {" 1", 0},    {"x", 0},     {"inf", 0},  {"nan", 0},   {"-inf", 0},
                 {"0x10", 1}, {"1e", 1},    {"1e+", 1},   {"1e-x", 1}, {"1.2.3", 3}, {"1,5", 1},
                 {"--1", 0},  {"1-", 1},    {"1e5e5", 3}, {"12 ", 2},  {"1_0", 1},   {"0.5f", 3},
                 {"1.e1", 4}, {"1e400", 0}, {"-1e400", 0}};
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        double value = 12345;
        size_t used = 0;
        const char *end = parse_exact(CASES[i].text, &value, &used);
        if ((end == NULL) != (CASES[i].used == 0) || used != CASES[i].used)
            fail_msg("\"%s\": %zu characters, expected %zu", CASES[i].text, used, CASES[i].used);
        if (!end)
            assert_true(value == 12345); /* untouched */
    }
}

static void nothing_is_read_behind_the_end(void **state)
{
    const char text[] = "123456";
    double value = 0;
    (void)state;
    for (int i = 1; i <= 6; i++)
        assert_ptr_equal(hnbrdf_parse_double(text, text + i, &value), text + i);
    assert_null(hnbrdf_parse_double(text, text, &value));
}

static void a_small_buffer_is_cut_and_terminated(void **state)
{
    char text[6] = "xxxxx";
    (void)state;
    assert_int_equal(hnbrdf_format_float(text, 4, 0.123456789f), 11);
    assert_string_equal(text, "0.1");
    assert_int_equal(text[4], 'x');
    assert_int_equal(hnbrdf_format_double(NULL, 0, 0.5), 3);
}

/* Skipped where no locale with another separator is installed. */
static void a_comma_locale_changes_nothing(void **state)
{
    static const char *const LOCALES[] = {"de_DE.UTF-8", "de_DE.utf8",  "de_DE", "fr_FR.UTF-8",
                                          "fr_FR.utf8",  "ru_RU.UTF-8", "ps_AF", "fa_IR.UTF-8"};
    char text[HNBRDF_NUMBER_TEXT], expected[HNBRDF_NUMBER_TEXT];
    double value = 0;
    int found = 0;
    (void)state;
    snprintf(expected, sizeof expected, "%.9g", (double)-1.5e-20f);
    for (size_t i = 0; i < sizeof LOCALES / sizeof *LOCALES; i++) {
        if (!setlocale(LC_ALL, LOCALES[i]) || strcmp(localeconv()->decimal_point, ".") == 0)
            continue;
        found = 1;
        hnbrdf_format_float(text, sizeof text, -1.5e-20f);
        assert_string_equal(text, expected);
        assert_non_null(hnbrdf_parse_double(text, text + strlen(text), &value));
        assert_true((float)value == -1.5e-20f);
    }
    setlocale(LC_ALL, "C");
    if (!found)
        skip();
}

static void utf8_is_what_rfc_3629_says(void **state)
{
    static const struct {
        const char *text;
        size_t length;
    } CASES[] = {{"a", 1},
                 {"\x7f", 1},
                 {"\xc2\x80", 2},
                 {"\xdf\xbf", 2},
                 {"\xe0\xa0\x80", 3},
                 {"\xed\x9f\xbf", 3},
                 {"\xee\x80\x80", 3},
                 {"\xf0\x90\x80\x80", 4},
                 {"\xf4\x8f\xbf\xbf", 4},
                 {"", 0},
                 {"\x80", 0},             /* a continuation alone */
                 {"\xc1\xbf", 0},         /* overlong */
                 {"\xe0\x9f\xbf", 0},     /* overlong */
                 {"\xf0\x8f\xbf\xbf", 0}, /* overlong */
                 {"\xed\xa0\x80", 0},     /* surrogate */
                 {"\xf4\x90\x80\x80", 0}, /* above U+10FFFF */
                 {"\xf5\x80\x80\x80", 0},
                 {"\xff", 0},
                 {"\xc3", 0}, /* cut */
                 {"\xe2\x82", 0},
                 {"\xf0\x9f\x8e", 0},
                 {"\xe2\x28\xa1", 0}};
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        assert_int_equal(hnbrdf_utf8_length(CASES[i].text, CASES[i].text + strlen(CASES[i].text)),
                         CASES[i].length);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_float_survives_nine_digits),
        cmocka_unit_test(floats_are_printed_as_the_c_locale_does),
        cmocka_unit_test(every_double_survives_seventeen_digits),
        cmocka_unit_test(any_decimal_is_rounded_once),
        cmocka_unit_test(midpoints_are_rounded_to_even),
        cmocka_unit_test(long_and_extreme_numbers_are_read),
        cmocka_unit_test(numbers_end_where_the_grammar_does),
        cmocka_unit_test(nothing_is_read_behind_the_end),
        cmocka_unit_test(a_small_buffer_is_cut_and_terminated),
        cmocka_unit_test(a_comma_locale_changes_nothing),
        cmocka_unit_test(utf8_is_what_rfc_3629_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
