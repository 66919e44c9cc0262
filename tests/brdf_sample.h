/* brdf_sample.h: .brdf files in the syntax of the published ones, made up from a seed. */
#ifndef HNBRDF_TESTS_BRDF_SAMPLE_H
#define HNBRDF_TESTS_BRDF_SAMPLE_H

#include "model_support.h"

/* One dataset's network, [out][in] as in hnbrdf_model_desc, and what its files look like. */
typedef struct brdf_sample {
    int hidden, layers, latent;
    int anisotropic; /* alpha_x and alpha_y instead of alpha */
    /* no spaces, comments and line breaks in odd places, columns written the other way */
    int dense;
    const char *exponent; /* what stands in exp(...) */
    float weights[HNBRDF_MAX_LAYERS + 1][64 * 64], biases[HNBRDF_MAX_LAYERS + 1][64];
} brdf_sample;

void make_brdf_sample(brdf_sample *s, uint64_t seed, int hidden, int layers, int latent);
/* Columns and rows of weights[layer]. */
int brdf_sample_inputs(const brdf_sample *s, int layer);
int brdf_sample_outputs(const brdf_sample *s, int layer);
/* The text of one material's file. */
bytes brdf_sample_text(const brdf_sample *s, const hnbrdf_material *material);

#endif
