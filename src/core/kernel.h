/* kernel.h: the evaluation kernels, one table an instruction set, all compiled from kernel_body.h.
 * Every sum and every other operation has one order whatever the width, so all give the same
 * bits; the fused ones have that order too, but round a product together with its sum. */
#ifndef HNBRDF_CORE_KERNEL_H
#define HNBRDF_CORE_KERNEL_H

#include "core/network.h"

/* Where a batch reads and writes: strides in bytes, none of them 0. */
typedef struct hnbrdf_pairs {
    size_t count;
    const float *wi, *wo;
    float *f;
    size_t wi_stride, wo_stride, f_stride;
} hnbrdf_pairs;

/* What a batch draws, likewise. */
typedef struct hnbrdf_draws {
    size_t count;
    const float *wo, *u;
    hnbrdf_sample_result *results;
    size_t wo_stride, u_stride, result_stride;
} hnbrdf_draws;

/* The materials of a batch: `prepared` for all, or, where that is NULL, materials[index[k]] for
 * item k, or materials[k] where index is NULL too. */
typedef struct hnbrdf_materials {
    const hnbrdf_model *model;
    const hnbrdf_prepared *prepared;
    const hnbrdf_material *materials;
    const int *index;
} hnbrdf_materials;

typedef struct hnbrdf_kernel {
    hnbrdf_variant variant;
    /* prepared->first from the latent code; models with a network only. */
    void (*fold)(const hnbrdf_model *model, const float *latent, float *first);
    /* One pair, both above the horizon, of an unedited material. */
    void (*single)(const hnbrdf_prepared *prepared, const float wi[3], const float wo[3],
                   float f[3]);
    /* The network alone, of one pair that is encoded; out has room for HNBRDF_MAX_HIDDEN. */
    void (*outputs)(const hnbrdf_prepared *prepared, const float *x, float *out);
    void (*eval)(const hnbrdf_materials *of, const hnbrdf_pairs *pairs);
    /* The analytic part alone, of any kind of model. */
    void (*analytic)(const hnbrdf_prepared *prepared, const hnbrdf_pairs *pairs);
    /* f of the pairs is one float each: the density. */
    void (*pdf)(const hnbrdf_materials *of, const hnbrdf_pairs *pairs);
    void (*sample)(const hnbrdf_materials *of, const hnbrdf_draws *draws);
    void (*network)(const hnbrdf_prepared *prepared, float x[HNBRDF_ENCODING_SIZE][HNBRDF_LANES],
                    float out[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES]);
} hnbrdf_kernel;

/* Which of these exist is the build's choice, see HNBRDF_WITH_VARIANTS. */
extern const hnbrdf_kernel hnbrdf_kernel_plain, hnbrdf_kernel_sse2, hnbrdf_kernel_avx2,
    hnbrdf_kernel_avx512, hnbrdf_kernel_neon, hnbrdf_kernel_avx2_fused, hnbrdf_kernel_avx512_fused,
    hnbrdf_kernel_neon_fused;

/* As `single` of an edited material; only a hybrid has those. */
void hnbrdf_edited_eval(const hnbrdf_prepared *prepared, const float wi[3], const float wo[3],
                        float f[3]);

/* NULL where hnbrdf_variant_available() says 0; the fastest for HNBRDF_VARIANT_AUTO. */
const hnbrdf_kernel *hnbrdf_kernel_of(hnbrdf_variant variant);

#endif
