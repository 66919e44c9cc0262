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

/* tan^2 of the angle between n and h, its two parts over alpha_x^2 and alpha_y^2: what every
 * distribution of normals that only scales with roughness is a function of. */
static inline double scaled_slope2(const pair *p, double alpha_x, double alpha_y)
{
    return (square(p->h[0] / alpha_x) + square(p->h[1] / alpha_y)) / square(p->h[2]);
}

/* 2 w.z / G1(w) of GGX: Heitz 2014. */
static inline double smith_ggx(const double w[3], double alpha_x, double alpha_y)
{
    return w[2] + sqrt(square(w[2]) + square(alpha_x * w[0]) + square(alpha_y * w[1]));
}

/* D G1 G1 / (4 wi.z wo.z) of GGX with Smith shadowing: Walter et al. 2007; Heitz 2014. */
static inline double ggx(const pair *p, double alpha_x, double alpha_y)
{
    double t = square(p->h[0] / alpha_x) + square(p->h[1] / alpha_y) + square(p->h[2]);
    double vi = smith_ggx(p->wi, alpha_x, alpha_y), vo = smith_ggx(p->wo, alpha_x, alpha_y);
    return 1.0 / (PI * alpha_x * alpha_y * t * t * (vi * vo));
}

/* w.z / G1(w) of Beckmann's distribution: Heitz 2014, Eq. 72. */
static inline double smith_beckmann(const double w[3], double alpha_x, double alpha_y)
{
    double sine = sqrt(square(alpha_x * w[0]) + square(alpha_y * w[1]));
    double a = sine > 0.0 ? w[2] / sine : INFINITY;
    return w[2] * (1.0 + erf(a)) / 2 + sine * exp(-a * a) / (2 * sqrt(PI));
}

/* D G1 G1 / (4 wi.z wo.z) of Gaussian slopes: Cook and Torrance 1982; Heitz 2014. */
static inline double beckmann(const pair *p, double alpha_x, double alpha_y)
{
    double d = exp(-scaled_slope2(p, alpha_x, alpha_y)) /
               (PI * alpha_x * alpha_y * square(square(p->h[2])));
    return d / (4 * (smith_beckmann(p->wi, alpha_x, alpha_y) *
                     smith_beckmann(p->wo, alpha_x, alpha_y)));
}

/* Slopes after Student's t, exponent 7/4 in the place of GGX's 2, so with a longer tail: Ribardiere
 * et al. 2017, STD: Student's t-Distribution of Slopes for Microfacet Based BSDFs. Its own masking
 * has no closed form; that of GGX of LONG_TAIL_MASKING alpha is the same at grazing. */
#define LONG_TAIL_EXPONENT 1.75
#define LONG_TAIL_MASKING 1.6692 /* 2 Gamma(5/4) / (sqrt(pi) Gamma(3/4) (2 7/4 - 3)) */
static inline double long_tail(const pair *p, double alpha_x, double alpha_y)
{
    double d = (LONG_TAIL_EXPONENT - 1.0) *
               pow(1.0 + scaled_slope2(p, alpha_x, alpha_y), -LONG_TAIL_EXPONENT) /
               (PI * alpha_x * alpha_y * square(square(p->h[2])));
    double mx = LONG_TAIL_MASKING * alpha_x, my = LONG_TAIL_MASKING * alpha_y;
    return d / (smith_ggx(p->wi, mx, my) * smith_ggx(p->wo, mx, my));
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

/* n and k of metals in the red, green and blue, rounded: right enough for their colours. */
static const double GOLD_N[3] = {0.18, 0.54, 1.35}, GOLD_K[3] = {3.44, 2.23, 1.89};
static const double COPPER_N[3] = {0.27, 0.68, 1.32}, COPPER_K[3] = {3.61, 2.63, 2.29};
static const double ALUMINIUM_N[3] = {1.43, 0.94, 0.69}, ALUMINIUM_K[3] = {7.52, 6.42, 5.64};
static const double IRON_N[3] = {2.89, 2.95, 2.59}, IRON_K[3] = {3.35, 2.93, 2.77};
static const double CHROMIUM_N[3] = {3.11, 2.98, 2.08}, CHROMIUM_K[3] = {3.32, 3.33, 3.02};

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
