/* picture.h: what makers of pictures share: light, exposure, files, comparison. */
#ifndef HNBRDF_REPORT_PICTURE_H
#define HNBRDF_REPORT_PICTURE_H

#include "hnbrdf/metrics.h"
#include "render/render.h"

#include <stdio.h>

typedef struct report_light {
    const char *env; /* "sky", "furnace" or a file */
    double rotate;   /* degrees */
    double exposure; /* stops; NAN: chosen */
    long spp, seed, threads;
    const char *layer;  /* of the environment's file, see render_read_options */
    int repair;         /* likewise */
    hnbrdf_notes notes; /* told of what the environment's file needed */
} report_light;

/* Opens the environment and, where none was given, sets the exposure: mean light as bright as that
 * of the sky. */
hnbrdf_result report_open_light(report_light *light, render_environment *environment,
                                hnbrdf_error *error);

/* Writes path and, for an .exr, the .png beside it. */
hnbrdf_result report_picture_write(const render_image *image, const char *path,
                                   const render_write_options *options, hnbrdf_error *error);
/* A line for each file that report_picture_write() wrote. */
void report_print_pictures(const char *path, FILE *file);

/* Error over the pixels that render_covered() counts, as they are, premultiplied; pictures of the
 * same size. */
hnbrdf_result report_picture_compare(const render_image *image, const render_image *reference,
                                     hnbrdf_image_error *difference, hnbrdf_error *error);
/* Of pictures rendered twice: see hnbrdf_image_compare_twice(). */
hnbrdf_result report_picture_compare_twice(const render_image image[2],
                                           const render_image reference[2],
                                           hnbrdf_image_error *difference,
                                           hnbrdf_image_noise *noise, hnbrdf_error *error);

#endif
