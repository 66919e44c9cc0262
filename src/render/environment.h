/* environment.h: distant light from all directions, as a latitude-longitude map that can be
 * sampled.
 *
 *   World       right-handed, y up; the camera looks along -z with +x to its right.
 *   Map         top row is up (+y), bottom row down. The centre column is -z, straight ahead of the
 *               camera; +x lies a quarter of the width to the right of it, +z at the two edges:
 *               the map looks as seen from inside.
 *   Radiance    constant within a texel, and so is the density: proportional to the luminance of
 *               the texel, drawn uniformly in solid angle inside it. Both stay exact at the
 *               poles. */
#ifndef HNBRDF_RENDER_ENVIRONMENT_H
#define HNBRDF_RENDER_ENVIRONMENT_H

#include "image/image.h"

#include <stdint.h>

/* Random numbers on the map are whole: a row, and in it a texel, owns as many of these places as
 * its share of the luminance, so that what is drawn does not depend on the machine. Texels with
 * less than a place are never drawn; they hold 2^-31 of the light at most. */
#define RENDER_ENVIRONMENT_PLACES (UINT32_C(1) << 31)

/* Immutable once made; may be shared between threads. */
typedef struct render_environment {
    int width, height;
    float *rgb;        /* [height][width][3], in [0, HNBRDF_MAX_VALUE] */
    double *sums;      /* [height] inclusive sums of luminance times solid angle, row by row */
    double total;      /* luminance integrated over the sphere, = sums[height - 1] */
    uint32_t *rows;    /* [height] where the places of each row end */
    uint32_t *columns; /* [height][width] where those of each texel end, in its row */
    /* [height + 1] 1 - |cosine| of the polar angles between rows: 0, ... 1 ..., 0 */
    float *caps;
    uint16_t *row_start;    /* [height] where the search for a row begins, see find() */
    uint16_t *column_start; /* [height][width] likewise in each row */
    double rotation; /* radians about +y: the direction that the centre column shows is -z turned
                        counter-clockwise, seen from above */
    float turn;      /* the same in turns, in [0, 1] */
} render_environment;

/* Takes over image->rgb and empties the image. Values are clamped to [0, HNBRDF_MAX_VALUE]; one
 * that is not finite or a map that is black throughout is refused. `name` is used in messages. */
hnbrdf_result render_environment_create(render_image *image, double rotation, const char *name,
                                        render_environment *environment, hnbrdf_error *error);
/* "sky", the built-in one, "furnace", radiance 1 from everywhere, or a latitude-longitude map in
 * an OpenEXR or Radiance file, read with these options (NULL: the defaults). An OpenEXR file that
 * says so is a cube map, which is turned into one. */
hnbrdf_result render_environment_open(const char *source, double rotation,
                                      const render_read_options *options,
                                      render_environment *environment, hnbrdf_error *error);
void render_environment_free(render_environment *environment);
/* Multiplies all radiance by gain > 0; before the environment is shared. */
void render_environment_scale(render_environment *environment, double gain);

/* Radiance from a unit direction; returns the density with which sample() draws it, in 1/sr. */
double render_environment_lookup(const render_environment *environment, const float direction[3],
                                 float radiance[3]);
/* The density in 1/sr of directions in a texel, by its number: row by row. */
double render_environment_density(const render_environment *environment, size_t texel);
/* Draws a direction; u in [0, 1)^2. Returns its density in 1/sr, > 0. */
double render_environment_sample(const render_environment *environment, const double u[2],
                                 float direction[3], float radiance[3]);
/* `count` of either, at most RENDER_ENVIRONMENT_BLOCK, with the bits of the calls above and faster:
 * maps do not fit into caches, and many waits for memory then go on at once. */
enum { RENDER_ENVIRONMENT_BLOCK = 64 };
void render_environment_lookup_many(const render_environment *environment, int count,
                                    const float direction[][3], float radiance[][3],
                                    double density[]);
void render_environment_sample_many(const render_environment *environment, int count,
                                    const double u[][2], float direction[][3], float radiance[][3],
                                    double density[]);
/* Mean luminance over the sphere. */
double render_environment_level(const render_environment *environment);

/* The built-in sky: blue gradient over a warm ground, a sun of 3 degrees radius high at the
 * camera's left shoulder, a soft box to the right and a strip light behind. A white diffuse
 * sphere in it comes out near 1. 1024 x 512, deterministic. */
hnbrdf_result render_sky(render_image *image, hnbrdf_error *error);

#endif
