/* verify.h: the shader of an exported scene, run by anything, against the C library. */
#ifndef HNBRDF_CHECK_VERIFY_H
#define HNBRDF_CHECK_VERIFY_H

#include "check/parity.h"
#include "check/rules.h"

typedef enum check_build {
    CHECK_BUILD_EXACT = 0, /* HNBRDF_EXACT 1 */
    CHECK_BUILD_FAST,      /* built-in exp and log, contraction allowed */
    CHECK_BUILDS
} check_build;

/* "exact", "fast". */
const char *check_build_name(check_build build);

/* What runs shaders/parity.glsl: a device, or a program that was handed a folder. */
typedef struct check_runner {
    int is_llvmpipe; /* the driver is Mesa llvmpipe */
    /* 1: the language lets a compiler order operations anew whatever the shader says */
    int is_unordered;
    hnbrdf_result (*probe)(void *user, check_arithmetic *arithmetic, hnbrdf_error *error);
    /* outputs[count][CHECK_PARITY_OUTPUTS] of rows[count][CHECK_PARITY_INPUTS]; called with the
     * rows of one material after the other, for every build. *has_run stays 1, or becomes 0 where
     * there is no such build. */
    hnbrdf_result (*run)(void *user, check_build build, const float *rows, size_t count,
                         float *outputs, int *has_run, hnbrdf_error *error);
    void *user;
} check_runner;

typedef struct check_verify_options {
    hnbrdf_glsl_precision precision; /* of the scene */
    const int *materials;            /* indices of the exported materials, in order */
    int material_count;
    size_t pairs; /* per material */
    uint64_t seed;
    void (*progress)(void *user, double share); /* may be NULL */
    void *progress_user;
} check_verify_options;

/* What a scene costs on a device; NaN where it was not measured. */
typedef struct check_timing {
    int evaluations;          /* per measurement */
    double value_ns, copy_ns; /* of one evaluation; of its buffer traffic alone */
    double compile_ms;        /* the text, to what the driver takes */
    double first_ms;          /* pipeline and first dispatch; less if the driver keeps a cache */
    size_t spirv_bytes;       /* 0: the driver takes the text */
} check_timing;

typedef struct check_report {
    check_arithmetic arithmetic;
    check_timing timing;
    int ordered; /* 1: the exact build keeps the order of its operations */
    /* every comparison within its bounds, and exp and log as accurate as the bounds assume */
    int within;
    int material_count;
    check_comparison (*comparisons)[CHECK_BUILDS][CHECK_STAGES]; /* [material_count] */
} check_report;

/* The pairs of material number k of the options, and the rows of inputs that they make. */
void check_material_rows(const hnbrdf_model *model, const check_verify_options *options, int k,
                         check_reference *reference, float (*rows)[CHECK_PARITY_INPUTS]);

/* Fails if something could not be run; a shader that is wrong gives HNBRDF_OK and within = 0. */
hnbrdf_result check_verify(const check_runner *runner, const hnbrdf_model *model,
                           const check_verify_options *options, check_report *report,
                           hnbrdf_error *error);
void check_report_free(check_report *report);

#endif
