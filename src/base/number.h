/* number.h: numbers as text, the same whatever the locale and the C library: in files, shaders and
 * messages. */
#ifndef HNBRDF_BASE_NUMBER_H
#define HNBRDF_BASE_NUMBER_H

#include <math.h>
#include <stdio.h>
#include <string.h>

/* A buffer that holds any number printed here with up to 17 digits, with its NUL. */
enum { HNBRDF_NUMBER_TEXT = 32 };

/* Whatever run of bytes in a finite number is no digit, sign or exponent is the locale's
 * separator. */
static inline void hnbrdf_with_point(const char *printed, char text[HNBRDF_NUMBER_TEXT])
{
    int in_separator = 0;
    for (; *printed; ++printed) {
        const char c = *printed;
        const int plain = (c >= '0' && c <= '9') || c == '+' || c == '-' || c == 'e';
        if (plain)
            *text++ = c;
        else if (!in_separator)
            *text++ = '.';
        in_separator = !plain;
    }
    *text = '\0';
}

/* As C's "%.*g" in the C locale, digits at most 17; "inf", "-inf" and "nan" for values that are not
 * finite. Returns text. */
static inline const char *hnbrdf_print_number(char text[HNBRDF_NUMBER_TEXT], double value,
                                              int digits)
{
    if (isfinite(value)) {
        char printed[64];
        snprintf(printed, sizeof printed, "%.*g", digits, value);
        hnbrdf_with_point(printed, text);
    } else {
        strcpy(text, isnan(value) ? "nan" : value < 0 ? "-inf" : "inf");
    }
    return text;
}

/* A number for a person to read, as "%g": the argument of a %s in the same expression. A struct, as
 * C++ takes no address of a temporary array. */
typedef struct hnbrdf_number {
    char text[HNBRDF_NUMBER_TEXT];
} hnbrdf_number;
#define HNBRDF_NUMBER(value) hnbrdf_print_number((hnbrdf_number){{0}}.text, (double)(value), 6)

#endif
