/* kernel_vector.h: vectors of the kernel of one evaluation: shuffles, roots, and functions of
 * math.h for all numbers of a vector, the same operations in the same order. Part of kernel_body.h,
 * after kernel_network.h. */

typedef float quad __attribute__((vector_size(16)));
typedef int32_t quad_bits __attribute__((vector_size(16)));
typedef float quad_memory __attribute__((vector_size(16), aligned(4), may_alias));
typedef int32_t unit_bits __attribute__((vector_size(KERNEL_SINGLE * sizeof(int32_t))));

/* Numbers of a and b as a vector, by their places: those of b come after those of a. */
#if defined(__clang__)
#define QUAD_OF(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#else
#define QUAD_OF(a, b, i, j, k, l) __builtin_shuffle(a, b, (quad_bits){i, j, k, l})
#endif
#define QUAD_ALL(a, i) QUAD_OF(a, a, i, i, i, i)

KERNEL_INLINE quad quad_at(const float *from)
{
    return *(const quad_memory *)from;
}

/* Two numbers from each. */
KERNEL_INLINE quad quad_of_two(const float *a, const float *b)
{
    return (quad){a[0], a[1], b[0], b[1]};
}

KERNEL_INLINE quad quad_root(quad x)
{
#if defined(__SSE2__)
    return _mm_sqrt_ps(x);
#else
    return (quad){sqrtf(x[0]), sqrtf(x[1]), sqrtf(x[2]), sqrtf(x[3])};
#endif
}

/* hnbrdf_clamp(): a comparison that fails, one with a NaN too, gives the bound. */
KERNEL_INLINE unit_vector units_clamp(unit_vector x, float low, float high)
{
    const unit_vector zero = {0}, lowest = zero + low, highest = zero + high;
#if defined(__SSE2__)
    return KERNEL_FOR(KERNEL_MIN_, KERNEL_SINGLE)(KERNEL_FOR(KERNEL_MAX_, KERNEL_SINGLE)(x, lowest),
                                                  highest);
#else
    unit_bits above = (unit_bits)(x > lowest);
    x = (unit_vector)((above & (unit_bits)x) | (~above & (unit_bits)lowest));
    unit_bits below = (unit_bits)(x < highest);
    return (unit_vector)((below & (unit_bits)x) | (~below & (unit_bits)highest));
#endif
}

KERNEL_INLINE quad quad_clamp(quad x, float low, float high)
{
    const quad zero = {0}, lowest = zero + low, highest = zero + high;
#if defined(__SSE2__)
    return _mm_min_ps(_mm_max_ps(x, lowest), highest);
#else
    quad_bits above = (quad_bits)(x > lowest);
    x = (quad)((above & (quad_bits)x) | (~above & (quad_bits)lowest));
    quad_bits below = (quad_bits)(x < highest);
    return (quad)((below & (quad_bits)x) | (~below & (quad_bits)highest));
#endif
}

/* hnbrdf_exp(). */
KERNEL_INLINE unit_vector units_exp(unit_vector x)
{
    unit_vector y = x * 1.44269504f;
    unit_vector half = (unit_vector)(((unit_bits)y & INT32_MIN) | 0x3f000000);
    unit_bits k = __builtin_convertvector(y + half, unit_bits);
    unit_vector fk = __builtin_convertvector(k, unit_vector);
    unit_vector r = (x - fk * 0.693359375f) - fk * -2.12194440e-4f;
    unit_vector q = r * 1.98909809e-4f;
    q = (q + 1.39336410e-3f) * r;
    q = (q + 8.33331093e-3f) * r;
    q = (q + 4.16664650e-2f) * r;
    q = (q + 1.66666667e-1f) * r;
    q = q + 0.5f;
    unit_vector e = (q * (r * r) + r) + 1.0f;
    return e * (unit_vector)((k + 127) << 23);
}

/* hnbrdf_log(). */
KERNEL_INLINE quad quad_log(quad x)
{
#if defined(__SSE2__)
    const quad zero = {0};
    x = _mm_max_ps(x, zero + 1.17549435e-38f);
#else
    for (int k = 0; k < 4; k++)
        x[k] = x[k] > 1.17549435e-38f ? x[k] : 1.17549435e-38f;
#endif
    quad_bits i = (quad_bits)x - 0x3f3504f3, e = i >> 23;
    quad f = (quad)((i & 0x7fffff) + 0x3f3504f3) - 1.0f;
    quad s = f / (2.0f + f);
    quad s2 = s * s;
    quad p = s2 * 2.95799494e-1f + 3.99887806e-1f;
    p = p * s2 + 6.66666850e-1f;
    return __builtin_convertvector(e, quad) * 0.693147181f + (2.0f * s + s * (s2 * p));
}
