/* procedural.h: as many procedural materials as wanted, each a random mixture of reflection terms:
 * what a network that shall describe unknown materials is trained on besides measurements. */
#ifndef HNBRDF_MEASURED_PROCEDURAL_H
#define HNBRDF_MEASURED_PROCEDURAL_H

#include "measured/builtin.h"
#include "measured/rgl.h"

typedef enum term_kind {
    TERM_GGX,
    TERM_BECKMANN,
    TERM_LONG_TAIL,
    TERM_SHEEN,     /* alpha: its roughness */
    TERM_LAFORTUNE, /* shape: weight of z, exponent */
    TERM_RETRO,     /* a GGX lobe around the light */
    TERM_LAMBERT,
    TERM_OREN_NAYAR, /* shape: roughness */
    TERM_UNDER_COAT, /* weight: albedo */
    TERM_HAPKE       /* shape: albedo, width of the surge, asymmetry */
} term_kind;

typedef enum term_tint {
    TINT_NONE,
    TINT_SCHLICK,    /* facing: reflectance at normal incidence */
    TINT_DIELECTRIC, /* eta */
    TINT_FILM,       /* film */
    TINT_FLOP        /* from facing to grazing, by a power of a cosine: flakes of two colours */
} term_tint;

typedef struct procedural_term {
    term_kind kind;
    term_tint tint;
    int inside; /* 1: below the coat, where there is one */
    double alpha, eta, shape[3], weight[3];
    double facing[3], grazing[3], power;
    int by_tilt; /* of TINT_FLOP, 1: the cosine is that of the flake's tilt, not of incidence */
    film_table film;
} procedural_term;

enum { PROCEDURAL_TERMS = 6 };

typedef struct procedural {
    procedural_term terms[PROCEDURAL_TERMS];
    int count;
    int coated;
    double dye[3];     /* optical depth of the coat, one way at normal incidence */
    double saturation; /* above 1 colours leave the gamut */
    /* ln f rises with wi.z - wo.z by so much: no measurement is reciprocal */
    double imbalance[3];
    double limb[3];   /* and with ((1 - wi.z)(1 - wo.z))^2 */
    double incidence; /* of a simulated measurement: how its directions of incidence are spread */
} procedural;

/* The material of this number; the same on every machine. */
void hnbrdf_procedural_draw(int number, procedural *material);
/* f, which may be negative where a colour is outside the gamut. */
void hnbrdf_procedural_eval(const procedural *material, const double wi[3], const double wo[3],
                            double f[3]);

/* The tables that RGL's goniometer would make of it (Dupuy and Jakob 2018, An Adaptive
 * Parameterization for Efficient Material Acquisition and Rendering): eight incident directions, 32
 * x 32 colours each, placed by the retroreflection. What lies between them is interpolated, which
 * is why such data are not reciprocal, and broaden what is sharp. NULL: out of memory. */
rgl *hnbrdf_procedural_measure(const procedural *material);

#endif
