/* encoding.h: what the network sees of a pair of directions, six numbers.
 * shaders/hybrid_brdf.glsl holds the same functions, named alike and in the same order of
 * operations. */
#ifndef HNBRDF_CORE_ENCODING_H
#define HNBRDF_CORE_ENCODING_H

#include "core/carry.h"
#include "hnbrdf/hnbrdf.h"

/* The table of encodings, one row each. What depends on which encodings there are is made from it:
 * names, kernels, exported shaders. row(ENUM, function, name, reciprocal, sees_azimuth):
 *   ENUM          HNBRDF_ENCODING_ENUM in hnbrdf.h
 *   function      hnbrdf_encode_FUNCTION(), here and in shaders/hybrid_brdf.glsl
 *   name          in model files, messages and on the command line
 *   reciprocal    1: swapping wi and wo changes no bit
 *   sees_azimuth  1: turning both directions about the normal changes it */
#define HNBRDF_ENCODINGS(row)                                                               \
    row(DIRECTIONS, directions, "directions", 0, 1)                                         \
        row(HALF_DIFFERENCE, half_difference, "half-difference", 1, 0)                      \
            row(ANGLES_DIRECTED, angles_directed, "angles-directed", 0, 0)                  \
                row(ANGLES, angles, "angles", 1, 0)                                         \
                    row(ANGLES_ANISOTROPIC, angles_anisotropic, "angles-anisotropic", 1, 1) \
                        row(ANGLES_AZIMUTHS, angles_azimuths, "angles-azimuths", 1, 1)

/* All names, each after ", ": to be joined to a text; the list alone. For help and messages. */
#define HNBRDF_ENCODING_COMMA(ENUM, function, name, reciprocal, sees_azimuth) ", " name
#define HNBRDF_ENCODING_NAMES HNBRDF_ENCODINGS(HNBRDF_ENCODING_COMMA)
#define HNBRDF_ENCODING_LIST (&(HNBRDF_ENCODING_NAMES)[2])

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

/* Functions of h and of the difference angle that do not change, to the last bit, when wi and wo
 *   swap: 1 + ln(1e-5 + tan^2 th)/4, sqrt(sin th), c, sqrt(1 - c), wi.z wo.z, wi.z + wo.z
 * th is the angle between n and h, c = wi.h. sqrt(1 - c) is taken from |wi - wo|^2 = 4 (1 - c^2),
 * exact where 1 - c would cancel (near retroreflection). */
HNBRDF_DIVIDES_AS_IEEE
static inline void hnbrdf_encode_half_difference(const hnbrdf_pair *p, float x[6])
{
    float r2 = p->sx * p->sx + p->sy * p->sy;
    float d2 = hnbrdf_dot3(p->wi[0] - p->wo[0], p->wi[1] - p->wo[1], p->wi[2] - p->wo[2]);
    x[0] = 1.0f + 0.25f * hnbrdf_log(1e-5f + r2 / (p->sz * p->sz));
    x[1] = sqrtf(sqrtf(r2 / p->length2));
    x[2] = p->c;
    x[3] = sqrtf((0.25f * d2) / (1.0f + p->c));
    x[4] = p->wi[2] * p->wo[2];
    x[5] = p->wi[2] + p->wo[2];
}

/* 1 - c of the difference angle from |wi - wo|^2 = 4 (1 - c^2). */
static inline float hnbrdf_one_minus_c(const hnbrdf_pair *p)
{
    float d2 = hnbrdf_dot3(p->wi[0] - p->wo[0], p->wi[1] - p->wo[1], p->wi[2] - p->wo[2]);
    return (0.25f * d2) / (1.0f + p->c);
}

/* What the encodings by angles share; the cosines of incidence are a and b:
 *   1 + ln(1e-5 + tan^2 th)/4, sin th, ln(1e-3 + 1 - c)/4, 1 - c, a, b */
