/* rounding.h: what rounding the network's own products and sums costs f. Trained weights are
 * large and of both signs, so where f is small of what it is the difference of, a correct
 * evaluation in floats is off by more. */
#ifndef HNBRDF_CHECK_ROUNDING_H
#define HNBRDF_CHECK_ROUNDING_H

#include "check/oracle.h"
#include "check/stability.h"

/* Error of f relative to oracle_point.scale, in one channel, if every product, sum and input of the
 * network is rounded by its own chance, uniformly over what the state allows: the mean (0 to
 * nearest) and the standard deviation. 0 and 0 without a network. */
typedef struct stability_rounding {
    double mean, deviation;
} stability_rounding;

stability_rounding stability_rounding_of(const hnbrdf_model_desc *desc,
                                         const hnbrdf_material *material, const oracle_point *point,
                                         int channel, stability_state state);

#endif
