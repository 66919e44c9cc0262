/* compile.h: GLSL to SPIR-V by the reference compiler, glslangValidator, as a program of its own.
 * */
#ifndef HNBRDF_GPU_COMPILE_H
#define HNBRDF_GPU_COMPILE_H

#include "hnbrdf/hnbrdf.h"

#include <stdint.h>

/* A text that the shader can #include by this name; no directories. */
typedef struct gpu_include {
    const char *name, *text;
} gpu_include;

/* A text that grows by gpu_text_append(), which is an hnbrdf_write_fn. Zero-initialise; free
 * bytes. */
typedef struct gpu_text {
    char *bytes; /* ends in a NUL that size does not count; NULL while empty */
    size_t size, room;
} gpu_text;
int gpu_text_append(void *text, const void *data, size_t size);

enum { GPU_MAX_DEFINES = 3 };

/* 1 if glslangValidator is in PATH. */
int gpu_compiler_found(void);

/* Compiles a Vulkan compute shader. defines are "NAME=VALUE", up to
 * GPU_MAX_DEFINES, the last followed by NULL; or NULL for none. *spirv is malloc'ed, *size in
 * bytes. On a compile error what the compiler says goes to stderr, and the first error line into
 * `error`. */
hnbrdf_result gpu_compile(const char *text, const gpu_include *includes, int include_count,
                          const char *const *defines, uint32_t **spirv, size_t *size,
                          hnbrdf_error *error);
/* The same for a shader of another stage: "vert", "frag". */
hnbrdf_result gpu_compile_at(const char *stage, const char *text, const gpu_include *includes,
                             int include_count, const char *const *defines, uint32_t **spirv,
                             size_t *size, hnbrdf_error *error);

#endif
