/* bounds_draw.h: how far a device may be from C in what it draws, and in densities. */
#ifndef HNBRDF_CHECK_BOUNDS_DRAW_H
#define HNBRDF_CHECK_BOUNDS_DRAW_H

#include "check/bounds.h"

/* hnbrdf_pdf() of two directions above the horizon; drift as for check_bounds_make(). The material
 * is prepared with hnbrdf_prepare_analytic() and hnbrdf_prepare_lobes(). */
check_tracked check_density_make(const check_rules *rules, const hnbrdf_prepared *prepared,
                                 const float wi[3], const float wo[3], double drift);

/* The direction that hnbrdf_sample() draws for wo above the horizon; (0, 0, 1) where it draws none.
 * Infinite where a device may choose another lobe, or draw where C does not: close to where one
 * begins to. */
void check_draw_make(const check_rules *rules, const hnbrdf_prepared *prepared, const float wo[3],
                     const float u[2], check_tracked wi[3]);

#endif
