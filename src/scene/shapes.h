/* shapes.h: shapes from formulas, as meshes with normals and texture coordinates; y is up. */
#ifndef HNBRDF_SCENE_SHAPES_H
#define HNBRDF_SCENE_SHAPES_H

#include "scene/mesh.h"

typedef enum render_shape_kind {
    RENDER_SPHERE, /* radius 1 about the origin; never a mesh, see scene.h */
    RENDER_QUAD,   /* unit square in the plane y = 0 about the origin, facing up */
    RENDER_BOX,    /* unit cube about the origin */
    RENDER_TORUS,  /* about the y axis: ring of radius 1, tube of radius `tube` */
    /* torus knot: turns[0] times about the axis, turns[1] through the hole */
    RENDER_KNOT,
    /* Barr 1981, radii 1; powers 1 1: sphere, 0.2 0.2: box with round edges */
    RENDER_SUPERELLIPSOID,
    RENDER_TEAPOT, /* Newell 1975, on y = 0, 3.15 high, spout towards +x */
    RENDER_LATHE,  /* a profile turned about the y axis */
    RENDER_OBJ,    /* from a file */
    RENDER_SHAPE_KINDS
} render_shape_kind;

enum { RENDER_MAX_PROFILE = 64 };

/* Zero-initialise for defaults. */
typedef struct render_shape_options {
    int detail;       /* quads around; 0 stands for 64 */
    double tube;      /* torus, knot: 0 stands for 0.35 */
    double turns[2];  /* knot, whole numbers; 0 stands for 2 and 3 */
    double powers[2]; /* superellipsoid, of latitude and longitude; 0 stands for 1 */
    /* lathe: (radius, y), a Catmull-Rom spline through these; a point given twice is a corner.
     * Going up it faces away from the axis. */
    int profile_count;
    double profile[RENDER_MAX_PROFILE][2];
} render_shape_options;

/* Adds the shape to the mesh, in part "". 0, or -1 when memory is out. */
int render_shape_mesh(render_shape_kind kind, const render_shape_options *options,
                      render_mesh *mesh);

/* ---- For shapes made of pieces --------------------------------------------------------------- */

/* A point for (u, v) in [0, 1]^2. dP/du x dP/dv points outwards. Returns 1 if it has set the
 * normal n too; 0 leaves that to differences. */
typedef int (*render_patch_fn)(const void *user, double u, double v, double p[3], double n[3]);
/* Adds across x along quads of it. 0, or -1 when memory is out. */
int render_patch_mesh(render_patch_fn patch, const void *user, int across, int along,
                      render_mesh *mesh);
int render_teapot_mesh(int detail, render_mesh *mesh);

#endif
