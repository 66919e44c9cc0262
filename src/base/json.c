/* json.c: a small strict JSON reader that walks the text and allocates nothing; string escaping. */
#include "base/json.h"

#include "base/text.h"

#include <stdio.h>
#include <string.h>

enum { MAX_DEPTH = 64, MAX_SHOWN = 60 };

int hnbrdf_json_fail(hnbrdf_json *json, const char *at, const char *expected)
{
    if (!json->expected) {
        json->at = at;
        json->expected = expected;
    }
    return 0;
}

void hnbrdf_json_begin(hnbrdf_json *json, const char *text, size_t size)
{
    json->begin = json->at = text;
    json->end = text + size;
    json->expected = NULL;
    json->fresh = 0;
}

/* The next character that is no white space, not consumed; 0 at the end and after a failure. */
static char peek(hnbrdf_json *json)
{
    if (json->expected)
        return 0;
    while (json->at < json->end && *json->at && strchr(" \t\n\r", *json->at))
        ++json->at;
    return json->at < json->end ? *json->at : 0;
}

static int take(hnbrdf_json *json, char wanted, const char *expected)
{
    if (peek(json) != wanted)
        return hnbrdf_json_fail(json, json->at, expected);
    ++json->at;
    return 1;
}

/* ---- Structure ------------------------------------------------------------------------------- */

int hnbrdf_json_open(hnbrdf_json *json, char bracket)
{
    if (!take(json, bracket, bracket == '{' ? "'{'" : "'['"))
        return 0;
    json->fresh = 1;
    return 1;
}

int hnbrdf_json_more(hnbrdf_json *json, char bracket)
{
    const int first = json->fresh;
    const char next = peek(json);
    json->fresh = 0;
    if (json->expected)
        return 0;
    if (next == bracket) {
        ++json->at;
        return 0;
    }
    return first || take(json, ',', bracket == '}' ? "',' or '}'" : "',' or ']'");
}

int hnbrdf_json_key(hnbrdf_json *json, hnbrdf_json_text *key)
{
    return hnbrdf_json_string(json, key) && take(json, ':', "':'");
}

int hnbrdf_json_finish(hnbrdf_json *json)
{
    peek(json);
    if (!json->expected && json->at != json->end)
        return hnbrdf_json_fail(json, json->at, "the end of the text");
    return !json->expected;
}

/* ---- Strings --------------------------------------------------------------------------------- */

static int hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* The four digits of \uXXXX at `at`, or -1. */
static long hex4(const char *at, const char *end)
{
    long value = 0;
    if (end - at < 4)
        return -1;
    for (int i = 0; i < 4; ++i) {
        const int digit = hex_digit(at[i]);
        if (digit < 0)
            return -1;
        value = value * 16 + digit;
    }
    return value;
}

static size_t encode_utf8(unsigned long code, char to[4])
{
    static const unsigned char LEAD[5] = {0, 0, 0xc0, 0xe0, 0xf0};
    const size_t length = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    for (size_t i = length - 1; i > 0; --i) {
        to[i] = (char)(0x80 | (code & 0x3f));
        code >>= 6;
    }
    to[0] = (char)(LEAD[length] | code);
    return length;
}

/* \uXXXX at `at` behind the u, with its second half if it is a surrogate. */
static const char *read_unicode(const char *at, const char *end, char to[4], size_t *length)
{
    const long high = hex4(at, end);
    unsigned long code = (unsigned long)high;
    at += 4;
    if (high < 0 || (high >= 0xdc00 && high < 0xe000))
        return NULL;
    if (high >= 0xd800 && high < 0xdc00) {
        const long low = end - at >= 6 && at[0] == '\\' && at[1] == 'u' ? hex4(at + 2, end) : -1;
        if (low < 0xdc00 || low >= 0xe000)
            return NULL;
        code = 0x10000 + ((unsigned long)(high - 0xd800) << 10) + (unsigned long)(low - 0xdc00);
        at += 6;
    }
    *length = encode_utf8(code, to);
    return at;
}

/* Reads one character of a string's inside, at < end, into `to` as UTF-8. Returns where it ends, or
 * NULL with *expected set. */
static const char *read_character(const char *at, const char *end, char to[4], size_t *length,
                                  const char **expected)
{
    static const char ESCAPES[] = "\"\\/bfnrt", MEANINGS[] = "\"\\/\b\f\n\r\t";
    *length = 0;
    if (*at == '\\') {
        const char kind = end - at >= 2 ? at[1] : 0;
        const char *escape = kind ? strchr(ESCAPES, kind) : NULL;
        if (kind == 'u') {
            *expected = "\\uXXXX with four hexadecimal digits, surrogates in pairs";
            return read_unicode(at + 2, end, to, length);
        }
        *expected = "a valid escape";
        if (!escape)
            return NULL;
        to[0] = MEANINGS[escape - ESCAPES];
        *length = 1;
        return at + 2;
    }
    *expected = "an escape instead of a control character";
    if ((unsigned char)*at < 0x20)
        return NULL;
    *expected = "UTF-8";
    *length = hnbrdf_utf8_length(at, end);
    memcpy(to, at, *length);
    return *length ? at + *length : NULL;
}

int hnbrdf_json_string(hnbrdf_json *json, hnbrdf_json_text *text)
{
    char character[4];
    size_t length;
    if (!take(json, '"', "'\"'"))
        return 0;
    for (const char *at = json->at; at < json->end;) {
        const char *expected, *next;
        if (*at == '"') {
            text->begin = json->at;
            text->end = at;
            json->at = at + 1;
            return 1;
        }
        next = read_character(at, json->end, character, &length, &expected);
        if (!next)
            return hnbrdf_json_fail(json, at, expected);
        at = next;
    }
    return hnbrdf_json_fail(json, json->end, "'\"' at the end of a string");
}

