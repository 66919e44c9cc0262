/* families.h: procedural BRDFs with free parameters, so that what a material is after an edit is
 * known: the roughness times 2, the reflectance halved, another colour. The members of a family
 * differ in nothing but these parameters. Reciprocal to the last bit, and at every parameter no
 * member reflects more than arrives. */
#ifndef HNBRDF_MEASURED_FAMILIES_H
#define HNBRDF_MEASURED_FAMILIES_H

#include "hnbrdf/measured.h"

/* Which parameters besides alpha a family has. */
typedef enum hnbrdf_family_parts {
    HNBRDF_FAMILY_ETA = 1,     /* a dielectric surface or coat: `reflectance` may be above 1 */
    HNBRDF_FAMILY_TINT = 2,    /* a metal or film: `reflectance` at most 1 gives it a colour */
    HNBRDF_FAMILY_DIFFUSE = 4, /* a diffuse part: `diffuse` */
    HNBRDF_FAMILY_STRETCH = 8, /* alpha[0] and alpha[1] may differ */
    HNBRDF_FAMILY_BRUSHED = 16 /* they do, and so `rotation` means something, in each member */
} hnbrdf_family_parts;

typedef struct hnbrdf_family_parameters {
    /* Along x and y, [HNBRDF_MIN_ALPHA, 1]. Every lobe has a fixed multiple of it as its own
     * roughness, at most 1. */
    double alpha[2];
    double rotation; /* of the tangent frame about n, radians counter-clockwise */
    /* Factor on the reflectance at normal incidence of the specular lobes, per channel, (0, 2] or
     * (0, 1]; 1 for what has neither HNBRDF_FAMILY_ETA nor HNBRDF_FAMILY_TINT. */
    double reflectance[3];
    double diffuse[3]; /* factor on the diffuse part, per channel, [0, 1.5] */
} hnbrdf_family_parameters;

/* The families from 0 on: "two-lobe", "beckmann" and so on; NULL past the last. */
const char *hnbrdf_family_name(int family);
/* One line about the family. */
const char *hnbrdf_family_about(int family);
/* hnbrdf_family_parts, together. */
int hnbrdf_family_has(int family);
/* The member with this geometric mean of alpha and all factors 1. */
void hnbrdf_family_member(int family, double alpha, hnbrdf_family_parameters *parameters);
/* A parameter out of its range, or one that the family does not have, is HNBRDF_ERROR_ARGUMENT. */
hnbrdf_result hnbrdf_family_open(int family, const hnbrdf_family_parameters *parameters,
                                 const char *name, hnbrdf_measured **measured, hnbrdf_error *error);

#endif
