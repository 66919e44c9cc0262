/* conserve.h: a model whose materials give off no more light than they get. */
#ifndef HNBRDF_REPORT_CONSERVE_H
#define HNBRDF_REPORT_CONSERVE_H

#include "hnbrdf/hnbrdf.h"
#include "report/watch.h"

#include <stdio.h>

/* The model with the factors that these of its materials need (hnbrdf_energy_fit()): those that
 * need none have none. Says which got one. */
hnbrdf_result report_conserve(const hnbrdf_model *model, const int *materials, int count,
                              const report_watch *watch, FILE *file, hnbrdf_model **conserving,
                              hnbrdf_error *error);

#endif
