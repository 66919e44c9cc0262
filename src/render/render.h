/* render.h: a sphere of one material under an environment, one bounce of light, by Monte Carlo. */
#ifndef HNBRDF_RENDER_RENDER_H
#define HNBRDF_RENDER_RENDER_H

#include "hnbrdf/measured.h"
#include "render/environment.h"

/* ---- Surfaces: what is put on the sphere ----------------------------------------------------- */

/* Where to look for light: a mixture of GGX densities (hnbrdf_pdf() of a GGX model), each about the
 * mirror direction or, for retroreflection, about the view. Any guide gives the right picture;
 * one that follows f wi.z gives it with little noise. */
enum { RENDER_LOBES = 5 };
typedef struct render_guide {
    const hnbrdf_model *model; /* of kind GGX; borrowed */
    int count;
    struct {
        hnbrdf_material material;
        int retro;
        float share;              /* of the samples; all of them sum to 1 */
        hnbrdf_prepared prepared; /* the material's; made by render_surface_guide() */
    } lobes[RENDER_LOBES];
} render_guide;

/* Three functions with the conventions of hnbrdf.h. sample() and pdf() must agree and must cover
 * every direction in which eval() is not 0. */
typedef struct render_surface {
    /* f for count pairs; wi, wo and f are packed [count][3] and do not overlap. */
    void (*eval)(const struct render_surface *surface, size_t count, const float *wi,
                 const float *wo, float *f);
    /* Draws wi; returns its density, 0 for none. u is three numbers in [0, 1). */
    float (*sample)(const struct render_surface *surface, const float wo[3], const float u[3],
                    float wi[3]);
    float (*pdf)(const struct render_surface *surface, const float wi[3], const float wo[3]);
    /* What those below use; models and measurements are borrowed. Other surfaces leave them zero.
     * */
    const hnbrdf_model *model;
    hnbrdf_material material;
    hnbrdf_prepared prepared;
    const hnbrdf_measured *measured;
    render_guide guide;
    const struct render_table *table; /* of tabulated.h; borrowed */
} render_surface;

/* hnbrdf_eval(), and hnbrdf_sample() and hnbrdf_pdf() until it is given a guide. */
render_surface render_surface_model(const hnbrdf_model *model, const hnbrdf_material *material);
/* hnbrdf_eval_analytic(); likewise. */
render_surface render_surface_analytic(const hnbrdf_model *model, const hnbrdf_material *material);
/* hnbrdf_measured_eval(), invalid measurements count as black. Must be given a guide. */
render_surface render_surface_measured(const hnbrdf_measured *measured);

/* Lets a guide choose the directions. Surfaces with the same guide share their random directions,
 * so that what differs between their pictures is hardly noise. */
void render_surface_guide(render_surface *surface, const render_guide *guide);
/* A GGX model for guides to borrow. */
hnbrdf_result render_guide_model(hnbrdf_model **model, hnbrdf_error *error);
/* The mixture, out of lobes of many widths and shapes, that follows the eval() of all these
 * surfaces most closely: fitted by expectation maximisation to a few thousand values, always the
 * same ones. Surfaces that reflect nothing get a cosine lobe. */
render_guide render_guide_fit(const render_surface *const *surfaces, int count,
                              const hnbrdf_model *model);

/* ---- The estimator --------------------------------------------------------------------------- */

typedef enum render_strategy {
    RENDER_MIS = 0, /* environment and BRDF sampling joined by the balance heuristic (Veach 1995) */
    RENDER_LIGHT,   /* environment sampling alone */
    RENDER_BRDF     /* BRDF sampling alone */
} render_strategy;

/* Random numbers for `count` samples of one pixel: (0,2)-sequences (Sobol 1967), each with a random
 * digital shift and in a random order of its own. Every number is uniform on its own, the first 2^k
 * pairs of a sequence are stratified, and pairs of different sequences are not tied to each
 * other. */
