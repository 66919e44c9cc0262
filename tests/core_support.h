/* core_support.h: what the core tests share: random numbers, directions, materials and models
 * made up from a seed. Everything is reproducible: no test depends on time or on the machine. */
#ifndef HNBRDF_TESTS_CORE_SUPPORT_H
#define HNBRDF_TESTS_CORE_SUPPORT_H

#include "fitted_support.h"
#include "hnbrdf/hnbrdf.h"

#include <stdint.h>

/* Unit round-off of float, 2^-24: half the distance from 1 to the next float. */
#define UNIT 5.9604644775390625e-8

/* xorshift64* (Vigna 2016); any state but 0. */
typedef struct rng {
    uint64_t state;
} rng;

rng rng_make(uint64_t seed);
uint32_t rng_u32(rng *r);
float rng_float(rng *r);                        /* (u32 >> 8) * 2^-24, in [0, 1) */
float rng_range(rng *r, float low, float high); /* uniform */
float rng_log_range(rng *r, float low, float high);
/* about N(0, 1): four uniforms, bounded by 3.5 */
float rng_normal(rng *r);

/* Unit directions above the horizon, rounded to float: the polar and the spherical form. */
void direction(double cos_theta, double phi, float w[3]);
void direction_uniform(rng *r, float w[3]);
void direction_grazing(rng *r, float w[3]); /* w.z log-uniform in [1e-6, 0.1] */
/* wi that mirrors wo about a normal near n: tangents of its angle up to about 4 alpha. 0 if
 * below. */
int direction_near_mirror(rng *r, const float alpha[2], const float wo[3], float wi[3]);

/* A random valid material; alpha log-uniform over its whole range. */
hnbrdf_material random_material(rng *r, int isotropic);

/* A model with random weights whose outputs are of order 1, and one material, random too. Aborts
 * the test on failure; free it with hnbrdf_model_free(). */
/* Two lobes, one in four of all normals; legal. */
void random_lobes(rng *r, hnbrdf_lobes *lobes);
/* The same material, fitted with other kd, eta and alpha: now it is edited. */
hnbrdf_material edited_from(rng *r, hnbrdf_material material);

hnbrdf_model *random_model(rng *r, hnbrdf_kind kind, hnbrdf_encoding encoding, int hidden,
                           int layers, int latent);

/* Fails unless the bits of all count floats are equal. */
void assert_same_bits(const float *a, const float *b, int count);

#endif
