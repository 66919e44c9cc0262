/* text.h: numbers and UTF-8 as text, the same whatever the locale.
 * Model files, exported shaders and the command line print and parse every number through this. */
#ifndef HNBRDF_BASE_TEXT_H
#define HNBRDF_BASE_TEXT_H

#include "base/number.h" /* HNBRDF_NUMBER_TEXT: a buffer that holds any number printed here */

#include <stddef.h>

/* Print as C's "%.9g" (float) and "%.17g" (double) do in the C locale: enough digits to read back
 * the same bits. Returns the length as snprintf does: what does not fit in size bytes is cut, and
 * what is written ends with NUL. "inf", "-inf" and "nan" for values that are not finite. */
int hnbrdf_format_float(char *buffer, size_t size, float value);
int hnbrdf_format_double(char *buffer, size_t size, double value);

/* Read one decimal number, [+-] digits [. digits] [e [+-] digits], at least one digit before or
 * after the point, that starts at begin; nothing at or after end is looked at, no space is
 * skipped. Returns where the number ends, or NULL if there is none or it is too large, and then
 * leaves *value alone. The value is the nearest representable one, ties to even, however many
 * digits there are. */
const char *hnbrdf_parse_double(const char *begin, const char *end, double *value);
/* Rounds once, straight to float: a cast from double can be off by an ulp. */
const char *hnbrdf_parse_float(const char *begin, const char *end, float *value);

/* Bytes of the well-formed UTF-8 sequence (RFC 3629) at begin, before end; 0 if there is none. */
size_t hnbrdf_utf8_length(const char *begin, const char *end);

/* Bytes of the UTF-8 byte-order mark with which some programs begin text: 3, or 0 without. */
size_t hnbrdf_byte_order_mark(const void *text, size_t size);

/* 1 where text begins with the byte-order mark of UTF-16, of either order. */
int hnbrdf_is_utf16(const void *text, size_t size);

/* Capitals of ASCII as small letters, everything else as it is. */
static inline char hnbrdf_lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}
/* 1 if text ends so, whatever the case of ASCII letters. */
int hnbrdf_ends_with(const char *text, const char *ending);

#endif
