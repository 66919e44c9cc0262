/* text.c: numbers and UTF-8 as text, the same whatever the locale.
 * Short numbers are parsed with one exact product or division, all others by shifting decimal
 * digits. */
#include "base/text.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* ---- Printing -------------------------------------------------------------------------------- */

static int format_digits(char *buffer, size_t size, double value, int digits)
{
    char text[HNBRDF_NUMBER_TEXT];
    const size_t length = strlen(hnbrdf_print_number(text, value, digits));
    if (size > 0) {
        const size_t kept = length < size ? length : size - 1;
        memcpy(buffer, text, kept);
        buffer[kept] = '\0';
    }
    return (int)length;
}

int hnbrdf_format_float(char *buffer, size_t size, float value)
{
    return format_digits(buffer, size, (double)value, 9);
}

int hnbrdf_format_double(char *buffer, size_t size, double value)
{
    return format_digits(buffer, size, value, 17);
}

/* ---- Exact decimals -------------------------------------------------------------------------- */

/* A midpoint between two doubles has at most 767 significant digits, so that of what is cut from
 * longer numbers it only matters whether it is zero. */
enum { MAX_DIGITS = 800, MAX_SHIFT = 60 };

/* 0.d[0]d[1]... times 10^point; no leading and no trailing zeros; count 0 is zero. */
typedef struct decimal {
    uint8_t digit[MAX_DIGITS];
    int count;
    int64_t point;
} decimal;

typedef struct format {
    int bits;         /* of the significand, with the leading one */
    int min_exponent; /* of the smallest normal number, written 0.1xxx * 2^min_exponent */
    int max_exponent;
} format;

static const format FORMAT_FLOAT = {FLT_MANT_DIG, FLT_MIN_EXP, FLT_MAX_EXP};
static const format FORMAT_DOUBLE = {DBL_MANT_DIG, DBL_MIN_EXP, DBL_MAX_EXP};

static void append(decimal *d, unsigned digit)
{
    if (d->count < MAX_DIGITS)
        d->digit[d->count++] = (uint8_t)digit;
    else if (digit != 0)
        d->digit[MAX_DIGITS - 1] |= 1;
}

static void trim(decimal *d)
{
    while (d->count > 0 && d->digit[d->count - 1] == 0)
        --d->count;
}

/* d / 2^shift, d not zero, 0 < shift <= MAX_SHIFT: long division in place; what is written lies
 * behind what is read. */
static void shift_right(decimal *d, int shift)
{
    const uint64_t mask = ((uint64_t)1 << shift) - 1;
    const int count = d->count;
    uint64_t rest = 0;
    int read = 0;
    do {
        rest = rest * 10 + (read < count ? d->digit[read] : 0u);
        ++read;
    } while (rest >> shift == 0);
    d->point -= read - 1;
    d->count = 0;
    append(d, (unsigned)(rest >> shift));
    while ((rest &= mask) != 0 || read < count) {
        rest = rest * 10 + (read < count ? d->digit[read] : 0u);
        ++read;
        append(d, (unsigned)(rest >> shift));
    }
    trim(d);
}

/* d * 2^shift, 0 < shift <= MAX_SHIFT. */
static void shift_left(decimal *d, int shift)
{
    uint8_t product[MAX_DIGITS + MAX_SHIFT]; /* the last digit first */
    uint64_t carry = 0;
    int count = 0;
    for (int i = d->count - 1; i >= 0; --i) {
        carry += (uint64_t)d->digit[i] << shift;
        product[count++] = (uint8_t)(carry % 10);
        carry /= 10;
    }
    for (; carry != 0; carry /= 10)
        product[count++] = (uint8_t)(carry % 10);
    d->point += count - d->count;
    d->count = 0;
    while (count > 0)
        append(d, product[--count]);
    trim(d);
}

/* The nearest integer, ties to even; d < 2^MAX_SHIFT. */
static uint64_t round_to_integer(const decimal *d)
{
    uint64_t integer = 0;
    int64_t i = 0;
    if (d->point < 0)
        return 0;
    for (; i < d->point; ++i)
        integer = integer * 10 + (i < d->count ? d->digit[i] : 0u);
    if (i >= d->count || d->digit[i] < 5)
        return integer;
    const int tie = d->digit[i] == 5 && i + 1 == d->count;
    return integer + (tie ? integer & 1 : 1);
}

static int smaller(int64_t a, int b)
{
    return a < b ? (int)a : b;
}

/* The nearest number of the format; 0 when it is too large. */
static int decimal_to_binary(decimal *d, const format *f, double *value)
{
    int exponent = 0; /* what is asked for is d * 2^exponent */
    if (d->count == 0 || d->point < -400) {
        *value = 0;
        return 1;
    }
    if (d->point > 400)
        return 0;
    while (d->point > 0) { /* below 10^p, hence below 2^(4p) */
        const int shift = smaller(4 * d->point, MAX_SHIFT);
        shift_right(d, shift);
        exponent += shift;
    }
    while (d->point < 0 || d->digit[0] < 5) { /* below 10^-p, hence below 2^(-3p) */
        const int shift = d->point < 0 ? smaller(-3 * d->point, MAX_SHIFT) : 1;
        shift_left(d, shift);
        exponent -= shift;
    }
    while (exponent < f->min_exponent) {
        const int shift = smaller(f->min_exponent - exponent, MAX_SHIFT);
        shift_right(d, shift);
        exponent += shift;
    }
    shift_left(d, f->bits);
    const uint64_t significand = round_to_integer(d);
    const int carried = significand >> f->bits != 0;
    if (exponent + carried > f->max_exponent)
        return 0;
    *value = ldexp((double)significand, exponent - f->bits);
    return 1;
}

