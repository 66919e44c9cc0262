/* teapot.c: the Utah teapot: Newell's cubic Bezier patches of 1975, as all books print them.
 * Body, lid and bottom are his profiles turned about the axis, where he approximates the circle
 * by four cubics. */
#include "scene/shapes.h"

#include <math.h>

/* (radius, height), each from the lower end up, so that the outside is outside. */
typedef struct profile {
    double points[4][2];
} profile;

static const profile profiles[] = {
    {{{0, 0}, {1.425, 0}, {1.5, 0.075}, {1.5, 0.15}}},                /* bottom */
    {{{1.5, 0.15}, {1.5, 0.225}, {2, 0.45}, {2, 0.9}}},               /* body */
    {{{2, 0.9}, {2, 1.35}, {1.75, 1.875}, {1.5, 2.4}}},               /* body */
    {{{1.5, 2.4}, {1.4375, 2.53125}, {1.3375, 2.53125}, {1.4, 2.4}}}, /* rim */
    {{{1.3, 2.4}, {1.3, 2.55}, {0.4, 2.55}, {0.2, 2.7}}},             /* lid */
    {{{0.2, 2.7}, {0, 2.85}, {0.8, 3.15}, {0, 3.15}}},                /* knob */
};

/* Half of handle and spout, in Newell's frame with z up; the other half has the opposite y. */
static const double halves[][16][3] = {
    {{-1.6, 0, 2.025},
     {-1.6, -0.3, 2.025},
     {-1.5, -0.3, 2.25},
     {-1.5, 0, 2.25},
     {-2.3, 0, 2.025},
     {-2.3, -0.3, 2.025},
     {-2.5, -0.3, 2.25},
     {-2.5, 0, 2.25},
     {-2.7, 0, 2.025},
     {-2.7, -0.3, 2.025},
     {-3, -0.3, 2.25},
     {-3, 0, 2.25},
     {-2.7, 0, 1.8},
     {-2.7, -0.3, 1.8},
     {-3, -0.3, 1.8},
     {-3, 0, 1.8}},
    {{-2.7, 0, 1.8},
     {-2.7, -0.3, 1.8},
     {-3, -0.3, 1.8},
     {-3, 0, 1.8},
     {-2.7, 0, 1.575},
     {-2.7, -0.3, 1.575},
     {-3, -0.3, 1.35},
     {-3, 0, 1.35},
     {-2.5, 0, 1.125},
     {-2.5, -0.3, 1.125},
     {-2.65, -0.3, 0.9375},
     {-2.65, 0, 0.9375},
     {-2, 0, 0.9},
     {-2, -0.3, 0.9},
     {-1.9, -0.3, 0.6},
     {-1.9, 0, 0.6}},
    {{1.7, 0, 1.425},
     {1.7, -0.66, 1.425},
     {1.7, -0.66, 0.6},
     {1.7, 0, 0.6},
     {2.6, 0, 1.425},
     {2.6, -0.66, 1.425},
     {3.1, -0.66, 0.825},
     {3.1, 0, 0.825},
     {2.3, 0, 2.1},
     {2.3, -0.25, 2.1},
     {2.4, -0.25, 2.025},
     {2.4, 0, 2.025},
     {2.7, 0, 2.4},
     {2.7, -0.25, 2.4},
     {3.3, -0.25, 2.4},
     {3.3, 0, 2.4}},
    {{2.7, 0, 2.4},
     {2.7, -0.25, 2.4},
     {3.3, -0.25, 2.4},
     {3.3, 0, 2.4},
     {2.8, 0, 2.475},
     {2.8, -0.25, 2.475},
     {3.525, -0.25, 2.49375},
     {3.525, 0, 2.49375},
     {2.9, 0, 2.475},
     {2.9, -0.15, 2.475},
     {3.45, -0.15, 2.5125},
     {3.45, 0, 2.5125},
     {2.8, 0, 2.4},
     {2.8, -0.15, 2.4},
     {3.2, -0.15, 2.4},
     {3.2, 0, 2.4}},
};
enum { PROFILES = sizeof profiles / sizeof *profiles, HALVES = sizeof halves / sizeof *halves };

static void bernstein(double t, double b[4])
{
    double s = 1.0 - t;
    b[0] = s * s * s;
    b[1] = 3.0 * s * s * t;
    b[2] = 3.0 * s * t * t;
    b[3] = t * t * t;
}

static int turned(const void *user, double u, double v, double p[3], double n[3])
{
    const profile *turn = user;
    double b[4], radius = 0.0, height = 0.0, angle = 2.0 * 3.14159265358979323846 * u;
    (void)n;
    bernstein(v, b);
    for (int i = 0; i < 4; i++) {
        radius += b[i] * turn->points[i][0];
        height += b[i] * turn->points[i][1];
    }
    p[0] = radius * sin(angle);
    p[1] = height;
    p[2] = radius * cos(angle);
    return 0;
}

typedef struct half {
    const double (*points)[3];
    double side; /* 1 for the half as given, -1 for the other one */
} half;

/* u goes around, backwards on the other side, so that the normal points outwards on both. */
static int patch(const void *user, double u, double v, double p[3], double n[3])
{
    const half *h = user;
    double around[4], along[4], q[3] = {0.0, 0.0, 0.0};
    (void)n;
    bernstein(h->side > 0.0 ? u : 1.0 - u, around);
    bernstein(v, along);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            for (int k = 0; k < 3; k++)
                q[k] += along[i] * around[j] * h->points[4 * i + j][k];
    p[0] = q[0];
    p[1] = q[2];
    p[2] = -h->side * q[1];
    return 0;
}

int render_teapot_mesh(int detail, render_mesh *mesh)
{
    int steps = detail / 4 + 2;
    for (int i = 0; i < PROFILES; i++)
        if (render_patch_mesh(turned, &profiles[i], detail, steps, mesh))
            return -1;
    for (int i = 0; i < 2 * HALVES; i++) {
        half h = {halves[i / 2], i % 2 ? -1.0 : 1.0};
        if (render_patch_mesh(patch, &h, steps, steps, mesh))
            return -1;
    }
    return 0;
}
