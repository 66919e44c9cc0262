/* obj.h: read Wavefront OBJ files of any origin. */
#ifndef HNBRDF_SCENE_OBJ_H
#define HNBRDF_SCENE_OBJ_H

#include "scene/mesh.h"

/* Zero-initialise for defaults; those of the limits are also the most. */
typedef struct render_obj_options {
    size_t max_bytes;     /* of the file; 0 stands for 512 MiB */
    size_t max_triangles; /* 0 stands for 2^25 */
    int smooth;           /* render_mesh_smooth() in place of the file's normals */
    hnbrdf_notes notes;   /* told of what was left aside or computed, a line for each kind */
} render_obj_options;

/* v, vt, vn, f with any number of corners and negative indices, usemtl, g, o; lines may be
 * continued with a backslash, and faces may come before what they name. Materials, smoothing
 * groups and the like are passed over, as are a w of v, a third vt and colours after xyz.
 *
 * Drawn, and noted: faces without normals or texture coordinates that others have, that the file
 * lacks, or that are no numbers, get none. Left aside, and noted: faces of fewer than 3 corners,
 * lines, points, free-form surfaces, unknown statements. Triangles without any area are left out;
 * a mesh without a triangle wider than the rounding of its coordinates is refused.
 *
 * The mesh has the vertices of its triangles alone. Where single precision could not hold their
 * places, far from the origin, or where they are very large or small, they are moved and scaled:
 * *place takes them to the coordinates of the file, and is render_identity where that is not so.
 * place may be NULL. Memory is at most some 40 times the file. */
hnbrdf_result render_obj_decode(const void *data, size_t size, const char *name,
                                const render_obj_options *options, render_mesh *mesh,
                                render_transform *place, hnbrdf_error *error);
hnbrdf_result render_obj_read(const char *path, const render_obj_options *options,
                              render_mesh *mesh, render_transform *place, hnbrdf_error *error);

#endif
