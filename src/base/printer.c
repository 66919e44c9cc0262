/* printer.c: text written piece by piece through the caller's function; the first failure sticks.
 * */
#include "base/printer.h"

#include "base/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void hnbrdf_put_flush(hnbrdf_printer *out)
{
    if (!out->failed && out->used > 0)
        out->failed = out->write(out->user, out->buffer, out->used) != 0;
    out->used = 0;
}

void hnbrdf_put_bytes(hnbrdf_printer *out, const char *text, size_t size)
{
    while (size > 0) {
        size_t room = sizeof out->buffer - out->used;
        size_t part = size < room ? size : room;
        memcpy(out->buffer + out->used, text, part);
        out->used += part;
        text += part;
        size -= part;
        if (out->used == sizeof out->buffer)
            hnbrdf_put_flush(out);
    }
}

void hnbrdf_put(hnbrdf_printer *out, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (length > 0)
        hnbrdf_put_bytes(out, text,
                         (size_t)length < sizeof text ? (size_t)length : sizeof text - 1);
}

void hnbrdf_put_float(hnbrdf_printer *out, float value)
{
    char text[HNBRDF_NUMBER_TEXT];
    int length = hnbrdf_format_float(text, sizeof text, value);
    hnbrdf_put_bytes(out, text, (size_t)length);
    if (!strpbrk(text, ".e"))
        hnbrdf_put_bytes(out, ".0", 2);
}
