/* pairs.h: the direction pairs a shader is verified on: usual ones and every edge there is. */
#ifndef HNBRDF_GPU_PAIRS_H
#define HNBRDF_GPU_PAIRS_H

#include "hnbrdf/measured.h"

typedef enum gpu_pair_class {
    GPU_PAIR_UNIFORM = 0, /* uniform in solid angle */
    GPU_PAIR_GRID,        /* MERL's grid: dense around the mirror direction */
    GPU_PAIR_MIRROR,      /* wo is wi reflected, exactly or a little off */
    GPU_PAIR_GRAZING,     /* one or both within 1e-6 to 0.1 of the horizon */
    GPU_PAIR_RETRO,       /* wo is wi, exactly or a little off */
    GPU_PAIR_NORMAL,      /* one or both exactly n */
    GPU_PAIR_SWAPPED,     /* the pair before, wi and wo exchanged */
    GPU_PAIR_EXTREME,     /* on, below or 1e-38 above the horizon; opposite; not of unit length */
    GPU_PAIR_NOT_FINITE,  /* a NaN or an infinity: only a finite value is asked for */
    GPU_PAIR_CLASSES
} gpu_pair_class;

const char *gpu_pair_class_name(gpu_pair_class class_of_pair);

/* Pair number k of a sequence, wi then wo, 6 floats; pair holds the one before on entry. */
gpu_pair_class gpu_pair_draw(hnbrdf_rng *rng, size_t k, float pair[6]);

#endif
