/* shapes.c: surfaces from formulas, cut into triangles. */
#include "scene/shapes.h"

#include "scene/vectors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* ---- Formulas -------------------------------------------------------------------------------- */

static int quad(const void *user, double u, double v, double p[3], double n[3])
{
    (void)user;
    p[0] = u - 0.5;
    p[1] = 0.0;
    p[2] = 0.5 - v;
    n[0] = n[2] = 0.0;
    n[1] = 1.0;
    return 1;
}

/* Side *user of the cube: 0 to 2 the positive ones of x, y, z, then the negative ones. */
static int box_side(const void *user, double u, double v, double p[3], double n[3])
{
    int side = *(const int *)user, axis = side % 3;
    double sign = side < 3 ? 1.0 : -1.0;
    p[axis] = 0.5 * sign;
    p[(axis + 1) % 3] = sign * (u - 0.5);
    p[(axis + 2) % 3] = v - 0.5;
    n[axis] = sign;
    n[(axis + 1) % 3] = n[(axis + 2) % 3] = 0.0;
    return 1;
}

static int torus(const void *user, double u, double v, double p[3], double n[3])
{
    const render_shape_options *options = user;
    double a = 2.0 * pi * u, b = 2.0 * pi * v, ring = 1.0 + options->tube * cos(b);
    p[0] = ring * sin(a);
    p[1] = options->tube * sin(b);
    p[2] = ring * cos(a);
    n[0] = cos(b) * sin(a);
    n[1] = sin(b);
    n[2] = cos(b) * cos(a);
    return 1;
}

/* The middle of the tube, and the direction away from the torus it winds around. */
static void knot_curve(const render_shape_options *options, double t, double c[3], double away[3])
{
    double a = 2.0 * pi * options->turns[0] * t, b = 2.0 * pi * options->turns[1] * t;
    double ring = 1.0 + 0.45 * cos(b);
    c[0] = ring * sin(a);
    c[1] = 0.45 * sin(b);
    c[2] = ring * cos(a);
    away[0] = cos(b) * sin(a);
    away[1] = sin(b);
    away[2] = cos(b) * cos(a);
}

static int knot(const void *user, double u, double v, double p[3], double n[3])
{
    static const double h = 1e-5;
    const render_shape_options *options = user;
    double c[3], away[3], before[3], after[3], along[3], side[3], unused[3];
    knot_curve(options, u - h, before, unused);
    knot_curve(options, u + h, after, unused);
    knot_curve(options, u, c, away);
    for (int k = 0; k < 3; k++)
        along[k] = after[k] - before[k];
    double length = cross(away, along, side);
    for (int k = 0; k < 3; k++) {
        n[k] = cos(2.0 * pi * v) * away[k] + sin(2.0 * pi * v) * side[k] / length;
        p[k] = c[k] + options->tube * n[k];
    }
    return 1;
}

static double power(double x, double e)
{
    return copysign(pow(fabs(x), e), x);
}

/* In the middle of a face |cos| falls below rounding before it is 0; both are the face. */
static double cosine(double x)
{
    double c = cos(x);
    return fabs(c) < 1e-12 ? 0.0 : c;
}

static double sine(double x)
{
    double s = sin(x);
    return fabs(s) < 1e-12 ? 0.0 : s;
}

static int superellipsoid(const void *user, double u, double v, double p[3], double n[3])
{
    const double *e = ((const render_shape_options *)user)->powers;
    double a = pi * (2.0 * u - 1.0), b = pi * (v - 0.5);
    double ring = power(cosine(b), e[0]), slope = power(cosine(b), 2.0 - e[0]);
    p[0] = ring * power(sine(a), e[1]);
    p[1] = power(sine(b), e[0]);
    p[2] = ring * power(cosine(a), e[1]);
    n[0] = slope * power(sine(a), 2.0 - e[1]);
    n[1] = power(sine(b), 2.0 - e[0]);
    n[2] = slope * power(cosine(a), 2.0 - e[1]);
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++)
        n[k] /= length;
    return 1;
}

