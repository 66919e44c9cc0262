/* csv.h: read comma-separated text line by line. */
#ifndef HNBRDF_BASE_CSV_H
#define HNBRDF_BASE_CSV_H

#include "hnbrdf/hnbrdf.h"

#include <stdio.h>

enum { HNBRDF_CSV_LINE = 8192, HNBRDF_CSV_FIELDS = 256 };

typedef struct hnbrdf_csv_reader {
    FILE *file;
    const char *name; /* of the file, for messages */
    long line;        /* the number of the line read last, from 1 */
    long blank;       /* how many blank lines came before it, or before the end */
    int count;        /* fields of it */
    const char
        *fields[HNBRDF_CSV_FIELDS]; /* each ends with NUL, without its quotes and outer spaces */
    char text[HNBRDF_CSV_LINE];
} hnbrdf_csv_reader;

void hnbrdf_csv_begin(hnbrdf_csv_reader *reader, FILE *file, const char *name);

/* Reads the next line that is not blank and splits it: 1, or 0 at the end, or -1 with *error
 * filled: a line that is too long, holds a NUL byte, a CR or an open quote, or cannot be read.
 * Lines end with LF or CRLF, the last one may go without; a byte order mark is skipped. */
int hnbrdf_csv_next(hnbrdf_csv_reader *reader, hnbrdf_error *error);

/* 1 if a field of this line holds the character, which may have been meant to separate fields. */
int hnbrdf_csv_has(const hnbrdf_csv_reader *reader, char c);

/* Reads fields[index] as one finite decimal number: 0, or -1 with *error filled, which calls it
 * `what`. */
int hnbrdf_csv_number(const hnbrdf_csv_reader *reader, int index, const char *what, float *value,
                      hnbrdf_error *error);

#endif
