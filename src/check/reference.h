/* reference.h: what the C library says of a set of direction pairs, every stage. */
#ifndef HNBRDF_CHECK_REFERENCE_H
#define HNBRDF_CHECK_REFERENCE_H

#include "check/bounds.h"
#include "check/pairs.h"
#include "hnbrdf/glsl.h"

/* What a pipeline of a scene runs. Also the values of STAGE in shaders/verify.comp. */
typedef enum check_stage {
    CHECK_STAGE_ENCODING = 0,
    CHECK_STAGE_NETWORK, /* alone: its inputs are those that C encoded */
    CHECK_STAGE_ANALYTIC,
    CHECK_STAGE_VALUE,
    CHECK_STAGES,
    CHECK_STAGE_COPY = CHECK_STAGES /* reads and writes as VALUE does and nothing else */
} check_stage;

/* "encoding", "network", "analytic", "value". */
const char *check_stage_name(check_stage stage);

/* One number of one pair. */
typedef struct check_place {
    check_pair_class class_of_pair;
    float pair[6];
    int component;
    float device, reference;
    double bound; /* on |device - reference| */
    double ulp;
} check_place;

/* Errors are in ulp of, and relative to, the reference, but where it is small of 2^-10 for f and
 * f_a (below that, what is left of f when the floor is subtracted has no digits of its own) and
 * of 1 for what goes in and out of the network (numbers around 1, of which absolute errors
 * count). Bounds know no such limit. */
typedef struct check_comparison {
    int applies;      /* 0: this kind of model has no such stage */
    size_t values;    /* compared */
    size_t identical; /* same bits */
    size_t outside;   /* beyond the bound; or not finite or negative where f must be neither */
    size_t unbounded; /* not compared: nothing can be promised there (extreme pairs) */
    double sum_ulp, worst_ulp, sum_relative, worst_relative;
    double worst_share; /* largest error/bound; infinite for any error where the bound is 0 */
    /* the first value outside of its bound if there is one, else the largest in ulp */
    check_place worst;
} check_comparison;

/* Sums over several comparisons of one stage. */
void check_comparison_add(check_comparison *sum, const check_comparison *more);

/* `count` pairs of one material, for a shader of this precision: in half, network and value are
 * those of half.h. Stages keep 6, 6, 3 and 3 numbers a pair. */
typedef struct check_reference {
    hnbrdf_glsl_precision precision;
    size_t count;
    float *pairs; /* 6 each */
    check_pair_class *classes;
    float *stages[CHECK_STAGES];
} check_reference;

int check_stage_stride(check_stage stage);

hnbrdf_result check_reference_open(size_t count, hnbrdf_glsl_precision precision,
                                   check_reference *reference, hnbrdf_error *error);
void check_reference_close(check_reference *reference);
/* Draws pairs and evaluates all stages. */
void check_reference_fill(const hnbrdf_model *model, const hnbrdf_material *material,
                          hnbrdf_rng *rng, check_reference *reference);

/* Compares what the device returned for each stage. HNBRDF_ERROR_FORMAT if bounds.c does not
 * reproduce the bits of the C library, in which case its bounds mean nothing. */
hnbrdf_result check_compare(const check_rules *rules, const hnbrdf_model *model,
                            const hnbrdf_material *material, const check_reference *reference,
                            const float *const device[CHECK_STAGES],
                            check_comparison comparisons[CHECK_STAGES], hnbrdf_error *error);

#endif
