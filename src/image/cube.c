/* cube.c: cube maps, as OpenEXR defines them, into maps by latitude and longitude.
 *
 * The faces +x, -x, +y, -y, +z, -z lie one below the other, each N x N pixels. Seen from the
 * middle of the cube, the centres of a face's outer pixels lie on the edges of the cube, so that
 * neighbouring faces share them. The middle column of the map shows +z, a quarter to the right of
 * it -x, and the top row +y. */
#include "image/image.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* Where a direction meets the cube: a face, and a place in its picture, in pixels from the centre
 * of the one at its top left. */
static void find_place(const double d[3], int side, int *face, double *x, double *y)
{
    const double ax = fabs(d[0]), ay = fabs(d[1]), az = fabs(d[2]), last = side - 1;
    const int axis = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
    const double size = axis == 0 ? ax : axis == 1 ? ay : az;
    const int negative = d[axis] < 0.0;
    double p[3];
    for (int k = 0; k < 3; k++)
        p[k] = (d[k] / size + 1.0) / 2.0 * last;
    *face = 2 * axis + negative;
    if (axis == 0) {
        *x = negative ? last - p[2] : p[2];
        *y = last - p[1];
    } else if (axis == 1) {
        *x = p[0];
        *y = negative ? p[2] : last - p[2];
    } else {
        *x = negative ? p[0] : last - p[0];
        *y = last - p[1];
    }
}

/* Adds what is seen in a direction: linear between the four pixels around. */
static void add_seen(const render_image *cube, const double d[3], double rgba[4])
{
    const int side = cube->width;
    int face;
    double x, y;
    find_place(d, side, &face, &x, &y);
    const int left = (int)fmin(floor(x), side > 1 ? side - 2 : 0);
    const int top = (int)fmin(floor(y), side > 1 ? side - 2 : 0);
    for (int i = 0; i < (side > 1 ? 4 : 1); i++) {
        const int u = left + (i & 1), v = top + (i >> 1);
        const double weight = (1.0 - fabs(x - u)) * (1.0 - fabs(y - v));
        const size_t pixel = (size_t)(face * side + v) * (size_t)side + (size_t)u;
        if (weight == 0.0)
            continue; /* 0 times a value that is not finite */
        for (int k = 0; k < 3; k++)
            rgba[k] += weight * (double)cube->rgb[3 * pixel + (size_t)k];
        rgba[3] += cube->alpha ? weight * (double)cube->alpha[pixel] : 0.0;
    }
}

/* Points inside a pixel of the map, each way. */
enum { POINTS = 4 };

/* A row of the map; turns: sine and cosine of the longitudes of its points. */
static void fill_row(const render_image *cube, render_image *map, int row, const double (*turns)[2])
{
    for (int x = 0; x < map->width; x++) {
        double sum[4] = {0.0, 0.0, 0.0, 0.0};
        const size_t pixel = (size_t)row * (size_t)map->width + (size_t)x;
        for (int j = 0; j < POINTS; j++) {
            const double polar = pi * (row + (j + 0.5) / POINTS) / map->height;
            const double radius = sin(polar), up = cos(polar);
            for (int i = 0; i < POINTS; i++) {
                const double *turn = turns[POINTS * x + i];
                const double d[3] = {radius * turn[0], up, radius * turn[1]};
                add_seen(cube, d, sum);
            }
        }
        for (int k = 0; k < 3; k++)
            map->rgb[3 * pixel + (size_t)k] = (float)(sum[k] / (POINTS * POINTS));
        if (map->alpha)
            map->alpha[pixel] = (float)(sum[3] / (POINTS * POINTS));
    }
}

static hnbrdf_result fill_map(const render_image *cube, render_image *map, const char *name,
                              hnbrdf_error *error)
{
    const int count = POINTS * map->width;
    double(*turns)[2] = malloc((size_t)count * sizeof *turns);
    if (!turns)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: no memory to unfold it", name);
    for (int i = 0; i < count; i++) {
        const double longitude = pi - 2.0 * pi * (i + 0.5) / count;
        turns[i][0] = sin(longitude);
        turns[i][1] = cos(longitude);
    }
    for (int y = 0; y < map->height; y++)
        fill_row(cube, map, y, (const double(*)[2])turns);
    free(turns);
    return HNBRDF_OK;
}

hnbrdf_result render_image_unfold(render_image *image, const char *name, hnbrdf_error *error)
{
    if (image->map != RENDER_MAP_CUBE)
        return HNBRDF_OK;
    const int side = image->width;
    if (image->height / 6 != side || image->height % 6 != 0)
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                           "%s: a cube map of %d x %d: expected six square faces one below the "
                           "other, %d x %d",
                           name, side, image->height, side, 6 * side);
    int width = 4 * side; /* as many pixels along the horizon as the cube has */
    while ((size_t)width * (size_t)width / 2 > RENDER_MAX_PIXELS || width > RENDER_MAX_SIDE)
        width /= 2;
    render_image map;
    hnbrdf_result result = render_image_create(width, width / 2, image->alpha != NULL, &map, error);
    if (result != HNBRDF_OK)
        return result;
    result = fill_map(image, &map, name, error);
    map.map = RENDER_MAP_LATLONG;
    render_image_free(result == HNBRDF_OK ? image : &map);
    if (result == HNBRDF_OK)
        *image = map;
    return result;
}
