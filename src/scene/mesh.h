/* mesh.h: triangles in memory: from files and from formulas. */
#ifndef HNBRDF_SCENE_MESH_H
#define HNBRDF_SCENE_MESH_H

#include "hnbrdf/hnbrdf.h"

#include <stdint.h>

#define RENDER_NONE UINT32_MAX

/* Counter-clockwise as seen from the side that its normal points to. Indices below the counts of
 * the mesh; RENDER_NONE for all three corners where there are no normals or texture coordinates. */
typedef struct render_triangle {
    uint32_t position[3], normal[3], uv[3], part;
} render_triangle;

/* What a material is bound to: named by the last usemtl, before any by the last g or o; "" for
 * none. */
typedef struct render_part {
    char name[HNBRDF_MAX_NAME + 1];
} render_part;

/* All-zero is an empty mesh. */
typedef struct render_mesh {
    float (*positions)[3], (*normals)[3], (*uvs)[2];
    render_triangle *triangles;
    render_part *parts;
    size_t position_count, normal_count, uv_count, triangle_count, part_count;
    /* Of the functions below: room in each array; numbers of parts, from 1, by a hash of their
     * names, and how many fit. */
    size_t position_room, normal_room, uv_room, triangle_room, part_room;
    uint32_t *part_slots;
    size_t part_slot_count;
} render_mesh;

void render_mesh_free(render_mesh *mesh);

/* Each adds one element and returns its index, or RENDER_NONE when memory is out. */
uint32_t render_mesh_position(render_mesh *mesh, const double p[3]);
uint32_t render_mesh_normal(render_mesh *mesh, const double n[3]);
uint32_t render_mesh_uv(render_mesh *mesh, const double uv[2]);
uint32_t render_mesh_triangle(render_mesh *mesh, const render_triangle *triangle);
/* The part of that name, cut to HNBRDF_MAX_NAME bytes: an old one, or a new one added at the end.
 * */
uint32_t render_mesh_part(render_mesh *mesh, const char *name, size_t length);

/* Normals at the positions, the average of the triangles around each weighted by their angles
 * there; in place of those that were. 0, or -1 when memory is out. */
int render_mesh_smooth(render_mesh *mesh);

/* x' = m[..][0..2] x + m[..][3]. Normals go with the inverse transpose; a mirror image keeps its
 * outside. */
typedef struct render_transform {
    double m[3][4];
} render_transform;
extern const render_transform render_identity;
/* The transform that does a, then b. */
render_transform render_transform_then(const render_transform *a, const render_transform *b);
double render_transform_determinant(const render_transform *transform);
void render_mesh_transform(render_mesh *mesh, const render_transform *transform);
/* The largest coordinate of the mesh once transformed, as an absolute value; NaN if one is. */
double render_mesh_reach(const render_mesh *mesh, const render_transform *transform);

/* Smallest and largest coordinates; the mesh must not be empty. */
void render_mesh_bounds(const render_mesh *mesh, float low[3], float high[3]);

#endif
