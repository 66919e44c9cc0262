/* error.h: fill an hnbrdf_error. The message names file, place, what was found, what was
 * expected. */
#ifndef HNBRDF_BASE_ERROR_H
#define HNBRDF_BASE_ERROR_H

#include "base/number.h"
#include "hnbrdf/hnbrdf.h"

#include <stdarg.h>
#include <stdio.h>

/* Writes the message if error is not NULL and returns result, so that a failure is one statement:
 *     return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: header is %zu bytes, expected ...", ...);
 * Numbers with a fraction go in as %s and HNBRDF_NUMBER(): a %g would follow the locale. */
#if defined(__GNUC__) && !defined(__MINGW32__) /* whose printf attribute knows no %zu */
__attribute__((format(printf, 3, 4)))
#endif
static inline hnbrdf_result
hnbrdf_fail(hnbrdf_error *error, hnbrdf_result result, const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->text, sizeof error->text, format, arguments);
        va_end(arguments);
        for (char *c = error->text; *c; ++c) {
            /* from names and contents of files */
            *c = (unsigned char)*c < 0x20 || *c == 0x7f ? '?' : *c;
        }
    }
    return result;
}

#endif
