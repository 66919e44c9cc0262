/* output.h: files that a person names: stdout for "-", otherwise complete or not there. */
#ifndef HNBRDF_REPORT_OUTPUT_H
#define HNBRDF_REPORT_OUTPUT_H

#include "base/files.h"

#include <stdio.h>

/* As base/files.h has it; "-" is stdout. */
typedef struct report_output {
    FILE *file;           /* write here */
    hnbrdf_output output; /* unless it is stdout */
} report_output;

hnbrdf_result report_output_open(const char *path, report_output *output, hnbrdf_error *error);
/* Flush, check, rename. */
hnbrdf_result report_output_close(report_output *output, hnbrdf_error *error);
/* Can it be written? To be asked before long work. */
hnbrdf_result report_output_check(const char *path, hnbrdf_error *error);
/* Drops what was written. */
void report_output_discard(report_output *output);
/* Unless it is there. */
hnbrdf_result report_make_folder(const char *path, hnbrdf_error *error);

/* DIRECTORY/NAME; malloc'ed, NULL with the message of it when memory is short. */
char *report_path_join(const char *directory, const char *name, hnbrdf_error *error);
/* Opens, writes and closes; what `write` could not write is an error. */
hnbrdf_result report_write_file(const char *path, void (*write)(const void *what, FILE *file),
                                const void *what, hnbrdf_error *error);

/* FILE.png, written beside FILE.exr; malloc'ed, NULL when memory is short. */
char *report_png_beside(const char *path);

#endif
