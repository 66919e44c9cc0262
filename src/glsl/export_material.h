/* export_material.h: the material of a scene as a GLSL struct, and the scene's materials as
 * constants. */
#ifndef HNBRDF_GLSL_EXPORT_MATERIAL_H
#define HNBRDF_GLSL_EXPORT_MATERIAL_H

#include "glsl/export_scene.h"
#include "glsl/printer.h"

/* struct hnbrdf_material. What a fixed scene keeps is not what can be edited, but what evaluation
 * needs. */
void hnbrdf_put_material_struct(hnbrdf_printer *out, const hnbrdf_scene *s);

/* HNBRDF_MATERIAL_NAME, HNBRDF_MATERIAL_COUNT and hnbrdf_material hnbrdf_scene_material(int
 * index). */
void hnbrdf_put_materials(hnbrdf_printer *out, const hnbrdf_scene *s);

/* hnbrdf_material(...) of material k as an expression. */
void hnbrdf_put_material(hnbrdf_printer *out, const hnbrdf_scene *s, int k);

#endif
