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

/* Cosine of the polar angle at the upper border of a row. */
static double border(const render_environment *environment, int row)
{
    return cos(pi * row / environment->height);
}

static hnbrdf_result check_values(render_image *image, const char *name, hnbrdf_error *error)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(image->rgb[i]))
            return hnbrdf_fail(error, HNBRDF_ERROR_FORMAT,
                               "%s: pixel (%zu, %zu) is not a finite number: expected radiance", name,
                               i / 3 % (size_t)image->width, i / 3 / (size_t)image->width);
        image->rgb[i] = image->rgb[i] > 0.0f ? image->rgb[i] : 0.0f;
    }
    return HNBRDF_OK;
}

static void sum_luminance(render_environment *environment)
{
    size_t width = (size_t)environment->width;
    double step = 2.0 * pi / environment->width, total = 0.0;
    for (int y = 0; y < environment->height; y++) {
        double *sums = environment->columns + (size_t)y * width, sum = 0.0;
        for (size_t x = 0; x < width; x++)
            sums[x] = sum += luminance(environment->rgb + 3 * ((size_t)y * width + x));
        total += sum * step * (border(environment, y) - border(environment, y + 1));
        environment->rows[y] = total;
    }
    environment->total = total;
}

hnbrdf_result render_environment_create(render_image *image, double rotation, const char *name,
                                        render_environment *environment, hnbrdf_error *error)
{
    hnbrdf_result checked = check_values(image, name, error);
    if (checked != HNBRDF_OK)
        return checked;
    render_environment result = {.width = image->width, .height = image->height, .rotation = rotation};
    size_t height = (size_t)image->height;
    result.rows = malloc(sizeof(double) * height);
    result.columns = malloc(sizeof(double) * height * (size_t)image->width);
    if (!result.rows || !result.columns) {
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
    free(environment->columns);
    memset(environment, 0, sizeof *environment);
}

static int texel(double place, int count)
{
    return place > 0.0 ? (place < count ? (int)place : count - 1) : 0; /* NaN: 0 */
}

double render_environment_lookup(const render_environment *environment, const float direction[3],
                                 float radiance[3])
{
    double y = (double)direction[1];
    double theta = acos(y > -1.0 ? (y < 1.0 ? y : 1.0) : -1.0);
    double turn =
        (atan2((double)direction[0], -(double)direction[2]) + environment->rotation) / (2.0 * pi);
    turn += 0.5;
    turn -= floor(turn);
    size_t row = (size_t)texel(theta / pi * environment->height, environment->height);
    size_t column = (size_t)texel(turn * environment->width, environment->width);
    const float *rgb = environment->rgb + 3 * (row * (size_t)environment->width + column);
    memcpy(radiance, rgb, 3 * sizeof(float));
    return luminance(rgb) / environment->total;
}

/* The first of count ascending sums that is greater than x; never an entry that adds nothing. */
static int find(const double *sums, int count, double x)
{
    int low = 0, high = count - 1;
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (sums[middle] > x)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* Where x lies between the sum before index and the sum at it, in [0, 1]. */
static double share(const double *sums, int index, double x)
{
    double before = index > 0 ? sums[index - 1] : 0.0;
    double part = (x - before) / (sums[index] - before);
    return part > 0.0 ? (part < 1.0 ? part : 1.0) : 0.0;
}

double render_environment_sample(const render_environment *environment, const double u[2],
                                 float direction[3], float radiance[3])
{
    size_t width = (size_t)environment->width;
    double along_rows = u[0] * environment->total;
    int row = find(environment->rows, environment->height, along_rows);
    const double *sums = environment->columns + (size_t)row * width;
    double along_row = u[1] * sums[width - 1];
    int column = find(sums, environment->width, along_row);

    double top = border(environment, row), bottom = border(environment, row + 1);
    double y = top + (bottom - top) * share(environment->rows, row, along_rows);
    double turn = (column + share(sums, column, along_row)) / environment->width - 0.5;
    double phi = 2.0 * pi * turn - environment->rotation;
    double radius = sqrt(fmax(0.0, 1.0 - y * y));
    direction[0] = (float)(radius * sin(phi));
    direction[1] = (float)y;
    direction[2] = (float)(-radius * cos(phi));
    const float *rgb = environment->rgb + 3 * ((size_t)row * width + (size_t)column);
    memcpy(radiance, rgb, 3 * sizeof(float));
    return luminance(rgb) / environment->total;
}

double render_environment_level(const render_environment *environment)
{
    return environment->total / (4.0 * pi);
}
