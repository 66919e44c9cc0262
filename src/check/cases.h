/* cases.h: where evaluating a BRDF in floats is hard: the materials and pairs that `hnbrdf
 * stability` tries. */
#ifndef HNBRDF_CHECK_CASES_H
#define HNBRDF_CHECK_CASES_H

#include "hnbrdf/measured.h"

/* Evaluations of one material, the unit of work. */
enum { STABILITY_BLOCK = 64 };
typedef struct stability_block {
    hnbrdf_material material;
    float pairs[STABILITY_BLOCK][6]; /* wi, wo */
    float u[STABILITY_BLOCK][2];     /* for sampling wo: every third one at an end of [0, 1) */
} stability_block;

/* All of hnbrdf_material is floats. */
enum { STABILITY_FIELDS = sizeof(hnbrdf_material) / sizeof(float) };

/* What is asked of a case. */
typedef enum stability_demand {
    STABILITY_ACCURATE = 0, /* the bars of judge.h */
    STABILITY_TURNED,       /* the same; kept apart in summaries: see turned_bar() in run.c */
    /* a finite value that is not negative; errors are shown, `why` says why */
    STABILITY_FINITE
} stability_demand;

typedef struct stability_case {
    const char *name;
    const char *about; /* what is swept */
    const char *why;   /* why the value may be far off; NULL for STABILITY_ACCURATE */
    stability_demand demand;
    stability_demand value_demand; /* of the whole BRDF, where its network asks for less */
    void (*change)(hnbrdf_rng *rng, int number, hnbrdf_material *material);
    void (*pair)(hnbrdf_rng *rng, int number, const hnbrdf_material *material, float wi[3],
                 float wo[3]);
    /* 0 unless the case asks for it: */
    float weight_factor;  /* on the network's weights and biases */
    float largest_weight; /* the factor that makes this the largest of them */
    int edited;           /* 1: the material keeps what it was fitted with; 0: it is what it is */
    int not_a_number;     /* 1: some arguments are NaN or infinite; there is no true value */
    /* 1: every second of the random numbers for sampling too, or outside of [0, 1) */
    int broken_u;
} stability_case;

extern const stability_case stability_cases[];
extern const int stability_case_count;

/* Block `number` of a case: the material changed as the case asks, its pairs and random numbers;
 * the same for the same arguments. */
void stability_block_make(const stability_case *what, int number, const hnbrdf_material *material,
                          stability_block *block);

#endif
