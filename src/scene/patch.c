/* patch.c: a surface from a formula, cut into triangles with normals. */
#include "scene/shapes.h"

#include "scene/vectors.h"

#include <math.h>
#include <string.h>

/* Central differences, one-sided at the borders; 0 where the patch is not smooth. */
static double normal_at(render_patch_fn patch, const void *user, double u, double v, double n[3])
{
    static const double h = 1e-4;
    double ends[4][3], du[3], dv[3], unused[3];
    patch(user, clamp(u - h, 0.0, 1.0), v, ends[0], unused);
    patch(user, clamp(u + h, 0.0, 1.0), v, ends[1], unused);
    patch(user, u, clamp(v - h, 0.0, 1.0), ends[2], unused);
    patch(user, u, clamp(v + h, 0.0, 1.0), ends[3], unused);
    for (int k = 0; k < 3; k++) {
        du[k] = ends[1][k] - ends[0][k];
        dv[k] = ends[3][k] - ends[2][k];
    }
    double length = cross(du, dv, n);
    if (!(length > 1e-14))
        return 0.0;
    for (int k = 0; k < 3; k++)
        n[k] /= length;
    return length;
}

static uint32_t add_vertex(render_patch_fn patch, const void *user, double u, double v,
                           render_mesh *mesh)
{
    double p[3], n[3] = {0.0, 1.0, 0.0}, uv[2] = {u, v};
    if (!patch(user, u, v, p, n) && normal_at(patch, user, u, v, n) == 0.0) {
        /* At a pole: a little towards the middle. */
        double nearby = v + (v < 0.5 ? 1e-3 : -1e-3), beside = u + (u < 0.5 ? 1e-3 : -1e-3);
        if (normal_at(patch, user, u, nearby, n) == 0.0)
            normal_at(patch, user, beside, v, n);
    }
    if (render_mesh_normal(mesh, n) == RENDER_NONE || render_mesh_uv(mesh, uv) == RENDER_NONE)
        return RENDER_NONE;
    return render_mesh_position(mesh, p);
}

/* Unless two of its corners are one point, as at a pole. */
static int add_triangle(render_mesh *mesh, uint32_t base, uint32_t shift, uint32_t a, uint32_t b,
                        uint32_t c, uint32_t part)
{
    const float *p = mesh->positions[base + a], *q = mesh->positions[base + b],
                *r = mesh->positions[base + c];
    if (memcmp(p, q, 3 * sizeof *p) == 0 || memcmp(q, r, 3 * sizeof *p) == 0 ||
        memcmp(r, p, 3 * sizeof *p) == 0)
        return 0;
    render_triangle triangle = {.position = {base + a, base + b, base + c},
                                .normal = {shift + a, shift + b, shift + c},
                                .part = part};
    memcpy(triangle.uv, triangle.normal, sizeof triangle.uv);
    return render_mesh_triangle(mesh, &triangle) == RENDER_NONE ? -1 : 0;
}

int render_patch_mesh(render_patch_fn patch, const void *user, int across, int along,
                      render_mesh *mesh)
{
    uint32_t base = (uint32_t)mesh->position_count, shift = (uint32_t)mesh->normal_count;
    uint32_t part = render_mesh_part(mesh, "", 0);
    if (part == RENDER_NONE)
        return -1;
    for (int j = 0; j <= along; j++)
        for (int i = 0; i <= across; i++)
            if (add_vertex(patch, user, (double)i / across, (double)j / along, mesh) == RENDER_NONE)
                return -1;
    uint32_t row = (uint32_t)across + 1;
    for (uint32_t j = 0; j < (uint32_t)along; j++)
        for (uint32_t i = 0; i < (uint32_t)across; i++) {
            uint32_t a = j * row + i, b = a + 1, c = b + row, d = a + row;
            if (add_triangle(mesh, base, shift, a, b, c, part) ||
                add_triangle(mesh, base, shift, a, c, d, part))
                return -1;
        }
    return 0;
}
