/* film.h: pictures of scenes that grow sample by sample, can be kept in a file and gone on with. */
#ifndef HNBRDF_SCENE_FILM_H
#define HNBRDF_SCENE_FILM_H

#include "scene/scene.h"

enum { RENDER_TILE = 16, RENDER_MAX_BOUNCES = 1024 };

/* What each pixel sums up, over its samples: radiance, coverage, and of the first surface that the
 * camera sees the directional albedo and the shading normal. */
enum {
    RENDER_RADIANCE = 0,
    RENDER_COVERAGE = 3,
    RENDER_ALBEDO = 4,
    RENDER_NORMAL = 7,
    RENDER_SUMS = 10
};

/* Tiles of RENDER_TILE pixels a side; each has a number of samples of its own. All-zero is no
 * film. */
typedef struct render_film {
    int width, height, tiles_across, tiles;
    double (*sums)[RENDER_SUMS]; /* [height][width] */
    int32_t *samples;            /* [tiles] */
} render_film;

hnbrdf_result render_film_create(int width, int height, render_film *film, hnbrdf_error *error);
void render_film_free(render_film *film);
/* Averages: radiance with coverage as alpha (transparent: what is seen beside all shapes is left
 * out by the integrator), and with `layers` albedo, normal and samples. */
hnbrdf_result render_film_develop(const render_film *film, int layers, render_image *image,
                                  hnbrdf_error *error);

/* For the machine that wrote it: numbers in its own byte order. The fingerprint must match. Written
 * aside and renamed. */
hnbrdf_result render_film_save(const render_film *film, uint64_t fingerprint, const char *path,
                               hnbrdf_error *error);
/* The film must have been created; it is untouched on failure. */
hnbrdf_result render_film_decode(const void *data, size_t size, const char *name,
                                 uint64_t fingerprint, render_film *film, hnbrdf_error *error);
hnbrdf_result render_film_load(const char *path, uint64_t fingerprint, render_film *film,
                               hnbrdf_error *error);

/* ---- Filling it ------------------------------------------------------------------------------ */

/* Zero-initialise for defaults. */
typedef struct render_path_options {
    uint64_t seed;
    /* most reflections of a path; 0 stands for 16; 1: light that is reflected once */
    int bounces;
    /* 1: the environment is not seen by the camera itself, but by its reflections */
    int transparent;
    /* no path brings more than this after its first reflection, in its brightest channel; 0: no
     * limit. Takes away bright speckles, and light */
    double clamp;
    render_strategy strategy;
} render_path_options;

/* Adds samples [first, first + count) to the pixels of one tile. Each sample has random numbers
 * of its own, so that pictures depend neither on threads nor on where a rendering was
 * interrupted. */
void render_path_tile(const render_scene *scene, const render_path_options *options,
                      render_film *film, int tile, int first, int count);

/* Zero-initialise for defaults. */
typedef struct render_scene_options {
    render_path_options path;
    int spp;           /* samples a pixel; 0 stands for 64 */
    int threads;       /* 0: all cores */
    double seconds;    /* stop when these are over, wherever it is; 0: no limit */
    const char *state; /* file to keep the film in, every minute and when stopped; NULL: none */
    int resume;        /* go on from it, if it exists */
    /* Called from the caller's thread with the share done, 0 to 1; non-zero stops. May be NULL. */
    int (*progress)(void *user, double share);
    void *progress_user;
} render_scene_options;

/* Renders until every tile has spp samples, or is stopped: *complete says which. What there is
 * lies in the film, which must have been created. */
hnbrdf_result render_scene_run(const render_scene *scene, const render_scene_options *options,
                               render_film *film, int *complete, hnbrdf_error *error);

#endif
