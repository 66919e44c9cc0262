/* bake.h: what a bake tried and picked, for people, as CSV, as JSON and as a picture. */
#ifndef HNBRDF_REPORT_BAKE_H
#define HNBRDF_REPORT_BAKE_H

#include "hnbrdf/bake.h"

#include <stdio.h>

/* For people, in this order: what is baked (path: of the model), the columns and the model's own
 * row (once the report has its first row), each row, the result. */
void report_bake_heading(const hnbrdf_bake_report *report, const char *path, FILE *file);
void report_bake_columns(const hnbrdf_bake_report *report, FILE *file);
void report_bake_row(const hnbrdf_bake_report *report, const hnbrdf_bake_row *row, FILE *file);
void report_bake_result(const hnbrdf_bake_report *report, const char *output, FILE *file);

/* What is being done, "short fits of 4x1 to 8x2", and how it goes, for a line that is rewritten. */
void report_bake_stage(const hnbrdf_bake_progress *progress, char what[64], char detail[64]);

/* HNBRDF_OK if the model saved as `output` is what was asked for; else why it is not: it was
 * stopped or had `seconds` for all (HNBRDF_ERROR_CANCELLED), or nothing is good enough
 * (HNBRDF_ERROR_LIMIT). */
hnbrdf_result report_bake_verdict(const hnbrdf_bake_report *report, double seconds,
                                  const char *output, hnbrdf_error *error);

/* For programs; the argument is an hnbrdf_bake_report. */
void report_bake_csv(const void *report, FILE *file);
void report_bake_json(const void *report, FILE *file);
/* SVG: error against time of every row, the limit, and the picked one. */
void report_bake_plot(const void *report, FILE *file);

/* Bakes of 1, 6, ... materials, each with HNBRDF_BAKE_FRONT. */
enum { REPORT_BAKE_FRONTS = 6 };
typedef struct report_bake_front {
    hnbrdf_bake_report reports[REPORT_BAKE_FRONTS];
    int count;
} report_bake_front;
/* The argument is a report_bake_front. CSV as above with the number of materials before it; SVG:
 * the error against time that each can reach. */
void report_bake_front_csv(const void *front, FILE *file);
void report_bake_front_plot(const void *front, FILE *file);

#endif
