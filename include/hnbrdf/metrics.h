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

/* The same of another measurement or approximation in the place of a model, over the same pairs; it
 * has no analytic part, smape_analytic is smape. Where it has no valid value it counts as 0. */
HNBRDF_API hnbrdf_result hnbrdf_compare_measured(const hnbrdf_measured *approximation,
                                                 const hnbrdf_measured *measured,
                                                 hnbrdf_sampler sampler, size_t pairs,
                                                 uint64_t seed, hnbrdf_comparison *comparison,
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

/* ---- FLIP ---------------------------------------------------------------------------------------
 *
 * FLIP (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images") is how much
 * a person sees of a difference who lets two pictures alternate on a display, a figure from 0 to 1
 * for each pixel: 0 for none, 0.967 for black against white. This is an implementation of ours,
 * from the paper, in double precision; it is not NVIDIA's program, whose float arithmetic differs
 * in the fifth decimal.
 *
 * Colour: linear Rec. 709 as displayed, [0, 1]; opponent colours YyCxCz; the eye's sensitivity to
 * contrast as Gaussians, transforms of a sqrt(pi/b) exp(-pi^2 x^2/b), x in degrees, cut at 3
 * standard deviations of the widest: (a, b) = (1, 0.0047) achromatic, (1, 0.0053) red-green,
 * (34.1, 0.04) and (13.5, 0.025) blue-yellow; back to RGB, clamped; L*a*b* (D65), a* and b* times
 * 0.01 L* (Hunt); |dL| + |(da, db)| to the power of 0.7; 0.4 of the largest such difference, that
 * of green and blue, maps to 0.95.
 * Features: edges and points of Y, first and second derivatives of a Gaussian 0.082 degrees wide
 * (a standard deviation of half of that); the larger difference of both, over sqrt(2), to the
 * power of 0.5.
 * FLIP = colour to the power of 1 - feature. Beyond its rim a picture goes on with the values
 * there.
 *
 * pixels_per_degree: of the observer, 1 to 2000; 0 stands for 3840 pi/180 = 67.02, a display 0.7 m
 * wide of 3840 pixels seen from 0.7 m. Pictures are [height][width][3], linear and finite; map is
 * [height][width], written whole. Equal pictures give 0 everywhere, swapped ones the same (but for
 * hnbrdf_flip_hdr(), whose exposures are those of the reference). The figure of a picture is the
 * mean of its pixels. HNBRDF_ERROR_ARGUMENT, HNBRDF_ERROR_MEMORY. */

/* Of pictures as they are displayed: values below 0 count as 0, above 1 as 1. */
HNBRDF_API hnbrdf_result hnbrdf_flip(const float *image, const float *reference, int width,
                                     int height, double pixels_per_degree, float *map,
                                     hnbrdf_error *error);

/* Exposures at which pictures without a fixed white are displayed, in stops. */
typedef struct hnbrdf_flip_exposures {
    double start, stop; /* values are displayed times 2 to the power of these and those between */
    int count;          /* with equal steps from start to stop; 1 to 64 */
} hnbrdf_flip_exposures;

/* Those of HDR-FLIP (Andersson et al. 2021, "Visualizing and Communicating Errors in Rendered
 * Images"), from the luminance of the reference: from where its largest is displayed as 0.85 to
 * where its median is, as many as there are stops between, at least 2. Ours: a median 16 stops or
 * more below the largest counts as that, and a black picture has the exposures 0 and 0. */
HNBRDF_API hnbrdf_result hnbrdf_flip_exposures_of(const float *reference, size_t pixels,
                                                  hnbrdf_flip_exposures *exposures,
                                                  hnbrdf_error *error);

/* HDR-FLIP: the largest FLIP of each pixel over the exposures, displayed through the curve of ACES
 * (Narkowicz's fit, 0.6 before it). exposures: NULL for those of the whole reference. */
HNBRDF_API hnbrdf_result hnbrdf_flip_hdr(const float *image, const float *reference, int width,
                                         int height, double pixels_per_degree,
                                         const hnbrdf_flip_exposures *exposures, float *map,
                                         hnbrdf_error *error);

/* What is physical about a material of a model, by evaluating it. All channels. */
typedef struct hnbrdf_physics {
    /* Directional albedo: the share of light from everywhere that leaves towards wo, the integral
     * of f wi.z. Above 1 the material gives off more than it gets. The largest of 26 angles of
     * incidence, 0 to 89.9 degrees (8 azimuths if anisotropic), good to 0.5 %. */
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

/* The factor that keeps the albedo of a material at most 1, to 89.9 degrees and in all channels:
 * to be its `energy`; it may be that itself. Of those that do, the one that takes least light
 * away; both numbers 0 where there is no need of one, and 1 at normal incidence unless the
 * albedo is above 1 there too. What energy the material has already does not matter. Some tens
 * of milliseconds. */
HNBRDF_EXPERIMENTAL hnbrdf_result hnbrdf_energy_fit(const hnbrdf_model *model,
                                                    const hnbrdf_material *material,
                                                    hnbrdf_energy *energy, hnbrdf_error *error);

#ifdef __cplusplus
}
#endif

#endif
