/* environment.c: importance sampling of latitude-longitude maps by luminance (2-D inverse CDF). */
#include "render/environment.h"

#include "base/error.h"
#include "core/math.h"
#include "render/turn.h"

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
                               "%s: pixel (%zu, %zu) is not a finite number: expected radiance",
                               name, i / 3 % (size_t)image->width, i / 3 / (size_t)image->width);
        image->rgb[i] = fminf(fmaxf(image->rgb[i], 0.0f), HNBRDF_MAX_VALUE);
    }
    return HNBRDF_OK;
}

/* Cuts the places into `count` equal cells and keeps for each the first of the ascending ends
 * that lies behind its first place (Chen and Asau 1974). */
static void cut(const uint32_t *ends, int count, uint16_t *starts)
{
    const uint64_t cells = (uint64_t)count;
    for (uint64_t cell = 0, index = 0; cell < cells; cell++) {
        uint64_t first = (cell * RENDER_ENVIRONMENT_PLACES + cells - 1) / cells;
        while (index < cells - 1 && ends[index] <= first)
            index++;
        starts[cell] = (uint16_t)index;
    }
}

static uint32_t end_of(double sum, double total)
{
    return (uint32_t)(sum / total * RENDER_ENVIRONMENT_PLACES + 0.5);
}

/* Places for the texels of a row, by luminance, of which it returns the sum. */
static double divide_row(const float *rgb, int width, uint32_t *ends)
{
    double sum = 0.0, total = 0.0;
    for (int x = 0; x < width; x++)
        total += luminance(rgb + 3 * x);
    for (int x = 0; x < width; x++) {
        sum += luminance(rgb + 3 * x);
        ends[x] = total > 0.0 ? end_of(sum, total) : 0;
    }
    return total;
}

static void sum_luminance(render_environment *environment)
{
    const int width = environment->width, height = environment->height;
    double step = 2.0 * pi / width, total = 0.0;
    for (int y = 0; y <= height; y++) {
        double half = sin(pi * (y < height - y ? y : height - y) / (2.0 * height));
        environment->caps[y] = (float)(2.0 * half * half);
    }
    for (int y = 0; y < height; y++) {
        size_t first = (size_t)y * (size_t)width;
        double sum = divide_row(environment->rgb + 3 * first, width, environment->columns + first);
        total += sum * step * (cos(pi * y / height) - cos(pi * (y + 1) / height));
        environment->sums[y] = total;
        cut(environment->columns + first, width, environment->column_start + first);
    }
    environment->total = total;
    for (int y = 0; y < height; y++)
        environment->rows[y] = total > 0.0 ? end_of(environment->sums[y], total) : 0;
    cut(environment->rows, height, environment->row_start);
}

