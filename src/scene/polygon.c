/* polygon.c: split polygons into triangles. */
#include "scene/polygon.h"

#include "scene/outline.h"

#include <math.h>

static int largest_of(const double v[3])
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        axis = v[k] > v[axis] ? k : axis;
    return axis;
}

/* The projection of the largest area (Newell's method), seen from the side from which the polygon
 * turns left. A projection keeps coordinates as they are: corners that coincide still do, and signs
 * of turns are exact. Where areas cancel, on a way there and back or around a figure of eight, it
 * is the one in which the polygon is not seen edge-on. */
static render_outline make_outline(const double (*p)[3], uint32_t count)
{
    double area[3] = {0.0, 0.0, 0.0}, sizes[3], spread[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 1; i + 1 < count; i++)
        for (int k = 0; k < 3; k++) {
            int u = (k + 1) % 3, v = (k + 2) % 3;
            double twice = (p[i][u] - p[0][u]) * (p[i + 1][v] - p[0][v]) -
                           (p[i][v] - p[0][v]) * (p[i + 1][u] - p[0][u]);
            area[k] += twice;
            spread[k] += fabs(twice);
        }
    for (int k = 0; k < 3; k++)
        sizes[k] = fabs(area[k]);
    int axis = largest_of(sizes), widest = largest_of(spread);
    if (sizes[axis] <= 0x1p-40 * spread[widest]) /* what rounding leaves of sums that cancel */
        axis = widest;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    return area[axis] < 0.0 ? (render_outline){p, v, u, count} : (render_outline){p, u, v, count};
}

/* Whether a fan from corner 0 covers it: every turn is to the left or straight on, and so is every
 * one seen from there. */
static int is_convex(const render_outline *o)
{
    const uint32_t count = o->count;
    for (uint32_t i = 0; i < count; i++)
        if (render_outline_turn(o, i, (i + 1) % count, (i + 2) % count) < 0)
            return 0;
    for (uint32_t i = 1; i + 1 < count; i++)
        if (render_outline_turn(o, 0, i, i + 1) < 0)
            return 0;
    return 1;
}

int render_polygon_split(const double (*p)[3], uint32_t count, uint32_t (*triangles)[3])
{
    const render_outline o = make_outline(p, count);
    if (count > 3 && !is_convex(&o))
        return render_outline_cut_ears(&o, triangles);
    for (uint32_t i = 0; i + 2 < count; i++) {
        triangles[i][0] = 0;
        triangles[i][1] = i + 1;
        triangles[i][2] = i + 2;
    }
    return 0;
}
