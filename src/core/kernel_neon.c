/* kernel_neon.c: the evaluation kernels for 64-bit Arm: 32 registers of 4 floats. */
#define KERNEL_TABLE hnbrdf_kernel_neon
#define KERNEL_VARIANT HNBRDF_VARIANT_NEON
#define KERNEL_WIDTH 4
#define KERNEL_ROWS 6
#define KERNEL_WIDE 4
#define KERNEL_SINGLE 4
#include "core/kernel_body.h"
