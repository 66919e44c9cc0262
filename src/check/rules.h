/* rules.h: how a device rounds, as far as it is known, and rules by which errors can be bounded. */
#ifndef HNBRDF_CHECK_RULES_H
#define HNBRDF_CHECK_RULES_H

/* What was seen on `values` operands of each operation; 1 in a flag: the bits of IEEE 754,
 * always. */
typedef struct check_arithmetic {
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
} check_arithmetic;

/* What the bounds assume of an operation with operands a, b and true result r: an error of at most
 * `...` relative to |r|, plus tiny. `repeats`: equal operands give the bits that C gives. */
typedef struct check_rules {
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
} check_rules;

/* The largest error of exp(x) and log(x) by the rules; the second number is the true result. */
double check_exp_error(const check_rules *rules, double x, double exponential);
double check_log_error(const check_rules *rules, double x, double logarithm);

/* The build with HNBRDF_EXACT 1 on a device that was probed. */
check_rules check_rules_exact(const check_arithmetic *arithmetic);
/* The same where the language has no `precise`, or a compiler pays no heed to it: GL before 400, ES
 * before 320, WGSL. */
check_rules check_rules_unordered(const check_arithmetic *arithmetic);
/* The build with built-in exp and log: what Vulkan promises, and what more is known of the driver
 * Mesa llvmpipe. */
check_rules check_rules_fast(const check_arithmetic *arithmetic, int is_llvmpipe);

#endif
