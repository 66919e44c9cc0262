/* stability.h: every implementation of the BRDF against the oracle, over the hard cases. */
#ifndef HNBRDF_CHECK_STABILITY_H
#define HNBRDF_CHECK_STABILITY_H

#include "check/cases.h"

typedef enum stability_stage {
    STABILITY_ANALYTIC = 0, /* hnbrdf_eval_analytic(): 3 numbers an evaluation */
    STABILITY_VALUE,        /* hnbrdf_eval(): 3 */
    STABILITY_PDF,          /* hnbrdf_pdf(): 1 */
    STABILITY_SAMPLE,       /* hnbrdf_sample(): wi, weight, pdf, then hnbrdf_pdf() of that wi: 8 */
    STABILITY_STAGES
} stability_stage;
enum { STABILITY_NUMBERS = 8, STABILITY_NAME = 96 };

/* "analytic", "value", "pdf", "sample"; numbers an evaluation. */
const char *stability_stage_name(stability_stage stage);
int stability_stage_numbers(stability_stage stage);

/* What arithmetic is in while a backend runs; equal operations then give equal bits. */
typedef enum stability_state {
    STABILITY_NEAREST = 0,
    STABILITY_UP,
    STABILITY_DOWN,
    STABILITY_TO_ZERO,
    STABILITY_FLUSH, /* to nearest; subnormal operands and results are 0 */
    STABILITY_STATES
} stability_state;

/* An implementation. run() is called between begin() with the model and end(). */
typedef struct stability_backend {
    char name[STABILITY_NAME];
    int stages; /* sum of 1 << stage */
    double loosen,
        /* factor on the bars, on that of the value: 1 for correctly rounded operations */
        loosen_value;
    stability_state state;
    int exact; /* 1: promises the bits of the first backend in its state */
    hnbrdf_result (*begin)(struct stability_backend *backend, const hnbrdf_model *model,
                           hnbrdf_error *error);
    hnbrdf_result (*run)(struct stability_backend *backend, stability_stage stage,
                         const stability_block *block,
                         float values[STABILITY_BLOCK][STABILITY_NUMBERS], hnbrdf_error *error);
    void (*end)(struct stability_backend *backend);
    /* What begin() and run() keep; nobody else looks at them. */
    void *user;
    hnbrdf_model *model;
    int variant, form;
} stability_backend;

/* The C library: every variant this machine runs, called for one pair, prepared and in batches; the
 * first is the reference, plain and singly. Then the plain and the fastest variant in every
 * rounding mode and with subnormals flushed, plain first. Returns how many; at most
 * STABILITY_C_BACKENDS. */
enum { STABILITY_C_BACKENDS = 32 };
int stability_c_backends(stability_backend backends[STABILITY_C_BACKENDS]);

/* The bars, relative: of f_a and pdf to themselves; of f to oracle_point.scale, because where the
 * floor is subtracted f has no digits of its own. */
#define STABILITY_ANALYTIC_BAR 4e-6
#define STABILITY_VALUE_BAR 2e-5

/* Where an error is largest. */
typedef struct stability_place {
    hnbrdf_material material;
    float pair[6];
    int channel;
    double got, expected, scale;
    /* relative change of the true value when every input moves by an ulp: sum of sizes */
    double sensitivity;
} stability_place;

/* One case, backend and stage. Errors are relative; below the smallest normal float they are
 * none. */
typedef struct stability_row {
    const stability_case *what;
    char backend[STABILITY_NAME];
    stability_stage stage;
    int applies;   /* 0: not run */
    size_t values; /* numbers looked at */
    size_t not_finite, negative;
    size_t
        /* samples below the horizon, or whose density is not hnbrdf_pdf()'s to the bit */
        inconsistent;
    /* Beyond the bar of the value, but within what rounding in the network's sums must cost
     * there. */
    size_t ill_conditioned;
    stability_state state; /* of the backend */
    /* Numbers whose bits are not those of the first backend in this state if exact, when there
     * must be none; otherwise of the first of all. */
    size_t differs;
    int exact;
    double worst_own;   /* to f itself */
    double worst_scale; /* to the scale: what is judged */
    double worst_ulp;   /* of f itself, in spacings of floats */
    double bar;         /* least one among its evaluations; infinite: none */
    double worst_share; /* of the bar of its own evaluation */
    /* of worst_scale, or of the first number that is not finite or negative */
    stability_place place;
    int within;
} stability_row;

typedef struct stability_options {
    int blocks; /* of STABILITY_BLOCK evaluations a case */
    void (*progress)(void *user, double share);
    void *progress_user;
} stability_options;

/* rows[stability_case_count][backend_count][STABILITY_STAGES]. Fails if something cannot be run;
 * what is out of its bar gives HNBRDF_OK and a row with within = 0. */
hnbrdf_result stability_run(const hnbrdf_model *model, const stability_options *options,
                            stability_backend *backends, int backend_count, stability_row *rows,
                            hnbrdf_error *error);

#endif
