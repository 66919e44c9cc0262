/* probe.c: every operation of a shader on one device compared with C. */
#include "check/probe.h"

#include "base/error.h"
#include "core/math.h"
#include "hnbrdf/measured.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum { OPERANDS = CHECK_PROBE_OPERANDS, RESULTS = CHECK_PROBE_RESULTS };

/* ---- Operands -------------------------------------------------------------------------------- */

static float random_float(hnbrdf_rng *rng, int low_exponent, int high_exponent)
{
    uint32_t bits = hnbrdf_rng_u32(rng);
    int range = high_exponent - low_exponent + 1;
    int exponent = low_exponent + (int)(hnbrdf_rng_u32(rng) % (uint32_t)range);
    float magnitude = ldexpf(1.0f + (float)(bits >> 9) * 0x1p-23f, exponent);
    return bits & 1 ? -magnitude : magnitude;
}

static void draw_operands(hnbrdf_rng *rng, int k, float operands[OPERANDS])
{
    static const int ranges[4][2] = {{0, 0}, {-3, 3}, {-20, 20}, {-140, 100}};
    const int *range = ranges[k % 4];
    operands[0] = random_float(rng, range[0], range[1]);
    operands[1] = random_float(rng, range[0], range[1]);
    operands[2] = 160.0f * hnbrdf_rng_float(rng) - 80.0f;
    operands[3] = k % 4 == 1   ? 1.0f + random_float(rng, -23, -2)
                  : k % 4 == 3 ? fabsf(random_float(rng, -1, 0))
                               : fabsf(random_float(rng, -16, 125));
}

/* ---- Comparison ------------------------------------------------------------------------------ */

