/* kernel_avx512.c: the evaluation kernels for AVX-512: 32 registers of 16 floats. */
#define KERNEL_TABLE hnbrdf_kernel_avx512
#define KERNEL_VARIANT HNBRDF_VARIANT_AVX512
#define KERNEL_WIDTH 16
#define KERNEL_ROWS 8
#define KERNEL_WIDE 1
#define KERNEL_SINGLE 8
#include "core/kernel_body.h"
