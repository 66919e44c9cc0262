/* scene.c: prepare a scene: lights, camera, albedos, and what tells it from another one. */
#include "scene/scene.h"

#include "base/error.h"
#include "base/hash.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Lights ---------------------------------------------------------------------------------- */

static double luminance(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

static size_t primitives(const render_shape *shape)
{
    return shape->mesh.triangle_count ? shape->mesh.triangle_count : 1;
}

static float area_of(const render_shape *shape, size_t primitive)
{
    if (shape->mesh.triangle_count == 0)
        return 4.0f * 3.14159265f * shape->radius * shape->radius;
    const render_triangle *triangle = &shape->mesh.triangles[primitive];
    const float *p = shape->mesh.positions[triangle->position[0]],
                *q = shape->mesh.positions[triangle->position[1]],
                *r = shape->mesh.positions[triangle->position[2]];
    float e1[3], e2[3], n[3];
    for (int k = 0; k < 3; k++) {
        e1[k] = q[k] - p[k];
        e2[k] = r[k] - p[k];
    }
    render_cross(e1, e2, n);
    return 0.5f * sqrtf(render_dot(n, n));
}

static hnbrdf_result collect_lights(render_scene *scene, hnbrdf_error *error)
{
    size_t count = 0;
    double sum = 0.0;
    for (int i = 0; i < scene->shape_count; i++)
        count += luminance(scene->shapes[i].emission) > 0.0 ? primitives(&scene->shapes[i]) : 0;
    scene->lights = malloc((count + 1) * sizeof *scene->lights);
    scene->light_sums = malloc((count + 1) * sizeof *scene->light_sums);
    if (!scene->lights || !scene->light_sums || count >= RENDER_NONE)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for %zu lights", count);
    for (int i = 0; i < scene->shape_count; i++) {
        render_shape *shape = &scene->shapes[i];
        double power = luminance(shape->emission);
        shape->first_light = scene->light_count;
        for (size_t k = 0; k < primitives(shape) && power > 0.0; k++) {
            render_light light = {(uint32_t)i, (uint32_t)k, area_of(shape, k)};
            sum += power * (double)light.area;
            scene->light_sums[scene->light_count] = sum;
            scene->lights[scene->light_count++] = light;
        }
    }
    if (!(sum > 0.0))
        scene->light_count = 0;
    return HNBRDF_OK;
}

static hnbrdf_result prepare_portals(render_scene *scene, hnbrdf_error *error)
{
    for (int i = 0; i < scene->portal_count; i++) {
        render_portal *portal = &scene->portals[i];
        render_cross(portal->edge[0], portal->edge[1], portal->normal);
        portal->area = sqrtf(render_dot(portal->normal, portal->normal));
        if (!(portal->area > 0.0f))
            return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT, "portal %d has no area", i + 1);
        for (int k = 0; k < 3; k++)
            portal->normal[k] /= portal->area;
    }
    if (!scene->environment && !scene->light_count)
        return hnbrdf_fail(error, HNBRDF_ERROR_ARGUMENT,
                           "a scene without light: expected an environment or a shape that emits");
    return scene->environment && scene->portal_count
               ? render_portal_guide(scene, &scene->guide, error)
               : HNBRDF_OK;
}

/* ---- Camera ---------------------------------------------------------------------------------- */

static hnbrdf_result aim(render_camera *camera, hnbrdf_error *error)
{
    float back[3], right[3];
    for (int k = 0; k < 3; k++)
        back[k] = camera->from[k] - camera->to[k];
    float distance = sqrtf(render_dot(back, back));
    render_cross(camera->up, back, right);
    float length = sqrtf(render_dot(right, right));
    if (!(distance > 0.0f) ||
        !(length > 1e-6f * distance * sqrtf(render_dot(camera->up, camera->up))))
        return hnbrdf_fail(
            error, HNBRDF_ERROR_ARGUMENT,
            "the camera looks nowhere, or along its up direction: expected from and to "
            "apart, and up beside");
    for (int k = 0; k < 3; k++) {
        camera->axes[2][k] = back[k] / distance;
        camera->axes[0][k] = right[k] / length;
    }
    render_cross(camera->axes[2], camera->axes[0], camera->axes[1]);
    camera->plane = 2.0f * tanf(camera->fov * (3.14159265f / 360.0f));
    camera->focus = camera->focus > 0.0f ? camera->focus : distance;
    return HNBRDF_OK;
}

/* ---- Albedos --------------------------------------------------------------------------------- */