HNBRDF_DIVIDES_AS_IEEE
static inline void hnbrdf_encode_angle_terms(const hnbrdf_pair *p, float a, float b, float x[6])
{
    float r2 = p->sx * p->sx + p->sy * p->sy;
    float q = hnbrdf_one_minus_c(p);
    x[0] = 1.0f + 0.25f * hnbrdf_log(1e-5f + r2 / (p->sz * p->sz));
    x[1] = sqrtf(r2 / p->length2);
    x[2] = 0.25f * hnbrdf_log(1e-3f + q);
    x[3] = q;
    x[4] = a;
    x[5] = b;
}

/* a = wi.z, b = wo.z: sees which of the two is the light. */
static inline void hnbrdf_encode_angles_directed(const hnbrdf_pair *p, float x[6])
{
    hnbrdf_encode_angle_terms(p, p->wi[2], p->wo[2], x);
}

/* a and b in order of size: reciprocal. */
static inline void hnbrdf_encode_angles(const hnbrdf_pair *p, float x[6])
{
    int swap = p->wo[2] < p->wi[2];
    hnbrdf_encode_angle_terms(p, swap ? p->wo[2] : p->wi[2], swap ? p->wi[2] : p->wo[2], x);
}

/* |h.x| for sin th and |h.y| for 1 - c: reciprocal, and mirror-symmetric about the tangent frame.
 * */
HNBRDF_DIVIDES_AS_IEEE
static inline void hnbrdf_encode_angles_anisotropic(const hnbrdf_pair *p, float x[6])
{
    hnbrdf_encode_angles(p, x);
    float length = sqrtf(p->length2);
    x[1] = fabsf(p->sx) / length;
    x[3] = fabsf(p->sy) / length;
}

/* |h.x| for sin th and |wi.x - wo.x|/2 for the larger cosine, which is nearly what 1 - c, th and
 * the smaller one add up to: reciprocal, mirror-symmetric about the tangent frame, and nothing else
 * is lost: a pair, its mirror images and its swapped one have six numbers of their own. */
HNBRDF_DIVIDES_AS_IEEE
static inline void hnbrdf_encode_angles_azimuths(const hnbrdf_pair *p, float x[6])
{
    hnbrdf_encode_angles(p, x);
    x[1] = fabsf(p->sx) / sqrtf(p->length2);
    x[5] = 0.5f * fabsf(p->wi[0] - p->wo[0]);
}

/* The pair of an edited material as its network sees it, the tangents of s times x and y where f_a
 * is specular. The cosines of incidence go with s: a network has seen no other pairs. An encoding
 * that sees the directions themselves has them turned with s; one that sees the azimuth of wi - wo
 * keeps it. */
static inline hnbrdf_pair hnbrdf_seen(hnbrdf_encoding encoding, const hnbrdf_pair *p, float x,
                                      float y, float part)
{
    hnbrdf_pair q = hnbrdf_warped(p, x, y, part);
    if (encoding == HNBRDF_ENCODING_DIRECTIONS)
        hnbrdf_turn_pair(p, &q);
    else
        hnbrdf_incline_pair(p, &q);
    if (encoding == HNBRDF_ENCODING_ANGLES_AZIMUTHS)
        hnbrdf_keep_azimuth(p, &q);
    return q;
}

/* An encoding that is none of these leaves x alone; no model has one. */
static inline void hnbrdf_encode(hnbrdf_encoding encoding, const hnbrdf_pair *p, float x[6])
{
#define HNBRDF_ENCODE_CASE(ENUM, function, name, reciprocal, azimuth) \
    case HNBRDF_ENCODING_##ENUM:                                      \
        hnbrdf_encode_##function(p, x);                               \
        break;
    switch (encoding) {
        HNBRDF_ENCODINGS(HNBRDF_ENCODE_CASE)
    }
#undef HNBRDF_ENCODE_CASE
}

#endif
