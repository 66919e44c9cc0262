/* kernel_double.c: the trainer's kernel in double, for the tests of its gradients. */
#include <math.h>

#define REAL double
#define REAL_EXP(x) exp(x)
#define REAL_EXP_INSIDE(x) exp(x)
#define REAL_LOG(x) log(x)
#define REAL_SQRT(x) sqrt(x)
#define REAL_COS(x) cos(x)
#define REAL_SIN(x) sin(x)
#define KERNEL_WIDTH 2
#include "fit/kernel_body.h"

const fit_kernel_double_table hnbrdf_fit_kernel_double = {
    kernel_derive, kernel_network, kernel_analytic, kernel_own_rows,
    kernel_own,    kernel_pixel,   kernel_matrix};
