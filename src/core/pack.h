/* pack.h: how each channel of a packed material is decoded; shared by pack.c and the GLSL
 * exporter. */
#ifndef HNBRDF_CORE_PACK_H
#define HNBRDF_CORE_PACK_H

#include "hnbrdf/hnbrdf.h"

/* How a number goes on from `offset + scale code`, code being what a sampler returns. */
typedef enum hnbrdf_curve {
    HNBRDF_CURVE_LINEAR = 0,
    HNBRDF_CURVE_SQUARE,
    HNBRDF_CURVE_EXP
} hnbrdf_curve;

/* One field; all its channels are decoded alike, but each number of the latent code has a range
 * of its own. */
typedef struct hnbrdf_field {
    int first, count; /* channels; count is 0 for what is not stored */
    hnbrdf_curve curve;
    float offset, scale;
    float low, high; /* clamped to, after the curve */
} hnbrdf_field;

typedef struct hnbrdf_texel_layout {
    /* r is the amplitude (eta - 1)/(eta + 1); the rotation is a multiple of (cosine, sine). */
    hnbrdf_field kd, r, alpha, rotation, latent[HNBRDF_MAX_LATENT];
    hnbrdf_field fitted_kd, fitted_r, fitted_alpha;
    /* v = s/(1 + |s|) of both scales s, times lobe_unit; then the shares of both lobes. */
    hnbrdf_field lobe_scale, lobe_share[HNBRDF_LOBES];
    float lobe_unit;
    hnbrdf_field horizon, slope; /* of energy */
    float shortest2; /* a squared (cosine, sine) below this has no angle and stands for none */
    int channels;
} hnbrdf_texel_layout;

/* A scale smaller than this is none. */
#define HNBRDF_PACKED_MIN_SCALE 1e-4f

void hnbrdf_texel_layout_make(const hnbrdf_packing *packing, hnbrdf_texel_layout *layout);

#endif