int hnbrdf_json_equals(hnbrdf_json_text text, const char *plain)
{
    while (text.begin < text.end) {
        const char *expected;
        char character[4];
        size_t length = 0;
        text.begin = read_character(text.begin, text.end, character, &length, &expected);
        for (size_t i = 0; i < length; ++i)
            if (*plain == '\0' || *plain++ != character[i])
                return 0;
    }
    return *plain == '\0';
}

size_t hnbrdf_json_unescape(hnbrdf_json_text text, char *to)
{
    size_t total = 0;
    while (text.begin < text.end) {
        const char *expected;
        char character[4];
        size_t length = 0;
        text.begin = read_character(text.begin, text.end, character, &length, &expected);
        memcpy(to + total, character, length);
        total += length;
    }
    return total;
}

int hnbrdf_json_shown(hnbrdf_json_text text)
{
    const char *end = text.end - text.begin > MAX_SHOWN ? text.begin + MAX_SHOWN : text.end;
    while (end < text.end && end > text.begin && ((unsigned char)*end & 0xc0) == 0x80)
        --end;
    return (int)(end - text.begin);
}

int hnbrdf_json_escape(const char *text, size_t size, hnbrdf_write_fn write, void *user)
{
    for (size_t i = 0; i < size; ++i) {
        char escaped[8];
        int length = 1;
        if ((unsigned char)text[i] < 0x20) {
            length = snprintf(escaped, sizeof escaped, "\\u%04x", (unsigned)(unsigned char)text[i]);
        } else if (text[i] == '"' || text[i] == '\\') {
            escaped[0] = '\\';
            escaped[1] = text[i];
            length = 2;
        } else {
            escaped[0] = text[i];
        }
        const int stopped = write(user, escaped, (size_t)length);
        if (stopped)
            return stopped;
    }
    return 0;
}

/* ---- Numbers and values that are skipped ----------------------------------------------------- */

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

int hnbrdf_json_integer(hnbrdf_json *json, uint64_t *value)
{
    static const char EXPECTED[] = "a whole number from 0 to 18446744073709551615";
    uint64_t number = 0;
    const char first = peek(json);
    const char *at = json->at;
    if (!is_digit(first))
        return hnbrdf_json_fail(json, at, EXPECTED);
    for (; at < json->end && is_digit(*at); ++at) {
        const uint64_t digit = (uint64_t)(*at - '0');
        if (number > (UINT64_MAX - digit) / 10)
            return hnbrdf_json_fail(json, json->at, EXPECTED);
        number = number * 10 + digit;
    }
    const int leading_zero = first == '0' && at - json->at > 1;
    if (leading_zero || (at < json->end && (*at == '.' || *at == 'e' || *at == 'E')))
        return hnbrdf_json_fail(json, json->at, EXPECTED);
    json->at = at;
    *value = number;
    return 1;
}

static const char *skip_digits(const char *at, const char *end)
{
    const char *begin = at;
    while (at < end && is_digit(*at))
        ++at;
    return at > begin ? at : NULL;
}

static int skip_number(hnbrdf_json *json)
{
    const char *at = json->at, *end = json->end;
    at += *at == '-';
    const int zero = at < end && *at == '0';
    at = zero ? at + 1 : skip_digits(at, end);
    if (at && at < end && *at == '.')
        at = skip_digits(at + 1, end);
    if (at && at < end && (*at == 'e' || *at == 'E')) {
        ++at;
        at += at < end && (*at == '+' || *at == '-');
        at = skip_digits(at, end);
    }
    if (!at || (zero && at < end && is_digit(*at)))
        return hnbrdf_json_fail(json, json->at, "a number");
    json->at = at;
    return 1;
}

static int skip_word(hnbrdf_json *json)
{
    static const char *const WORDS[] = {"true", "false", "null"};
    for (int i = 0; i < 3; ++i) {
        const size_t length = strlen(WORDS[i]);
        if ((size_t)(json->end - json->at) >= length && memcmp(json->at, WORDS[i], length) == 0) {
            json->at += length;
            return 1;
        }
    }
    return hnbrdf_json_fail(json, json->at, "a value");
}

static int skip_scalar(hnbrdf_json *json, char first)
{
    hnbrdf_json_text text;
    if (first == '"')
        return hnbrdf_json_string(json, &text);
    return first == '-' || is_digit(first) ? skip_number(json) : skip_word(json);
}

int hnbrdf_json_skip(hnbrdf_json *json)
{
    char brackets[MAX_DEPTH]; /* the closing ones that are still due */
    int depth = 0;
    if (json->expected)
        return 0;
    do {
        const char first = peek(json);
        hnbrdf_json_text key;
        if (first == '{' || first == '[') {
            if (depth == MAX_DEPTH)
                return hnbrdf_json_fail(json, json->at, "at most 64 levels of nesting");
            brackets[depth++] = first == '{' ? '}' : ']';
            hnbrdf_json_open(json, first);
        } else if (!skip_scalar(json, first)) {
            return 0;
        }
        while (depth > 0 && !hnbrdf_json_more(json, brackets[depth - 1]))
            --depth;
        if (depth > 0 && brackets[depth - 1] == '}' && !hnbrdf_json_key(json, &key))
            return 0;
    } while (depth > 0);
    return !json->expected;
}
