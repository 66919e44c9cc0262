/* texels.h: the materials of an export as texels in a file, and what the packing costs. */
#ifndef HNBRDF_CLI_TEXELS_H
#define HNBRDF_CLI_TEXELS_H

#include "hnbrdf/hnbrdf.h"

#include <stdio.h>

/* What is packed: materials[0..count) of the model. */
typedef struct cli_texels {
    const hnbrdf_model *model;
    const int *materials;
    int count;
    hnbrdf_packing packing;
} cli_texels;

/* A row of texels a material, in the order of the materials. Returns 0, or CLI_FAILURE after a
 * message. */
int cli_texels_write(const cli_texels *texels, const char *path);

/* Lines: the format, and the SMAPE between packed and original materials, mean and worst. */
void cli_texels_print_cost(const cli_texels *texels, FILE *file);

#endif
