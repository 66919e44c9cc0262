/* bounds.h: how far a device may be from C, derived pair by pair (running forward error
 * analysis). */
#ifndef HNBRDF_CHECK_BOUNDS_H
#define HNBRDF_CHECK_BOUNDS_H

#include "core/network.h"
#include "hnbrdf/glsl.h"
#include "check/rules.h"

/* A number as C computes it, and a bound on |device - C|; infinite where nothing is promised. */
typedef struct check_tracked {
    float v;
    double e;
} check_tracked;

/* One evaluation, stage by stage. `fed` is the network with the inputs that C encoded. */
typedef struct check_bounds {
    check_tracked encoding[HNBRDF_ENCODING_SIZE];
    check_tracked fed[HNBRDF_MAX_OUTPUTS];
    check_tracked analytic[3];
    check_tracked value[3];
} check_bounds;

/* Directions above the horizon; the values v are, bit by bit, those of the C library, or, if the
 * shader is in half precision, of half.h. Entries that the kind of model does not have are 0.
 * drift: 0 for directions that the device was given. A device that made wi itself, as a difference
 * from wo, may simplify wi + wo and wi - wo: what they are made of is then this far from wi. */
void check_bounds_make(const check_rules *rules, const hnbrdf_model_desc *desc,
                       hnbrdf_glsl_precision precision, const hnbrdf_material *material,
                       const float wi[3], const float wo[3], double drift, check_bounds *bounds);

#endif