/* ---- Lathe ----------------------------------------------------------------------------------- */

/* Points of a profile between two corners. */
typedef struct run {
    const double (*points)[2];
    int count;
} run;

/* Beyond its ends a run goes on as it came. */
static double run_point(const run *r, int i, int k)
{
    if (i < 0)
        return 2.0 * r->points[0][k] - r->points[1][k];
    if (i >= r->count)
        return 2.0 * r->points[r->count - 1][k] - r->points[r->count - 2][k];
    return r->points[i][k];
}

/* Catmull and Rom 1974. */
static double spline(const run *r, double t, int k)
{
    double x = t * (r->count - 1);
    int i = (int)clamp(floor(x), 0.0, r->count - 2);
    x -= i;
    double a = run_point(r, i - 1, k), b = run_point(r, i, k), c = run_point(r, i + 1, k),
           d = run_point(r, i + 2, k);
    return b +
           0.5 * x * (c - a + x * (2.0 * a - 5.0 * b + 4.0 * c - d + x * (3.0 * (b - c) + d - a)));
}

static int turned(const void *user, double u, double v, double p[3], double n[3])
{
    double radius = fmax(0.0, spline(user, v, 0)), a = 2.0 * pi * u;
    (void)n;
    p[0] = radius * sin(a);
    p[1] = spline(user, v, 1);
    p[2] = radius * cos(a);
    return 0;
}

static int lathe(const render_shape_options *options, render_mesh *mesh)
{
    const double(*points)[2] = options->profile;
    int steps = options->detail / 6 + 1;
    for (int first = 0, i = 1; i <= options->profile_count; i++) {
        if (i < options->profile_count && memcmp(points[i], points[i - 1], sizeof *points) != 0)
            continue;
        run r = {points + first, i - first};
        /* A straight line needs no steps, but for what normals do near the axis. */
        if (r.count > 1 && render_patch_mesh(turned, &r, options->detail,
                                             r.count == 2 ? 4 : steps * (r.count - 1), mesh))
            return -1;
        first = i;
    }
    return 0;
}

/* ---- All of them ----------------------------------------------------------------------------- */

static render_shape_options settled(const render_shape_options *options)
{
    render_shape_options o = *options;
    o.detail = o.detail ? o.detail : 64;
    o.tube = o.tube != 0.0 ? o.tube : 0.35;
    o.turns[0] = o.turns[0] != 0.0 ? o.turns[0] : 2.0;
    o.turns[1] = o.turns[1] != 0.0 ? o.turns[1] : 3.0;
    for (int k = 0; k < 2; k++)
        o.powers[k] = o.powers[k] != 0.0 ? o.powers[k] : 1.0;
    return o;
}

int render_shape_mesh(render_shape_kind kind, const render_shape_options *options,
                      render_mesh *mesh)
{
    render_shape_options o = settled(options);
    int result = 0;
    switch (kind) {
    case RENDER_QUAD:
        return render_patch_mesh(quad, &o, 1, 1, mesh);
    case RENDER_BOX:
        for (int side = 0; side < 6 && result == 0; side++)
            result = render_patch_mesh(box_side, &side, 1, 1, mesh);
        return result;
    case RENDER_TORUS:
        return render_patch_mesh(torus, &o, 2 * o.detail, o.detail, mesh);
    case RENDER_KNOT:
        return render_patch_mesh(knot, &o, 6 * o.detail, o.detail / 2 + 3, mesh);
    case RENDER_SUPERELLIPSOID:
        return render_patch_mesh(superellipsoid, &o, 2 * o.detail, o.detail, mesh);
    case RENDER_TEAPOT:
        return render_teapot_mesh(o.detail, mesh);
    case RENDER_LATHE:
        return lathe(&o, mesh);
    case RENDER_SPHERE:
    case RENDER_OBJ:
    case RENDER_SHAPE_KINDS:
        break;
    }
    return -1;
}
