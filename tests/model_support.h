/* model_support.h: what the tests of model files share: example models, bytes in memory, an
 * allocator that counts and fails on demand. */
#ifndef HNBRDF_TESTS_MODEL_SUPPORT_H
#define HNBRDF_TESTS_MODEL_SUPPORT_H

#include "core_support.h"

#include <stddef.h>

/* A random model with materials named m0, m1 ... and, if `special` is not 0, scale, shift, floor,
 * rotations and names that need escaping. Fails the test if it cannot be made. */
hnbrdf_model *example_model(uint64_t seed, hnbrdf_kind kind, int hidden, int layers, int latent,
                            int materials, int special);

/* Fails unless both describe the same thing to the last bit. */
void assert_same_model(const hnbrdf_model *a, const hnbrdf_model *b);

typedef struct bytes {
    unsigned char *data;
    size_t size;
} bytes;

/* An hnbrdf_write_fn that appends to the bytes given as user. */
int write_bytes(void *user, const void *data, size_t size);
bytes model_bytes(const hnbrdf_model *model);
/* A safetensors file with this header, as it stands, and data_size bytes of zero. */
bytes file_with_header(const char *header, size_t data_size);
void free_bytes(bytes *b);
/* Replaces the first occurrence of `old` by `new` in the header and corrects the header's length.
 * Fails the test if there is none. */
bytes with_replaced(const bytes *file, const char *old, const char *new_text);

/* Counts what is alive; fails the allocation number `fail_at` (from 0; -1 none). Checks that only
 * its own pointers come back. */
typedef struct counting {
    long calls, alive, fail_at;
    size_t largest;
} counting;
hnbrdf_allocator counting_allocator(counting *state);

#endif
