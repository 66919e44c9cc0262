/* generate.c: choices, bytes and damage for the generators of the fuzz targets. */
#include "generate.h"

#include "fuzz.h"

#include <stdarg.h>

/* In replay programs nothing mutates. */
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size) __attribute__((weak));

/* ---- Choices --------------------------------------------------------------------------------- */

/* splitmix64 */
static uint64_t next(fuzz_choices *c)
{
    uint64_t z = c->state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

unsigned fuzz_below(fuzz_choices *c, unsigned count)
{
    return count ? (unsigned)((next(c) >> 32) % count) : 0;
}

int fuzz_between(fuzz_choices *c, int low, int high)
{
    return low + (int)fuzz_below(c, (unsigned)(high - low) + 1);
}

double fuzz_real_between(fuzz_choices *c, double low, double high)
{
    return low + (high - low) * ((double)(next(c) >> 11) * 0x1p-53);
}

int fuzz_odd(fuzz_choices *c)
{
    return c->asked++ == c->odd_at;
}

uint64_t fuzz_whole(fuzz_choices *c, uint64_t usual)
{
    static const uint64_t ends[] = {
        0x7f,    0x80,       0xff,       0x100,      0x7fff,      0x8000,    0xffff,
        0x10000, 0x7fffffff, 0x80000000, 0xffffffff, 0x100000000, INT64_MAX, (uint64_t)1 << 63};
    if (!fuzz_odd(c))
        return usual;
    switch (fuzz_below(c, 8)) {
    case 0:
        return 0;
    case 1:
        return usual + 1;
    case 2:
        return usual - 1;
    case 3:
        return 2 * usual;
    case 4:
        return usual / 2;
    case 5:
        return UINT64_MAX - fuzz_below(c, 16);
    case 6:
        return fuzz_below(c, 64);
    default:
        return ends[fuzz_below(c, sizeof ends / sizeof ends[0])];
    }
}

double fuzz_real(fuzz_choices *c, double usual)
{
    return fuzz_odd(c) ? fuzz_hostile(c, usual) : usual;
}

double fuzz_hostile(fuzz_choices *c, double usual)
{
    static const double ends[] = {0.0,    -0.0,    -1.0,   1.0,    1e-46, -1e-46, 1e-320,
                                  3.4e38, -3.4e38, 3.5e38, 1e39,   -1e39, 1e308,  -1e308,
                                  1e10,   -1e10,   0x1p31, 0x1p63, 0.5,   2.0,    1e-7};
    switch (fuzz_below(c, 6)) {
    case 0:
        return (double)NAN;
    case 1:
        return (double)INFINITY;
    case 2:
        return -(double)INFINITY;
    case 3:
        return -usual;
    default:
        return ends[fuzz_below(c, sizeof ends / sizeof ends[0])];
    }
}

const char *fuzz_word(fuzz_choices *c, const char *usual)
{
    static char longest[5001];
    if (!fuzz_odd(c))
        return usual;
    if (fuzz_below(c, 6) == 0) {
        memset(longest, 'x', sizeof longest - 1);
        longest[FUZZ_PICK(c, int, 20, 31, 32, 63, 64, 127, 128, 255, 256, 1023, 5000)] = '\0';
        return longest;
    }
    return FUZZ_PICK(c, char *, "", " ", "x", "\"", "\\", "\x7f", "\x01", "\n", "\r\n", "\t", ",",
                     "#", "%s%n", "a b", "..", "/", "-", "\xc3\xa9", "\xff", "\xed\xa0\x80",
                     "\xf4\x90\x80\x80", "\xef\xbb\xbf", "0", "-1", "1e39", "nan");
}

/* ---- Bytes ----------------------------------------------------------------------------------- */

static void reserve(fuzz_bytes *out, size_t size)
{
    if (size <= out->capacity - out->size)
        return;
    out->capacity = 2 * (out->size + size);
    out->data = realloc(out->data, out->capacity);
    FUZZ_CHECK(out->data != NULL);
}

void fuzz_free(fuzz_bytes *bytes)
{
    free(bytes->data);
    *bytes = (fuzz_bytes){0};
}

void fuzz_put(fuzz_bytes *out, const void *data, size_t size)
{
    reserve(out, size + 1);
    if (size)
        memcpy(out->data + out->size, data, size);
    out->size += size;
}

void fuzz_put_text(fuzz_bytes *out, const char *text)
{
    fuzz_put(out, text, strlen(text));
}

void fuzz_printf(fuzz_bytes *out, const char *format, ...)
{
    va_list arguments;
    reserve(out, 8192);
    va_start(arguments, format);
    const int length = vsnprintf((char *)out->data + out->size, 8192, format, arguments);
    va_end(arguments);
    FUZZ_CHECK(length >= 0 && length < 8192);
    out->size += (size_t)length;
}

void fuzz_put_le(fuzz_bytes *out, uint64_t value, int size)
{
    for (int i = 0; i < size; i++)
        fuzz_put(out, &(unsigned char){(unsigned char)(value >> 8 * i)}, 1);
}

void fuzz_put_be(fuzz_bytes *out, uint64_t value, int size)
{
    for (int i = size - 1; i >= 0; i--)
        fuzz_put(out, &(unsigned char){(unsigned char)(value >> 8 * i)}, 1);
}

/* Beyond the range of floats: infinity, as a file may hold it. */
static float to_float(double value)
{
    if (fabs(value) > 3.4028234e38)
        return value > 0.0 ? INFINITY : -INFINITY;
    return (float)value;
}

void fuzz_put_float(fuzz_bytes *out, double value)
{
    const float number = to_float(value);
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    fuzz_put_le(out, bits, 4);
}

void fuzz_put_double(fuzz_bytes *out, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    fuzz_put_le(out, bits, 8);
}

void fuzz_put_number(fuzz_bytes *out, fuzz_choices *c, double usual)
{
    char text[64];
    if (!fuzz_odd(c)) {
        snprintf(text, sizeof text, fuzz_below(c, 4) ? "%.6g" : "%.9e", usual);
        fuzz_put_text(out, text);
    } else if (fuzz_below(c, 2)) {
        fuzz_put_text(out, FUZZ_PICK(c, char *, "", "-", "+", ".", "e5", "1e", "1e+", "0x10", "1,5",
                                     "--1", "1.2.3", "nan", "inf", "-inf", "1e999", "-1e999",
                                     "1e-999", "1e99999999999", "00000000000000000000001", "1f",
                                     "0.1000000000000000055511151231257827", "1 2", "1_0"));
    } else {
        snprintf(text, sizeof text, "%.9g", fuzz_hostile(c, usual));
        fuzz_put_text(out, text);
    }
}

/* ---- Damage anywhere ------------------------------------------------------------------------- */

static void cut_out(fuzz_bytes *b, size_t at, size_t length)
{
    memmove(b->data + at, b->data + at + length, b->size - at - length);
    b->size -= length;
}

static void insert(fuzz_bytes *b, size_t at, const void *data, size_t length)
{
    unsigned char *copy = fuzz_copy(data, length);
    fuzz_put(b, copy, length); /* makes room */
    memmove(b->data + at + length, b->data + at, b->size - length - at);
    memcpy(b->data + at, copy, length);
    free(copy);
}

/* Half of the places are near the beginning, where headers are. */
static void damage(fuzz_choices *c, fuzz_bytes *b)
{
    static const unsigned char ends[8] = {0xff, 0xff, 0xff, 0x7f, 0, 0, 0, 0x80};
    if (b->size == 0)
        return;
    const size_t near = b->size < 256 || fuzz_below(c, 2) ? b->size : 256;
    const size_t at = fuzz_below(c, (unsigned)near), left = b->size - at;
    size_t length = 1 + fuzz_below(c, 16);
    length = length < left ? length : left;
    switch (fuzz_below(c, 7)) {
    case 0:
        b->size = at;
        break;
    case 1:
        cut_out(b, at, length);
        break;
    case 2:
        insert(b, at, b->data + at, length);
        break;
    case 3:
        b->data[at] = (unsigned char)(b->data[at] ^ 1u << fuzz_below(c, 8));
        break;
    case 4:
        b->data[at] = (unsigned char)fuzz_below(c, 256);
        break;
    case 5:
        memcpy(b->data + at, ends + 4 * fuzz_below(c, 2), length < 4 ? length : 4);
        break;
    default:
        insert(b, b->size, b->data + at, length);
        break;
    }
}

/* ---- Generators ------------------------------------------------------------------------------ */

void fuzz_generate(fuzz_generator *generate, uint64_t seed, fuzz_bytes *out)
{
    fuzz_choices c = {.state = seed, .odd_at = -1};
    const unsigned kind = fuzz_below(&c, 8);
    const uint64_t start = next(&c);
    c.state = start;
    generate(&c, out);
    const long places = c.asked;
    if (kind == 0)
        damage(&c, out);
    if (kind <= 2 || places == 0)
        return;
    /* The same file again with one place odd. Where that changes what follows, the place may never
     * come. */
    const long odd_at = (long)fuzz_below(&c, (unsigned)places);
    out->size = 0;
    c = (fuzz_choices){.state = start, .odd_at = odd_at};
    generate(&c, out);
}

size_t fuzz_mutate(fuzz_generator *generate, uint8_t *data, size_t size, size_t max_size,
                   unsigned seed)
{
    fuzz_bytes made = {0};
    if (seed % 4 == 0 || !LLVMFuzzerMutate) {
        fuzz_generate(generate, seed / 4, &made);
        const int fits = made.size > 0 && made.size <= max_size;
        if (fits)
            memcpy(data, made.data, size = made.size);
        fuzz_free(&made);
        if (fits)
            return size;
    }
    return LLVMFuzzerMutate ? LLVMFuzzerMutate(data, size, max_size) : size;
}
