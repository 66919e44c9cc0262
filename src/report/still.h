/* still.h: the picture of one material, on a sphere or a mesh, before a background. */
#ifndef HNBRDF_REPORT_STILL_H
#define HNBRDF_REPORT_STILL_H

#include "report/same_picture.h"
#include "report/spheres.h"
#include "scene/mesh_view.h"

typedef enum report_background {
    REPORT_BACKDROP = 0, /* like a studio wall */
    REPORT_ENVIRONMENT,
    REPORT_TRANSPARENT
} report_background;

typedef struct report_still {
    /* To fill in: a model and its material, or a measurement. */
    const hnbrdf_model *model;
    int material;
    const hnbrdf_measured *measured;
    int analytic;           /* the model's analytic part alone */
    int layers;             /* of a sphere, EXR: also that part, as a layer */
    int half;               /* EXR: half instead of float */
    int background;         /* a report_background */
    report_spheres spheres; /* opened; size and light hold for a mesh too */
    render_mesh_view mesh;  /* path NULL: a sphere */
    render_job job;         /* of a mesh: output, bounces, seconds, clamp, resume */

    render_image image; /* what was rendered */
} report_still;

/* The sphere or the mesh. A mesh that the watch stops is a picture with fewer samples, as the
 * outcome says; a sphere is HNBRDF_ERROR_CANCELLED then. */
hnbrdf_result report_still_render(report_still *still, render_outcome *outcome,
                                  hnbrdf_error *error);
/* As spheres of models are rendered on devices: hnbrdf_sample() draws, options without progress. */
render_options report_still_options(const report_still *still);
/* The same sphere on the CPU, and how it differs from the image that a device rendered; *seconds
 * receives the time. */
hnbrdf_result report_still_check(report_still *still, report_same_picture *same, double *seconds,
                                 hnbrdf_error *error);
/* Puts the background behind and writes the picture, telling its paths. */
hnbrdf_result report_still_write(report_still *still, const char *path, hnbrdf_error *error);

#endif
