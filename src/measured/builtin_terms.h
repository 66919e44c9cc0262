/* builtin_terms.h: the reflection terms the built-in materials combine, each named after its
 * source. All in double precision, unchanged to the last bit when wi and wo swap; values are in
 * 1/sr, or reflectances where the name says Fresnel. */
#ifndef HNBRDF_MEASURED_BUILTIN_TERMS_H
#define HNBRDF_MEASURED_BUILTIN_TERMS_H

#include "measured/builtin.h"

#include <math.h>
#include <stddef.h>

#define PI 3.14159265358979323846
#define COAT_ETA 1.5 /* index of every coat */
/* Fresnel reflectance of a surface of index 1.5 in a diffuse field outside: the integral of 2 c
 * F(c) over c. Inside, transmission is that of outside over eta^2. */
#define DIFFUSE_FRESNEL_OUTSIDE 0.0918

static inline double square(double x)
{
    return x * x;
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

static inline pair make_pair(const double wi[3], const double wo[3])
{
    pair p;
    double h2 = 0.0;
    for (int i = 0; i < 3; i++) {
        p.wi[i] = wi[i];
        p.wo[i] = wo[i];
        p.h[i] = wi[i] + wo[i];
        h2 += p.h[i] * p.h[i];
    }
    p.film = NULL;
    double length = sqrt(h2); /* > 0: both are above the horizon */
    for (int i = 0; i < 3; i++)
        p.h[i] /= length;
    p.c = length / 2 < 1.0 ? length / 2 : 1.0;
    return p;
}

/* The same directions with the tangent turned by angle radians about n. */
static inline pair turned_pair(const pair *p, double angle)
{
    double c = cos(angle), s = sin(angle);
    double wi[3] = {c * p->wi[0] + s * p->wi[1], c * p->wi[1] - s * p->wi[0], p->wi[2]};
    double wo[3] = {c * p->wo[0] + s * p->wo[1], c * p->wo[1] - s * p->wo[0], p->wo[2]};
    return make_pair(wi, wo);
}

/* The same directions after refraction into a medium of this index. */
static inline pair refracted_pair(const pair *p, double eta)
{
    double wi[3] = {p->wi[0] / eta, p->wi[1] / eta, 0.0};
    double wo[3] = {p->wo[0] / eta, p->wo[1] / eta, 0.0};
    wi[2] = sqrt(1.0 - square(wi[0]) - square(wi[1]));
    wo[2] = sqrt(1.0 - square(wo[0]) - square(wo[1]));
    return make_pair(wi, wo);
}

/* wi mirrored about n: lobes around the mirror direction become lobes around the light. */
static inline pair retro_pair(const pair *p)
{
    double mirrored[3] = {-p->wi[0], -p->wi[1], p->wi[2]};
    return make_pair(mirrored, p->wo);
}

/* ---- Specular -------------------------------------------------------------------------------- */

/* D G1 G1 / (4 wi.z wo.z) of GGX with Smith shadowing: Walter et al. 2007; Heitz 2014. */
static inline double ggx(const pair *p, double alpha_x, double alpha_y)
{
    double t = square(p->h[0] / alpha_x) + square(p->h[1] / alpha_y) + square(p->h[2]);
    double vi =
        p->wi[2] + sqrt(square(p->wi[2]) + square(alpha_x * p->wi[0]) + square(alpha_y * p->wi[1]));
    double vo =
        p->wo[2] + sqrt(square(p->wo[2]) + square(alpha_x * p->wo[0]) + square(alpha_y * p->wo[1]));
    return 1.0 / (PI * alpha_x * alpha_y * t * t * (vi * vo));
}

/* Unpolarised, no absorption; eta >= 1: Walter et al. 2007, Eq. 22, g - c without cancellation. */
static inline double fresnel_dielectric(double eta, double c)
{
    double g = sqrt(eta * eta - 1.0 + c * c), difference = (eta * eta - 1.0) / (g + c);
    return square(difference / (g + c)) *
           (1.0 + square((c * (g + c) - 1.0) / (c * difference + 1.0))) / 2;
}

/* Unpolarised, index n - ik: Born and Wolf, Principles of Optics, 14.2. */
static inline double fresnel_conductor(double n, double k, double c)
{
    double c2 = c * c, s2 = 1.0 - c2, base = n * n - k * k - s2;
    double ab = sqrt(base * base + square(2 * n * k)), a = sqrt((ab + base) / 2);
    double rs = (ab + c2 - 2 * a * c) / (ab + c2 + 2 * a * c);
    double rp = (c2 * ab + s2 * s2 - 2 * a * c * s2) / (c2 * ab + s2 * s2 + 2 * a * c * s2);
    return rs * (1.0 + rp) / 2;
}

/* Schlick 1994, An Inexpensive BRDF Model for Physically-based Rendering. */
static inline double schlick(double f0, double c)
{
    double m = 1.0 - c;
    return f0 + (1.0 - f0) * square(square(m)) * m;
}

/* ---- Coats ----------------------------------------------------------------------------------- */

/* What gets into and out of a smooth coat of index 1.5: Weidlich and Wilkie 2007, Arbitrarily
 * Layered Micro-Facet Surfaces. Over a base that sees refracted directions, divide by 1.5^2:
 * radiance leaving the coat spreads. */
static inline double coat_transmission(const pair *p)
{
    return (1.0 - fresnel_dielectric(COAT_ETA, p->wi[2])) *
           (1.0 - fresnel_dielectric(COAT_ETA, p->wo[2]));
}

/* Lambert below a smooth coat of index 1.5, with all internal reflections, each of which takes the
 * base's colour again: Saunderson 1942; as a BRDF in Jakob's Mitsuba ("plastic"). albedo < 0 stands
 * for a colour outside the gamut. */
static inline double diffuse_under_coat(const pair *p, double albedo)
{
    double inside = 1.0 - (1.0 - DIFFUSE_FRESNEL_OUTSIDE) / (COAT_ETA * COAT_ETA);
    return coat_transmission(p) / (COAT_ETA * COAT_ETA) * albedo / (PI * (1.0 - albedo * inside));
}

/* ---- Rough, fibrous and granular ------------------------------------------------------------- */

/* Reflectance factor 1: Oren and Nayar 1994 in the form of Y. Fujii, whose lobe loses energy but
 * never gains any; roughness in [0, 1]. */
static inline double oren_nayar(const pair *p, double roughness)
{
    double a = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * roughness);
    double s = p->wi[0] * p->wo[0] + p->wi[1] * p->wo[1];
    double t = s > 0.0 ? fmax(p->wi[2], p->wo[2]) : 1.0;
    return a * (1.0 + roughness * s / t) / PI;
}

