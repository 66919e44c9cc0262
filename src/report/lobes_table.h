/* lobes_table.h: the lobes with which the materials of a model are sampled, as a table. */
#ifndef HNBRDF_REPORT_LOBES_TABLE_H
#define HNBRDF_REPORT_LOBES_TABLE_H

#include "hnbrdf/hnbrdf.h"

#include <stdio.h>

void report_lobes_print(const hnbrdf_model_desc *desc, FILE *file);
/* desc is an hnbrdf_model_desc. */
void report_lobes_write_csv(const void *desc, FILE *file);

#endif
