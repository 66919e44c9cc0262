/* fuzz.h: what the fuzz targets share. A target is one file that defines LLVMFuzzerTestOneInput():
 * clang's libFuzzer drives it where HNBRDF_BUILD_FUZZERS is set, replay.c (any compiler) in the
 * tests. */
#ifndef HNBRDF_TESTS_FUZZ_H
#define HNBRDF_TESTS_FUZZ_H

#include "hnbrdf/hnbrdf.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whatever the bytes are, it returns; what the reader promised and did not keep aborts. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define FUZZ_CHECK(condition)                                                               \
    do {                                                                                    \
        if (!(condition)) {                                                                 \
            fprintf(stderr, "%s:%d: broken promise: %s\n", __FILE__, __LINE__, #condition); \
            abort();                                                                        \
        }                                                                                   \
    } while (0)

/* Some words in one line without control characters. */
static inline void fuzz_check_line(const char *line)
{
    FUZZ_CHECK(strlen(line) > 10);
    for (const char *c = line; *c; c++)
        FUZZ_CHECK((unsigned char)*c >= 0x20 && *c != 0x7f);
}

/* A refusal tells why, in a line. */
static inline void fuzz_check_refusal(hnbrdf_result result, const hnbrdf_error *error)
{
    FUZZ_CHECK(result > HNBRDF_OK && result <= HNBRDF_ERROR_CANCELLED);
    FUZZ_CHECK(memchr(error->text, 0, sizeof error->text) != NULL);
    fuzz_check_line(error->text);
}

static inline void fuzz_check_value(const float f[3])
{
    for (int c = 0; c < 3; c++)
        FUZZ_CHECK(f[c] >= 0.0f && f[c] <= HNBRDF_MAX_VALUE);
}

/* Pair k of a few fixed ones: the normal, mirror, grazing, below the horizon, and 0. */
enum { FUZZ_PAIRS = 6 };
static inline void fuzz_pair(int k, float wi[3], float wo[3])
{
    static const float pairs[FUZZ_PAIRS][6] = {
        {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f},      {0.6f, 0.0f, 0.8f, -0.6f, 0.0f, 0.8f},
        {0.48f, 0.64f, 0.6f, 0.0f, -0.28f, 0.96f}, {1.0f, 0.0f, 1e-7f, 0.0f, 1.0f, 1e-6f},
        {0.0f, 0.6f, -0.8f, 0.0f, 0.0f, 1.0f},     {0.0f, 0.0f, 0.0f, -0.96f, 0.0f, 0.28f}};
    memcpy(wi, pairs[k], 3 * sizeof *wi);
    memcpy(wo, pairs[k] + 3, 3 * sizeof *wo);
}

/* A block of exactly `size` bytes, so that a sanitizer sees a read behind it; never NULL. */
static inline void *fuzz_copy(const void *data, size_t size)
{
    unsigned char *copy = size ? malloc(size) : calloc(1, 1);
    FUZZ_CHECK(copy != NULL);
    if (size)
        memcpy(copy, data, size);
    return copy;
}

/* A hnbrdf_write_fn that takes everything and keeps nothing but the count. */
static inline int fuzz_count_bytes(void *user, const void *data, size_t size)
{
    (void)data;
    *(size_t *)user += size;
    return 0;
}

#endif
