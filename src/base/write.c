/* write.c: fields of CSV (RFC 4180) and JSON (RFC 8259) for what writes tables. */
#include "base/write.h"

#include "base/number.h"

void hnbrdf_write_number(FILE *file, double value, int digits)
{
    char text[HNBRDF_NUMBER_TEXT];
    fputs(hnbrdf_print_number(text, value, digits), file);
}

void hnbrdf_write_csv_text(FILE *file, const char *text)
{
    if (!text[strcspn(text, ",\"\r\n")] && *text) {
        fputs(text, file);
        return;
    }
    putc('"', file);
    for (; *text; text++) {
        if (*text == '"')
            putc('"', file);
        putc(*text, file);
    }
    putc('"', file);
}

void hnbrdf_write_csv_number(FILE *file, double value, int digits)
{
    if (isfinite(value))
        hnbrdf_write_number(file, value, digits);
}

void hnbrdf_write_json_text(FILE *file, const char *text)
{
    putc('"', file);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            putc('\\', file);
        if ((unsigned char)*text < 0x20)
            fprintf(file, "\\u%04x", (unsigned)(unsigned char)*text);
        else
            putc(*text, file);
    }
    putc('"', file);
}

void hnbrdf_write_json_number(FILE *file, double value, int digits)
{
    if (isfinite(value))
        hnbrdf_write_number(file, value, digits);
    else
        fputs("null", file);
}
