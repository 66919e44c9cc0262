/* ggx.h: fit Lambert + one GGX lobe to one material. */
#ifndef HNBRDF_FIT_GGX_H
#define HNBRDF_FIT_GGX_H

#include "fit/pool.h"
#include "hnbrdf/fit.h"

enum { FIT_GGX_TILES = 96 }; /* of a material, at most, that its fit sees */

/* Fits parameters[FIT_ANALYTIC] (kernel.h) to the material's tiles: Adam from several starts, the
 * best of them refined. Isotropic data tie the two alphas and keep the rotation 0. Others take
 * the rotation of `axis` (axis.h) or across it, where that costs nearly nothing. Returns the mean
 * loss; search may be NULL. */
double hnbrdf_fit_ggx(const fit_kernel *kernel, const fit_pool *pool, int material, int isotropic,
                      double axis, float *parameters, hnbrdf_fit_search *search);

/* Moves parameters into their ranges: kd [0, 1], eta [1.001, 100], alpha [HNBRDF_MIN_ALPHA, 1]. */
void hnbrdf_fit_ggx_project(float *parameters, int isotropic);

/* The parameters whose material has this kd, eta, alpha and rotation, but for their ranges. */
void hnbrdf_fit_ggx_parameters(const hnbrdf_material *material, float *parameters);

/* parameters to kd, eta, alpha and rotation of a material. */
void hnbrdf_fit_ggx_material(const float *parameters, hnbrdf_material *material);

#endif
