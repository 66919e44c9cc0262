/* portals.c: of an environment that is seen through windows, most can be left out of sampling. */
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* Points of the scene that look, and directions that are tried: across the map and down. */
enum { POINTS = 64, ACROSS = 128, DOWN = 64 };
/* What every direction keeps of its density: some light comes past the portals, and a density of 0
 * would leave all of it to chance. */
static const float kept = 0.05f;

/* Smallest and largest coordinates of all shapes. */
static void scene_bounds(const render_scene *scene, float low[3], float high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
    }
    for (int i = 0; i < scene->shape_count; i++) {
        const render_shape *shape = &scene->shapes[i];
        float l[3], h[3];
        for (int k = 0; k < 3; k++) {
            l[k] = shape->centre[k] - shape->radius;
            h[k] = shape->centre[k] + shape->radius;
        }
        if (shape->mesh.triangle_count)
            render_mesh_bounds(&shape->mesh, l, h);
        for (int k = 0; k < 3; k++) {
            low[k] = fminf(low[k], l[k]);
            high[k] = fmaxf(high[k], h[k]);
        }
    }
}

static int passes(const render_scene *scene, const float position[3], const float direction[3])
{
    for (int i = 0; i < scene->portal_count; i++)
        if (render_portal_density(&scene->portals[i], position, direction) > 0.0)
            return 1;
    return 0;
}

/* The share of the points from which a direction leaves through a portal. */
static void look_around(const render_scene *scene, float seen[DOWN][ACROSS])
{
    hnbrdf_rng rng;
    float low[3], high[3], points[POINTS][3];
    hnbrdf_rng_seed(&rng, 5, 0);
    scene_bounds(scene, low, high);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = low[k] + hnbrdf_rng_float(&rng) * (high[k] - low[k]);
    for (int y = 0; y < DOWN; y++)
        for (int x = 0; x < ACROSS; x++) {
            double theta = 3.14159265358979323846 * (y + 0.5) / DOWN,
                   phi = 2.0 * 3.14159265358979323846 * ((x + 0.5) / ACROSS - 0.5) -
                         scene->environment->rotation;
            const float direction[3] = {(float)(sin(theta) * sin(phi)), (float)cos(theta),
                                        (float)(-sin(theta) * cos(phi))};
            int count = 0;
            for (int i = 0; i < POINTS; i++)
                count += passes(scene, points[i], direction);
            seen[y][x] = (float)count / POINTS;
        }
}

/* The largest of the nine cells around, so that no direction is missed between those that were
 * tried. */
static float around(const float seen[DOWN][ACROSS], int x, int y)
{
    float most = 0.0f;
    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < DOWN; j++)
        for (int i = x - 1; i <= x + 1; i++)
            most = fmaxf(most, seen[j][(i + ACROSS) % ACROSS]);
    return most;
}

hnbrdf_result render_portal_guide(const render_scene *scene, render_environment *guide,
                                  hnbrdf_error *error)
{
    const render_environment *e = scene->environment;
    float seen[DOWN][ACROSS];
    render_image image;
    hnbrdf_result result = render_image_create(e->width, e->height, 0, &image, error);
    if (result != HNBRDF_OK)
        return result;
    look_around(scene, seen);
    for (int y = 0; y < e->height; y++)
        for (int x = 0; x < e->width; x++) {
            size_t at = 3 * ((size_t)y * (size_t)e->width + (size_t)x);
            float share = fmaxf(kept, around((const float(*)[ACROSS])seen, x * ACROSS / e->width,
                                             y * DOWN / e->height));
            for (size_t k = 0; k < 3; k++)
                image.rgb[at + k] = e->rgb[at + k] * share;
        }
    result = render_environment_create(&image, e->rotation, "portals", guide, error);
    render_image_free(&image);
    return result;
}
