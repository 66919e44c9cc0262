/* hash.h: FNV-1a (Fowler, Noll, Vo), to tell inputs apart; not against who wants a collision. */
#ifndef HNBRDF_BASE_HASH_H
#define HNBRDF_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

#define HNBRDF_HASH_START UINT64_C(14695981039346656037)
#define HNBRDF_HASH32_START UINT32_C(2166136261)

/* The hash so far, with more bytes. */
static inline uint64_t hnbrdf_hash(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = (const unsigned char *)data;
    for (size_t i = 0; i < size; ++i)
        hash = (hash ^ bytes[i]) * UINT64_C(1099511628211);
    return hash;
}

static inline uint32_t hnbrdf_hash32(uint32_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = (const unsigned char *)data;
    for (size_t i = 0; i < size; ++i)
        hash = (hash ^ bytes[i]) * UINT32_C(16777619);
    return hash;
}

#endif