hnbrdf_result render_environment_create(render_image *image, double rotation, const char *name,
                                        render_environment *environment, hnbrdf_error *error)
{
    hnbrdf_result checked = check_values(image, name, error);
    if (checked != HNBRDF_OK)
        return checked;
    double turn = rotation / (2.0 * pi);
    render_environment result = {.width = image->width,
                                 .height = image->height,
                                 .rotation = rotation,
                                 .turn = (float)(turn - floor(turn))};
    size_t height = (size_t)image->height, texels = height * (size_t)image->width;
    result.sums = malloc(sizeof(double) * height);
    result.rows = malloc(sizeof(uint32_t) * height);
    result.columns = malloc(sizeof(uint32_t) * texels);
    result.caps = malloc(sizeof(float) * (height + 1));
    result.row_start = malloc(sizeof(uint16_t) * height);
    result.column_start = malloc(sizeof(uint16_t) * texels);
    if (!result.rows || !result.sums || !result.columns || !result.caps || !result.row_start ||
        !result.column_start) {
        render_environment_free(&result);
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "%s: no memory to sample %d x %d pixels",
                           name, image->width, image->height);
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

/* Shapes that other kinds of maps have: a person should know how they were taken. */
static void tell_shape(const render_image *image, const char *name, const hnbrdf_notes *notes)
{
    const int64_t w = image->width, h = image->height;
    const char *looks = w == h                             ? "an angular map or a light probe"
                        : 3 * w == 4 * h || 4 * w == 3 * h ? "a cross of cube faces"
                        : w == 6 * h || 6 * w == h         ? "a strip of cube faces"
                                                           : NULL;
    if (image->map == RENDER_MAP_UNSAID && looks)
        hnbrdf_note(notes, "%s: %d x %d, the shape of %s: taken as a map by latitude and longitude",
                    name, image->width, image->height, looks);
}

static hnbrdf_result read_map(const char *path, const render_read_options *options,
                              render_image *image, hnbrdf_error *error)
{
    hnbrdf_result result = render_image_read(path, options, image, error);
    if (result == HNBRDF_OK)
        result = render_image_check(image, path, error);
    if (result == HNBRDF_OK && options)
        tell_shape(image, path, &options->notes);
    return result == HNBRDF_OK ? render_image_unfold(image, path, error) : result;
}

hnbrdf_result render_environment_open(const char *source, double rotation,
                                      const render_read_options *options,
                                      render_environment *environment, hnbrdf_error *error)
{
    render_image image = {0};
    hnbrdf_result result = strcmp(source, "sky") == 0 ? render_sky(&image, error)
                           : strcmp(source, "furnace") == 0
                               ? make_furnace(&image, error)
                               : read_map(source, options, &image, error);
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
    free(environment->caps);
    free(environment->row_start);
    free(environment->column_start);
    memset(environment, 0, sizeof *environment);
}

void render_environment_scale(render_environment *environment, double gain)
{
    size_t values = 3 * (size_t)environment->width * (size_t)environment->height;
    for (size_t i = 0; i < values; i++)
        environment->rgb[i] =
            (float)fmin((double)environment->rgb[i] * gain, (double)HNBRDF_MAX_VALUE);
    sum_luminance(environment);
}

static int texel(float place, int count)
{
    return place > 0.0f ? (place < (float)count ? (int)place : count - 1) : 0; /* NaN: 0 */
}

/* Number of the texel that a direction shows. shaders/sphere.comp holds the same, to the last
 * bit. */
static size_t texel_of(const render_environment *environment, const float direction[3])
{
    float x = direction[0], y = direction[1], z = direction[2];
    float polar = render_turn(sqrtf(x * x + z * z), y);
    float turn = (render_turn(x, -z) + environment->turn) + 0.5f;
    turn -= floorf(turn);
    size_t row = (size_t)texel(2.0f * polar * (float)environment->height, environment->height);
    size_t column = (size_t)texel(turn * (float)environment->width, environment->width);
    return row * (size_t)environment->width + column;
}

double render_environment_density(const render_environment *environment, size_t number)
{
    return luminance(environment->rgb + 3 * number) / environment->total;
}

/* Radiance of a texel, and the density of directions in it. */
static double look(const render_environment *environment, size_t number, float radiance[3])
{
    const float *rgb = environment->rgb + 3 * number;
    memcpy(radiance, rgb, 3 * sizeof(float));
    return render_environment_density(environment, number);
}

void render_environment_lookup_many(const render_environment *environment, int count,
                                    const float direction[][3], float radiance[][3],
                                    double density[])
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

/* ---- Drawing. shaders/sphere.comp holds the same, to the last bit. --------------------------- */

/* The number of a place; u in [0, 1). */
static uint32_t place_of(double u)
{
    return (uint32_t)(u * RENDER_ENVIRONMENT_PLACES);
}

/* The cell of a place. */
static size_t cell(uint32_t place, int count)
{
    return (size_t)((uint64_t)place * (uint64_t)count / RENDER_ENVIRONMENT_PLACES);
}

/* The first of the ascending ends that lies behind a place, never one without places of its own;
 * from where the place's cell begins it is one step on average. */
static int find(const uint32_t *ends, int start, uint32_t place)
{
    while (ends[start] <= place)
        start++;
    return start;
}

/* How far a place lies between the end before index and the end at it, in [0, 1]. */
static float share(const uint32_t *ends, int index, uint32_t place)
{
    uint32_t before = index > 0 ? ends[index - 1] : 0;
    return (float)(place - before) / (float)(ends[index] - before);
}

/* The direction that a point of the map shows: texel, and how far down and along inside it.
 * Uniform in solid angle: 1 - |y|, the height of the cap above it, is linear in `down`. */
static void direction_of(const render_environment *environment, int row, int column, float down,
                         float along, float direction[3])
{
    float upper = environment->caps[row], lower = environment->caps[row + 1], cap, y, sine, cosine;
    int mirrored = environment->height - 1 - row;
    if (row == mirrored) { /* across the equator */
        y = (1.0f - upper) * (1.0f - 2.0f * down);
        cap = 1.0f - fabsf(y);
    } else {
        cap = upper + (lower - upper) * down;
        y = row < mirrored ? 1.0f - cap : cap - 1.0f;
    }
    float radius = sqrtf(cap * (2.0f - cap));
    float turn = (((float)column + along) / (float)environment->width + 0.5f) - environment->turn;
    hnbrdf_sincos_turn(turn - floorf(turn), &sine, &cosine);
    direction[0] = radius * sine;
    direction[1] = y;
    direction[2] = -(radius * cosine);
}

/* A sample on its way: what is still to be fetched for it lies at `cell` of the table of starts,
 * then around `column` of the row's ends. */
typedef struct draw {
    uint32_t down, along;
    size_t base, cell; /* base: number of the row's first texel */
    int row, column;
} draw;

static void draw_row(const render_environment *environment, const double u[2], draw *d)
{
    int height = environment->height, width = environment->width;
    d->down = place_of(u[0]);
    d->along = place_of(u[1]);
    d->row = find(environment->rows, environment->row_start[cell(d->down, height)], d->down);
    d->base = (size_t)d->row * (size_t)width;
    d->cell = d->base + cell(d->along, width);
    __builtin_prefetch(environment->column_start + d->cell);
}

static void start_column(const render_environment *environment, draw *d)
{
    d->column = environment->column_start[d->cell];
    __builtin_prefetch(environment->columns + d->base + d->column);
}

static void draw_column(const render_environment *environment, draw *d)
{
    d->column = find(environment->columns + d->base, d->column, d->along);
    __builtin_prefetch(environment->rgb + 3 * (d->base + (size_t)d->column));
}

static double finish(const render_environment *environment, const draw *d, float direction[3],
                     float radiance[3])
{
    float down = share(environment->rows, d->row, d->down);
    float along = share(environment->columns + d->base, d->column, d->along);
    direction_of(environment, d->row, d->column, down, along, direction);
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
