/* environment.c: importance sampling of latitude-longitude maps by luminance (2-D inverse CDF). */
#include "render/environment.h"

#include "core/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static double luminance(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static hnbrdf_result check_values(render_image *image, const char *name, hnbrdf_error *error)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(image->rgb[i]))
            return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                               "%s: pixel (%zu, %zu) is not a finite number: expected radiance", name,
                               i / 3 % (size_t)image->width, i / 3 / (size_t)image->width);
        image->rgb[i] = fminf(fmaxf(image->rgb[i], 0.0f), HNBRDF_MAX_VALUE);
    }
    return HNBRDF_OK;
}

/* Cuts [0, total) into `count` equal cells and keeps for each the first of the ascending sums that is
 * greater than where it begins (Chen and Asau 1974). */
static void cut(const double *sums, int count, uint16_t *starts)
{
    double total = sums[count - 1];
    for (int cell = 0, index = 0; cell < count; cell++) {
        while (index < count - 1 && sums[index] <= total * cell / count)
            index++;
        starts[cell] = (uint16_t)index;
    }
}

static void sum_luminance(render_environment *environment)
{
    size_t width = (size_t)environment->width;
    double step = 2.0 * pi / environment->width, total = 0.0;
    for (int y = 0; y <= environment->height; y++)
        environment->borders[y] = cos(pi * y / environment->height);
    for (int y = 0; y < environment->height; y++) {
        double *sums = environment->columns + (size_t)y * width, sum = 0.0;
        for (size_t x = 0; x < width; x++)
            sums[x] = sum += luminance(environment->rgb + 3 * ((size_t)y * width + x));
        environment->sums[y] = sum;
        total += sum * step * (environment->borders[y] - environment->borders[y + 1]);
        environment->rows[y] = total;
        cut(sums, environment->width, environment->column_start + (size_t)y * width);
    }
    environment->total = total;
    cut(environment->rows, environment->height, environment->row_start);
}

hnbrdf_result render_environment_create(render_image *image, double rotation, const char *name,
                                        render_environment *environment, hnbrdf_error *error)
{
    hnbrdf_result checked = check_values(image, name, error);
    if (checked != HNBRDF_OK)
        return checked;
    render_environment result = {.width = image->width, .height = image->height, .rotation = rotation};
    size_t height = (size_t)image->height, texels = height * (size_t)image->width;
    result.rows = malloc(sizeof(double) * height);
    result.sums = malloc(sizeof(double) * height);
    result.columns = malloc(sizeof(double) * texels);
    result.borders = malloc(sizeof(double) * (height + 1));
    result.row_start = malloc(sizeof(uint16_t) * height);
    result.column_start = malloc(sizeof(uint16_t) * texels);
    if (!result.rows || !result.sums || !result.columns || !result.borders || !result.row_start ||
        !result.column_start) {
        render_environment_free(&result);
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: no memory to sample %d x %d pixels", name,
                           image->width, image->height);
    }
    result.rgb = image->rgb;
    sum_luminance(&result);
    if (!(result.total > 0.0)) {
        result.rgb = NULL;
        render_environment_free(&result);
        return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT, "%s: black throughout: expected some light",
                           name);
    }
    image->rgb = NULL;
    render_image_free(image);
    *environment = result;
    return HNBRDF_OK;
}

/* Radiance 1 from everywhere: what a surface shows is its directional albedo. */
static hnbrdf_result make_furnace(render_image *image, hnbrdf_error *error)
{
    hnbrdf_result result = render_image_create(64, 32, 0, image, error);
    for (size_t k = 0; result == HNBRDF_OK && k < (size_t)64 * 32 * 3; k++)
        image->rgb[k] = 1.0f;
    return result;
}

hnbrdf_result render_environment_open(const char *source, double rotation,
                                      render_environment *environment, hnbrdf_error *error)
{
    render_image image = {0};
    hnbrdf_result result = strcmp(source, "sky") == 0       ? render_sky(&image, error)
                           : strcmp(source, "furnace") == 0 ? make_furnace(&image, error)
                                                            : render_image_read(source, NULL, &image, error);
    if (result == HNBRDF_OK)
        result = render_environment_create(&image, rotation, source, environment, error);
    render_image_free(&image);
    return result;
}

void render_environment_free(render_environment *environment)
{
    free(environment->rgb);
    free(environment->rows);
    free(environment->sums);
    free(environment->columns);
    free(environment->borders);
    free(environment->row_start);
    free(environment->column_start);
    memset(environment, 0, sizeof *environment);
}

static int texel(double place, int count)
{
    return place > 0.0 ? (place < count ? (int)place : count - 1) : 0; /* NaN: 0 */
}

/* Number of the texel that a direction shows. */
static size_t texel_of(const render_environment *environment, const float direction[3])
{
    double y = (double)direction[1];
    double theta = acos(y > -1.0 ? (y < 1.0 ? y : 1.0) : -1.0);
    double turn =
        (atan2((double)direction[0], -(double)direction[2]) + environment->rotation) / (2.0 * pi);
    turn += 0.5;
    turn -= floor(turn);
    size_t row = (size_t)texel(theta / pi * environment->height, environment->height);
    size_t column = (size_t)texel(turn * environment->width, environment->width);
    return row * (size_t)environment->width + column;
}