/* Fibres standing up: the distribution of Estevez and Kulla 2017, Production Friendly Microfacet
 * Sheen BRDF, with the visibility of Neubelt and Pettineo 2013. */
static inline double charlie_sheen(const pair *p, double roughness)
{
    double sine2 = fmin(square(p->h[0]) + square(p->h[1]), 1.0);
    double d = (2.0 + 1.0 / roughness) * pow(sine2, 0.5 / roughness) / (2 * PI);
    return d / (4.0 * (p->wi[2] + p->wo[2] - p->wi[2] * p->wo[2]));
}

/* One generalised cosine lobe (Lafortune et al. 1997): z_weight < 1 pulls it from the mirror
 * direction down to the horizon. Peak 1 towards grazing; the caller scales it. */
static inline double lafortune(const pair *p, double z_weight, double exponent)
{
    double lobe = z_weight * p->wi[2] * p->wo[2] - (p->wi[0] * p->wo[0] + p->wi[1] * p->wo[1]);
    return lobe > 0.0 ? pow(lobe, exponent) : 0.0;
}

/* Dust: Hapke 1981 and 1986, Bidirectional Reflectance Spectroscopy 1 and 4: single scattering
 * with the opposition surge B and a Henyey-Greenstein phase function, multiple scattering through
 * H. */
static inline double hapke(const pair *p, double albedo, double surge, double width,
                           double asymmetry)
{
    double backward = p->wi[0] * p->wo[0] + p->wi[1] * p->wo[1] + p->wi[2] * p->wo[2];
    double cosine =
        fmax(-1.0, fmin(1.0, backward)); /* of the phase angle: 1 when looking from the light */
    double half_tangent = sqrt((1.0 - cosine) / fmax(1.0 + cosine, 1e-12));
    double b = surge / (1.0 + half_tangent / width);
    double g = asymmetry, phase = (1.0 - g * g) / pow(1.0 + g * g + 2.0 * g * cosine, 1.5);
    double gamma = 2.0 * sqrt(1.0 - albedo);
    double hi = (1.0 + 2.0 * p->wi[2]) / (1.0 + gamma * p->wi[2]);
    double ho = (1.0 + 2.0 * p->wo[2]) / (1.0 + gamma * p->wo[2]);
    return albedo / (4 * PI * (p->wi[2] + p->wo[2])) * ((1.0 + b) * phase + hi * ho - 1.0);
}

#endif
