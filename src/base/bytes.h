/* bytes.h: little-endian numbers from bytes, whatever the host. The caller has checked the
 * bounds. */
#ifndef HNBRDF_BASE_BYTES_H
#define HNBRDF_BASE_BYTES_H

#include <stdint.h>
#include <string.h>

static inline uint16_t le16(const unsigned char *p)
{
    return (uint16_t)(p[0] | p[1] << 8);
}

static inline uint32_t le32(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static inline uint64_t le64(const unsigned char *p)
{
    return (uint64_t)le32(p) | (uint64_t)le32(p + 4) << 32;
}

static inline float le_float(const unsigned char *p)
{
    uint32_t bits = le32(p);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double le_double(const unsigned char *p)
{
    uint64_t bits = le64(p);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
