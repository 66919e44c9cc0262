/* stability_plot.h: heat maps of the error, for `hnbrdf stability --plot`. */
#ifndef HNBRDF_REPORT_STABILITY_PLOT_H
#define HNBRDF_REPORT_STABILITY_PLOT_H

#include "check/stability.h"

/* Writes FILE.png: two maps (see maps.h) of each of: plain C, the first fast shader, the first half
 * one. */
hnbrdf_result stability_plot(const char *path, const hnbrdf_model *model, const char *model_path,
                             stability_backend *backends, int backend_count, hnbrdf_error *error);

#endif
