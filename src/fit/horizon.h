/* horizon.h: what training takes for the data near the horizon, where measurements end. Readers go
 * on beyond their last sample (an RGL file with what it has there over wo.z), to an albedo of 3 at
 * 89 degrees and no end; where no pair is drawn the network is free. */
#ifndef HNBRDF_FIT_HORIZON_H
#define HNBRDF_FIT_HORIZON_H

#include "hnbrdf/measured.h"

enum { FIT_HORIZON_KNOTS = 8 };

/* Factors on f near the horizon, at most 1: of wo.z and of wi.z, at the cosines of horizon.c,
 * linear between. */
typedef struct fit_horizon {
    float most[2][FIT_HORIZON_KNOTS];
    int held; /* 1: some factor is below 1 */
} fit_horizon;

/* The factors that keep the albedo of the data near the horizon below 1: of what leaves towards wo,
 * and of what comes from wi. Those of data that give off no more than they get are all 1. */
void hnbrdf_fit_horizon_make(const hnbrdf_measured *measured, fit_horizon *horizon);

/* f of this pair with its factors. */
void hnbrdf_fit_horizon_hold(const fit_horizon *horizon, const float wi[3], const float wo[3],
                             float f[3]);

/* Draws a pair of which one direction at least is within 6 degrees of the horizon, down to 0.57
 * degrees, where samplers end, or to 0.06 where data are held: there the network is free. Half
 * of them near the mirror direction of each other. Its f is that of the nearest pair with a
 * measurement, as it is: hold() is still to come. Returns 0 where there is none. */
int hnbrdf_fit_horizon_draw(const fit_horizon *horizon, const hnbrdf_measured *measured,
                            hnbrdf_rng *rng, float wi[3], float wo[3], float f[3]);

#endif