enum {
    RENDER_PAIR_LENS,
    RENDER_PAIR_LIGHT,
    RENDER_PAIR_DIRECTION,
    RENDER_PAIR_LOBE, /* first number only */
    RENDER_PAIRS
};
typedef struct render_stream {
    uint32_t mask, order[RENDER_PAIRS], shift[RENDER_PAIRS][2];
} render_stream;
void render_stream_begin(render_stream *stream, uint64_t seed, uint64_t pixel, uint32_t count);
/* Sample `index` < count as two 32-bit fractions. */
void render_stream_pair(const render_stream *stream, int pair, uint32_t index, uint32_t u[2]);

/* The same for as many samples and dimensions as there will be: every aligned run of 2^k samples is
 * stratified. One key a pixel. */
uint64_t render_pixel_key(uint64_t seed, uint64_t pixel);
void render_endless_pair(uint64_t key, uint32_t dimension, uint32_t index, uint32_t u[2]);

/* A visible point: columns of the rotation to the world, and the local direction to the viewer. */
typedef struct render_point {
    float tangent[3], bitangent[3], normal[3];
    float wo[3];
} render_point;

/* Sum over count points of an estimate of the radiance towards wo; sample i of the stream, from
 * `first` on, belongs to points[i - first]. At most RENDER_BLOCK points. */
enum { RENDER_BLOCK = 64 };
void render_shade(const render_surface *surface, const render_environment *environment,
                  render_strategy strategy, const render_stream *stream, uint32_t first,
                  const render_point *points, int count, double sum[3]);

/* ---- The picture ----------------------------------------------------------------------------- */

/* Seen along -z by a camera at 8 radii with a long lens; the unit sphere fills 1 / RENDER_FRAME
 * of the square picture. */
#define RENDER_FRAME 1.06f
#define RENDER_DISTANCE 8.0f
/* The outline's place in the picture plane times RENDER_FRAME: RENDER_FRAME /
 * sqrt(RENDER_DISTANCE^2 - 1). */
#define RENDER_SCALE 0.13354744f
/* The ray through (x, y) in [-1, 1]^2, y up. Returns 1 and the point it hits, or 0. The tangent
 * points along increasing longitude about y. shaders/sphere.comp holds the same, to the last bit.
 */
int render_sphere_hit(float x, float y, render_point *point);

/* Zero-initialise for defaults. */
typedef struct render_options {
    int size;      /* pixels a side; 0 stands for 512 */
    int spp;       /* samples a pixel; 0 stands for 64; powers of 2 are stratified best */
    uint64_t seed; /* the picture depends on it and never on the number of threads */
    int threads;   /* 0: all cores */
    render_strategy strategy;
    /* Called from the caller's thread with the share done, 0 to 1; non-zero stops with
     * HNBRDF_ERROR_CANCELLED. May be NULL. */
    int (*progress)(void *user, double share);
    void *progress_user;
} render_options;

/* Where in [-1, 1]^2 the ray of a pixel's sample passes, y up. Settled options; the stream is the
 * pixel's. */
void render_sphere_place(const render_options *options, size_t pixel, const render_stream *stream,
                         uint32_t index, float at[2]);
/* options with its zeros settled; HNBRDF_ERROR_ARGUMENT if spp is not 1 to 2^24. */
hnbrdf_result render_options_settle(const render_options *options, render_options *settled,
                                    hnbrdf_error *error);
/* Pixels of radiance with the sphere's coverage as alpha; black and 0 beside it. */
hnbrdf_result render_sphere(const render_surface *surface, const render_environment *environment,
                            const render_options *options, render_image *image,
                            hnbrdf_error *error);

/* ---- What is behind the sphere --------------------------------------------------------------- */

/* A neutral backdrop, lit like a studio wall: brighter at the middle, `level` there. Drops alpha.
 * */
void render_over_backdrop(render_image *image, double level);
/* The environment ahead of the camera through a 60 degree lens, times `gain`. Drops alpha. */
void render_over_environment(render_image *image, const render_environment *environment,
                             double gain);

#endif
