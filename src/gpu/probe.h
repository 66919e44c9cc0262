/* probe.h: how one device rounds, and from that, rules by which errors can be bounded. */
#ifndef HNBRDF_GPU_PROBE_H
#define HNBRDF_GPU_PROBE_H

#include "gpu/device.h"

/* What was seen on `values` operands of each operation; 1 in a flag: the bits of IEEE 754,
 * always. */
typedef struct gpu_arithmetic {
    int values;
    /* + - *, and a * b + c kept as two operations where the shader says `precise` */
    int exact_basic;
    int exact_divide, exact_sqrt;
    int keeps_denormals;
    /* instead of keeping them, all: every subnormal operand and result is a zero of its sign,
     * otherwise the bits of IEEE 754 */
    int flushes_denormals;
    int has_half; /* half precision, which the following is about */
    int exact_half,
        keeps_half_denormals;    /* conversion, + and * to the nearest, ties to even; subnormals */
    double divide_ulp, sqrt_ulp; /* worst error seen, in ulp of the true result */
    double exp_ulp, exp_share;   /* likewise, x in [-80, 80]; worst share of what the rules allow */
    /* worst |log - true| near 1 (0.5 to 2); worst share, all x >= 1e-5 */
    double log_error, log_share;
} gpu_arithmetic;

/* What the bounds assume of an operation with operands a, b and true result r: an error of at most
 * `...` relative to |r|, plus tiny. `repeats`: equal operands give the bits that C gives. */
typedef struct gpu_rules {
    int repeats_basic, repeats_divide, repeats_sqrt;
    /* exp and log are those of exact operations, hnbrdf_exp and hnbrdf_log */
    int repeats_functions;
    double basic, divide, sqrt;
    double exp, exp_slope;  /* exp(x): exp + exp_slope |x| */
    double log, log_near_1; /* log; absolute, for x in [0.5, 2], or everywhere if log_is_sum */
    int log_is_sum;
    double tiny;      /* absolute: a subnormal number may become 0 */
    int repeats_half; /* in half precision: the bits of half.h */
    /* conversion, + and *: relative; absolute, among the subnormal halves */
    double half, half_tiny;
} gpu_rules;

/* The largest error of exp(x) and log(x) by the rules; the second number is the true result. */
double gpu_exp_error(const gpu_rules *rules, double x, double exponential);
double gpu_log_error(const gpu_rules *rules, double x, double logarithm);

/* The build with HNBRDF_EXACT 1 on a device that was probed. */
gpu_rules gpu_rules_exact(const gpu_arithmetic *arithmetic);
/* The build with built-in exp and log: what Vulkan promises, and what more is known of the
 * driver. */
gpu_rules gpu_rules_fast(const gpu_arithmetic *arithmetic, VkDriverId driver);

hnbrdf_result gpu_probe(const gpu_device *device, gpu_arithmetic *arithmetic, hnbrdf_error *error);

#endif
