/* info_physics.h: what `hnbrdf info` says about energy, reciprocity and black values of a model's
 * materials. */
#ifndef HNBRDF_REPORT_INFO_PHYSICS_H
#define HNBRDF_REPORT_INFO_PHYSICS_H

#include "hnbrdf/metrics.h"
#include "report/watch.h"

#include <stdio.h>

/* Of every material of the model, on all processors; malloc'ed, NULL if memory is short. */
hnbrdf_physics *info_measure_physics(const hnbrdf_model *model, const report_watch *watch);
/* A table with a line for each material, `width` the width of its first column, and what it
 * means. */
void info_print_physics(const hnbrdf_model *model, const hnbrdf_physics *physics, int width,
                        FILE *file);
/* The same of one material as members of a JSON object, after others. */
void info_json_physics(const hnbrdf_physics *physics, FILE *file);

#endif
