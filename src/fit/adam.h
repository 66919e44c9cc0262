/* adam.h: Adam (Kingma and Ba 2015) over a flat array of parameters. */
#ifndef HNBRDF_FIT_ADAM_H
#define HNBRDF_FIT_ADAM_H

#include <stddef.h>

#define FIT_ADAM_BETA1 0.9
#define FIT_ADAM_BETA2 0.99

/* One step: parameters -= rate * m^ / (sqrt(v^) + 1e-8). m and v are [count], zero before the
 * first step; step counts from 1. A gradient that is not finite leaves its parameter and moments
 * alone. */
void hnbrdf_fit_adam(float *parameters, const float *gradient, float *m, float *v, size_t count,
                     long step, double rate);

#endif
