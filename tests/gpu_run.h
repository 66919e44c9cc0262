/* gpu_run.h: a compute shader of a test, with an exported scene, on every Vulkan device of this
 * machine. */
#ifndef HNBRDF_TESTS_GPU_RUN_H
#define HNBRDF_TESTS_GPU_RUN_H

#include "hnbrdf/glsl.h"

#include "gpu/probe.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>

/* Runs the tests on each device, one after the other, with validation if the layer is installed:
 * returns what main() returns, 77 where there is no device or no glslangValidator. A message of the
 * validation layer is a failure. */
int gpu_run_tests(const struct CMUnitTest *tests, size_t count);

/* 1 if the device's + - * / sqrt give the bits of IEEE 754, subnormal numbers aside: HNBRDF_EXACT
 * then gives those of C that treats subnormals alike, as C does between gpu_run_c_begin() and
 * gpu_run_c_end(). */
int gpu_run_exact(void);
void gpu_run_c_begin(void);
void gpu_run_c_end(void);

/* The device that the running test is to use, and how it rounds in a build with HNBRDF_EXACT 1 or
 * 0. */
const gpu_device *gpu_run_device(void);
check_rules gpu_run_rules(int exact);

/* SPIR-V of body with HNBRDF_EXACT 1 or 0, malloc'ed. The body follows hybrid_brdf.glsl, the
 *   scene and uint in_words[], float results[] (set 0, bindings 0 and 1), uint count, int
 *   material (push
 * constants) and has a main(). Ends the test if it does not compile. */
uint32_t *gpu_run_compile(const char *scene, const char *body, int exact, size_t *bytes);

/* What main() wrote for invocations 0 to count - 1: result_words floats. */
void gpu_run(const char *scene, const char *body, int exact, int material, uint32_t count,
             const void *in, size_t in_words, float *results, size_t result_words);

/* The same of what gpu_run_compile() gave. */
void gpu_run_compiled(const uint32_t *spirv, size_t bytes, int material, uint32_t count,
                      const void *in, size_t in_words, float *results, size_t result_words);

/* Appends to a malloc'ed text; user is a gpu_run_text. Zero-initialise. */
typedef struct gpu_run_text {
    char *bytes;
    size_t size;
} gpu_run_text;
int gpu_run_append(void *user, const void *data, size_t size);

/* The text of an export, malloc'ed. Ends the test if it cannot be made. */
char *gpu_run_export(const hnbrdf_model *model, const hnbrdf_glsl_options *options);

/* Ends the test unless all count floats are equal as numbers or have the same bits. */
void gpu_run_assert_same(const char *what, const float *device, const float *reference,
                         size_t count);

#endif
