/* export_unpack.h: the GLSL function that makes a material from texels. */
#ifndef HNBRDF_GLSL_EXPORT_UNPACK_H
#define HNBRDF_GLSL_EXPORT_UNPACK_H

#include "glsl/export_scene.h"
#include "glsl/printer.h"

/* A line of the heading: format, texels and bytes of a material. */
void hnbrdf_put_texel_summary(hnbrdf_printer *out, const hnbrdf_packing *packing);

/* #define HNBRDF_TEXELS N and
 *   hnbrdf_material hnbrdf_material_unpack(vec4 t0, ...)      of N texels
 * For scenes that have a packing. */
void hnbrdf_put_unpack(hnbrdf_printer *out, const hnbrdf_scene *s);

#endif
