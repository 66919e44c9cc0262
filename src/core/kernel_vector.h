/* kernel_vector.h: vectors of the kernel of one evaluation: shuffles, roots, and functions of
 * math.h for all numbers of a vector, the same operations in the same order. Part of kernel_body.h,
 * after kernel_network.h. */
#include <math.h>

typedef float quad __attribute__((vector_size(16)));
typedef int32_t quad_bits __attribute__((vector_size(16)));
typedef float quad_memory __attribute__((vector_size(16), aligned(4), may_alias));
typedef int32_t tile_bits __attribute__((vector_size(KERNEL_WIDTH * sizeof(int32_t))));
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
#if defined(__SSE2__)
#define CLAMP_VECTOR(vector, bits, width)                                                \
    const vector zero = {0};                                                             \
    return KERNEL_FOR(KERNEL_MIN_, width)(KERNEL_FOR(KERNEL_MAX_, width)(x, zero + low), \
                                          zero + high);
#else
#define CLAMP_VECTOR(vector, bits, width)                                \
    const vector zero = {0}, lowest = zero + low, highest = zero + high; \
    bits above = (bits)(x > lowest);                                     \
    x = (vector)((above & (bits)x) | (~above & (bits)lowest));           \
    bits below = (bits)(x < highest);                                    \
    return (vector)((below & (bits)x) | (~below & (bits)highest));
#endif

KERNEL_INLINE quad quad_clamp(quad x, float low, float high){CLAMP_VECTOR(quad, quad_bits, 4)}

KERNEL_INLINE unit_vector units_clamp(unit_vector x, float low, float high){
    CLAMP_VECTOR(unit_vector, unit_bits, KERNEL_SINGLE)}

KERNEL_INLINE tile_vector tile_clamp(tile_vector x, float low, float high)
{
    CLAMP_VECTOR(tile_vector, tile_bits, KERNEL_WIDTH)
}

/* hnbrdf_exp() of `count` vectors, each exponent clamped to what those of the network are. One is a
 * long wait, so that each step is done for all before the next. */
static const float exp_steps[] = {1.39336410e-3f, 8.33331093e-3f, 4.16664650e-2f, 1.66666667e-1f,
                                  0.5f};
#define EXP_VECTORS(vector, bits, clamp)                               \
    vector y[6], q[6];                                                 \
    bits k[6];                                                         \
    for (int v = 0; v < count; v++)                                    \
        x[v] = clamp(x[v], -HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT); \
    for (int v = 0; v < count; v++)                                    \
        y[v] = x[v] * 1.44269504f;                                     \
    for (int v = 0; v < count; v++)                                    \
        y[v] = y[v] + (vector)(((bits)y[v] & INT32_MIN) | 0x3f000000); \
    for (int v = 0; v < count; v++)                                    \
        k[v] = __builtin_convertvector(y[v], bits);                    \
    for (int v = 0; v < count; v++)                                    \
        y[v] = __builtin_convertvector(k[v], vector);                  \
    for (int v = 0; v < count; v++)                                    \
        x[v] = (x[v] - y[v] * 0.693359375f) - y[v] * -2.12194440e-4f;  \
    for (int v = 0; v < count; v++)                                    \
        q[v] = x[v] * 1.98909809e-4f + exp_steps[0];                   \
    for (int i = 1; i < 5; i++)                                        \
        for (int v = 0; v < count; v++)                                \
            q[v] = q[v] * x[v] + exp_steps[i];                         \
    for (int v = 0; v < count; v++)                                    \
        q[v] = (q[v] * (x[v] * x[v]) + x[v]) + 1.0f;                   \
    for (int v = 0; v < count; v++)                                    \
        x[v] = q[v] * (vector)((k[v] + 127) << 23);

KERNEL_INLINE void units_exp(unit_vector *x,
                             int count){EXP_VECTORS(unit_vector, unit_bits, units_clamp)}

KERNEL_INLINE
    void tile_exp(tile_vector *x, int count){EXP_VECTORS(tile_vector, tile_bits, tile_clamp)}

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
