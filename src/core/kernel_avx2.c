/* kernel_avx2.c: the evaluation kernels for AVX2: 16 registers of 8 floats. */
#define KERNEL_TABLE hnbrdf_kernel_avx2
#define KERNEL_VARIANT HNBRDF_VARIANT_AVX2
#define KERNEL_WIDTH 8
#define KERNEL_ROWS 6
#define KERNEL_WIDE 2
#define KERNEL_SINGLE 8
#include "core/kernel_body.h"
