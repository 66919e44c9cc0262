/* axis.h: the direction about which an anisotropic material is symmetric. */
#ifndef HNBRDF_FIT_AXIS_H
#define HNBRDF_FIT_AXIS_H

#include "hnbrdf/measured.h"

/* The angle from the tangent, radians in [0, pi/2) or a little beside it, so that f changes least
 * in the two mirrors along it and across it: threads, scratches and grooves lie along one of them,
 * also where the highlight is as wide along as across, and so has no direction of its own. */
double hnbrdf_fit_axis(const hnbrdf_measured *measured);

#endif
