/* compose.h: network outputs and analytic part into one channel of f.
 * shaders/hybrid_brdf.glsl holds the same functions, named alike and in the same order of
 * operations. */
#ifndef HNBRDF_CORE_COMPOSE_H
#define HNBRDF_CORE_COMPOSE_H

#include "core/math.h"
#include "hnbrdf/hnbrdf.h"

/* [0, HNBRDF_MAX_VALUE]; a NaN becomes 0. */
static inline float hnbrdf_finish(float f)
{
    return hnbrdf_clamp(f, 0.0f, HNBRDF_MAX_VALUE);
}

/* exp(s c + m), the exponent clamped. */
static inline float hnbrdf_correction(float c, float scale, float shift)
{
    return hnbrdf_exp(hnbrdf_clamp(scale * c + shift, -HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT));
}

/* sigmoid(g). */
static inline float hnbrdf_gate(float g)
{
    return 1.0f / (1.0f + hnbrdf_exp(hnbrdf_clamp(-g, -HNBRDF_MAX_EXPONENT, HNBRDF_MAX_EXPONENT)));
}

/* max(0, exp(s c + m) + sigmoid(g) f_a - b). */
static inline float hnbrdf_compose_hybrid(float c, float g, float analytic, float scale,
                                          float shift, float floor)
{
    return hnbrdf_finish((hnbrdf_correction(c, scale, shift) + hnbrdf_gate(g) * analytic) - floor);
}

/* max(0, exp(s c + m) - b). */
static inline float hnbrdf_compose_neural(float c, float scale, float shift, float floor)
{
    return hnbrdf_finish(hnbrdf_correction(c, scale, shift) - floor);
}

#endif
