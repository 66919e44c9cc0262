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

/* Writes `glsl` in the language of the options; it comes behind this scene. */
hnbrdf_result hnbrdf_write_behind(const hnbrdf_grown *scene, const char *name, const char *glsl,
                                  const hnbrdf_glsl_options *options, hnbrdf_write_fn write,
                                  void *user, hnbrdf_error *error);

/* For checks: writes `glsl`, a text that comes behind the standalone scene of these options, in
 * their language; in GLSL as it is. name is for messages. */
hnbrdf_result hnbrdf_export_behind(const hnbrdf_model *model, const hnbrdf_glsl_options *options,
                                   const char *name, const char *glsl, hnbrdf_write_fn write,
                                   void *user, hnbrdf_error *error);

#endif
