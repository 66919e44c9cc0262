/* half.h: IEEE 754 binary16 from and to float, by bits alone; what a texture of half floats
 * holds. */
#ifndef HNBRDF_CORE_HALF_H
#define HNBRDF_CORE_HALF_H

#include "core/math.h"

#define HNBRDF_MAX_HALF 65504.0f

/* To nearest, ties to even; beyond HNBRDF_MAX_HALF the largest half, a NaN becomes 0. */
static inline uint16_t hnbrdf_half_of(float value)
{
    uint32_t bits = (uint32_t)hnbrdf_float_to_bits(value), sign = bits >> 16 & 0x8000u;
    uint32_t size = bits & 0x7fffffffu;
    if (size > 0x7f800000u)
        return 0;
    if (size >= 0x477ff000u) /* would round to infinity */
        return (uint16_t)(sign | 0x7bffu);
    if (size < 0x38800000u) { /* below 2^-14: a multiple of 2^-24, which adding 1/2 rounds to */
        float shifted = hnbrdf_bits_to_float((int32_t)size) + 0.5f;
        return (uint16_t)(sign | (uint32_t)(hnbrdf_float_to_bits(shifted) - 0x3f000000));
    }
    uint32_t rounded = size + 0xfffu + (size >> 13 & 1u);
    return (uint16_t)(sign | ((rounded - 0x38000000u) >> 13));
}

/* Exact; infinities and NaN stay what they are. */
static inline float hnbrdf_float_of_half(uint16_t half)
{
    uint32_t sign = (uint32_t)(half & 0x8000u) << 16, size = half & 0x7fffu;
    if (size < 0x400u) {
        float value = (float)size * 5.9604644775390625e-8f;
        return sign ? -value : value;
    }
    uint32_t bits = size < 0x7c00u ? (size << 13) + 0x38000000u : (size << 13) + 0x70000000u;
    return hnbrdf_bits_to_float((int32_t)(sign | bits));
}

#endif
