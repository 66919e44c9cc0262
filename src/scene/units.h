/* units.h: the vertices of a mesh in units and from a place that suit single precision. */
#ifndef HNBRDF_SCENE_UNITS_H
#define HNBRDF_SCENE_UNITS_H

#include "scene/mesh.h"

/* Gives a mesh whose triangles number the positions p[0..count) those that they use, in their
 * order. *place takes them back to p: the identity, unless the mesh is far from the origin for its
 * size, or very large or small. 0, or -1 when memory is out. */
int render_units_settle(const double (*p)[3], size_t count, render_mesh *mesh,
                        render_transform *place);
/* 1 if a triangle is wider than the rounding of the coordinates: there is something to be drawn. */
int render_units_resolve(const render_mesh *mesh);

#endif
