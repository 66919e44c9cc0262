/* language.h: our GLSL as other shading languages. One text of the formulas, so that they cannot
 * come to differ.
 *
 * What is translated is the GLSL of shaders/hybrid_brdf.glsl and of the exporter: functions without
 * recursion, structs, constants, one uniform block, loops; no matrices, no textures, no
 * initialiser lists. Everything else is refused with its line. Directives are resolved as a Vulkan
 * compiler of GLSL 450 would (330 where the language has no `precise`); macros that stand for
 * numbers, comments and line breaks stay. */
#ifndef HNBRDF_LANGUAGE_LANGUAGE_H
#define HNBRDF_LANGUAGE_LANGUAGE_H

#include "hnbrdf/hnbrdf.h"

#include <stddef.h>

typedef struct hnbrdf_dialect hnbrdf_dialect;

/* A text of a translation; all see what those before them define. */
typedef struct hnbrdf_source {
    const char *name; /* for messages */
    const char *text;
    size_t size;
    int print;           /* 0: only what it defines matters */
    const char *heading; /* if set: printed in place of the comment on top of its guard */
} hnbrdf_source;

extern const hnbrdf_dialect hnbrdf_hlsl, hnbrdf_msl, hnbrdf_wgsl, hnbrdf_slang;
extern const hnbrdf_dialect hnbrdf_glsl_plain; /* without directives */

/* "hlsl": also the ending of its files. */
const char *hnbrdf_dialect_name(const hnbrdf_dialect *dialect);

/* Translates; exact: with HNBRDF_EXACT 1. Nothing is written before everything was understood.
 * HNBRDF_ERROR_FORMAT, with the line, for what is not understood. */
hnbrdf_result hnbrdf_translate(const hnbrdf_source *sources, int count,
                               const hnbrdf_dialect *dialect, int exact,
                               const hnbrdf_allocator *memory, hnbrdf_write_fn write, void *user,
                               hnbrdf_error *error);

#endif
