/* microfacet.h: the analytic part, Lambert + GGX (Walter et al. 2007; Heitz 2014), term by term.
 * shaders/hybrid_brdf.glsl holds the same functions, named alike and in the same order of
 * operations.
 *
 * Everything is written in s = wi + wo, not in the normalised half vector h = s/|s|: one square
 * root less, symmetric in wi and wo to the last bit, and no cancellation for any roughness. */
#ifndef HNBRDF_CORE_MICROFACET_H
#define HNBRDF_CORE_MICROFACET_H

#include "core/math.h"

/* What eval, encode and pdf share of one pair of directions, in the tangent frame of the
 * material. */
typedef struct hnbrdf_pair {
    float wi[3], wo[3];
    float sx, sy, sz; /* s = wi + wo */
    float length2;    /* s.s */
    float c;          /* cosine of the difference angle, wi.h = |s|/2 for unit vectors */
} hnbrdf_pair;

static inline float hnbrdf_dot3(float x, float y, float z)
{
    return (x * x + y * y) + z * z;
}

static inline hnbrdf_pair hnbrdf_pair_make(const float wi[3], const float wo[3])
{
    hnbrdf_pair p = {{wi[0], wi[1], wi[2]}, {wo[0], wo[1], wo[2]}, 0, 0, 0, 0, 0};
    p.sx = wi[0] + wo[0];
    p.sy = wi[1] + wo[1];
    p.sz = wi[2] + wo[2];
    p.length2 = hnbrdf_dot3(p.sx, p.sy, p.sz);
    p.c = 0.5f * sqrtf(p.length2);
    return p;
}

/* GGX normal density D(h), 1/sr (Walter 2007 Eq. 33, anisotropic: Heitz 2014 Eq. 86), in the
 * tangent-frame form: 1 - (n.h)^2 would lose every digit of a narrow lobe. What depends on the
 * material alone, area = pi ax ay here and e = eta^2 - 1 below, has a function of its own. */
static inline float hnbrdf_ggx_area(float ax, float ay)
{
    return (HNBRDF_PI * ax) * ay;
}

HNBRDF_DIVIDES_AS_IEEE
static inline float hnbrdf_ggx_d_of_area(float sx, float sy, float sz, float length2, float ax,
                                         float ay, float area)
{
    float t = hnbrdf_dot3(sx / ax, sy / ay, sz) / length2;
    return 1.0f / (area * (t * t));
}

static inline float hnbrdf_ggx_d(float sx, float sy, float sz, float length2, float ax, float ay)
{
    return hnbrdf_ggx_d_of_area(sx, sy, sz, length2, ax, ay, hnbrdf_ggx_area(ax, ay));
}

/* Smith masking of one direction over its share of the denominator, V(w) = G1(w) / (2 w.z), so that
 * G1 G1 / (4 wi.z wo.z) = V V, finite at grazing (Heitz 2014 Eq. 43). */
HNBRDF_DIVIDES_AS_IEEE
static inline float hnbrdf_smith_v(float x, float y, float z, float ax, float ay)
{
    return 1.0f / (z + sqrtf(hnbrdf_dot3(ax * x, ay * y, z)));
}

/* Visible normals of w, D V(w)/2 of which is their density as reflections (Heitz 2018 Eq. 17):
 * V(w), the cap of normals cut off where all reflections go below the horizon (Eto and Tokuyoshi
 * 2023). */
static inline float hnbrdf_cap_bound(float x, float y, float z, float ax, float ay)
{
    float a = ax < ay ? ax : ay;
    float a2 = a * a;
    float s = 1.0f + sqrtf(x * x + y * y);
    float s2 = s * s;
    return ((1.0f - a2) * s2) / (s2 + a2 * (z * z));
}

HNBRDF_DIVIDES_AS_IEEE
static inline float hnbrdf_visible_v(float x, float y, float z, float ax, float ay)
{
    return 1.0f / (hnbrdf_cap_bound(x, y, z, ax, ay) * z + sqrtf(hnbrdf_dot3(ax * x, ay * y, z)));
}

/* Unpolarised Fresnel reflectance of a dielectric with index eta > 1 at cosine c = wi.h (Walter
 * 2007 Eq. 22). g - c is taken as (eta^2 - 1)/(g + c): the difference itself loses digits as eta
 * nears 1. */
static inline float hnbrdf_fresnel_e(float eta)
{
    return (eta - 1.0f) * (eta + 1.0f);
}

HNBRDF_DIVIDES_AS_IEEE
static inline float hnbrdf_fresnel_of_e(float e, float c)
{
    float sum = sqrtf(e + c * c) + c; /* g + c */
    float difference = e / sum;       /* g - c */
    float a = difference / sum;
    float b = (c * sum - 1.0f) / (c * difference + 1.0f);
    return (0.5f * (a * a)) * (1.0f + b * b);
}

static inline float hnbrdf_fresnel_dielectric(float eta, float c)
{
    return hnbrdf_fresnel_of_e(hnbrdf_fresnel_e(eta), c);
}

/* D V V, what the Fresnel factor of every channel multiplies; 1/sr. */
static inline float hnbrdf_specular_of_area(const hnbrdf_pair *p, float ax, float ay, float area)
{
    return hnbrdf_ggx_d_of_area(p->sx, p->sy, p->sz, p->length2, ax, ay, area) *
           (hnbrdf_smith_v(p->wi[0], p->wi[1], p->wi[2], ax, ay) *
            hnbrdf_smith_v(p->wo[0], p->wo[1], p->wo[2], ax, ay));
}

static inline float hnbrdf_specular(const hnbrdf_pair *p, float ax, float ay)
{
    return hnbrdf_specular_of_area(p, ax, ay, hnbrdf_ggx_area(ax, ay));
}

/* One channel of f_a, 1/sr. diffuse is kd/pi, e is eta^2 - 1. */
static inline float hnbrdf_microfacet_of(float diffuse, float e, float c, float specular)
{
    return diffuse + hnbrdf_fresnel_of_e(e, c) * specular;
}

static inline float hnbrdf_microfacet(float kd, float eta, float c, float specular)
{
    return hnbrdf_microfacet_of(kd * HNBRDF_INV_PI, hnbrdf_fresnel_e(eta), c, specular);
}

#endif
