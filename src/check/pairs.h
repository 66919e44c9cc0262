/* pairs.h: the direction pairs a shader is verified on: usual ones and every edge there is. */
#ifndef HNBRDF_CHECK_PAIRS_H
#define HNBRDF_CHECK_PAIRS_H

#include "hnbrdf/measured.h"

typedef enum check_pair_class {
    CHECK_PAIR_UNIFORM = 0, /* uniform in solid angle */
    CHECK_PAIR_GRID,        /* MERL's grid: dense around the mirror direction */
    CHECK_PAIR_MIRROR,      /* wo is wi reflected, exactly or a little off */
    CHECK_PAIR_GRAZING,     /* one or both within 1e-6 to 0.1 of the horizon */
    CHECK_PAIR_RETRO,       /* wo is wi, exactly or a little off */
    CHECK_PAIR_NORMAL,      /* one or both exactly n */
    CHECK_PAIR_SWAPPED,     /* the pair before, wi and wo exchanged */
    CHECK_PAIR_EXTREME,     /* on, below or 1e-38 above the horizon; opposite; not of unit length */
    CHECK_PAIR_NOT_FINITE,  /* a NaN or an infinity: only a finite value is asked for */
    CHECK_PAIR_CLASSES
} check_pair_class;

const char *check_pair_class_name(check_pair_class class_of_pair);

/* Pair number k of a sequence, wi then wo, 6 floats; pair holds the one before on entry. */
check_pair_class check_pair_draw(hnbrdf_rng *rng, size_t k, float pair[6]);

#endif
