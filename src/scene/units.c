/* units.c: the vertices of a mesh in units and from a place that suit single precision. */
#include "scene/units.h"

#include "scene/vectors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct extent {
    double low[3], high[3];
} extent;

static void include(extent *e, const double p[3])
{
    for (int k = 0; k < 3; k++) {
        e->low[k] = p[k] < e->low[k] ? p[k] : e->low[k];
        e->high[k] = p[k] > e->high[k] ? p[k] : e->high[k];
    }
}

/* Half of the diagonal. */
static double radius_of(const extent *e)
{
    const double x = e->high[0] - e->low[0], y = e->high[1] - e->low[1], z = e->high[2] - e->low[2];
    return 0.5 * sqrt(x * x + y * y + z * z);
}

static double largest_of(const extent *e)
{
    double largest = 0.0;
    for (int k = 0; k < 3; k++)
        largest = fmax(largest, fmax(fabs(e->low[k]), fabs(e->high[k])));
    return largest;
}

/* Single precision does well for a mesh about the origin of a size near 1. A distance of 16 sizes
 * costs 4 of its 24 bits, and rays start 2^-18 of the largest coordinate off a surface: still
 * 2^-14 of the size. They start no less than 2^-24 off, the same share of a size of 2^-10. Lengths
 * of normals are taken from fourth powers of edges: (2 * 2^28)^4 is below 2^128. */
static render_transform suit(const extent *e)
{
    const double radius = radius_of(e);
    render_transform place = render_identity;
    double size = largest_of(e), unit = 1.0;
    if (size > 16.0 * radius) {
        for (int k = 0; k < 3; k++)
            place.m[k][3] = 0.5 * e->low[k] + 0.5 * e->high[k];
        size = radius;
    }
    if (size < 0x1p-10 || size > 0x1p28)
        unit = ldexp(1.0, ilogb(size)); /* a power of two: nothing is rounded */
    for (int k = 0; k < 3; k++)
        place.m[k][k] = unit;
    return place;
}

/* Numbers those that triangles use from 0 on, the others RENDER_NONE. */
static size_t number_used(render_mesh *mesh, size_t count, uint32_t *numbers)
{
    size_t used = 0;
    memset(numbers, 0, count * sizeof *numbers);
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            numbers[mesh->triangles[i].position[k]] = 1;
    for (size_t i = 0; i < count; i++)
        numbers[i] = numbers[i] ? (uint32_t)used++ : RENDER_NONE;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            mesh->triangles[i].position[k] = numbers[mesh->triangles[i].position[k]];
    return used;
}

int render_units_settle(const double (*p)[3], size_t count, render_mesh *mesh,
                        render_transform *place)
{
    extent e = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    uint32_t *numbers = malloc((count + 1) * sizeof *numbers);
    if (!numbers)
        return -1;
    const size_t used = number_used(mesh, count, numbers);
    float(*positions)[3] = malloc((used + 1) * sizeof *positions);
    if (!positions) {
        free(numbers);
        return -1;
    }
    for (size_t i = 0; i < count; i++)
        if (numbers[i] != RENDER_NONE)
            include(&e, p[i]);
    *place = used ? suit(&e) : render_identity;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3 && numbers[i] != RENDER_NONE; k++)
            positions[numbers[i]][k] = (float)((p[i][k] - place->m[k][3]) / place->m[k][k]);
    free(numbers);
    free(mesh->positions);
    mesh->positions = positions;
    mesh->position_count = used;
    mesh->position_room = used + 1;
    return 0;
}

int render_units_resolve(const render_mesh *mesh)
{
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *corners = mesh->triangles[i].position;
        double e[3][3], n[3], longest = 0.0, largest = 0.0;
        for (int k = 0; k < 3; k++) {
            double length = 0.0;
            for (int j = 0; j < 3; j++) {
                const double x = (double)mesh->positions[corners[k]][j];
                e[k][j] = (double)mesh->positions[corners[(k + 1) % 3]][j] - x;
                length += e[k][j] * e[k][j];
                largest = fmax(largest, fabs(x));
            }
            longest = fmax(longest, sqrt(length));
        }
        /* twice the area, over the longest side: the width */
        if (cross(e[0], e[1], n) > 0x1p-24 * largest * longest)
            return 1;
    }
    return 0;
}
