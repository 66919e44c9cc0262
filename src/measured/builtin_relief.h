/* builtin_relief.h: surfaces made of threads and grooves, as microfacets that need not be mirrors:
 * each facet of a relief has a BRDF of its own in its own frame (Heitz and Dupuy 2015, Implementing
 * a Simple Anisotropic Rough Diffuse Material with Stochastic Evaluation), and facets hide each
 * other as in Smith's model (Heitz 2014). Reciprocal; never reflects more than its brightest
 * facet. */
#ifndef HNBRDF_MEASURED_BUILTIN_RELIEF_H
#define HNBRDF_MEASURED_BUILTIN_RELIEF_H

#include "measured/builtin_terms.h"

/* Facets that slope along one direction: a thread that bends up and down, the flanks of a rib or a
 * groove. Seen from above all sines of slope from `low` to `high` have the same share, as on the
 * arc of a circle. */
typedef struct strand {
    double along; /* the direction of the slopes, radians from the tangent */
    double grain; /* the tangent of the facets, radians from `along` */
    double share; /* of the area seen from above; those of a relief add up to 1 */
    double low, high;
    int facets; /* the slopes that stand for all of them */
    /* Adds the facet's BRDF times `weight` to f. */
    void (*facet)(const pair *p, double weight, double f[3]);
} strand;

/* The sine of slope of facet k. */
static inline double facet_sine(const strand *s, int k)
{
    return s->low + (s->high - s->low) * (k + 0.5) / s->facets;
}

/* Area of the facets that face w, seen along w, per area seen from above: w.z / G1(w). */
static inline double facing_area(const double w[3], const strand *s)
{
    double slope = w[0] * cos(s->along) + w[1] * sin(s->along), sum = 0.0;
    for (int k = 0; k < s->facets; k++) {
        double sine = facet_sine(s, k);
        sum += fmax(0.0, w[2] + slope * sine / sqrt(1.0 - sine * sine));
    }
    return s->share * sum / s->facets;
}

/* Directions in the frame of a facet whose normal leans towards x; the cosine is that of the
 * slope. */
static inline pair facet_pair(const pair *p, double sine, double cosine, double grain)
{
    double wi[3] = {cosine * p->wi[0] - sine * p->wi[2], p->wi[1],
                    sine * p->wi[0] + cosine * p->wi[2]};
    double wo[3] = {cosine * p->wo[0] - sine * p->wo[2], p->wo[1],
                    sine * p->wo[0] + cosine * p->wo[2]};
    pair q = make_pair(wi, wo);
    return grain == 0.0 ? q : turned_pair(&q, grain);
}

/* Adds the relief times `weight` to f. */
static inline void add_relief(const pair *p, const strand *strands, int count, double weight,
                              double f[3])
{
    double area_i = 0.0, area_o = 0.0;
    for (int k = 0; k < count; k++) {
        area_i += facing_area(p->wi, &strands[k]);
        area_o += facing_area(p->wo, &strands[k]);
    }
    double hidden = weight / (area_i * area_o);
    for (int k = 0; k < count; k++) {
        const strand *s = &strands[k];
        pair turned = turned_pair(p, s->along);
        for (int j = 0; j < s->facets; j++) {
            double sine = facet_sine(s, j), cosine = sqrt(1.0 - sine * sine);
            pair q = facet_pair(&turned, sine, cosine, s->grain);
            if (q.wi[2] > 0.0 && q.wo[2] > 0.0)
                s->facet(&q, s->share / s->facets * hidden / cosine * (q.wi[2] * q.wo[2]), f);
        }
    }
}

/* ---- Threads --------------------------------------------------------------------------------- */

/* Parallel fibres along x. The longitudinal part of each lobe is a Gaussian in the sum of the
 * sines to the fibre, whose integral is at most 1; `centre` is not 0 where scales on the fibre tilt
 * it (Marschner et al. 2003, Light Scattering from Human Hair Fibers). */
static inline double fibre_lobe(const pair *p, double width, double centre)
{
    double off = (p->wi[0] + p->wo[0] - centre) / width;
    return exp(-off * off / 2) / (width * sqrt(2 * PI));
}

/* 2/(cos + cos), of the angles to the plane across the fibre: as in Sadeghi et al. 2013. */
static inline double fibre_spread(const pair *p)
{
    double ci = sqrt(square(p->wi[1]) + square(p->wi[2]));
    double co = sqrt(square(p->wo[1]) + square(p->wo[2]));
    return 2.0 / (ci + co);
}

/* What a round fibre reflects into the azimuth between wi and wo: cos(phi/2)/4. */
static inline double fibre_azimuth(const pair *p)
{
    double ci2 = square(p->wi[1]) + square(p->wi[2]), co2 = square(p->wo[1]) + square(p->wo[2]);
    double cosine = (p->wi[1] * p->wo[1] + p->wi[2] * p->wo[2]) / sqrt(ci2 * co2);
    return sqrt(fmax(0.0, (1.0 + cosine) / 2)) / 4;
}

/* A thread: light reflected by the surfaces of its fibres, and light scattered inside them, partly
 * in the same cone but wider, partly everywhere (Sadeghi et al. 2013, A Practical Microcylinder
 * Appearance Model for Cloth Rendering). Widths are in the sum of sines. */
typedef struct thread {
    double eta, surface, volume, everywhere;
    double colour[3]; /* of what went through the fibres */
} thread;

static inline void add_thread(const pair *p, const thread *t, double weight, double f[3])
{
    double spread = weight * fibre_spread(p);
    double reflected = fresnel_dielectric(t->eta, p->c) * fibre_azimuth(p) *
                       fibre_lobe(p, t->surface, 0.0) * spread;
    double ci = sqrt(square(p->wi[1]) + square(p->wi[2]));
    double co = sqrt(square(p->wo[1]) + square(p->wo[2]));
    double through =
        (1.0 - fresnel_dielectric(t->eta, ci)) * (1.0 - fresnel_dielectric(t->eta, co));
    double scattered = (1.0 - t->everywhere) * fibre_lobe(p, t->volume, 0.0) + t->everywhere / 2;
    for (int c = 0; c < 3; c++)
        f[c] += reflected + through * scattered / 2 * spread * t->colour[c];
}

#endif
