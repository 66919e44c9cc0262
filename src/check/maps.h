/* maps.h: where over two angles precision goes: the relative error of an implementation, cell by
 * cell. */
#ifndef HNBRDF_CHECK_MAPS_H
#define HNBRDF_CHECK_MAPS_H

#include "check/stability.h"

typedef enum stability_map_kind {
    /* f_a over cos theta_h (right) and alpha (up, 1e-4 to 1, logarithmic) */
    STABILITY_MAP_HALF = 0,
    STABILITY_MAP_COSINES, /* f over cos theta_i (right) and cos theta_o (up) */
    STABILITY_MAPS
} stability_map_kind;

enum { STABILITY_MAP_SIDE = 96 };

/* A cosine at t in [0, 1] of an axis that resolves both ends: 1e-7 at 0, 1/2 at 1/2, and 1 - near
 * at 1. */
double stability_map_cosine(double t, double near);
/* The inverse. */
double stability_map_position(double cosine, double one_minus_cosine, double near);
/* `near` of the axes of cosines: theta_h from 1e-7 of the normal, the others from 1e-3. */
#define STABILITY_NEAR_HALF 5e-15
#define STABILITY_NEAR_COSINE 1e-7

/* The worst relative error of each cell (of f: relative to oracle_point.scale), [row][column],
 * row 0 below; over azimuths, difference angles and channels. `material` gives what the axes do
 * not. begin() has been called for the backends. errors is [count][SIDE][SIDE]. */
hnbrdf_result stability_map(const hnbrdf_model *model, const hnbrdf_material *material,
                            stability_map_kind kind, stability_backend *const *backends, int count,
                            float (*errors)[STABILITY_MAP_SIDE][STABILITY_MAP_SIDE],
                            hnbrdf_error *error);

#endif
