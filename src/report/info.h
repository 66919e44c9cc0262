/* info.h: what `hnbrdf info` tells of models and measured files. */
#ifndef HNBRDF_REPORT_INFO_H
#define HNBRDF_REPORT_INFO_H

#include "hnbrdf/measured.h"
#include "hnbrdf/metrics.h"

#include <stdio.h>

/* For people. physics: of each material, as info_measure_physics() gives it, or NULL: not told. */
void info_print_model(const char *path, const hnbrdf_model *model, const hnbrdf_physics *physics,
                      FILE *file);
void info_print_measured(const char *path, const hnbrdf_measured *measured, FILE *file);
/* Several measured materials, a line each. */
void info_print_data(hnbrdf_measured *const *items, int count, FILE *file);

/* The same as JSON. `identified`: 1 if the file was compared with the published ones. */
void info_json_model(const hnbrdf_model *model, const hnbrdf_physics *physics, FILE *file);
void info_json_measured(const hnbrdf_measured *measured, int identified, FILE *file);
void info_json_data(hnbrdf_measured *const *items, int count, FILE *file);

#endif
