/* lights.c: where light comes from: environment, portals and shapes that give it off, as one
 * mixture. */
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* ---- Environment ----------------------------------------------------------------------------- */

double render_portal_density(const render_portal *portal, const float position[3],
                             const float direction[3])
{
    float to[3], place[3];
    for (int k = 0; k < 3; k++)
        to[k] = portal->corner[k] - position[k];
    float cosine = render_dot(direction, portal->normal);
    float distance = render_dot(to, portal->normal) / cosine;
    if (!(distance > 0.0f) || !isfinite(distance))
        return 0.0;
    for (int k = 0; k < 3; k++)
        place[k] = distance * direction[k] - to[k];
    float aa = render_dot(portal->edge[0], portal->edge[0]),
          ab = render_dot(portal->edge[0], portal->edge[1]),
          bb = render_dot(portal->edge[1], portal->edge[1]),
          pa = render_dot(place, portal->edge[0]), pb = render_dot(place, portal->edge[1]),
          area2 = aa * bb - ab * ab;
    float s = (bb * pa - ab * pb) / area2, t = (aa * pb - ab * pa) / area2;
    if (!(s >= 0.0f && s <= 1.0f && t >= 0.0f && t <= 1.0f))
        return 0.0;
    return (double)distance * (double)distance / ((double)portal->area * fabs((double)cosine));
}

double render_light_behind(const render_scene *scene, const float position[3],
                           const float direction[3], float radiance[3])
{
    memset(radiance, 0, 3 * sizeof *radiance);
    if (!scene->environment)
        return 0.0;
    double density = render_environment_lookup(scene->environment, direction, radiance);
    if (scene->guide.rgb) {
        float unused[3];
        density = render_environment_lookup(&scene->guide, direction, unused);
    }
    double through = 0.0, area = 0.0;
    for (int i = 0; i < scene->portal_count; i++) {
        through += (double)scene->portals[i].area *
                   render_portal_density(&scene->portals[i], position, direction);
        area += (double)scene->portals[i].area;
    }
    return scene->portal_count ? density + through / area : density;
}

/* u[0] also chooses the portal, by area. */
static int draw_portal(const render_scene *scene, const float position[3], const double u[2],
                       float direction[3])
{
    double area = 0.0, at = 0.0;
    for (int i = 0; i < scene->portal_count; i++)
        area += (double)scene->portals[i].area;
    int i = 0;
    double wanted = u[0] * area;
    while (i < scene->portal_count - 1 && wanted >= at + (double)scene->portals[i].area)
        at += (double)scene->portals[i++].area;
    const render_portal *portal = &scene->portals[i];
    float s = (float)((wanted - at) / (double)portal->area), t = (float)u[1], length = 0.0f;
    for (int k = 0; k < 3; k++) {
        direction[k] =
            portal->corner[k] + s * portal->edge[0][k] + t * portal->edge[1][k] - position[k];
        length += direction[k] * direction[k];
    }
    length = sqrtf(length);
    for (int k = 0; k < 3; k++)
        direction[k] /= length;
    return length > 0.0f;
}

/* ---- Shapes ---------------------------------------------------------------------------------- */

double render_light_density(const render_scene *scene, uint32_t shape, uint32_t primitive,
                            float distance, float cosine)
{
    uint32_t light = scene->shapes[shape].first_light + primitive;
    double before = light > 0 ? scene->light_sums[light - 1] : 0.0;
    double choice = (scene->light_sums[light] - before) / scene->light_sums[scene->light_count - 1];
    return choice * (double)distance * (double)distance /
           ((double)scene->lights[light].area * (double)cosine);
}

static uint32_t choose_light(const render_scene *scene, double x)
{
    uint32_t low = 0, high = scene->light_count - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (scene->light_sums[middle] > x)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* A point of the light, uniform over its area, and the normal there. */
static void point_on(const render_scene *scene, const render_light *light, const double u[2],
                     float point[3], float normal[3])
{
    const render_shape *shape = &scene->shapes[light->shape];
    if (shape->mesh.triangle_count == 0) {
        double y = 1.0 - 2.0 * u[1], ring = sqrt(fmax(0.0, 1.0 - y * y)),
               angle = 2.0 * 3.14159265358979323846 * u[0];
        const float n[3] = {(float)(ring * sin(angle)), (float)y, (float)(ring * cos(angle))};
        for (int k = 0; k < 3; k++) {
            normal[k] = n[k];
            point[k] = shape->centre[k] + shape->radius * n[k];
        }
        return;
    }
    const render_triangle *triangle = &shape->mesh.triangles[light->primitive];
    const float *p = shape->mesh.positions[triangle->position[0]],
                *q = shape->mesh.positions[triangle->position[1]],
                *r = shape->mesh.positions[triangle->position[2]];
    double root = sqrt(u[0]), a = root * (1.0 - u[1]), b = root * u[1];
    float e1[3], e2[3];
    for (int k = 0; k < 3; k++) {
        e1[k] = q[k] - p[k];
        e2[k] = r[k] - p[k];
        point[k] = p[k] + (float)a * e1[k] + (float)b * e2[k];
    }
    render_cross(e1, e2, normal);
    float length = sqrtf(render_dot(normal, normal));
    for (int k = 0; k < 3; k++)
        normal[k] /= length;
}

static void draw_shape(const render_scene *scene, const float position[3], double choice,
                       const double u[2], render_light_sample *sample)
{
    const render_light *light =
        &scene->lights[choose_light(scene, choice * scene->light_sums[scene->light_count - 1])];
    float point[3], normal[3], length = 0.0f;
    point_on(scene, light, u, point, normal);
    for (int k = 0; k < 3; k++) {
        sample->direction[k] = point[k] - position[k];
        length += sample->direction[k] * sample->direction[k];
    }
    length = sqrtf(length);
    if (!(length > 0.0f))
        return;
    for (int k = 0; k < 3; k++)
        sample->direction[k] /= length;
    float cosine = -render_dot(sample->direction, normal);
    if (!(cosine > 0.0f))
        return;
    sample->distance = length * (1.0f - 0x1p-12f); /* short of the light itself */
    memcpy(sample->radiance, scene->shapes[light->shape].emission, sizeof sample->radiance);
    sample->density = render_light_density(scene, light->shape, light->primitive, length, cosine);
}

void render_light_draw(const render_scene *scene, int way, const float position[3], double choice,
                       const double u[2], render_light_sample *sample)
{
    float unused[3];
    memset(sample, 0, sizeof *sample);
    if (way == RENDER_BY_SHAPES) {
        if (scene->light_count)
            draw_shape(scene, position, choice, u, sample);
        return;
    }
    if (!scene->environment)
        return;
    sample->distance = INFINITY;
    if (way == RENDER_BY_MAP)
        render_environment_sample(render_light_guide(scene), u, sample->direction, unused);
    else if (!scene->portal_count || !draw_portal(scene, position, u, sample->direction))
        return;
    sample->density = render_light_behind(scene, position, sample->direction, sample->radiance);
}
