/* render_mesh.h: the view of `hnbrdf render` when a mesh takes the sphere's place. */
#ifndef HNBRDF_CLI_RENDER_MESH_H
#define HNBRDF_CLI_RENDER_MESH_H

#include "cli/scene_job.h"

typedef struct mesh_view {
    const char *path; /* of the OBJ file; NULL: the sphere */
    int smooth;
    double turn, tilt; /* degrees: of the camera about the mesh, and up */
} mesh_view;

#define MESH_VIEW_DEFAULTS \
    {                      \
        .tilt = 15.0       \
    }

/* clang-format off */
#define MESH_OPTIONS(v) \
    {"mesh", 0, CLI_TEXT, &(v).path, 0, 0, "FILE.obj", "a mesh instead of the sphere (y is up)"}, \
    {"smooth", 0, CLI_FLAG, &(v).smooth, 0, 0, NULL, \
     "of a mesh: normals averaged at its vertices"}, \
    {"turn", 0, CLI_REAL, &(v).turn, -360, 360, "DEG", \
     "of a mesh: walk around it, counter-clockwise"}, \
    {"tilt", 0, CLI_REAL, &(v).tilt, -89, 89, "DEG", \
     "of a mesh: camera above the horizon, default 15"}
/* clang-format on */

/* All of the mesh with this surface, seen as a whole. 0, or CLI_FAILURE after a message. */
int mesh_view_render(const mesh_view *view, const render_surface *surface,
                     const render_environment *environment, int size, const scene_job *job,
                     render_image *image);

#endif
