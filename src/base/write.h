/* write.h: fields of CSV (RFC 4180) and JSON (RFC 8259) for what writes tables. Numbers are the
 * same whatever the locale. */
#ifndef HNBRDF_BASE_WRITE_H
#define HNBRDF_BASE_WRITE_H

#include <stdio.h>

/* As C's "%.*g" in the C locale, digits at most 17. */
void hnbrdf_write_number(FILE *file, double value, int digits);

/* One field, in quotes where it needs them. */
void hnbrdf_write_csv_text(FILE *file, const char *text);
/* Nothing for a number that is not finite. */
void hnbrdf_write_csv_number(FILE *file, double value, int digits);

/* With its quotes. */
void hnbrdf_write_json_text(FILE *file, const char *text);
/* null for a number that is not finite, which JSON does not have. */
void hnbrdf_write_json_number(FILE *file, double value, int digits);

#endif
