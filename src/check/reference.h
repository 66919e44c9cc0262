/* reference.h: what the C library says of a set of direction pairs, every stage. */
#ifndef HNBRDF_CHECK_REFERENCE_H
#define HNBRDF_CHECK_REFERENCE_H

#include "check/comparison.h"
#include "hnbrdf/glsl.h"

/* What is compared, in this order. */
typedef enum check_stage {
    CHECK_STAGE_ENCODING = 0,
    CHECK_STAGE_NETWORK, /* alone: its inputs are those that C encoded */
    CHECK_STAGE_ANALYTIC,
    CHECK_STAGE_VALUE,
    CHECK_STAGE_DIRECTION, /* drawn for wo and u */
    CHECK_STAGE_DENSITY,   /* of that direction, of the wi of the pair */
    CHECK_STAGE_WEIGHT,    /* of that direction */
    CHECK_STAGES
} check_stage;

/* "encoding", "network", "analytic", "value", "direction", "density", "weight". */
const char *check_stage_name(check_stage stage);
/* Numbers a pair that are kept: 6, 6, 3, 3, 3, 2, 3; and that mean something for this kind of
 * model, 0: it has no such stage. */
int check_stage_stride(check_stage stage);
int check_stage_components(const hnbrdf_model_desc *desc, check_stage stage);

/* `count` pairs of one material, for a shader of this precision: in half, network, value and weight
 * are those of half.h. */
typedef struct check_reference {
    hnbrdf_glsl_precision precision;
    size_t count;
    float *pairs, *u; /* 6 and 2 each */
    check_pair_class *classes;
    float *stages[CHECK_STAGES];
} check_reference;

hnbrdf_result check_reference_open(size_t count, hnbrdf_glsl_precision precision,
                                   check_reference *reference, hnbrdf_error *error);
void check_reference_close(check_reference *reference);
/* Draws pairs, then u, and evaluates all stages. */
void check_reference_fill(const hnbrdf_model *model, const hnbrdf_material *material,
                          hnbrdf_rng *rng, check_reference *reference);

/* hnbrdf_eval() of a shader of this precision. */
void check_reference_eval(const hnbrdf_model *model, hnbrdf_glsl_precision precision,
                          const hnbrdf_material *material, const float wi[3], const float wo[3],
                          float f[3]);

#endif
