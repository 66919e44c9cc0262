/* kernel_avx512_fused.c: kernel_avx512.c with products and sums fused, by the
 * compiler's flags. */
#define KERNEL_TABLE hnbrdf_kernel_avx512_fused
#define KERNEL_VARIANT HNBRDF_VARIANT_AVX512_FUSED
#define KERNEL_WIDTH 16
#define KERNEL_ROWS 8
#define KERNEL_WIDE 1
#define KERNEL_SINGLE 8
#include "core/kernel_body.h"
