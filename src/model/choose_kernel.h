/* choose_kernel.h: which kernel a model will use. */
#ifndef HNBRDF_MODEL_CHOOSE_KERNEL_H
#define HNBRDF_MODEL_CHOOSE_KERNEL_H

#include "core/kernel.h"

/* The kernel of a variant; for HNBRDF_VARIANT_AUTO the fastest. HNBRDF_ERROR_UNSUPPORTED if it is
 * not available here. */
hnbrdf_result hnbrdf_choose_kernel(hnbrdf_variant variant, const hnbrdf_kernel **kernel,
                                   hnbrdf_error *error);

#endif
