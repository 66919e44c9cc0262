/* export_language.h: an exported text in another language than GLSL. */
#ifndef HNBRDF_GLSL_EXPORT_LANGUAGE_H
#define HNBRDF_GLSL_EXPORT_LANGUAGE_H

#include "base/printer.h"
#include "hnbrdf/glsl.h"

/* A text that grows in the memory of an allocator. */
typedef struct hnbrdf_grown {
    const hnbrdf_allocator *memory;
    char *text;
    size_t size, room;
} hnbrdf_grown;

/* An hnbrdf_write_fn for it: nonzero without memory. */
int hnbrdf_grow(void *grown, const void *data, size_t size);

/* Writes `text`, GLSL, in the language of the options. It is the shared part, or begins with it
 * where `with_library` is 1; else it is what includes that. */
hnbrdf_result hnbrdf_write_language(const hnbrdf_grown *text, int with_library,
                                    const hnbrdf_glsl_options *options, hnbrdf_write_fn write,
                                    void *user, hnbrdf_error *error);

#endif
