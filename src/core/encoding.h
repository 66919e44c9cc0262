/* encoding.h: what the network sees of a pair of directions, six numbers.
 * shaders/hybrid_brdf.glsl holds the same functions, named alike and in the same order of operations. */
#ifndef HNBRDF_CORE_ENCODING_H
#define HNBRDF_CORE_ENCODING_H

#include "core/microfacet.h"

/* The paper's: the six Cartesian components. */
static inline void hnbrdf_encode_directions(const hnbrdf_pair *p, float x[6])
{
    x[0] = p->wi[0];
    x[1] = p->wi[1];
    x[2] = p->wi[2];
    x[3] = p->wo[0];
    x[4] = p->wo[1];
    x[5] = p->wo[2];
}

/* Functions of h and of the difference angle that do not change, to the last bit, when wi and wo swap:
 *   1 + ln(1e-5 + tan^2 th)/4, sqrt(sin th), c, sqrt(1 - c), wi.z wo.z, wi.z + wo.z
 * th is the angle between n and h, c = wi.h. sqrt(1 - c) is taken from |wi - wo|^2 = 4 (1 - c^2), exact
 * where 1 - c would cancel (near retroreflection). */
static inline void hnbrdf_encode_half_difference(const hnbrdf_pair *p, float x[6])
{
    float r2 = p->sx * p->sx + p->sy * p->sy;
    float d2 = hnbrdf_dot3(p->wi[0] - p->wo[0], p->wi[1] - p->wo[1], p->wi[2] - p->wo[2]);
    x[0] = 1.0f + 0.25f * hnbrdf_log(1e-5f + r2 / (p->sz * p->sz));
    x[1] = sqrtf(sqrtf(r2 / p->length2));
    x[2] = p->c;
    x[3] = sqrtf((0.25f * d2) / (1.0f + p->c));
    x[4] = p->wi[2] * p->wo[2];
    x[5] = p->sz;
}

#endif
