/* kernel_sse2.c: the evaluation kernels for SSE2: 16 registers of 4 floats. */
#define KERNEL_TABLE hnbrdf_kernel_sse2
#define KERNEL_VARIANT HNBRDF_VARIANT_SSE2
#define KERNEL_WIDTH 4
#define KERNEL_ROWS 6
#define KERNEL_WIDE 2
#define KERNEL_SINGLE 4
#include "core/kernel_body.h"
