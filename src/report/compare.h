/* compare.h: how far a model is from measured materials, one row for each, as `hnbrdf compare`
 * tells it. */
#ifndef HNBRDF_REPORT_COMPARE_H
#define HNBRDF_REPORT_COMPARE_H

#include "hnbrdf/metrics.h"
#include "report/watch.h"

#include <stdio.h>

typedef struct compare_row {
    const hnbrdf_measured *measured;
    int material, material_against; /* numbers in the models */
    hnbrdf_comparison error, error_against;
    hnbrdf_result result; /* of measuring it, with its message */
    hnbrdf_error message;
} compare_row;

/* Set down to seed; compare_choose() makes the rows, compare_measure() fills them. */
typedef struct model_comparison {
    const char *path, *path_against; /* the second one NULL when there is only one model */
    const hnbrdf_model *model, *against;
    hnbrdf_sampler sampler;
    long pairs, seed;
    compare_row *rows; /* malloc'ed; the caller frees it */
    int count;
    hnbrdf_comparison mean, mean_against;
} model_comparison;

/* A row for each of these that the models have; one they lack is an error unless skip_missing. */
hnbrdf_result compare_choose(model_comparison *comparison, hnbrdf_measured *const *items, int count,
                             int skip_missing, hnbrdf_error *error);
/* Materials are shared out to threads (0: one a processor); each has its own sequence of pairs, so
 * that the threads do not change a digit. */
hnbrdf_result compare_measure(model_comparison *comparison, int threads, const report_watch *watch,
                              hnbrdf_error *error);

/* For people: the table; which of the two models is better for how many materials. */
void compare_print(const model_comparison *comparison, FILE *file);
void compare_print_wins(const model_comparison *comparison, FILE *file);
/* For programs; the argument is a model_comparison. */
void compare_write_csv(const void *comparison, FILE *file);
void compare_write_json(const void *comparison, FILE *file);

#endif