static void measure_albedo(render_scene_surface *s)
{
    enum { DRAWS = 256 };
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 3, 0);
    for (int step = 0; step < RENDER_ALBEDO_STEPS; step++) {
        float z = ((float)step + 0.5f) / RENDER_ALBEDO_STEPS,
              wo[3] = {sqrtf(1.0f - z * z), 0.0f, z};
        double sum[3] = {0.0, 0.0, 0.0};
        for (int i = 0; i < DRAWS; i++) {
            float u[3] = {((float)i + hnbrdf_rng_float(&rng)) / DRAWS, hnbrdf_rng_float(&rng),
                          hnbrdf_rng_float(&rng)},
                  wi[3], f[3];
            float pdf = s->surface.sample(&s->surface, wo, u, wi);
            if (!(pdf > 0.0f))
                continue;
            s->surface.eval(&s->surface, 1, wi, wo, f);
            for (int k = 0; k < 3; k++)
                sum[k] += (double)f[k] * (double)wi[2] / (double)pdf / DRAWS;
        }
        for (int k = 0; k < 3; k++)
            s->albedo[step][k] = (float)sum[k];
    }
}

/* ---- All of it ------------------------------------------------------------------------------- */

hnbrdf_result render_scene_build(render_scene *scene, hnbrdf_error *error)
{
    hnbrdf_result result = aim(&scene->camera, error);
    if (result == HNBRDF_OK)
        result = collect_lights(scene, error);
    if (result == HNBRDF_OK)
        result = prepare_portals(scene, error);
    if (result == HNBRDF_OK)
        result = render_trace_create(scene, &scene->trace, error);
    for (int i = 0; i < scene->surface_count && result == HNBRDF_OK; i++)
        measure_albedo(&scene->surfaces[i]);
    return result;
}

void render_scene_free(render_scene *scene)
{
    render_trace_free(scene->trace);
    for (int i = 0; i < scene->shape_count; i++) {
        render_mesh_free(&scene->shapes[i].mesh);
        free(scene->shapes[i].surfaces);
    }
    free(scene->shapes);
    free(scene->surfaces);
    free(scene->lights);
    free(scene->light_sums);
    render_environment_free(&scene->guide);
    memset(scene, 0, sizeof *scene);
}

/* ---- Fingerprint ----------------------------------------------------------------------------- */

/* What a surface does to some pairs of directions stands for the surface. */
static uint64_t hash_surface(uint64_t hash, const render_surface *surface)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 17, 0);
    for (int i = 0; i < 256; i++) {
        float wi[3], wo[3], values[4];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        surface->eval(surface, 1, wi, wo, values);
        values[3] = surface->pdf(surface, wi, wo);
        hash = hnbrdf_hash(hash, values, sizeof values);
    }
    return hash;
}

static uint64_t hash_shape(uint64_t hash, const render_shape *shape)
{
    const render_mesh *mesh = &shape->mesh;
    const size_t parts = mesh->part_count ? mesh->part_count : 1;
    hash = hnbrdf_hash(hash, mesh->positions, mesh->position_count * sizeof *mesh->positions);
    hash = hnbrdf_hash(hash, mesh->normals, mesh->normal_count * sizeof *mesh->normals);
    hash = hnbrdf_hash(hash, mesh->uvs, mesh->uv_count * sizeof *mesh->uvs);
    hash = hnbrdf_hash(hash, mesh->triangles, mesh->triangle_count * sizeof *mesh->triangles);
    hash = hnbrdf_hash(hash, shape->surfaces, parts * sizeof *shape->surfaces);
    hash = hnbrdf_hash(hash, shape->centre, sizeof shape->centre);
    hash = hnbrdf_hash(hash, &shape->radius, sizeof shape->radius);
    hash = hnbrdf_hash(hash, shape->axes, sizeof shape->axes);
    return hnbrdf_hash(hash, shape->emission, sizeof shape->emission);
}

uint64_t render_scene_fingerprint(const render_scene *scene)
{
    const render_camera *c = &scene->camera;
    const float camera[] = {c->from[0], c->from[1], c->from[2],      c->to[0],        c->to[1],
                            c->to[2],   c->up[0],   c->up[1],        c->up[2],        c->fov,
                            c->lens,    c->focus,   (float)c->width, (float)c->height};
    uint64_t hash = hnbrdf_hash(HNBRDF_HASH_START, camera, sizeof camera);
    for (int i = 0; i < scene->shape_count; i++)
        hash = hash_shape(hash, &scene->shapes[i]);
    for (int i = 0; i < scene->surface_count; i++)
        hash = hash_surface(hash, &scene->surfaces[i].surface);
    for (int i = 0; i < scene->portal_count; i++)
        hash = hnbrdf_hash(hash, &scene->portals[i], sizeof scene->portals[i]);
    if (scene->environment) {
        const render_environment *e = scene->environment;
        hash = hnbrdf_hash(hash, e->rgb, 3 * sizeof *e->rgb * (size_t)e->width * (size_t)e->height);
        hash = hnbrdf_hash(hash, &e->rotation, sizeof e->rotation);
    }
    return hash;
}
