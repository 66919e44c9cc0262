/* printer.h: text written piece by piece through the caller's function, for shaders. */
#ifndef HNBRDF_BASE_PRINTER_H
#define HNBRDF_BASE_PRINTER_H

#include "hnbrdf/hnbrdf.h"

#include <stddef.h>

/* Start with write and user set and all else zero. Buffered; after the first failure nothing is
 * written, and `failed` stays set. */
typedef struct hnbrdf_printer {
    hnbrdf_write_fn write;
    void *user;
    int failed;
    size_t used;
    char buffer[4096];
} hnbrdf_printer;

void hnbrdf_put_flush(hnbrdf_printer *out);
void hnbrdf_put_bytes(hnbrdf_printer *out, const char *text, size_t size);

/* Whole numbers and text only: a %g would follow the locale. At most 511 characters a call. */
#if defined(__GNUC__) && !defined(__MINGW32__) /* whose printf attribute knows no %zu */
__attribute__((format(printf, 2, 3)))
#endif
void hnbrdf_put(hnbrdf_printer *out, const char *format, ...);

/* A literal that shading languages take for a float and that reads back as the same bits. */
void hnbrdf_put_float(hnbrdf_printer *out, float value);

#endif
