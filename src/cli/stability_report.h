/* stability_report.h: what `hnbrdf stability` found, as a table, CSV and JSON. */
#ifndef HNBRDF_CLI_STABILITY_REPORT_H
#define HNBRDF_CLI_STABILITY_REPORT_H

#include "check/stability.h"

#include <stdio.h>

/* One model's rows, as stability_run() leaves them. */
typedef struct stability_result {
    const char *path;
    int backend_count;
    stability_row *rows;
} stability_result;

/* 1: no number that is not finite or negative, every bar kept. */
int stability_passed(const stability_result *results, int count);
/* A line for every case, backend and stage; `brief`: of a case's stages only the worst backend's.
 * */
void stability_print(const stability_result *results, int count, int brief, FILE *file);
void stability_write_csv(const stability_result *results, int count, FILE *file);
void stability_write_json(const stability_result *results, int count, FILE *file);

#endif
