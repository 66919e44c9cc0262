/* math.h: exp, log, sin and cos from + - * / and bit moves alone, the same bits wherever IEEE
 * floats are, in C, in every vector width and in GLSL (hybrid_brdf.glsl holds the same functions
 * in the same order). Polynomials fitted at Chebyshev nodes; tests/test_math.c holds each to its
 * stated error. */
#ifndef HNBRDF_CORE_MATH_H
#define HNBRDF_CORE_MATH_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD > 0
#error floats are computed in a wider type: see src/arithmetic.cmake for the flags
#endif

/* -ffast-math, -Ofast and -ffinite-math-only let a compiler reorder sums and take it that there are
 * no NaN: other bits, and a NaN weight would pass the checks. Put -fno-fast-math after them. */
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error compiled with -ffast-math or -ffinite-math-only: add -fno-fast-math after it
#endif

/* Before a function that may divide by 0. Only the smallest cosines, directions that are no unit
 * vectors and materials that break their ranges bring that about; what IEEE 754 then gives,
 * infinity or NaN, is clamped where the value ends, and to ask for it here would cost every
 * evaluation. Without this UBSan would stop there. */
#if defined(__GNUC__)
#define HNBRDF_DIVIDES_AS_IEEE __attribute__((no_sanitize("float-divide-by-zero")))
#else
#define HNBRDF_DIVIDES_AS_IEEE
#endif

#define HNBRDF_PI 3.14159265f
#define HNBRDF_INV_PI 0.318309886f

static inline float hnbrdf_bits_to_float(int32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline int32_t hnbrdf_float_to_bits(float value)
{
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* x in [low, high]; a NaN becomes low. One after the other, not nested: that is a maximum and a
 * minimum. */
static inline float hnbrdf_clamp(float x, float low, float high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

/* exp(x) for x in [-80, 80]; within 1 ulp. */
static inline float hnbrdf_exp(float x)
{
    /* to the nearest integer: half, with the sign of y, added and cut off */
    float y = x * 1.44269504f;
    int32_t k =
        (int32_t)(y + hnbrdf_bits_to_float((hnbrdf_float_to_bits(y) & INT32_MIN) | 0x3f000000));
    float fk = (float)k;
    /* ln 2 in two parts, the first exact */
    float r = (x - fk * 0.693359375f) - fk * -2.12194440e-4f;
    float q = 1.98909809e-4f;
    q = q * r + 1.39336410e-3f;
    q = q * r + 8.33331093e-3f;
    q = q * r + 4.16664650e-2f;
    q = q * r + 1.66666667e-1f;
    q = q * r + 0.5f;
    float e = (q * (r * r) + r) + 1.0f;
    return e * hnbrdf_bits_to_float((k + 127) * 0x800000);
}

/* ln(x) for normal x > 0; error at most 1.05 ulp of the result plus 5e-8. +inf gives a finite
 * 88.7, a NaN what the smallest x gives: the bits of a NaN differ from machine to machine, and
 * the result must not. */
static inline float hnbrdf_log(float x)
{
    x = x > 1.17549435e-38f ? x : 1.17549435e-38f;
    int32_t i = hnbrdf_float_to_bits(x) - 0x3f3504f3; /* mantissa to [sqrt(1/2), sqrt(2)) */
    int32_t e = i >> 23;
    float f = hnbrdf_bits_to_float((i & 0x7fffff) + 0x3f3504f3) - 1.0f;
    float s = f / (2.0f + f);
    float s2 = s * s;
    float p = 2.95799494e-1f;
    p = p * s2 + 3.99887806e-1f;
    p = p * s2 + 6.66666850e-1f;
    return (float)e * 0.693147181f + (2.0f * s + s * (s2 * p));
}

/* sin and cos of 2 pi u for u in [0, 1]; absolute error at most 1.1e-7. */
static inline void hnbrdf_sincos_turn(float u, float *sine, float *cosine)
{
    int32_t quadrant = (int32_t)(4.0f * u + 0.5f);
    float a = (u - 0.25f * (float)quadrant) * 6.28318531f; /* the difference is exact */
    float a2 = a * a;
    float s = -1.95878909e-4f;
    s = s * a2 + 8.33274827e-3f;
    s = s * a2 - 1.66666647e-1f;
    s = a + a * (a2 * s);
    float c = 2.45479421e-5f;
    c = c * a2 - 1.38883030e-3f;
    c = c * a2 + 4.16666647e-2f;
    c = (1.0f - 0.5f * a2) + (a2 * a2) * c;
    int swap = (quadrant & 1) != 0;
    float upright = swap ? c : s, across = swap ? s : c;
    /* signs by their bits: without branches */
    int32_t flip = (int32_t)(((uint32_t)quadrant & 2u) << 30);
    int32_t flip_across = (int32_t)((((uint32_t)quadrant + 1u) & 2u) << 30);
    *sine = hnbrdf_bits_to_float(hnbrdf_float_to_bits(upright) ^ flip);
    *cosine = hnbrdf_bits_to_float(hnbrdf_float_to_bits(across) ^ flip_across);
}

#endif
