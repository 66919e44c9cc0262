/* scene_compare.h: one scene rendered with the models, with their GGX parts and with the
 * measurements. */
#ifndef HNBRDF_CLI_SCENE_COMPARE_H
#define HNBRDF_CLI_SCENE_COMPARE_H

#include "cli/scene_job.h"
#include "scene/describe.h"

typedef struct scene_files {
    const char *path, *csv, *json; /* csv, json: of the table, or NULL */
    render_description description;
} scene_files;

typedef struct scene_sizes {
    long width; /* 0: what the scene says */
} scene_sizes;

/* Loads the scene in this way and renders it. 0, or CLI_FAILURE after a message. */
int scene_files_render(const scene_files *files, const scene_job *job, render_show show,
                       const char *folder, const char *what, render_image *image, scene_time *time);
/* Renders the measurements in `folder`, the models and GGX alone; writes OUTPUT (models),
 * OUTPUT_ggx and OUTPUT_measured, prints errors against the measurements and times. */
int scene_compare(const scene_files *files, const scene_job *job, const char *folder,
                  double exposure);

#endif
