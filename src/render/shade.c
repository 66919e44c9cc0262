/* shade.c: the radiance that a point reflects: one bounce, environment and BRDF sampling joined by
 * multiple importance sampling (Veach and Guibas 1995, balance heuristic). */
#include "render/render.h"

#include <string.h>

static float unit_float(uint32_t u)
{
    return (float)(u >> 8) * 0x1p-24f;
}

/* ---- Geometry -------------------------------------------------------------------------------- */

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void to_local(const render_point *point, const float world[3], float local[3])
{
    local[0] = dot(world, point->tangent);
    local[1] = dot(world, point->bitangent);
    local[2] = dot(world, point->normal);
}

static void to_world(const render_point *point, const float local[3], float world[3])
{
    for (int k = 0; k < 3; k++)
        world[k] = local[0] * point->tangent[k] + local[1] * point->bitangent[k] +
                   local[2] * point->normal[k];
}

/* ---- The estimator --------------------------------------------------------------------------- */

/* Samples of a block wait here for one batch of evaluations: factor is radiance wi.z weight /
 * density. Floats up to the sum, as in shaders/sphere.comp. */
typedef struct sample_batch {
    float wi[2 * RENDER_BLOCK][3], wo[2 * RENDER_BLOCK][3], f[2 * RENDER_BLOCK][3];
    float factor[2 * RENDER_BLOCK][3];
    size_t count;
} sample_batch;

/* With the balance heuristic weight / density is 1 over the sum of both densities, whichever drew
 * it. */
static void add_sample(sample_batch *batch, const float wi[3], const float wo[3],
                       const float radiance[3], float density)
{
    if (!(wi[2] > 0.0f && wo[2] > 0.0f))
        return;
    memcpy(batch->wi[batch->count], wi, sizeof batch->wi[0]);
    memcpy(batch->wo[batch->count], wo, sizeof batch->wo[0]);
    for (int k = 0; k < 3; k++)
        batch->factor[batch->count][k] = radiance[k] * wi[2] / density;
    batch->count++;
}

static void sample_light(const render_surface *surface, const render_environment *environment,
                         render_strategy strategy, const render_stream *stream, uint32_t first,
                         const render_point *points, int count, sample_batch *batch)
{
    double places[RENDER_BLOCK][2], density[RENDER_BLOCK];
    float world[RENDER_BLOCK][3], radiance[RENDER_BLOCK][3], wi[3];
    for (int i = 0; i < count; i++) {
        uint32_t u[2];
        render_stream_pair(stream, RENDER_PAIR_LIGHT, first + (uint32_t)i, u);
        places[i][0] = u[0] * 0x1p-32;
        places[i][1] = u[1] * 0x1p-32;
    }
    render_environment_sample_many(environment, count, (const double(*)[2])places, world, radiance,
                                   density);
    for (int i = 0; i < count; i++) {
        to_local(&points[i], world[i], wi);
        float sum = (float)density[i];
        if (strategy == RENDER_MIS && wi[2] > 0.0f)
            sum += surface->pdf(surface, wi, points[i].wo);
        add_sample(batch, wi, points[i].wo, radiance[i], sum);
    }
}

static void sample_brdf(const render_surface *surface, const render_environment *environment,
                        render_strategy strategy, const render_stream *stream, uint32_t first,
                        const render_point *points, int count, sample_batch *batch)
{
    double density[RENDER_BLOCK];
    float world[RENDER_BLOCK][3], radiance[RENDER_BLOCK][3], wi[RENDER_BLOCK][3],
        drawn[RENDER_BLOCK];
    for (int i = 0; i < count; i++) {
        uint32_t u[2], lobe[2], index = first + (uint32_t)i;
        render_stream_pair(stream, RENDER_PAIR_DIRECTION, index, u);
        render_stream_pair(stream, RENDER_PAIR_LOBE, index, lobe);
        float numbers[3] = {unit_float(lobe[0]), unit_float(u[0]), unit_float(u[1])};
        drawn[i] = surface->sample(surface, points[i].wo, numbers, wi[i]);
        if (!(drawn[i] > 0.0f))
            memcpy(wi[i], (const float[3]){0.0f, 0.0f, 0.0f}, sizeof wi[i]);
        to_world(&points[i], wi[i], world[i]);
    }
    render_environment_lookup_many(environment, count, (const float(*)[3])world, radiance, density);
    for (int i = 0; i < count; i++)
        add_sample(batch, wi[i], points[i].wo, radiance[i],
                   strategy == RENDER_MIS ? (float)density[i] + drawn[i] : drawn[i]);
}

void render_shade(const render_surface *surface, const render_environment *environment,
                  render_strategy strategy, const render_stream *stream, uint32_t first,
                  const render_point *points, int count, double sum[3])
{
    sample_batch batch;
    batch.count = 0;
    if (strategy != RENDER_BRDF)
        sample_light(surface, environment, strategy, stream, first, points, count, &batch);
    if (strategy != RENDER_LIGHT)
        sample_brdf(surface, environment, strategy, stream, first, points, count, &batch);
    if (batch.count > 0)
        surface->eval(surface, batch.count, batch.wi[0], batch.wo[0], batch.f[0]);
    for (size_t i = 0; i < batch.count; i++)
        for (int k = 0; k < 3; k++)
            sum[k] += (double)(batch.f[i][k] * batch.factor[i][k]);
}
