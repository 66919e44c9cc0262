/* kernel_plain.c: the evaluation kernels in portable C, the reference of all others. */
#define KERNEL_TABLE hnbrdf_kernel_plain
#define KERNEL_VARIANT HNBRDF_VARIANT_PLAIN
#define KERNEL_WIDTH 1
#include "core/kernel_body.h"
