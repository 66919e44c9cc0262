/* error.h: fill an hnbrdf_error, or tell a note. The message names file, place, what was found,
 * what was expected (or what became of it). */
#ifndef HNBRDF_BASE_ERROR_H
#define HNBRDF_BASE_ERROR_H

#include "base/number.h"
#include "hnbrdf/hnbrdf.h"

#include <stdarg.h>
#include <stdio.h>

/* One line whatever it holds: control characters, from names and contents of files, become '?'. */
static inline void hnbrdf_one_line(char *text)
{
    for (char *c = text; *c; ++c)
        *c = (unsigned char)*c < 0x20 || *c == 0x7f ? '?' : *c;
}

#if defined(__GNUC__) && !defined(__MINGW32__)
__attribute__((format(printf, 2, 0)))
#endif
static inline void
hnbrdf_error_print(hnbrdf_error *error, const char *format, va_list arguments)
{
    vsnprintf(error->text, sizeof error->text, format, arguments);
    hnbrdf_one_line(error->text);
}

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
        hnbrdf_error_print(error, format, arguments);
        va_end(arguments);
    }
    return result;
}

/* Tells a line of the same kind to whoever wants to know; notes may be NULL. */
#if defined(__GNUC__) && !defined(__MINGW32__)
__attribute__((format(printf, 2, 3)))
#endif
static inline void
hnbrdf_note(const hnbrdf_notes *notes, const char *format, ...)
{
    if (notes && notes->note) {
        hnbrdf_error line;
        va_list arguments;
        va_start(arguments, format);
        hnbrdf_error_print(&line, format, arguments);
        va_end(arguments);
        notes->note(notes->user, line.text);
    }
}

#endif
