/* kernel_neon_fused.c: kernel_neon.c with products and sums fused, by the
 * compiler's flags. */
#define KERNEL_TABLE hnbrdf_kernel_neon_fused
#define KERNEL_VARIANT HNBRDF_VARIANT_NEON_FUSED
#define KERNEL_WIDTH 4
#define KERNEL_ROWS 6
#define KERNEL_WIDE 4
#define KERNEL_SINGLE 4
#include "core/kernel_body.h"
