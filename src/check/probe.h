/* probe.h: how one device rounds: every operation of a shader compared with C. */
#ifndef HNBRDF_CHECK_PROBE_H
#define HNBRDF_CHECK_PROBE_H

#include "check/rules.h"
#include "hnbrdf/hnbrdf.h"

/* Numbers that hnbrdf_probe() of shaders/probe.glsl takes and gives: slots 0 and 1. */
enum { CHECK_PROBE_OPERANDS = 4, CHECK_PROBE_RESULTS = 8, CHECK_PROBE_COUNT = 1 << 17 };

/* Both, with `run` in between: results[count][CHECK_PROBE_RESULTS] of
 * operands[count][CHECK_PROBE_OPERANDS]. */
hnbrdf_result check_probe_run(hnbrdf_result (*run)(void *user, const float *operands, int count,
                                                   float *results, hnbrdf_error *error),
                              void *user, int is_llvmpipe, check_arithmetic *arithmetic,
                              hnbrdf_error *error);

/* The first `count` of a sequence that is always the same: usual, small, large and subnormal
 * numbers. */
void check_probe_draw(float (*operands)[CHECK_PROBE_OPERANDS], int count);

/* What a device, the driver Mesa llvmpipe or not, made of them. The fields about half precision
 * become 0. */
void check_probe_judge(const float (*operands)[CHECK_PROBE_OPERANDS],
                       const float (*results)[CHECK_PROBE_RESULTS], int count, int is_llvmpipe,
                       check_arithmetic *arithmetic);

#endif
