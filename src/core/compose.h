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

static inline int hnbrdf_has_energy(const hnbrdf_energy *energy)
{
    return energy->horizon != 0.0f || energy->slope != 0.0f;
}

/* That of a material, k = 1 where it has none. */
static inline hnbrdf_energy hnbrdf_energy_used(const hnbrdf_energy *energy)
{
    const hnbrdf_energy none = {1.0f, 0.0f};
    return hnbrdf_has_energy(energy) ? *energy : none;
}

/* k(z) = min(1, horizon + slope z), of one cosine. */
static inline float hnbrdf_energy_at(float horizon, float slope, float z)
{
    return hnbrdf_clamp(horizon + slope * z, 0.0f, 1.0f);
}

/* What f of a material that conserves energy is multiplied by. */
static inline float hnbrdf_energy_factor(float horizon, float slope, float wi_z, float wo_z)
{
    return hnbrdf_energy_at(horizon, slope, wi_z) * hnbrdf_energy_at(horizon, slope, wo_z);
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
