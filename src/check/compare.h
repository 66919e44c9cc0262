/* compare.h: what a device returned for the pairs of a reference, beside C and the bounds. */
#ifndef HNBRDF_CHECK_COMPARE_H
#define HNBRDF_CHECK_COMPARE_H

#include "check/reference.h"
#include "check/rules.h"

/* Densities and weights of a drawn direction are compared with those of C for the direction that
 * the device drew. HNBRDF_ERROR_FORMAT if the bounds do not reproduce the bits of the C library, in
 * which case they mean nothing. */
hnbrdf_result check_compare(const check_rules *rules, const hnbrdf_model *model,
                            const hnbrdf_material *material, const check_reference *reference,
                            const float *const device[CHECK_STAGES],
                            check_comparison comparisons[CHECK_STAGES], hnbrdf_error *error);

#endif
