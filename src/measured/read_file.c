/* read_file.c: a whole file into memory, never beyond the limit by more than the buffer that holds
 * it. */
#include "measured/read_file.h"
#include "base/error.h"
#include "base/files.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { FIRST_CHUNK = 1 << 20 /* bytes; the buffer doubles from here */ };

/* Everything up to the end of the stream, at most limit bytes, into *bytes (malloc'ed, also when
 * empty). The size is what could be read: pipes and special files have no other. */
static hnbrdf_result read_stream(FILE *stream, size_t limit, const char *label,
                                 unsigned char **bytes, size_t *size, hnbrdf_error *error)
{
    size_t capacity = FIRST_CHUNK, used = 0;
    unsigned char *buffer = malloc(capacity);
    while (buffer) {
        used += fread(buffer + used, 1, capacity - used, stream);
        if (used > limit) {
            free(buffer);
            return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "%s: larger than the limit of %zu bytes",
                               label, limit);
        }
        if (ferror(stream)) {
            free(buffer);
            return hnbrdf_fail(error, HNBRDF_ERROR_IO,
                               "%s: cannot be read after %zu bytes, expected a regular file", label,
                               used);
        }
        if (used < capacity) {
            *bytes = buffer;
            *size = used;
            return HNBRDF_OK;
        }
        unsigned char *larger = capacity <= SIZE_MAX / 2 ? realloc(buffer, capacity * 2) : NULL;
        if (!larger)
            free(buffer);
        buffer = larger;
        capacity *= 2;
    }
    return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: out of memory after reading %zu bytes",
                       label, used);
}

hnbrdf_result hnbrdf_read_file(const char *path, size_t limit, const char *label,
                               unsigned char **bytes, size_t *size, hnbrdf_error *error)
{
    FILE *stream = hnbrdf_open_whole(path, label, error);
    if (!stream)
        return HNBRDF_ERROR_IO;
    hnbrdf_result result = read_stream(stream, limit, label, bytes, size, error);
    fclose(stream);
    return result;
}
