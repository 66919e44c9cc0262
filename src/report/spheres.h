/* spheres.h: what pages of spheres share: the light, the measurements beside, progress. */
#ifndef HNBRDF_REPORT_SPHERES_H
#define HNBRDF_REPORT_SPHERES_H

#include "report/picture.h"
#include "report/watch.h"

typedef struct report_spheres {
    hnbrdf_measured *const *data; /* measurements to show, found by the names of materials */
    int data_count;
    report_light light;
    long size; /* pixels of a sphere's side */
    report_watch watch;
    int first, count;   /* `first` of `count` spheres are done */
    const char *detail; /* what is being rendered */
    render_environment environment;
    hnbrdf_model *guide; /* see render_guide_model() */
} report_spheres;

/* Opens the light and makes the guide. */
hnbrdf_result report_spheres_open(report_spheres *spheres, hnbrdf_error *error);
void report_spheres_close(report_spheres *spheres);

/* The measurement of this name, or NULL. */
const hnbrdf_measured *report_spheres_find(const report_spheres *spheres, const char *name);
/* One sphere, with progress; the caller counts it as done. HNBRDF_ERROR_CANCELLED if the watch
 * stops it. */
hnbrdf_result report_spheres_render(report_spheres *spheres, const render_surface *surface,
                                    render_image *image, hnbrdf_error *error);

/* report_picture_write(), and the watch is told the paths of what was written. */
hnbrdf_result report_write_told(const render_image *image, const char *path,
                                const render_write_options *options, const report_watch *watch,
                                hnbrdf_error *error);

/* What follows the last slash of a path. */
const char *report_base_name(const char *path);

#endif
