/* parity.h: rows of inputs and outputs of shaders/parity.glsl. */
#ifndef HNBRDF_CHECK_PARITY_H
#define HNBRDF_CHECK_PARITY_H

#include "check/reference.h"

/* Floats of a row; outputs are 8 slots of 4. */
enum { CHECK_PARITY_INPUTS = 16, CHECK_PARITY_OUTPUTS = 32, CHECK_PARITY_SLOTS = 8 };

/* A row a pair of the reference, for the material with this index in the scene. */
void check_parity_rows(const check_reference *reference, int material,
                       float (*rows)[CHECK_PARITY_INPUTS]);

/* Outputs to what check_compare() takes. Returns 1 if the shader says that it keeps the order of
 * its operations. */
int check_parity_stages(const float (*outputs)[CHECK_PARITY_OUTPUTS], size_t count,
                        float *const stages[CHECK_STAGES]);

#endif
