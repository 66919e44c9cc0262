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
    int planes; /* 0: all texels of a material, then the next one's; 1: the first texel of all
                   materials, then the second of all, and so on */
} report_texels;

/* In the order of the materials, without a header. */
hnbrdf_result texels_write(const report_texels *texels, const char *path, hnbrdf_error *error);

/* Lines: the format, the fields and which material asks for them, and the SMAPE between packed and
 * original materials, mean and worst. */
void texels_print_cost(const report_texels *texels, const report_watch *watch, FILE *file);

#endif
