/* polygon.c: split polygons into triangles. */
#include "scene/mesh.h"

#include <math.h>
#include <string.h>

/* Coordinates in the plane that the polygon covers most of, counter-clockwise. */
typedef struct outline {
    const float (*p)[3];
    int x, y;
} outline;

/* Twice the area of each projection (Newell's method); the largest one is used, seen from the
 * side from which the polygon turns left. */
static outline make_outline(const float (*p)[3], uint32_t count)
{
    double area[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < count; i++) {
        const float *a = p[i], *b = p[(i + 1) % count];
        for (int k = 0; k < 3; k++) {
            int u = (k + 1) % 3, v = (k + 2) % 3;
            area[k] += (double)a[u] * (double)b[v] - (double)a[v] * (double)b[u];
        }
    }
    int axis = 0;
    for (int k = 1; k < 3; k++)
        axis = fabs(area[k]) > fabs(area[axis]) ? k : axis;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    return area[axis] < 0.0 ? (outline){p, v, u} : (outline){p, u, v};
}

/* Positive where a, b, c turn left. */
static double turn(const outline *o, uint32_t a, uint32_t b, uint32_t c)
{
    double ux = (double)o->p[b][o->x] - (double)o->p[a][o->x],
           uy = (double)o->p[b][o->y] - (double)o->p[a][o->y],
           vx = (double)o->p[c][o->x] - (double)o->p[a][o->x],
           vy = (double)o->p[c][o->y] - (double)o->p[a][o->y];
    return ux * vy - uy * vx;
}

/* Whether a fan from corner 0 covers it: every turn is to the left, and so is every one seen from
 * there. */
static int is_convex(const outline *o, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        if (turn(o, i, (i + 1) % count, (i + 2) % count) < 0.0)
            return 0;
    for (uint32_t i = 1; i + 1 < count; i++)
        if (turn(o, 0, i, i + 1) < 0.0)
            return 0;
    return 1;
}

/* Whether corner i of those left can be cut off: it turns left, and no other corner lies in it. */
static int is_ear(const outline *o, const uint32_t *left, uint32_t count, uint32_t i)
{
    uint32_t a = left[(i + count - 1) % count], b = left[i], c = left[(i + 1) % count];
    if (!(turn(o, a, b, c) > 0.0))
        return 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t p = left[k];
        if (p != a && p != b && p != c && turn(o, a, b, p) >= 0.0 && turn(o, b, c, p) >= 0.0 &&
            turn(o, c, a, p) >= 0.0)
            return 0;
    }
    return 1;
}

static void cut_ears(const outline *o, uint32_t count, uint32_t (*triangles)[3])
{
    uint32_t left[RENDER_MAX_CONCAVE];
    for (uint32_t i = 0; i < count; i++)
        left[i] = i;
    for (; count >= 3; count--) {
        uint32_t ear = 0;
        while (ear < count && !is_ear(o, left, count, ear))
            ear++;
        ear = ear < count ? ear : 0; /* it crosses itself: cut anything */
        (*triangles)[0] = left[(ear + count - 1) % count];
        (*triangles)[1] = left[ear];
        (*triangles)[2] = left[(ear + 1) % count];
        triangles++;
        memmove(left + ear, left + ear + 1, (count - ear - 1) * sizeof *left);
    }
}

int render_polygon_split(const float (*p)[3], uint32_t count, uint32_t (*triangles)[3])
{
    outline o = make_outline(p, count);
    if (is_convex(&o, count)) {
        for (uint32_t i = 0; i + 2 < count; i++) {
            triangles[i][0] = 0;
            triangles[i][1] = i + 1;
            triangles[i][2] = i + 2;
        }
        return 0;
    }
    if (count > RENDER_MAX_CONCAVE)
        return -1;
    cut_ears(&o, count, triangles);
    return 0;
}
