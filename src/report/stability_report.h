/* stability_report.h: what `hnbrdf stability` found, as a table, CSV and JSON. */
#ifndef HNBRDF_REPORT_STABILITY_REPORT_H
#define HNBRDF_REPORT_STABILITY_REPORT_H

#include "check/stability.h"

#include <stdio.h>

/* One model's rows, as stability_run() leaves them. */
typedef struct stability_result {
    const char *path;
    int backend_count;
    stability_row *rows;
} stability_result;

typedef struct stability_results {
    const stability_result *items;
    int count;
} stability_results;

/* 1: no number that is not finite or negative, every bar kept. */
int stability_passed(const stability_result *results, int count);
/* A line for every case, backend and stage; `brief`: of a case's stages only the worst backend's.
 * */
void stability_print(const stability_result *results, int count, int brief, FILE *file);
/* For programs; the argument is a stability_results. */
void stability_write_csv(const void *results, FILE *file);
void stability_write_json(const void *results, FILE *file);

#endif
