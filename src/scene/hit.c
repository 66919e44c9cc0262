/* hit.c: the point where a ray ends: position, normals, shading frame. */
#include "scene/scene.h"

#include <math.h>
#include <string.h>

static float normalise(float v[3])
{
    float length = sqrtf(render_dot(v, v));
    for (int k = 0; k < 3 && length > 0.0f; k++)
        v[k] /= length;
    return length;
}

/* A tangent for a normal that has none of its own (Duff et al. 2017). */
static void any_tangent(const float n[3], float t[3])
{
    float sign = copysignf(1.0f, n[2]), a = -1.0f / (sign + n[2]);
    t[0] = 1.0f + sign * n[0] * n[0] * a;
    t[1] = sign * n[0] * n[1] * a;
    t[2] = -sign * n[0];
}

/* ---- Normals that meet the viewer ------------------------------------------------------------ */

/* Bends the shading normal, on the viewer's side as `geometric` is, until wo and its mirror image
 * are above their horizons (in the manner of Keller et al. 2017). */
static void bend_normal(const float geometric[3], const float wo[3], float n[3])
{
    static const float least = 1e-3f; /* cosine that is left */
    float seen = render_dot(n, wo);
    if (seen < least) {
        for (int k = 0; k < 3; k++)
            n[k] += (least - seen) * wo[k];
        normalise(n);
        seen = render_dot(n, wo);
    }
    float mirror[3];
    for (int k = 0; k < 3; k++)
        mirror[k] = 2.0f * seen * n[k] - wo[k];
    float height = render_dot(mirror, geometric), wanted = fminf(least, render_dot(wo, geometric));
    if (height >= wanted)
        return;
    for (int k = 0; k < 3; k++)
        mirror[k] += (wanted - height) * geometric[k];
    normalise(mirror);
    for (int k = 0; k < 3; k++)
        n[k] = wo[k] + mirror[k];
    if (!(normalise(n) > 0.0f))
        memcpy(n, geometric, 3 * sizeof *n);
}

/* The frame about n with the tangent as near to t as it can be; right-handed. */
static void make_frame(const float n[3], const float t[3], const float wo[3], render_point *frame)
{
    float along = render_dot(n, t);
    for (int k = 0; k < 3; k++)
        frame->tangent[k] = t[k] - along * n[k];
    if (!(normalise(frame->tangent) > 1e-6f))
        any_tangent(n, frame->tangent);
    memcpy(frame->normal, n, sizeof frame->normal);
    render_cross(n, frame->tangent, frame->bitangent);
    frame->wo[0] = render_dot(wo, frame->tangent);
    frame->wo[1] = render_dot(wo, frame->bitangent);
    frame->wo[2] = render_dot(wo, n);
}

/* ---- Shapes ---------------------------------------------------------------------------------- */

/* Normals point outwards; *t is 0 where the shape has no tangents. */
static void sphere_at(const render_shape *shape, const float origin[3], const float direction[3],
                      float distance, render_surface_point *point, float n[3], float t[3])
{
    float local[3];
    for (int k = 0; k < 3; k++)
        n[k] = (origin[k] + distance * direction[k]) - shape->centre[k];
    if (!(normalise(n) > 0.0f))
        n[1] = 1.0f;
    for (int k = 0; k < 3; k++) {
        point->position[k] = shape->centre[k] + shape->radius * n[k];
        local[k] = render_dot(shape->axes[k], n);
    }
    memcpy(point->geometric, n, sizeof point->geometric);
    for (int k = 0; k < 3; k++) /* along longitude, as in sphere.c */
        t[k] = local[2] * shape->axes[0][k] - local[0] * shape->axes[2][k];
    if (local[0] == 0.0f && local[2] == 0.0f)
        memcpy(t, shape->axes[0], 3 * sizeof *t);
}

/* dP/du of the texture coordinates. */
static void tangent_of(const render_mesh *mesh, const render_triangle *triangle, const float e1[3],
                       const float e2[3], float t[3])
{
    const float *a = mesh->uvs[triangle->uv[0]], *b = mesh->uvs[triangle->uv[1]],
                *c = mesh->uvs[triangle->uv[2]];
    float v1 = b[1] - a[1], v2 = c[1] - a[1];
    float area = (b[0] - a[0]) * v2 - (c[0] - a[0]) * v1;
    for (int k = 0; k < 3; k++)
        t[k] = area != 0.0f ? (v2 * e1[k] - v1 * e2[k]) / area : 0.0f;
    if (!(normalise(t) > 0.0f) || !isfinite(t[0] + t[1] + t[2]))
        memset(t, 0, 3 * sizeof *t);
}

static void triangle_at(const render_mesh *mesh, const render_hit *hit, render_surface_point *point,
                        float n[3], float t[3])
{
    const render_triangle *triangle = &mesh->triangles[hit->primitive];
    const float *p[3], weight[3] = {1.0f - hit->u - hit->v, hit->u, hit->v};
    float e1[3], e2[3];
    for (int i = 0; i < 3; i++)
        p[i] = mesh->positions[triangle->position[i]];
    for (int k = 0; k < 3; k++) {
        e1[k] = p[1][k] - p[0][k];
        e2[k] = p[2][k] - p[0][k];
        point->position[k] = weight[0] * p[0][k] + weight[1] * p[1][k] + weight[2] * p[2][k];
    }
    render_cross(e1, e2, point->geometric);
    normalise(point->geometric);
    memcpy(n, point->geometric, 3 * sizeof *n);
    if (triangle->normal[0] != RENDER_NONE) {
        float smooth[3] = {0.0f, 0.0f, 0.0f};
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                smooth[k] += weight[i] * mesh->normals[triangle->normal[i]][k];
        if (normalise(smooth) > 0.0f && render_dot(smooth, n) > 0.0f)
            memcpy(n, smooth, sizeof smooth);
    }
    memset(t, 0, 3 * sizeof *t);
    if (triangle->uv[0] != RENDER_NONE)
        tangent_of(mesh, triangle, e1, e2, t);
}

void render_surface_at(const render_scene *scene, const float origin[3], const float direction[3],
                       const render_hit *hit, render_surface_point *point)
{
    const render_shape *shape = &scene->shapes[hit->shape];
    float n[3], t[3], wo[3];
    uint32_t part = 0;
    if (shape->mesh.triangle_count == 0) {
        sphere_at(shape, origin, direction, hit->distance, point, n, t);
    } else {
        triangle_at(&shape->mesh, hit, point, n, t);
        part = shape->mesh.triangles[hit->primitive].part;
    }
    for (int k = 0; k < 3; k++)
        wo[k] = -direction[k];
    point->surface = shape->surfaces[part];
    point->outside = render_dot(point->geometric, wo) >= 0.0f;
    for (int k = 0; k < 3 && !point->outside; k++) {
        point->geometric[k] = -point->geometric[k];
        n[k] = -n[k];
    }
    bend_normal(point->geometric, wo, n);
    make_frame(n, t, wo, &point->frame);
}

void render_ray_start(const render_surface_point *point, float origin[3])
{
    float largest = fmaxf(fabsf(point->position[0]), fabsf(point->position[1]));
    float off = render_ray_step(fmaxf(largest, fabsf(point->position[2])));
    for (int k = 0; k < 3; k++)
        origin[k] = point->position[k] + off * point->geometric[k];
}
