/* scene_compare.h: one scene rendered with the models, with their GGX parts and with the
 * measurements: pictures, errors and times. */
#ifndef HNBRDF_REPORT_SCENE_COMPARE_H
#define HNBRDF_REPORT_SCENE_COMPARE_H

#include "report/watch.h"
#include "scene/job.h"

#include <stdio.h>

typedef struct report_scene {
    const render_description *description;
    const render_reading *reading;
    const char *folder; /* where the measurements are */
    /* its output: the models' picture; OUTPUT_ggx and OUTPUT_measured lie beside. No progress and
     * no checkpoints */
    render_job job;
    double exposure; /* stops */
    int half;        /* EXR: half instead of float */
    report_watch watch;
} report_scene;

enum { REPORT_SCENE_MEASURED, REPORT_SCENE_MODEL, REPORT_SCENE_GGX, REPORT_SCENE_ROWS };

typedef struct report_scene_row {
    double mae;       /* of the means of both halves, with what noise is left; of
                       * REPORT_SCENE_MEASURED the noise alone */
    double psnr;      /* without noise; peak: the largest value of the measured picture */
    double png_psnr;  /* of the values in the PNG, 0 to 1, peak 1; likewise */
    double cpu, wall; /* seconds it took */
} report_scene_row;

/* Renders all and writes the pictures, telling their paths. Stopped by the watch:
 * HNBRDF_ERROR_CANCELLED. */
hnbrdf_result report_scene_compare(const report_scene *scene,
                                   report_scene_row rows[REPORT_SCENE_ROWS], hnbrdf_error *error);

/* The rows as text, CSV and JSON; `rows` is report_scene_row[REPORT_SCENE_ROWS]. */
void report_scene_print(const void *rows, FILE *file);
void report_scene_write_csv(const void *rows, FILE *file);
void report_scene_write_json(const void *rows, FILE *file);

#endif
