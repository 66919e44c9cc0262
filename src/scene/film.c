/* film.c: sums of samples and their averages. */
#include "scene/film.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

hnbrdf_result render_film_create(int width, int height, render_film *film, hnbrdf_error *error)
{
    if (width < 1 || height < 1 || width > RENDER_MAX_SIDE || height > RENDER_MAX_SIDE ||
        (size_t)width * (size_t)height > RENDER_MAX_PIXELS)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT,
                           "a picture of %d x %d: expected sides of 1 to %d and at most %zu pixels",
                           width, height, RENDER_MAX_SIDE, RENDER_MAX_PIXELS);
    render_film made = {.width = width, .height = height};
    made.tiles_across = (width + RENDER_TILE - 1) / RENDER_TILE;
    made.tiles = made.tiles_across * ((height + RENDER_TILE - 1) / RENDER_TILE);
    made.sums = calloc((size_t)width * (size_t)height, sizeof *made.sums);
    made.samples = calloc((size_t)made.tiles, sizeof *made.samples);
    if (!made.sums || !made.samples) {
        render_film_free(&made);
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for a picture of %d x %d", width,
                           height);
    }
    *film = made;
    return HNBRDF_OK;
}

void render_film_free(render_film *film)
{
    free(film->sums);
    free(film->samples);
    memset(film, 0, sizeof *film);
}

/* ---- Pictures -------------------------------------------------------------------------------- */

static int32_t samples_at(const render_film *film, size_t pixel)
{
    int x = (int)(pixel % (size_t)film->width), y = (int)(pixel / (size_t)film->width);
    return film->samples[y / RENDER_TILE * film->tiles_across + x / RENDER_TILE];
}

static void average(const render_film *film, int first, float *rgb)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    for (size_t i = 0; i < pixels; i++)
        for (size_t k = 0; k < 3; k++) {
            int32_t samples = samples_at(film, i);
            rgb[3 * i + k] = samples ? (float)(film->sums[i][(size_t)first + k] / samples) : 0.0f;
        }
}

static hnbrdf_result add_layer(const render_film *film, const char *name, int first,
                               render_image *image, hnbrdf_error *error)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    float *rgb = malloc(3 * sizeof *rgb * pixels);
    if (!rgb)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for a layer of %d x %d",
                           film->width, film->height);
    if (first >= 0)
        average(film, first, rgb);
    else
        for (size_t i = 0; i < 3 * pixels; i++)
            rgb[i] = (float)samples_at(film, i / 3);
    hnbrdf_result result = render_image_add_layer(image, name, rgb, error);
    if (result != HNBRDF_OK)
        free(rgb);
    return result;
}

hnbrdf_result render_film_develop(const render_film *film, int layers, render_image *image,
                                  hnbrdf_error *error)
{
    render_image made;
    hnbrdf_result result = render_image_create(film->width, film->height, 1, &made, error);
    if (result != HNBRDF_OK)
        return result;
    average(film, RENDER_RADIANCE, made.rgb);
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; i++) {
        int32_t samples = samples_at(film, i);
        made.alpha[i] = samples ? (float)(film->sums[i][RENDER_COVERAGE] / samples) : 0.0f;
    }
    if (layers)
        result = add_layer(film, "albedo", RENDER_ALBEDO, &made, error);
    if (layers && result == HNBRDF_OK)
        result = add_layer(film, "normal", RENDER_NORMAL, &made, error);
    if (layers && result == HNBRDF_OK)
        result = add_layer(film, "samples", -1, &made, error);
    if (result == HNBRDF_OK)
        *image = made;
    else
        render_image_free(&made);
    return result;
}
