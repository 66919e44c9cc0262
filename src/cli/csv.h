/* csv.h: read comma-separated text line by line, and write fields of it. */
#ifndef HNBRDF_CLI_CSV_H
#define HNBRDF_CLI_CSV_H

#include <stddef.h>
#include <stdio.h>

enum { CSV_LINE = 8192, CSV_FIELDS = 256 };

typedef struct csv_reader {
    FILE *file;
    const char *name;               /* of the file, for messages */
    long line;                      /* the number of the line read last, from 1 */
    int count;                      /* fields of it */
    const char *fields[CSV_FIELDS]; /* each ends with NUL, without its quotes and outer spaces */
    char text[CSV_LINE];
} csv_reader;

void csv_begin(csv_reader *reader, FILE *file, const char *name);

/* Reads the next line that is not blank and splits it: 1, or 0 at the end, or -1 after a message
 * about a line that is too long, holds a NUL byte or an open quote, or cannot be read. Lines end
 * with LF or CRLF, the last one may go without; a byte order mark is skipped. */
int csv_next(csv_reader *reader);

/* Reads fields[index] as one finite decimal number: 0, or -1 after a message that calls it
 * `what`. */
int csv_number(const csv_reader *reader, int index, const char *what, float *value);

/* Writes one field, in quotes where it needs them (RFC 4180). */
void csv_write_text(FILE *file, const char *text);

#endif
