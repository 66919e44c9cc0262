/* mesh_view.h: a mesh of one surface, seen as a whole. */
#ifndef HNBRDF_SCENE_MESH_VIEW_H
#define HNBRDF_SCENE_MESH_VIEW_H

#include "scene/job.h"

typedef struct render_mesh_view {
    const char *path; /* of the OBJ file */
    int smooth;
    double turn, tilt;  /* degrees: of the camera about the mesh, and up */
    hnbrdf_notes notes; /* told of what was left aside of the file */
} render_mesh_view;

/* A picture of size x size pixels of all of the mesh with this surface. */
hnbrdf_result render_mesh_view_run(const render_mesh_view *view, const render_surface *surface,
                                   const render_environment *environment, int size,
                                   const render_job *job, render_image *image,
                                   render_outcome *outcome, hnbrdf_error *error);

#endif
