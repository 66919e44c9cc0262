/* pixels.h: a small picture of a sphere under an even light of radiance 1 and one of three suns of
 * 3 degrees, in which a fitted material is judged: its pixels, and directions to the lights. */
#ifndef HNBRDF_FIT_PIXELS_H
#define HNBRDF_FIT_PIXELS_H

#include "hnbrdf/measured.h"

enum {
    FIT_SUNS = 3,
    FIT_PIXELS_SIDE = 24,  /* pixels across */
    FIT_PIXELS_SHARP = 96, /* where a highlight is as sharp as the sun itself */
};
#define FIT_SHARP 0.05f /* alpha below: most of a highlight is within 3 degrees */

/* One point of the sphere: its frame, x, y and the normal, and its view. */
typedef struct fit_pixel {
    double frame[3][3];
    float wo[3];
} fit_pixel;

/* Pixel k of side x side; 0 if it is beside the sphere. */
int hnbrdf_fit_pixel_at(int k, int side, fit_pixel *pixel);
/* Whether the half vector is within the sun's radius and the lobe's of the normal. */
int hnbrdf_fit_pixel_is_near(const fit_pixel *pixel, int sun, double alpha);
/* Point k of so many of a sun's disc, a spiral of equal areas: wi in the pixel's frame, perhaps
 * below its horizon, and the weight of f there. */
double hnbrdf_fit_pixel_sun(const fit_pixel *pixel, int sun, int k, int points, float wi[3]);
/* The same of the even light, drawn by the lobes of `ggx`; a weight of 0 where there is none. */
double hnbrdf_fit_pixel_even(const fit_pixel *pixel, const hnbrdf_prepared *ggx, int k, int points,
                             hnbrdf_rng *rng, float wi[3]);

#endif
