/* real.h: the numbers the oracle computes with: __float128 where the compiler has it, else long
 * double. */
#ifndef HNBRDF_CHECK_REAL_H
#define HNBRDF_CHECK_REAL_H

#ifdef HNBRDF_ORACLE_QUAD
#include <quadmath.h>
typedef __float128 real; /* 113 bits */
#define REAL_NAME "__float128"
#define real_sqrt sqrtq
#define real_exp expq
#define real_log logq
#define real_sin sinq
#define real_cos cosq
#define real_abs fabsq
#else
#include <math.h>
typedef long double real; /* 64 bits on x86, 53 to 113 elsewhere */
#define REAL_NAME "long double"
#define real_sqrt sqrtl
#define real_exp expl
#define real_log logl
#define real_sin sinl
#define real_cos cosl
#define real_abs fabsl
#endif

#endif
