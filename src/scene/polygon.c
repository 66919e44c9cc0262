/* polygon.c: split polygons into triangles. */
#include "scene/polygon.h"

#include "scene/outline.h"

#include <math.h>

/* Twice the area of each projection (Newell's method); the largest one is used, seen from the
 * side from which the polygon turns left. A projection keeps coordinates as they are: corners that
 * coincide still do, and signs of turns are exact. */
static render_outline make_outline(const double (*p)[3], uint32_t count)
{
    double area[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 1; i + 1 < count; i++)
        for (int k = 0; k < 3; k++) {
            int u = (k + 1) % 3, v = (k + 2) % 3;
            area[k] += (p[i][u] - p[0][u]) * (p[i + 1][v] - p[0][v]) -
                       (p[i][v] - p[0][v]) * (p[i + 1][u] - p[0][u]);
        }
    int axis = 0;
    for (int k = 1; k < 3; k++)
        axis = fabs(area[k]) > fabs(area[axis]) ? k : axis;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    return area[axis] < 0.0 ? (render_outline){p, v, u, count} : (render_outline){p, u, v, count};
}

/* Whether a fan from corner 0 covers it: every turn is to the left or straight on, and so is every
 * one seen from there. */
static int is_convex(const render_outline *o)
{
    const uint32_t count = o->count;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t b = (i + 1) % count, c = (i + 2) % count;
        const int turn = render_outline_turn(o, i, b, c);
        if (turn < 0 || (turn == 0 && render_outline_returns(o, i, b, c)))
            return 0;
    }
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