static int subnormal(float x)
{
    return x != 0.0f && fabsf(x) < FLT_MIN;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* Sets *exact or *keeps to 0 if the device's bits are not C's. */
static void compare_bits(const float operands[OPERANDS], float reference, float device, int *exact,
                         int *keeps)
{
    if (!isfinite(reference) || hnbrdf_float_to_bits(reference) == hnbrdf_float_to_bits(device))
        return;
    if (subnormal(operands[0]) || subnormal(operands[1]) || subnormal(reference))
        *keeps = 0;
    else
        *exact = 0;
}

static float flushed(float x)
{
    return subnormal(x) ? copysignf(0.0f, x) : x;
}

/* Clears *flushes if the device's bits are not the flushed reference. */
static void compare_flushed(float reference, float device, int *flushes)
{
    if (isfinite(reference) &&
        hnbrdf_float_to_bits(flushed(reference)) != hnbrdf_float_to_bits(device))
        *flushes = 0;
}

/* The operations once more where subnormal numbers are zeros. */
static void compare_all_flushed(const float operands[OPERANDS], const float *device, int *flushes)
{
    float a = flushed(operands[0]), b = flushed(operands[1]), c = flushed(operands[2]);
    compare_flushed(a + b, device[0], flushes);
    compare_flushed(a - b, device[1], flushes);
    compare_flushed(a * b, device[2], flushes);
    compare_flushed(flushed(a * b) + c, device[3], flushes);
    compare_flushed(sqrtf(fabsf(a)), device[5], flushes);
    if (b != 0.0f && fabsf(b) <= 0x1p126f) /* what Vulkan promises of divisors */
        compare_flushed(a / b, device[4], flushes);
}

static double error_in_ulp(double truth, float device)
{
    float rounded = fabsf((float)truth);
    double spacing = (double)(nextafterf(rounded, INFINITY) - rounded);
    return fabs((double)device - truth) / spacing;
}

static void compare_functions(const check_rules *rules, const float operands[OPERANDS],
                              const float *device, check_arithmetic *seen)
{
    double x = (double)operands[2], y = (double)operands[3], exponential = exp(x),
           logarithm = log(y);
    double exp_error = fabs((double)device[6] - exponential),
           log_error = fabs((double)device[7] - logarithm);
    seen->exp_ulp = larger(seen->exp_ulp, error_in_ulp(exponential, device[6]));
    seen->exp_share = larger(seen->exp_share, exp_error / check_exp_error(rules, x, exponential));
    if (y >= 0.5 && y <= 2.0)
        seen->log_error = larger(seen->log_error, log_error);
    seen->log_share = larger(seen->log_share, log_error / check_log_error(rules, y, logarithm));
}

static void compare_all(const check_rules *rules, const float (*operands)[OPERANDS],
                        const float (*results)[RESULTS], int count, check_arithmetic *seen)
{
    seen->exact_basic = seen->exact_divide = seen->exact_sqrt = seen->keeps_denormals = 1;
    seen->flushes_denormals = 1;
    for (int k = 0; k < count; k++) {
        float a = operands[k][0], b = operands[k][1], c = operands[k][2];
        const float *device = results[k];
        int *keeps = &seen->keeps_denormals;
        compare_bits(operands[k], a + b, device[0], &seen->exact_basic, keeps);
        compare_bits(operands[k], a - b, device[1], &seen->exact_basic, keeps);
        compare_bits(operands[k], a * b, device[2], &seen->exact_basic, keeps);
        if (!subnormal(a * b))
            compare_bits(operands[k], a * b + c, device[3], &seen->exact_basic, keeps);
        compare_bits(operands[k], sqrtf(fabsf(a)), device[5], &seen->exact_sqrt, keeps);
        if (!subnormal(a))
            seen->sqrt_ulp = larger(seen->sqrt_ulp, error_in_ulp(sqrt(fabs((double)a)), device[5]));
        compare_functions(rules, operands[k], device, seen);
        compare_all_flushed(operands[k], device, &seen->flushes_denormals);
        if (subnormal(b) || fabsf(b) > 0x1p126f || !isfinite(a / b))
            continue;
        compare_bits(operands[k], a / b, device[4], &seen->exact_divide, keeps);
        if (!subnormal(a) && !subnormal(a / b) && a / b != 0.0f)
            seen->divide_ulp =
                larger(seen->divide_ulp, error_in_ulp((double)a / (double)b, device[4]));
    }
    seen->flushes_denormals &= !seen->keeps_denormals;
}

/* ---- Both ------------------------------------------------------------------------------------ */

void check_probe_draw(float (*operands)[CHECK_PROBE_OPERANDS], int count)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; k < count; k++)
        draw_operands(&rng, k, operands[k]);
}

void check_probe_judge(const float (*operands)[CHECK_PROBE_OPERANDS],
                       const float (*results)[CHECK_PROBE_RESULTS], int count, int is_llvmpipe,
                       check_arithmetic *arithmetic)
{
    check_arithmetic seen = {.values = count};
    check_rules rules = check_rules_fast(&seen, is_llvmpipe);
    compare_all(&rules, operands, results, count, &seen);
    *arithmetic = seen;
}

hnbrdf_result check_probe_run(hnbrdf_result (*run)(void *user, const float *operands, int count,
                                                   float *results, hnbrdf_error *error),
                              void *user, int is_llvmpipe, check_arithmetic *arithmetic,
                              hnbrdf_error *error)
{
    float(*operands)[OPERANDS] = calloc(CHECK_PROBE_COUNT, sizeof *operands);
    float(*results)[RESULTS] = calloc(CHECK_PROBE_COUNT, sizeof *results);
    hnbrdf_result result = HNBRDF_OK;
    if (!operands || !results)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "probe: no memory");
    if (!result) {
        check_probe_draw(operands, CHECK_PROBE_COUNT);
        result = run(user, operands[0], CHECK_PROBE_COUNT, results[0], error);
    }
    if (!result)
        check_probe_judge((const float(*)[OPERANDS])operands, (const float(*)[RESULTS])results,
                          CHECK_PROBE_COUNT, is_llvmpipe, arithmetic);
    free(operands);
    free(results);
    return result;
}
