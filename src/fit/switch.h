/* switch.h: a latent code with which a hybrid's network leaves GGX as it is, exactly.
 *
 * One unit of each hidden layer, the last, is kept for it. Its weights are 0 in training, so that
 * nothing else depends on it. Afterwards the one of the first layer is made to look at the first
 * latent number alone: it is off for every code that training found, and on far beyond them. On,
 * it turns all other units of the next layer off, and its own one on; and so on to the outputs,
 * where the last one adds what leads from the bias to c = ln b and an open gate:
 *   f = max(0, exp(ln b) + sigmoid(20) f_a - b) = f_a
 * It is a network like any other: files, kernels and shaders know nothing of it. */
#ifndef HNBRDF_FIT_SWITCH_H
#define HNBRDF_FIT_SWITCH_H

#include "fit/kernel.h"

/* Where a network is large enough to spare the units. */
int hnbrdf_fit_switch_fits(const fit_layout *layout);
/* Before training. */
void hnbrdf_fit_switch_reserve(const fit_layout *layout, float *parameters);
/* After it. */
void hnbrdf_fit_switch_install(const fit_layout *layout, float *parameters);

/* Fills code [latent] with the one that leaves GGX alone. 0 if the network has no such switch. */
int hnbrdf_fit_switch_code(const hnbrdf_model_desc *network, float *code);
/* The largest first number of a code with which it is off; infinite if there is no switch. */
float hnbrdf_fit_switch_most(const hnbrdf_model_desc *network);
/* Whether a code is beyond those that training may find. */
int hnbrdf_fit_switch_is_on(const hnbrdf_model_desc *network, const float *code);

#endif
