/* rules.c: from what a device was seen to do, how far each operation may be off. */
#include "check/rules.h"

#include <float.h>
#include <math.h>

static const double ULP = 0x1p-23; /* of 1: the largest that one ulp is in relative terms */

/* ---- Rules -----------------------------------------------------------------------------------
 * Vulkan 1.3, "Precision of core SPIR-V instructions", 32 bits: + - * correctly rounded; division
 * 2.5 ulp for |b| in [2^-126, 2^126]; inversesqrt 2 ulp, sqrt as 1/inversesqrt; exp 3 + 2|x| ulp;
 * log 3 ulp, 2^-21 absolute for x in [0.5, 2]; subnormal numbers may be flushed. 16 bits: + * and
 * conversions correctly rounded, which without a stated mode means to either neighbour. */

static check_rules vulkan_rules(void)
{
    return (check_rules){.basic = 0.5 * ULP,
                         .divide = 2.5 * ULP,
                         .sqrt = 4.5 * ULP,
                         .exp = 3 * ULP,
                         .exp_slope = 2 * ULP,
                         .log = 3 * ULP,
                         .log_near_1 = 0x1p-21,
                         .tiny = (double)FLT_MIN,
                         .half = 0x1p-10,
                         .half_tiny = 0x1p-14};
}

/* Operations that the probe saw to be exact. */
static void apply_probe(const check_arithmetic *arithmetic, check_rules *rules)
{
    rules->repeats_basic = arithmetic->exact_basic;
    rules->repeats_divide = arithmetic->exact_divide;
    rules->repeats_sqrt = arithmetic->exact_sqrt;
    if (arithmetic->exact_divide)
        rules->divide = 0.5 * ULP;
    if (arithmetic->exact_sqrt)
        rules->sqrt = 0.5 * ULP;
    if (arithmetic->keeps_denormals)
        rules->tiny = 0;
    rules->repeats_half = arithmetic->exact_half && arithmetic->keeps_half_denormals;
    if (arithmetic->exact_half)
        rules->half = 0x1p-11;
    if (arithmetic->keeps_half_denormals)
        rules->half_tiny = 0x1p-24;
}

check_rules check_rules_exact(const check_arithmetic *arithmetic)
{
    check_rules rules = vulkan_rules();
    apply_probe(arithmetic, &rules);
    rules.repeats_functions = 1;
    /* hnbrdf_exp: 1.1 ulp. hnbrdf_log: 1.05 ulp + 5e-8; s = f/(2 + f), |s| <= 0.172, enters as
     * 2.06 s. */
    rules.exp = 1.1 * ULP;
    rules.exp_slope = 0;
    rules.log = 1.05 * ULP;
    rules.log_is_sum = 1;
    rules.log_near_1 = 5e-8 + 2.06 * 0.172 * rules.divide;
    return rules;
}

/* GL 3.3 promises 10^-5 of each operation, ES 3.0 and GL from 4.5 on what Vulkan does: that is
 * asked of all, and the probe tells where a device rounds as C does. Compilers may fuse a product
 * with a sum, which errs less than both; divide by a constant through its reciprocal (1.5 ulp);
 * and order sums anew, so that C's bits are not repeated. Other orders matter where the exact build
 * has numbers that nearly cancel:
 * exp  x - k ln 2 in two parts, the first exact; as one product it is off by half an ulp of
 *      k ln 2, which is x within 0.35, and by k times what ln 2 rounds off: 1.72 |x| 2^-24.
 * log  2 s + s (s2 p) as s (2 + s2 p) and the like: three roundings of at most 2 |s| = 0.344. */
check_rules check_rules_unordered(const check_arithmetic *arithmetic)
{
    check_rules rules = check_rules_exact(arithmetic);
    rules.repeats_basic = rules.repeats_divide = rules.repeats_sqrt = rules.repeats_half = 0;
    rules.divide = fmax(rules.divide, 1.5 * ULP);
    rules.exp_slope = ULP;
    rules.log_near_1 += 3 * 0.344 * 0.5 * ULP;
    return rules;
}

check_rules check_rules_fast(const check_arithmetic *arithmetic, int is_llvmpipe)
{
    check_rules rules = vulkan_rules();
    if (is_llvmpipe) {
        /* Each of its operations rounds as the probe saw, but without `precise` its compiler may
         * order sums anew and divide by a constant through its reciprocal (1.5 ulp), as it does
         * when a shader holds one material: C's bits are not repeated. And it keeps to neither
         * limit of exp and log: measured with Mesa 22.3, exp errs by 16 ulp where Vulkan allows
         * 3, log by 5.7e-7 near 1. */
        apply_probe(arithmetic, &rules);
        rules.repeats_basic = rules.repeats_divide = rules.repeats_sqrt = rules.repeats_half = 0;
        rules.divide = fmax(rules.divide, 1.5 * ULP);
        rules.exp = 16 * ULP;
        rules.log_near_1 = 6e-7;
    }
    return rules;
}

double check_exp_error(const check_rules *rules, double x, double exponential)
{
    return (rules->exp + rules->exp_slope * fabs(x)) * exponential;
}

double check_log_error(const check_rules *rules, double x, double logarithm)
{
    double relative = rules->log * fabs(logarithm);
    return rules->log_is_sum      ? relative + rules->log_near_1
           : x >= 0.5 && x <= 2.0 ? rules->log_near_1
                                  : relative;
}
