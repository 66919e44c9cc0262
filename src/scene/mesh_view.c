/* mesh_view.c: a scene of one mesh, with a camera that sees all of it. */
#include "scene/mesh_view.h"

#include "base/error.h"
#include "scene/obj.h"
#include "scene/vectors.h"

#include <math.h>
#include <stdlib.h>

static const double radians = 3.14159265358979323846 / 180.0;

/* At a distance from which the sphere about the mesh's box just fits. */
static void aim(const render_mesh_view *view, const render_mesh *mesh, int size,
                render_camera *camera)
{
    float low[3], high[3];
    double radius = 0.0, fov = 30.0;
    render_mesh_bounds(mesh, low, high);
    for (int k = 0; k < 3; k++) {
        camera->to[k] = 0.5f * (low[k] + high[k]);
        radius += 0.25 * pow((double)high[k] - (double)low[k], 2.0);
    }
    double distance = 1.02 * sqrt(radius) / sin(0.5 * fov * radians);
    const double towards[3] = {cos(view->tilt * radians) * sin(view->turn * radians),
                               sin(view->tilt * radians),
                               cos(view->tilt * radians) * cos(view->turn * radians)};
    for (int k = 0; k < 3; k++)
        camera->from[k] = camera->to[k] + (float)(distance * towards[k]);
    camera->up[1] = 1.0f;
    camera->fov = (float)fov;
    camera->width = camera->height = size;
}

/* How much of the mesh's area faces the camera, from 0 to 1. */
static double share_seen(const render_mesh *mesh, const render_camera *camera)
{
    double seen = 0.0, whole = 0.0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        double e1[3], e2[3], n[3], to[3];
        for (int k = 0; k < 3; k++) {
            const uint32_t *corners = mesh->triangles[i].position;
            const double p = (double)mesh->positions[corners[0]][k];
            e1[k] = (double)mesh->positions[corners[1]][k] - p;
            e2[k] = (double)mesh->positions[corners[2]][k] - p;
            to[k] = (double)camera->from[k] - p;
        }
        const double area = cross(e1, e2, n);
        seen += fabs(n[0] * to[0] + n[1] * to[1] + n[2] * to[2]);
        whole += area * sqrt(to[0] * to[0] + to[1] * to[1] + to[2] * to[2]);
    }
    return seen / whole;
}

static hnbrdf_result build(const render_mesh_view *view, const render_surface *surface, int size,
                           render_scene *scene, hnbrdf_error *error)
{
    scene->surfaces = calloc(1, sizeof *scene->surfaces);
    scene->shapes = calloc(1, sizeof *scene->shapes);
    if (!scene->surfaces || !scene->shapes)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    scene->surfaces[0].surface = *surface;
    scene->surface_count = scene->shape_count = 1;
    render_mesh *mesh = &scene->shapes[0].mesh;
    const render_obj_options options = {.smooth = view->smooth, .notes = view->notes};
    hnbrdf_result result = render_obj_read(view->path, &options, mesh, NULL, error);
    if (result != HNBRDF_OK)
        return result;
    scene->shapes[0].surfaces = calloc(mesh->part_count, sizeof *scene->shapes[0].surfaces);
    if (!scene->shapes[0].surfaces)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "out of memory");
    aim(view, mesh, size, &scene->camera);
    if (share_seen(mesh, &scene->camera) < 1e-5) /* single precision may leave 1e-6 */
        hnbrdf_note(&view->notes, "%s: a flat mesh, seen edge-on: turn or tilt the camera",
                    view->path);
    return render_scene_build(scene, error);
}

hnbrdf_result render_mesh_view_run(const render_mesh_view *view, const render_surface *surface,
                                   const render_environment *environment, int size,
                                   const render_job *job, render_image *image,
                                   render_outcome *outcome, hnbrdf_error *error)
{
    render_scene scene = {.environment = environment};
    hnbrdf_result result = build(view, surface, size, &scene, error);
    if (result == HNBRDF_OK)
        result = render_job_run(job, &scene, image, outcome, error);
    render_scene_free(&scene);
    return result;
}
