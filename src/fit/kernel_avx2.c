/* kernel_avx2.c: the trainer's kernel compiled for AVX2; the same bits as kernel.c. */
#include "fit/kernel.h"

#ifdef FIT_KERNEL_X86
#define KERNEL_WIDTH 8
#include "fit/kernel_float.h"

const fit_kernel hnbrdf_fit_kernel_avx2 = {"avx2",          kernel_derive,   kernel_network,
                                           kernel_analytic, kernel_own_rows, kernel_own,
                                           kernel_pixel,    kernel_matrix};
#else
typedef int fit_kernel_avx2_is_empty; /* ISO C wants something in a file */
#endif
