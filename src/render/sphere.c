/* sphere.c: the camera, the unit sphere and its shading frame, and the pixels of the picture. */
#include "render/render.h"

#include "base/error.h"
#include "render/tiles.h"

#include <math.h>

enum { TILE = 16 };

/* Where the ray (X, Y, -1) from (0, 0, d) meets the unit sphere, written so that nothing cancels:
 *   D = sqrt(1 - (d^2 - 1) R^2), R^2 = X^2 + Y^2 = the outline's where D = 0;  t = (d - D) / (1 +
 *   R^2) n = (t X, t Y, d - t) = (t X, t Y, (d R^2 + D) / (1 + R^2)) -ray in the frame of n and
 *   longitude, times |ray|: (-d X / rho, -(1 + t D) Y / rho, D), rho = |(n.x, n.z)|
 * Longitude about y gives the tangent; rho is never 0, the poles are behind the outline. */
int render_sphere_hit(float x, float y, render_point *point)
{
    float inside = 1.0f - (RENDER_FRAME * RENDER_FRAME) * (x * x + y * y);
    if (!(inside > 0.0f))
        return 0;
    float root = sqrtf(inside), px = x * RENDER_SCALE, py = y * RENDER_SCALE;
    float r2 = px * px + py * py, length2 = 1.0f + r2, length = sqrtf(length2);
    float t = (RENDER_DISTANCE - root) / length2;
    float n[3] = {t * px, t * py, (RENDER_DISTANCE * r2 + root) / length2};
    float rho = sqrtf(n[0] * n[0] + n[2] * n[2]), tx = n[2] / rho, tz = -(n[0] / rho);
    const render_point hit = {.tangent = {tx, 0.0f, tz},
                              .bitangent = {n[1] * tz, n[2] * tx - n[0] * tz, -(n[1] * tx)},
                              .normal = {n[0], n[1], n[2]},
                              .wo = {-(RENDER_DISTANCE * px) / (rho * length),
                                     -((1.0f + t * root) * py) / (rho * length), root / length}};
    *point = hit;
    return 1;
}

/* ---- One pixel ------------------------------------------------------------------------------- */

typedef struct render_job {
    const render_surface *surface;
    const render_environment *environment;
    render_options options;
    render_image *image;
    int tiles_across;
} render_job;

/* In [0, 2): across a pixel, where the picture is 2 wide. */
static float across(uint32_t u)
{
    return (float)(u >> 8) * 0x1p-23f;
}

void render_sphere_place(const render_options *options, size_t pixel, const render_stream *stream,
                         uint32_t index, float at[2])
{
    int size = options->size, column = (int)(pixel % (size_t)size),
        row = (int)(pixel / (size_t)size);
    uint32_t u[2];
    render_stream_pair(stream, RENDER_PAIR_LENS, index, u);
    at[0] = ((float)(2 * column - size) + across(u[0])) / (float)size;
    at[1] = ((float)(size - 2 * row) - across(u[1])) / (float)size;
}

static void render_pixel(const render_job *job, int column, int row)
{
    const render_options *options = &job->options;
    size_t pixel = (size_t)row * (size_t)options->size + (size_t)column;
    render_stream stream;
    render_stream_begin(&stream, options->seed, pixel, (uint32_t)options->spp);
    render_point points[RENDER_BLOCK];
    double sum[3] = {0.0, 0.0, 0.0};
    int covered = 0;
    for (int first = 0; first < options->spp; first += RENDER_BLOCK) {
        int count = options->spp - first < RENDER_BLOCK ? options->spp - first : RENDER_BLOCK,
            hits = 0;
        for (int i = 0; i < count; i++) {
            float at[2];
            render_sphere_place(options, pixel, &stream, (uint32_t)(first + i), at);
            hits += render_sphere_hit(at[0], at[1], &points[hits]);
        }
        render_shade(job->surface, job->environment, options->strategy, &stream, (uint32_t)first,
                     points, hits, sum);
        covered += hits;
    }
    for (int k = 0; k < 3; k++)
        job->image->rgb[3 * pixel + (size_t)k] = (float)(sum[k] / options->spp);
    job->image->alpha[pixel] = (float)covered / (float)options->spp;
}

/* ---- All of them ----------------------------------------------------------------------------- */

static void render_tile(void *user, int tile)
{
    const render_job *job = user;
    int x0 = tile % job->tiles_across * TILE, y0 = tile / job->tiles_across * TILE;
    for (int y = y0; y < y0 + TILE && y < job->options.size; y++)
        for (int x = x0; x < x0 + TILE && x < job->options.size; x++)
            render_pixel(job, x, y);
}

hnbrdf_result render_options_settle(const render_options *options, render_options *settled,
                                    hnbrdf_error *error)
{
    render_options result = *options;
    if (result.size == 0)
        result.size = 512;
    if (result.spp == 0)
        result.spp = 64;
    if (result.spp < 1 || result.spp > 1 << 24)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%d samples a pixel: expected 1 to %d",
                           result.spp, 1 << 24);
    *settled = result;
    return HNBRDF_OK;
}

hnbrdf_result render_sphere(const render_surface *surface, const render_environment *environment,
                            const render_options *options, render_image *image, hnbrdf_error *error)
{
    render_image result;
    render_job job = {.surface = surface, .environment = environment, .image = &result};
    hnbrdf_result created = render_options_settle(options, &job.options, error);
    if (created == HNBRDF_OK)
        created = render_image_create(job.options.size, job.options.size, 1, &result, error);
    if (created != HNBRDF_OK)
        return created;
    job.tiles_across = (job.options.size + TILE - 1) / TILE;
    const render_tiles tiles = {.count = job.tiles_across * job.tiles_across,
                                .threads = options->threads,
                                .work = render_tile,
                                .user = &job,
                                .progress = options->progress,
                                .progress_user = options->progress_user};
    if (render_tiles_run(&tiles)) {
        render_image_free(&result);
        return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED, "rendering was stopped");
    }
    *image = result;
    return HNBRDF_OK;
}
