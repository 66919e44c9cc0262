/* sphere.c: the camera, the unit sphere and its shading frame, and the threads that fill the picture.
 */
#include "render/render.h"

#include "core/error.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

static const double camera_distance = 8.0;
enum { TILE = 16, MAX_THREADS = 256 };

/* Longitude about y gives the tangent; it turns once around each pole, where it is +x by definition. */
static void shading_frame(const double n[3], render_point *point)
{
    double radius = sqrt(n[0] * n[0] + n[2] * n[2]);
    double t[3] = {radius > 0.0 ? n[2] / radius : 1.0, 0.0, radius > 0.0 ? -n[0] / radius : 0.0};
    double b[3] = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2], n[0] * t[1] - n[1] * t[0]};
    for (int k = 0; k < 3; k++) {
        point->tangent[k] = (float)t[k];
        point->bitangent[k] = (float)b[k];
        point->normal[k] = (float)n[k];
    }
}

int render_sphere_hit(double x, double y, render_point *point)
{
    /* The sphere's outline lies at tan(asin(1/distance)) of the picture plane. */
    double scale = RENDER_FRAME / sqrt(camera_distance * camera_distance - 1.0);
    double d[3] = {x * scale, y * scale, -1.0};
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + 1.0);
    for (int k = 0; k < 3; k++)
        d[k] /= length;
    double half = camera_distance * d[2];
    double discriminant = half * half - (camera_distance * camera_distance - 1.0);
    if (!(discriminant > 0.0))
        return 0;
    double t = -half - sqrt(discriminant);
    double n[3] = {t * d[0], t * d[1], camera_distance + t * d[2]};
    shading_frame(n, point);
    for (int k = 0; k < 3; k++)
        point->wo[k] = 0.0f;
    for (int k = 0; k < 3; k++) {
        point->wo[0] -= point->tangent[k] * (float)d[k];
        point->wo[1] -= point->bitangent[k] * (float)d[k];
        point->wo[2] -= point->normal[k] * (float)d[k];
    }
    return 1;
}

/* ---- One pixel
 * --------------------------------------------------------------------------------------- */

typedef struct render_job {
    const render_surface *surface;
    const render_environment *environment;
    render_options options;
    render_image *image;
    int tiles_across, tiles;
    atomic_int next, done, stop;
} render_job;

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
        int count = options->spp - first < RENDER_BLOCK ? options->spp - first : RENDER_BLOCK, hits = 0;
        for (int i = 0; i < count; i++) {
            uint32_t u[2];
            render_stream_pair(&stream, RENDER_PAIR_LENS, (uint32_t)(first + i), u);
            double x = 2.0 * (column + u[0] * 0x1p-32) / options->size - 1.0;
            double y = 1.0 - 2.0 * (row + u[1] * 0x1p-32) / options->size;
            hits += render_sphere_hit(x, y, &points[hits]);
        }
        render_shade(job->surface, job->environment, options->strategy, &stream, (uint32_t)first,
                     points, hits, sum);
        covered += hits;
    }
    for (int k = 0; k < 3; k++)
        job->image->rgb[3 * pixel + (size_t)k] = (float)(sum[k] / options->spp);
    job->image->alpha[pixel] = (float)covered / (float)options->spp;
}

/* ---- All of them
 * ------------------------------------------------------------------------------------- */

static void render_tile(const render_job *job, int tile)
{
    int x0 = tile % job->tiles_across * TILE, y0 = tile / job->tiles_across * TILE;
    for (int y = y0; y < y0 + TILE && y < job->options.size; y++)
        for (int x = x0; x < x0 + TILE && x < job->options.size; x++)
            render_pixel(job, x, y);
}

static void work(render_job *job, int is_caller)
{
    for (;;) {
        int tile = atomic_fetch_add(&job->next, 1);
        if (tile >= job->tiles || atomic_load(&job->stop))
            return;
        render_tile(job, tile);
        double share = (double)(atomic_fetch_add(&job->done, 1) + 1) / job->tiles;
        if (is_caller && job->options.progress &&
            job->options.progress(job->options.progress_user, share))
            atomic_store(&job->stop, 1);
    }
}

static void *worker(void *argument)
{
    work(argument, 0);
    return NULL;
}

static void run(render_job *job, int threads)
{
    pthread_t handles[MAX_THREADS];
    int started = 0;
    while (started < threads - 1 && pthread_create(&handles[started], NULL, worker, job) == 0)
        started++;
    work(job, 1);
    for (int i = 0; i < started; i++)
        pthread_join(handles[i], NULL);
}

static int thread_count(int wanted)
{
    long count = wanted > 0 ? wanted : sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > MAX_THREADS ? MAX_THREADS : (int)count;
}

hnbrdf_result render_sphere(const render_surface *surface, const render_environment *environment,
                            const render_options *options, render_image *image, hnbrdf_error *error)
{
    render_image result;
    render_job job = {
        .surface = surface, .environment = environment, .options = *options, .image = &result};
    if (job.options.size == 0)
        job.options.size = 512;
    if (job.options.spp == 0)
        job.options.spp = 64;
    if (job.options.spp < 1 || job.options.spp > 1 << 24)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "%d samples a pixel: expected 1 to %d",
                           job.options.spp, 1 << 24);
    hnbrdf_result created = render_image_create(job.options.size, job.options.size, 1, &result, error);
    if (created != HNBRDF_OK)
        return created;
    job.tiles_across = (job.options.size + TILE - 1) / TILE;
    job.tiles = job.tiles_across * job.tiles_across;
    atomic_init(&job.next, 0);
    atomic_init(&job.done, 0);
    atomic_init(&job.stop, 0);
    run(&job, thread_count(options->threads));
    if (atomic_load(&job.stop)) {
        render_image_free(&result);
        return hnbrdf_fail(error, HNBRDF_ERROR_CANCELLED, "rendering was stopped");
    }
    *image = result;
    return HNBRDF_OK;
}
