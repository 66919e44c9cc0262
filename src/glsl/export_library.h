/* export_library.h: the text of shaders/hybrid_brdf.glsl, whole or as far as a scene needs it. */
#ifndef HNBRDF_GLSL_EXPORT_LIBRARY_H
#define HNBRDF_GLSL_EXPORT_LIBRARY_H

#include "glsl/export_scene.h"
#include "glsl/printer.h"

/* The text of shaders/hybrid_brdf.glsl; the build makes it from that file. */
extern const char hnbrdf_hybrid_brdf_glsl[];

/* Letters, digits and underscores. */
static inline int hnbrdf_in_word(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

typedef void (*hnbrdf_put_scene_fn)(hnbrdf_printer *out, const hnbrdf_scene *s);

/* The whole of it for a scene that leaves nothing out; else what the text written by put_scene
 * calls, directly or not, and the preprocessor's lines. For a scene with a prefix each function and
 * struct has a guard of its own, so that several such texts can stand in one shader. */
void hnbrdf_put_library(hnbrdf_printer *out, const hnbrdf_scene *s, hnbrdf_put_scene_fn put_scene);

#endif
