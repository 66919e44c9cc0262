/* cie.h: from a reflectance spectrum to linear sRGB. */
#ifndef HNBRDF_MEASURED_CIE_H
#define HNBRDF_MEASURED_CIE_H

#include <stddef.h>

/* Linear sRGB of a spectrum that is linear between `count` nodes, in nm and increasing, and
 * constant beyond them: the sum over the nodes of value times weights[node]. The white of D65 is
 * (1, 1, 1), so a flat spectrum has R = G = B. */
void hnbrdf_cie_weights(const float *nodes, size_t count, double (*weights)[3]);

#endif
