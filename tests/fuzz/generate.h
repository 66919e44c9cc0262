/* generate.h: files made by a fuzz target that knows its format. A generator writes a sound file
 * from random choices and asks, wherever something can be wrong, whether this is the one place
 * that is to be: so every file is sound but for one field, and reaches the code behind all checks
 * before it. tests/README.md tells how a target gets one. */
#ifndef HNBRDF_TESTS_FUZZ_GENERATE_H
#define HNBRDF_TESTS_FUZZ_GENERATE_H

#include <stddef.h>
#include <stdint.h>

/* ---- Choices --------------------------------------------------------------------------------- */

typedef struct fuzz_choices {
    uint64_t state;
    long asked, odd_at; /* places so far that could be odd; the one that is, -1 for none */
} fuzz_choices;

/* 0 to count - 1. */
unsigned fuzz_below(fuzz_choices *c, unsigned count);
/* low to high. */
int fuzz_between(fuzz_choices *c, int low, int high);
/* In [low, high). */
double fuzz_real_between(fuzz_choices *c, double low, double high);
/* One of the arguments, which are all of one type. */
#define FUZZ_PICK(c, type, ...) \
    (((const type[]){           \
        __VA_ARGS__})[fuzz_below((c), sizeof((const type[]){__VA_ARGS__}) / sizeof(const type))])

/* 1 in the one place of a file that is to be wrong, 0 everywhere else. In a loop over many values
 * ask once, and choose the value with fuzz_below(): each question is as likely as any other. */
int fuzz_odd(fuzz_choices *c);
/* The usual value; in the odd place one that a reader may not expect. */
uint64_t fuzz_whole(fuzz_choices *c, uint64_t usual);
double fuzz_real(fuzz_choices *c, double usual);
const char *fuzz_word(fuzz_choices *c, const char *usual);
/* Such a number, for who has asked fuzz_odd() already. */
double fuzz_hostile(fuzz_choices *c, double usual);

/* ---- Bytes ----------------------------------------------------------------------------------- */

/* Grows as needed; begins as {0} and ends with fuzz_free(). */
typedef struct fuzz_bytes {
    unsigned char *data;
    size_t size, capacity;
} fuzz_bytes;

void fuzz_free(fuzz_bytes *bytes);
void fuzz_put(fuzz_bytes *out, const void *data, size_t size);
void fuzz_put_text(fuzz_bytes *out, const char *text);
void fuzz_printf(fuzz_bytes *out, const char *format, ...) __attribute__((format(printf, 2, 3)));
void fuzz_put_le(fuzz_bytes *out, uint64_t value, int size);
void fuzz_put_be(fuzz_bytes *out, uint64_t value, int size);
void fuzz_put_float(fuzz_bytes *out, double value);
void fuzz_put_double(fuzz_bytes *out, double value);
/* Decimals of a number; in the odd place perhaps what is none. */
void fuzz_put_number(fuzz_bytes *out, fuzz_choices *c, double usual);

/* ---- Generators ------------------------------------------------------------------------------ */

typedef void fuzz_generator(fuzz_choices *c, fuzz_bytes *out);

/* File number `seed` of a generator: one in four is sound, one in eight is sound but for some bytes
 * anywhere, the others have their one odd place. */
void fuzz_generate(fuzz_generator *generate, uint64_t seed, fuzz_bytes *out);
/* For LLVMFuzzerCustomMutator(): a new file, or what libFuzzer makes of this one. */
size_t fuzz_mutate(fuzz_generator *generate, uint8_t *data, size_t size, size_t max_size,
                   unsigned seed);

/* Stands once at the end of generate_TARGET.c. */
#define FUZZ_GENERATOR(generate)                                                                \
    fuzz_generator *const fuzz_target_generator = (generate);                                   \
    size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed); \
    size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed)  \
    {                                                                                           \
        return fuzz_mutate((generate), data, size, max_size, seed);                             \
    }

extern fuzz_generator *const fuzz_target_generator;

#endif
