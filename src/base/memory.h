/* memory.h: the caller's allocator, or malloc and free. */
#ifndef HNBRDF_BASE_MEMORY_H
#define HNBRDF_BASE_MEMORY_H

#include "base/error.h"

#include <stdlib.h>

static inline void *hnbrdf_malloc(void *user, size_t size)
{
    (void)user;
    return malloc(size);
}

static inline void hnbrdf_free(void *user, void *pointer)
{
    (void)user;
    free(pointer);
}

/* Fills *allocator from what the caller gave, which may be NULL or zero. */
static inline hnbrdf_result hnbrdf_choose_allocator(const hnbrdf_allocator *given,
                                                    hnbrdf_allocator *allocator,
                                                    hnbrdf_error *error)
{
    const hnbrdf_allocator standard = {hnbrdf_malloc, hnbrdf_free, NULL};
    if (!given || (!given->allocate && !given->release)) {
        *allocator = standard;
        return HNBRDF_OK;
    }
    *allocator = *given;
    if (!given->allocate || !given->release) {
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "allocator has only one of allocate and release, expected both or neither");
    }
    return HNBRDF_OK;
}

static inline void *hnbrdf_allocate(const hnbrdf_allocator *allocator, size_t size)
{
    return allocator->allocate(allocator->user, size);
}

/* NULL is allowed and not passed on. */
static inline void hnbrdf_release(const hnbrdf_allocator *allocator, void *pointer)
{
    if (pointer)
        allocator->release(allocator->user, pointer);
}

static inline hnbrdf_result hnbrdf_fail_memory(hnbrdf_error *error, size_t size, const char *what)
{
    return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "cannot allocate %zu bytes for %s", size, what);
}

#endif
