/* texels.h: the materials of an export as texels in a file, and what the packing costs. */
#ifndef HNBRDF_REPORT_TEXELS_H
#define HNBRDF_REPORT_TEXELS_H

#include "hnbrdf/hnbrdf.h"
#include "report/watch.h"

#include <stdio.h>

/* What is packed: materials[0..count) of the model. */
typedef struct report_texels {
    const hnbrdf_model *model;
    const int *materials;
    int count;
    hnbrdf_packing packing;
} report_texels;

/* A row of texels a material, in the order of the materials. */
hnbrdf_result texels_write(const report_texels *texels, const char *path, hnbrdf_error *error);

/* Lines: the format, and the SMAPE between packed and original materials, mean and worst. */
void texels_print_cost(const report_texels *texels, const report_watch *watch, FILE *file);

#endif
