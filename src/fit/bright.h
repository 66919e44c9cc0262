/* bright.h: pairs where a picture of a material is bright. The uniform sampler hardly looks into a
 * highlight of half a degree, and the grid sampler no more often than elsewhere near it, whatever
 * the material is. A picture of a sphere sums f wi.z over the light, and shows views with density
 * wo.z: what matters to it is f wi.z wo.z. */
#ifndef HNBRDF_FIT_BRIGHT_H
#define HNBRDF_FIT_BRIGHT_H

#include "hnbrdf/measured.h"

/* Candidates a pair is chosen from. */
enum { FIT_BRIGHT_CANDIDATES = 8 };

/* Draw a pair with a density near f wi.z wo.z, f the sum of the channels, and its value f. Half of
 * the candidates come from the grid sampler, half from the cosine sampler; each is chosen in
 * proportion to f wi.z wo.z over the density of both (resampled importance sampling, Talbot 2005).
 * A material that is black where it was looked at gives any of its valid pairs. Returns how many of
 * the candidates have a valid measurement; with 0 there is no pair. */
int hnbrdf_fit_bright_draw(const hnbrdf_measured *measured, hnbrdf_rng *rng, float wi[3],
                           float wo[3], float f[3]);

/* Density of the grid sampler over pairs of directions, in 1/sr^2. */
double hnbrdf_fit_grid_density(const float wi[3], const float wo[3]);

#endif
