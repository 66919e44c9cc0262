/* comparison.h: numbers of a device beside those of C, counted. */
#ifndef HNBRDF_CHECK_COMPARISON_H
#define HNBRDF_CHECK_COMPARISON_H

#include "check/pairs.h"

/* One number of one pair. */
typedef struct check_place {
    check_pair_class class_of_pair;
    float pair[6];
    int component;
    float device, reference;
    double bound; /* on |device - reference| */
    double ulp;
} check_place;

/* What a number must be in any case, and what its errors are related to: see check_comparison. */
typedef enum check_number_kind {
    CHECK_NUMBER_ANY = 0, /* goes in or out of the network: of 1 */
    CHECK_NUMBER_FINITE,  /* part of a direction: of 1 */
    CHECK_NUMBER_VALUE    /* finite, not negative: of 2^-10 */
} check_number_kind;

/* Errors are in ulp of, and relative to, the reference, but where it is small of 2^-10 for f, f_a,
 * densities and weights (below that, what is left of f when the floor is subtracted has no digits
 * of its own) and of 1 for directions and what goes in and out of the network (numbers around 1, of
 * which absolute errors count). Bounds know no such limit. */
typedef struct check_comparison {
    int applies;      /* 0: this kind of model has no such stage, or it was not run */
    size_t values;    /* compared */
    size_t identical; /* same bits */
    size_t outside;   /* beyond the bound; or not what such a number must be */
    size_t unbounded; /* not compared: nothing can be promised there (extreme pairs) */
    double sum_ulp, worst_ulp, sum_relative, worst_relative;
    double worst_share; /* largest error/bound; infinite for any error where the bound is 0 */
    /* the first value outside of its bound if there is one, else the largest in ulp */
    check_place worst;
} check_comparison;

/* Counts one more; place->ulp is not read. */
void check_comparison_take(check_comparison *comparison, const check_place *place,
                           check_number_kind number);
/* Sums over several comparisons of one stage. */
void check_comparison_add(check_comparison *sum, const check_comparison *more);

#endif
