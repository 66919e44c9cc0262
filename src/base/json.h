/* json.h: a small strict JSON reader (RFC 8259) that walks the text and allocates nothing, and
 * string escaping for writers. What the headers of model files need, no more. */
#ifndef HNBRDF_BASE_JSON_H
#define HNBRDF_BASE_JSON_H

#include "hnbrdf/hnbrdf.h"

#include <stdint.h>

/* A place in the text. Once `expected` is set every call below fails and moves nothing, so that a
 * caller may read on and look once at the end. */
typedef struct hnbrdf_json {
    const char *begin, *at, *end;
    const char *expected; /* what should have been at `at`; NULL while all is well */
    int fresh;            /* 1 directly after an opening bracket */
} hnbrdf_json;

/* The inside of a string literal as it stands in the text: checked, still escaped. */
typedef struct hnbrdf_json_text {
    const char *begin, *end;
} hnbrdf_json_text;

void hnbrdf_json_begin(hnbrdf_json *json, const char *text, size_t size);

/* An object is read as
 *     if (hnbrdf_json_open(json, '{')) {
 *         while (hnbrdf_json_more(json, '}')) {
 *             hnbrdf_json_key(json, &key);
 *             ... read or skip one value
 * an array the same with '[', ']' and without the key. All return 0 at the end and after a
 * failure. */
int hnbrdf_json_open(hnbrdf_json *json, char bracket);
int hnbrdf_json_more(hnbrdf_json *json, char bracket);
int hnbrdf_json_key(hnbrdf_json *json, hnbrdf_json_text *key);

int hnbrdf_json_string(hnbrdf_json *json, hnbrdf_json_text *text);
/* A whole number without fraction or exponent that fits. */
int hnbrdf_json_integer(hnbrdf_json *json, uint64_t *value);
/* Any value, nested at most 64 deep. */
int hnbrdf_json_skip(hnbrdf_json *json);
/* Nothing but white space may follow. 1 if so and if nothing failed before. */
int hnbrdf_json_finish(hnbrdf_json *json);

/* Sets json->expected at this place unless something failed before; returns 0. */
int hnbrdf_json_fail(hnbrdf_json *json, const char *at, const char *expected);

/* 1 if the unescaped text is `plain`. */
int hnbrdf_json_equals(hnbrdf_json_text text, const char *plain);
/* Unescape to UTF-8. The result is never longer than the text; `to` may be text.begin. Returns its
 * length; no NUL is added. */
size_t hnbrdf_json_unescape(hnbrdf_json_text text, char *to);

/* How many bytes of it to show in a message: not too many, cut between characters. */
int hnbrdf_json_shown(hnbrdf_json_text text);

/* Write the text (UTF-8) as a string literal without its quotation marks. Returns what `write`
 * does. */
int hnbrdf_json_escape(const char *text, size_t size, hnbrdf_write_fn write, void *user);

#endif