/* ---- Parsing --------------------------------------------------------------------------------- */

static const double POWER_OF_TEN[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                      1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                      1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* Digits and point, without sign; NULL if there is no digit. */
static const char *read_digits(const char *at, const char *end, decimal *d)
{
    int seen_digit = 0, seen_point = 0;
    d->count = 0;
    d->point = 0;
    for (; at < end; ++at) {
        if (*at == '.' && !seen_point) {
            seen_point = 1;
        } else if (is_digit(*at)) {
            const unsigned digit = (unsigned)(*at - '0');
            const int leading_zero = d->count == 0 && digit == 0;
            seen_digit = 1;
            if (!leading_zero)
                append(d, digit);
            d->point += seen_point ? -leading_zero : !leading_zero;
        } else {
            break;
        }
    }
    trim(d);
    return seen_digit ? at : NULL;
}

/* An exponent at `at`, if a complete one is there. */
static const char *read_exponent(const char *at, const char *end, int64_t *exponent)
{
    const int64_t bound = INT64_C(1000000000000000);
    const char *digit = at;
    int negative;
    *exponent = 0;
    if (digit == end || (*digit != 'e' && *digit != 'E'))
        return at;
    ++digit;
    negative = digit < end && *digit == '-';
    if (digit < end && (*digit == '-' || *digit == '+'))
        ++digit;
    if (digit == end || !is_digit(*digit))
        return at;
    for (; digit < end && is_digit(*digit); ++digit)
        if (*exponent < bound)
            *exponent = *exponent * 10 + (*digit - '0');
    if (negative)
        *exponent = -*exponent;
    return digit;
}

/* Exact when the digits fit a double and so does the power of ten (Clinger 1990). */
static int short_decimal(const decimal *d, double *value)
{
    const int64_t exponent = d->point - d->count;
    uint64_t integer = 0;
    if (FLT_EVAL_METHOD != 0 || d->count > 15 || exponent < -22 || exponent > 22)
        return 0;
    for (int i = 0; i < d->count; ++i)
        integer = integer * 10 + d->digit[i];
    *value = exponent < 0 ? (double)integer / POWER_OF_TEN[-exponent]
                          : (double)integer * POWER_OF_TEN[exponent];
    return 1;
}

/* The double decides unless it is a midpoint of two floats or near the subnormal ones. */
static int decides_float(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return value >= (double)FLT_MIN && value <= (double)FLT_MAX &&
           (bits & UINT64_C(0x1fffffff)) != UINT64_C(0x10000000);
}

static const char *parse(const char *begin, const char *end, const format *f, double *value)
{
    decimal d;
    int64_t exponent;
    double magnitude;
    const int negative = begin < end && *begin == '-';
    const int sign = begin < end && (*begin == '-' || *begin == '+');
    const char *at = read_digits(begin + sign, end, &d);
    if (!at)
        return NULL;
    at = read_exponent(at, end, &exponent);
    d.point += exponent;
    if (!(short_decimal(&d, &magnitude) && (f == &FORMAT_DOUBLE || decides_float(magnitude))) &&
        !decimal_to_binary(&d, f, &magnitude))
        return NULL;
    *value = negative ? -magnitude : magnitude;
    return at;
}

const char *hnbrdf_parse_double(const char *begin, const char *end, double *value)
{
    return parse(begin, end, &FORMAT_DOUBLE, value);
}

const char *hnbrdf_parse_float(const char *begin, const char *end, float *value)
{
    double rounded;
    const char *at = parse(begin, end, &FORMAT_FLOAT, &rounded);
    if (at)
        *value = (float)rounded;
    return at;
}

/* ---- UTF-8 ----------------------------------------------------------------------------------- */

size_t hnbrdf_utf8_length(const char *begin, const char *end)
{
    unsigned char b[4] = {0, 0, 0, 0};
    const size_t available = (size_t)(end - begin);
    memcpy(b, begin, available < 4 ? available : 4);
    if (available > 0 && b[0] < 0x80)
        return 1;
    const size_t length = b[0] >= 0xc2 && b[0] < 0xe0   ? 2
                          : b[0] >= 0xe0 && b[0] < 0xf0 ? 3
                          : b[0] >= 0xf0 && b[0] < 0xf5 ? 4
                                                        : 0;
    for (size_t i = 1; i < length; ++i)
        if ((b[i] & 0xc0) != 0x80)
            return 0;
    const int overlong = (b[0] == 0xe0 && b[1] < 0xa0) || (b[0] == 0xf0 && b[1] < 0x90);
    const int surrogate = b[0] == 0xed && b[1] >= 0xa0;
    const int too_large = b[0] == 0xf4 && b[1] >= 0x90;
    return overlong || surrogate || too_large ? 0 : length;
}

/* ---- Letters --------------------------------------------------------------------------------- */

size_t hnbrdf_byte_order_mark(const void *text, size_t size)
{
    static const char mark[] = "\xef\xbb\xbf";
    return size >= sizeof mark - 1 && memcmp(text, mark, sizeof mark - 1) == 0 ? sizeof mark - 1
                                                                               : 0;
}

int hnbrdf_is_utf16(const void *text, size_t size)
{
    return size >= 2 && (memcmp(text, "\xff\xfe", 2) == 0 || memcmp(text, "\xfe\xff", 2) == 0);
}

int hnbrdf_ends_with(const char *text, const char *ending)
{
    const size_t length = strlen(text), count = strlen(ending);
    if (length < count)
        return 0;
    for (size_t k = 0; k < count; k++)
        if (hnbrdf_lower(text[length - count + k]) != hnbrdf_lower(ending[k]))
            return 0;
    return 1;
}