/* Radiance of a texel, and the density of directions in it. */
static double look(const render_environment *environment, size_t number, float radiance[3])
{
    const float *rgb = environment->rgb + 3 * number;
    memcpy(radiance, rgb, 3 * sizeof(float));
    return luminance(rgb) / environment->total;
}

void render_environment_lookup_many(const render_environment *environment, int count,
                                    const float direction[][3], float radiance[][3], double density[])
{
    size_t texels[RENDER_ENVIRONMENT_BLOCK];
    for (int i = 0; i < count; i++) {
        texels[i] = texel_of(environment, direction[i]);
        __builtin_prefetch(environment->rgb + 3 * texels[i]);
    }
    for (int i = 0; i < count; i++)
        density[i] = look(environment, texels[i], radiance[i]);
}

double render_environment_lookup(const render_environment *environment, const float direction[3],
                                 float radiance[3])
{
    return look(environment, texel_of(environment, direction), radiance);
}

/* Where the search among count ascending sums begins. */
static int cell(double total, int count, double x)
{
    return texel(x / total * count, count);
}

/* The first of count ascending sums that is greater than x; never an entry that adds nothing. From where
 * x's cell begins it is one step on average; rounding may have put that start behind. */
static int find(const double *sums, int start, int count, double x)
{
    int index = start;
    while (index > 0 && sums[index - 1] > x)
        index--;
    while (index < count - 1 && sums[index] <= x)
        index++;
    return index;
}

/* Where x lies between the sum before index and the sum at it, in [0, 1]. */
static double share(const double *sums, int index, double x)
{
    double before = index > 0 ? sums[index - 1] : 0.0;
    double part = (x - before) / (sums[index] - before);
    return part > 0.0 ? (part < 1.0 ? part : 1.0) : 0.0;
}

/* A sample on its way: what is still to be fetched for it lies at `cell` of the table of starts, then
 * around `column` of the row's sums. */
typedef struct draw {
    double along_rows, along_row;
    size_t base, cell; /* base: number of the row's first texel */
    int row, column;
} draw;

static void draw_row(const render_environment *environment, const double u[2], draw *d)
{
    int height = environment->height, width = environment->width;
    d->along_rows = u[0] * environment->total;
    d->row = find(environment->rows, environment->row_start[cell(environment->total, height, d->along_rows)],
                  height, d->along_rows);
    d->base = (size_t)d->row * (size_t)width;
    d->along_row = u[1] * environment->sums[d->row];
    d->cell = d->base + (size_t)cell(environment->sums[d->row], width, d->along_row);
    __builtin_prefetch(environment->column_start + d->cell);
}

static void start_column(const render_environment *environment, draw *d)
{
    d->column = environment->column_start[d->cell];
    __builtin_prefetch(environment->columns + d->base + d->column);
}

static void draw_column(const render_environment *environment, draw *d)
{
    d->column = find(environment->columns + d->base, d->column, environment->width, d->along_row);
    __builtin_prefetch(environment->rgb + 3 * (d->base + (size_t)d->column));
}

static double finish(const render_environment *environment, const draw *d, float direction[3],
                     float radiance[3])
{
    double top = environment->borders[d->row], bottom = environment->borders[d->row + 1];
    double y = top + (bottom - top) * share(environment->rows, d->row, d->along_rows);
    double place = share(environment->columns + d->base, d->column, d->along_row);
    double turn = (d->column + place) / environment->width - 0.5;
    double phi = 2.0 * pi * turn - environment->rotation;
    double radius = sqrt(fmax(0.0, 1.0 - y * y));
    direction[0] = (float)(radius * sin(phi));
    direction[1] = (float)y;
    direction[2] = (float)(-radius * cos(phi));
    return look(environment, d->base + (size_t)d->column, radiance);
}

void render_environment_sample_many(const render_environment *environment, int count,
                                    const double u[][2], float direction[][3], float radiance[][3],
                                    double density[])
{
    draw draws[RENDER_ENVIRONMENT_BLOCK];
    for (int i = 0; i < count; i++)
        draw_row(environment, u[i], &draws[i]);
    for (int i = 0; i < count; i++)
        start_column(environment, &draws[i]);
    for (int i = 0; i < count; i++)
        draw_column(environment, &draws[i]);
    for (int i = 0; i < count; i++)
        density[i] = finish(environment, &draws[i], direction[i], radiance[i]);
}

double render_environment_sample(const render_environment *environment, const double u[2],
                                 float direction[3], float radiance[3])
{
    draw d;
    draw_row(environment, u, &d);
    start_column(environment, &d);
    draw_column(environment, &d);
    return finish(environment, &d, direction, radiance);
}

double render_environment_level(const render_environment *environment)
{
    return environment->total / (4.0 * pi);
}
