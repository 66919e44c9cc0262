/* metrics.h: how far a model is from a measurement (libhnbrdf_metrics).
 *
 * SMAPE = 2/N sum |f - F| / (|f| + |F|), 0 where both are 0, averaged over the channels: 0 is
 * perfect, 2 the worst. The sampler must be named beside every figure (measured.h). */
#ifndef HNBRDF_METRICS_H
#define HNBRDF_METRICS_H

#include "hnbrdf/measured.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How far a model is from a measurement. */
typedef struct hnbrdf_comparison {
    double smape;          /* of hnbrdf_eval() */
    double smape_analytic; /* of hnbrdf_eval_analytic() */
    double mae, mse;       /* of hnbrdf_eval(), mean over pairs and channels, 1/sr and 1/sr^2 */
    size_t pairs;          /* valid pairs used */
} hnbrdf_comparison;

/* Compare over `pairs` pairs of directions drawn by `sampler` with a fixed seed; pairs without a
 * valid measurement are drawn again (at most 1000 times `pairs` draws in all, so a material that
 * is invalid almost everywhere ends with fewer). HNBRDF_ERROR_ARGUMENT when no pair was valid. */
HNBRDF_API hnbrdf_result hnbrdf_compare(const hnbrdf_model *model, const hnbrdf_material *material,
                                        const hnbrdf_measured *measured, hnbrdf_sampler sampler,
                                        size_t pairs, uint64_t seed, hnbrdf_comparison *comparison,
                                        hnbrdf_error *error);

/* SMAPE of one value against a reference, one channel: 2 |f - F| / (|f| + |F|), 0 when both are
 * 0. */
HNBRDF_API double hnbrdf_smape(double f, double reference);

/* How far an image is from its reference. */
typedef struct hnbrdf_image_error {
    /* psnr in dB with peak = the largest reference value; infinite if equal */
    double mae, mse, psnr;
} hnbrdf_image_error;

/* What the noise of rendering does to those figures. */
typedef struct hnbrdf_image_noise {
    /* an estimate of the MSE without noise, right on average; where noise is nearly all of the
     * error it may be below 0 */
    double mse;
    double mse_error; /* standard error of that estimate */
    /* dB: standard error of PSNR, 10/ln 10 mse_error/MSE, a little more than it is */
    double psnr_error;
    /* dB by which PSNR is too low because noise counts as error; infinite where the mse above is
     * not > 0 */
    double psnr_bias;
    /* dB: standard error of 20 log10(peak), one for all images of a reference; from one pixel, so
     * good for a mean over many images only */
    double peak_error;
} hnbrdf_image_noise;

/* Over count values (pixels times channels) of two linear images of the same size. */
HNBRDF_API void hnbrdf_image_compare(const float *image, const float *reference, size_t count,
                                     hnbrdf_image_error *error);

/* Over `pixels` pixels of RGB: an image rendered twice with different seeds, against its
 * reference rendered twice with the same two. error is that of the mean of both renderings. */
HNBRDF_API void hnbrdf_image_compare_twice(const float *const image[2],
                                           const float *const reference[2], size_t pixels,
                                           hnbrdf_image_error *error, hnbrdf_image_noise *noise);

/* What is physical about a material of a model, by evaluating it. All channels. */
typedef struct hnbrdf_physics {
    /* Directional albedo: the share of light from everywhere that leaves towards wo, the integral
     * of f wi.z. Above 1 the material gives off more than it gets. The largest of 23 angles of
     * incidence, 0 to 88 degrees (8 azimuths if anisotropic), good to 0.5 %. */
    double albedo;
    double albedo_theta; /* of wo there, radians */
    int albedo_channel;  /* 0, 1 or 2 */
    /* |f(wi, wo) - f(wo, wi)| over the mean of both: over 4096 pairs uniform in solid angle,
     * averaged (a SMAPE of f against itself swapped), and the worst. 0 where the encoding is
     * reciprocal. */
    double reciprocity, reciprocity_worst;
    double black; /* share of those values that are exactly 0 */
    int valid;    /* 1: no value seen was negative or not finite */
} hnbrdf_physics;

/* Looks at one material. */
HNBRDF_API void hnbrdf_physics_of(const hnbrdf_model *model, const hnbrdf_material *material,
                                  hnbrdf_physics *physics);

/* Directional albedo towards wo, a unit vector above the horizon, per channel. */
HNBRDF_API void hnbrdf_albedo(const hnbrdf_model *model, const hnbrdf_material *material,
                              const float wo[3], double albedo[3]);

#ifdef __cplusplus
}
#endif

#endif
