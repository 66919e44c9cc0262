/* oracle.h: the BRDF and its density as the formulas say, in more digits than anybody needs.
 * For tests and tools: no library links it. It shares no code with the library, not even
 * constants of its arithmetic, and takes the formulas as printed, not as they are rearranged for
 * floats.
 *
 * Inputs are the floats given, taken as exact real numbers. Directions are not made unit length,
 * so it
 * is defined here what the formulas mean when they are not: s = wi + wo, h = s/|s|          the
 *                                                                                           half
 * vector, and tan, sin of its angle with n c = |s|/2                       stands for wi.h wherever
 * that is asked for 1 - c = |wi - wo|^2/(4 (1 + c)) wherever 1 - c is For unit vectors both are
 * equalities. G1 is that of Heitz 2014 for unit w: w.z and the slopes as given. Clamps are part
 * of the definition: the exponent and -g to +-HNBRDF_MAX_EXPONENT, f to [0, HNBRDF_MAX_VALUE]. */
#ifndef HNBRDF_CHECK_ORACLE_H
#define HNBRDF_CHECK_ORACLE_H

#include "hnbrdf/hnbrdf.h"

/* Each number rounded once, to double. */
typedef struct oracle_point {
    double encoded[6];  /* what the network sees; 0 for HNBRDF_KIND_GGX */
    double outputs[6];  /* of the network: c, g */
    double analytic[3]; /* f_a; 0 for HNBRDF_KIND_NEURAL */
    double ratio[3];    /* what an edit multiplies the correction less the floor by; else 1 */
    double value[3];    /* f */
    /* exp(s c + m) + sigmoid(g) f_a, or f_a for ggx, edited materials' as they carry it along: what
     * the floor is taken from, hence what errors of f are to be compared with where little is left
     * of it */
    double scale[3];
    double pdf; /* oracle_pdf() */
} oracle_point;

/* All 0 unless wi.z > 0 and wo.z > 0. Every argument finite. */
void oracle_evaluate(const hnbrdf_model_desc *desc, const hnbrdf_material *material,
                     const float wi[3], const float wo[3], oracle_point *point);

/* hnbrdf_pdf() of a model of this kind: the shares of the lobes times their densities, the rest
 * cosine. Without fitted lobes one of visible normals with the material's alpha and the share
 * s/(s + d) in [0.2, 0.9], s = 0.05 + mean of ((eta - 1)/(eta + 1))^2, d = mean kd; 0 for neural.
 */
double oracle_pdf(hnbrdf_kind kind, const hnbrdf_material *material, const float wi[3],
                  const float wo[3]);

/* "__float128" or "long double". */
const char *oracle_arithmetic(void);

#endif
