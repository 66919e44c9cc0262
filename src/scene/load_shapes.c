/* load_shapes.c: the shapes of a described scene: files, formulas, spheres, each in its place. */
#include "scene/loader.h"

#include "scene/obj.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static hnbrdf_result too_far(const loader *l, double reach)
{
    return hnbrdf_fail(l->error, HNBRDF_ERROR_ARGUMENT,
                       "a shape that reaches to %s: expected coordinates up to 1e9",
                       HNBRDF_NUMBER(reach));
}

static hnbrdf_result place_sphere(const loader *l, const render_text_shape *t, render_shape *shape)
{
    double lengths[3], across = 0.0, reach = 0.0;
    for (int j = 0; j < 3; j++) {
        double sum = 0.0;
        for (int i = 0; i < 3; i++) {
            sum += t->place.m[i][j] * t->place.m[i][j];
            across += t->place.m[i][j] * t->place.m[i][(j + 1) % 3];
        }
        lengths[j] = sqrt(sum);
        reach = fmax(reach, fabs(t->place.m[j][3]) + lengths[j]);
    }
    if (!(reach <= RENDER_FAR))
        return too_far(l, reach);
    if (fabs(lengths[0] - lengths[1]) > 1e-6 * lengths[0] ||
        fabs(lengths[0] - lengths[2]) > 1e-6 * lengths[0] ||
        fabs(across) > 1e-5 * lengths[0] * lengths[0])
        return hnbrdf_fail(l->error, HNBRDF_ERROR_ARGUMENT,
                           "a stretched sphere: use superellipsoid, which is a mesh");
    shape->radius = (float)lengths[0];
    for (int j = 0; j < 3; j++) {
        shape->centre[j] = (float)t->place.m[j][3];
        for (int i = 0; i < 3; i++)
            shape->axes[j][i] = (float)(t->place.m[i][j] / lengths[j]);
    }
    return HNBRDF_OK;
}

/* *place takes the mesh to where the scene has it. */
static hnbrdf_result read_mesh(const loader *l, const render_text_shape *t, render_mesh *mesh,
                               render_transform *place)
{
    char path[2 * RENDER_MAX_PATH];
    const render_obj_options options = {.smooth = t->smooth, .notes = l->reading.notes};
    render_transform units;
    render_description_path(l->d, t->file, path);
    hnbrdf_result result = render_obj_read(path, &options, mesh, &units, l->error);
    if (result == HNBRDF_OK && memcmp(&units, &render_identity, sizeof units) != 0)
        *place = render_transform_then(&units, place);
    return result;
}

/* Materials of the parts. A name that no part has is a slip. */
static hnbrdf_result bind_parts(const loader *l, const render_text_shape *t, render_shape *shape)
{
    size_t parts = shape->mesh.part_count ? shape->mesh.part_count : 1;
    shape->surfaces = malloc(parts * sizeof *shape->surfaces);
    if (!shape->surfaces)
        return hnbrdf_fail(l->error, HNBRDF_ERROR_MEMORY, "no memory for %zu parts", parts);
    for (size_t p = 0; p < parts; p++)
        shape->surfaces[p] = t->material;
    for (int u = 0; u < t->use_count; u++) {
        size_t p = 0;
        while (p < shape->mesh.part_count &&
               strcmp(shape->mesh.parts[p].name, t->uses[u].part) != 0)
            p++;
        if (p == shape->mesh.part_count)
            return hnbrdf_fail(l->error, HNBRDF_ERROR_ARGUMENT,
                               "%s has no part '%s': parts are named by usemtl, or g and o",
                               t->file, t->uses[u].part);
        shape->surfaces[p] = t->uses[u].material;
    }
    return HNBRDF_OK;
}

static hnbrdf_result make_mesh(const loader *l, const render_text_shape *t, render_mesh *mesh)
{
    render_transform place = t->place;
    hnbrdf_result result = HNBRDF_OK;
    if (t->kind == RENDER_OBJ)
        result = read_mesh(l, t, mesh, &place);
    else if (render_shape_mesh(t->kind, &t->options, mesh))
        result = hnbrdf_fail(l->error, HNBRDF_ERROR_MEMORY, "no memory for this shape");
    if (result == HNBRDF_OK && mesh->triangle_count == 0)
        result = hnbrdf_fail(l->error, HNBRDF_ERROR_ARGUMENT, "a shape without a surface");
    if (result != HNBRDF_OK)
        return result;
    const double reach = render_mesh_reach(mesh, &place);
    if (!(reach <= RENDER_FAR))
        return too_far(l, reach);
    render_mesh_transform(mesh, &place);
    return HNBRDF_OK;
}

/* Of a shape in its place. */
static void measure_shape(const render_shape *shape, double *size, double *reach)
{
    float low[3], high[3];
    *size = *reach = 0.0;
    if (shape->mesh.triangle_count)
        render_mesh_bounds(&shape->mesh, low, high);
    for (int k = 0; k < 3; k++) {
        if (shape->mesh.triangle_count == 0) {
            low[k] = shape->centre[k] - shape->radius;
            high[k] = shape->centre[k] + shape->radius;
        }
        *size = fmax(*size, (double)high[k] - (double)low[k]);
        *reach = fmax(*reach, fmax(fabs((double)low[k]), fabs((double)high[k])));
    }
}

/* Rays start a little off a surface: too far for a shape that is small for its place. */
static void tell_small(const loader *l, const render_text_shape *t, const render_shape *shape)
{
    double size, reach;
    measure_shape(shape, &size, &reach);
    if ((double)render_ray_step((float)reach) <= size / 32.0)
        return;
    hnbrdf_note(&l->reading.notes,
                "%s:%ld: a shape of size %s, up to %s from the origin, is too small there for "
                "single precision and is not lit right: scale the scene, or move it",
                l->d->name, t->line, HNBRDF_NUMBER(size), HNBRDF_NUMBER(reach));
}

static hnbrdf_result load_shape(const loader *l, const render_text_shape *t, render_shape *shape)
{
    hnbrdf_result result =
        t->kind == RENDER_SPHERE ? place_sphere(l, t, shape) : make_mesh(l, t, &shape->mesh);
    memcpy(shape->emission, t->emission, sizeof shape->emission);
    if (result != HNBRDF_OK)
        return result;
    tell_small(l, t, shape);
    return bind_parts(l, t, shape);
}

hnbrdf_result loader_shapes(const loader *l)
{
    render_scene *scene = &l->out->scene;
    scene->shapes = calloc((size_t)l->d->shape_count, sizeof *scene->shapes);
    if (!scene->shapes)
        return hnbrdf_fail(l->error, HNBRDF_ERROR_MEMORY, "%s: no memory for its shapes",
                           l->d->name);
    scene->shape_count = l->d->shape_count;
    hnbrdf_result result = HNBRDF_OK;
    for (int i = 0; i < l->d->shape_count && result == HNBRDF_OK; i++)
        result =
            loader_at(l, l->d->shapes[i].line, load_shape(l, &l->d->shapes[i], &scene->shapes[i]));
    return result;
}
