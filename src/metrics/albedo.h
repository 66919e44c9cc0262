/* albedo.h: directional albedo in parts, by where the light comes from. */
#ifndef HNBRDF_METRICS_ALBEDO_H
#define HNBRDF_METRICS_ALBEDO_H

#include "hnbrdf/metrics.h"

/* Azimuths of wo at which an anisotropic material is looked at, from its x axis on. */
enum { HNBRDF_ALBEDO_AZIMUTHS = 8 };

/* hnbrdf_albedo() of light with wi.z up to cosines[0], from there to cosines[1], ...; the last part
 * takes what is left. */
void hnbrdf_albedo_parts(const hnbrdf_model *model, const hnbrdf_material *material,
                         const float wo[3], const float *cosines, int parts, double (*albedo)[3]);

#endif
