/* text_buffer.h: a text that grows as it is written, for shaders that are made in memory. */
#ifndef HNBRDF_BASE_TEXT_BUFFER_H
#define HNBRDF_BASE_TEXT_BUFFER_H

#include <stddef.h>

/* Zero-initialise. After `failed` (no memory) nothing more is added. */
typedef struct hnbrdf_text_buffer {
    char *bytes; /* malloc'ed, NUL-terminated; NULL while empty */
    size_t size, room;
    int failed;
} hnbrdf_text_buffer;

/* An hnbrdf_write_fn for a text_buffer. */
int hnbrdf_text_buffer_append(void *buffer, const void *data, size_t size);
void hnbrdf_text_buffer_print(hnbrdf_text_buffer *buffer, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* The bytes, or NULL with everything freed if anything failed. */
char *hnbrdf_text_buffer_take(hnbrdf_text_buffer *buffer);

#endif
