/* kernel_avx2_fused.c: kernel_avx2.c with products and sums fused, by the
 * compiler's flags. */
#define KERNEL_TABLE hnbrdf_kernel_avx2_fused
#define KERNEL_VARIANT HNBRDF_VARIANT_AVX2_FUSED
#define KERNEL_WIDTH 8
#define KERNEL_ROWS 6
#define KERNEL_WIDE 2
#define KERNEL_SINGLE 8
#include "core/kernel_body.h"
