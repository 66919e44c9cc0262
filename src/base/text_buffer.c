/* text_buffer.c: a text that grows as it is written. */
#include "base/text_buffer.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int hnbrdf_text_buffer_append(void *buffer, const void *data, size_t size)
{
    hnbrdf_text_buffer *text = buffer;
    if (!text->failed && text->size + size + 1 > text->room) {
        size_t room = 2 * (text->size + size + 1);
        char *grown = realloc(text->bytes, room);
        text->failed = !grown;
        text->bytes = grown ? grown : text->bytes;
        text->room = grown ? room : text->room;
    }
    if (text->failed)
        return 1;
    memcpy(text->bytes + text->size, data, size);
    text->size += size;
    text->bytes[text->size] = '\0';
    return 0;
}

void hnbrdf_text_buffer_print(hnbrdf_text_buffer *buffer, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (length >= 0 && (size_t)length < sizeof text)
        hnbrdf_text_buffer_append(buffer, text, (size_t)length);
    else
        buffer->failed = 1;
}

char *hnbrdf_text_buffer_take(hnbrdf_text_buffer *buffer)
{
    char *bytes = buffer->bytes;
    if (buffer->failed) {
        free(bytes);
        bytes = NULL;
    }
    *buffer = (hnbrdf_text_buffer){0};
    return bytes;
}
