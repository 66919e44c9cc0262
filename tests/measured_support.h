/* measured_support.h: files in memory for the tests of measured data: tensor files made from
 * formulas, and what every refusal must look like. */
#ifndef MEASURED_SUPPORT_H
#define MEASURED_SUPPORT_H

#include "hnbrdf/measured.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct test_bytes {
    unsigned char *data;
    size_t size;
} test_bytes;

void put_le(unsigned char *p, uint64_t value, int bytes);
void put_float(unsigned char *p, float value);
void put_double(unsigned char *p, double value);

/* The parts of the phi_i circle that the synthetic RGL files cover. */
typedef enum test_circle { TEST_ISOTROPIC, TEST_WHOLE, TEST_HALF, TEST_QUARTER } test_circle;

/* A complete small RGL file; free() its data. */
test_bytes test_rgl(test_circle circle);
/* The spectral one: 400, 500, 600 and 700 nm, the whole circle; on request with a field "rgb"
 * too. */
test_bytes test_rgl_spectral(int with_rgb);
/* Offset of the record of a field, and of its type byte, offset, shape and data. */
size_t test_record(const test_bytes *file, const char *field);
size_t test_type_at(const test_bytes *file, const char *field);
size_t test_offset_at(const test_bytes *file, const char *field);
size_t test_shape_at(const test_bytes *file, const char *field, int axis);
size_t test_data_at(const test_bytes *file, const char *field);

/* Opening must fail with `result` and one line that names the file and holds `words`. */
void expect_refusal(const void *data, size_t size, hnbrdf_result result, const char *words);
hnbrdf_measured *expect_opens(const void *data, size_t size, const char *path);
hnbrdf_measured *expect_opens_with(const void *data, size_t size, const char *path,
                                   const hnbrdf_measured_options *options);
/* Any outcome but a crash: refused with a message, or opened with values that are finite and >=
 * 0. */
void expect_sane(const void *data, size_t size);
/* The same for a file of another name, read with options: values are then within
 * +-HNBRDF_MAX_VALUE. */
void expect_sane_with(const void *data, size_t size, const char *path,
                      const hnbrdf_measured_options *options);

/* f at spherical angles in radians. */
int eval_angles(const hnbrdf_measured *measured, const double angles[4], float f[3]);
/* The pair of directions at half and difference angles; 0 if one is below the horizon. */
int pair_at(double theta_h, double theta_d, double phi_d, double phi_h, float wi[3], float wo[3]);

/* Integral of f wi.z over wi, by `rings` x 180 midpoints over the half vector, theta_h = pi/2 u^4,
 * which resolves lobes down to alpha 0.005 with 240 rings. */
void directional_albedo(const hnbrdf_measured *measured, int rings, double theta, double phi,
                        double albedo[3]);

/* f(wi, wo) and f(wo, wi) have the same bits, over pairs of all samplers; stream: of the random
 * numbers. */
void assert_reciprocal(const hnbrdf_measured *measured, uint64_t stream, int pairs);

#endif
