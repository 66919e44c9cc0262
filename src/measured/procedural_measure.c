/* procedural_measure.c: the goniometer of RGL, simulated: Dupuy and Jakob 2018, An Adaptive
 * Parameterization for Efficient Material Acquisition and Rendering. Names are those of rgl.h and
 * of the files: ndf, sigma, vndf. */
#include "measured/procedural.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
enum {
    INCIDENT = 8, /* directions of incidence */
    NODES = 128,  /* of ndf and sigma; and of vndf, either way */
    SIDE = 32,    /* colours of one incident direction, either way */
    AZIMUTHS = 24,
    ITERATIONS = 4
};
#define LOWEST 0.08 /* cosine: nothing is measured nearer to the horizon */
#define LEAST_COSINE 0.01
#define LEAST_RETRO 1e-5 /* 1/sr */
/* Of the normals, spread as GGX of this roughness: a near-mirror of the database too has some 6 %
 * of them beyond 15 degrees. Without them what is far from a highlight has hardly any nodes. */
#define SPREAD_SHARE 0.1
#define SPREAD_ALPHA 0.3

typedef struct gonio {
    const procedural *material;
    rgl *tables;
    double ndf[NODES], sigma[NODES];
} gonio;

/* ---- Angles ---------------------------------------------------------------------------------- */

static double theta_of(double u)
{
    return u * u * PI / 2;
}

static void direction(double theta, double phi, double w[3])
{
    w[0] = sin(theta) * cos(phi);
    w[1] = sin(theta) * sin(phi);
    w[2] = cos(theta);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double between_nodes(const double table[NODES], double u)
{
    const double x = u * (NODES - 1);
    const int k = x < NODES - 2 ? (int)x : NODES - 2;
    return table[k] + (x - k) * (table[k + 1] - table[k]);
}

/* Solid angle of all normals of node k. */
static double solid_angle(int k)
{
    const double u = (double)k / (NODES - 1);
    return 2 * PI * PI * u * sin(theta_of(u)) / (NODES - 1) * (k == NODES - 1 ? 0.5 : 1.0);
}

/* ---- The distribution of normals ------------------------------------------------------------- */

/* f(w, w) w.z, which is D / (4 sigma) of a mirror without shadows. */
static double retroreflection(const procedural *material, double theta)
{
    double w[3], f[3];
    direction(fmin(theta, acos(LOWEST)), 0.0, w);
    hnbrdf_procedural_eval(material, w, w, f);
    return fmax(0.2126 * f[0] + 0.7152 * f[1] + 0.0722 * f[2], LEAST_RETRO) * w[2];
}

static double spread_normals(double theta)
{
    const double c = cos(theta), a2 = SPREAD_ALPHA * SPREAD_ALPHA, t = c * c * (a2 - 1.0) + 1.0;
    return a2 / (PI * t * t);
}

static double projected_area(const gonio *g, double theta)
{
    double turn[AZIMUTHS], sum = 0.0;
    for (int a = 0; a < AZIMUTHS; a++) /* half a circle, the other mirrors it */
        turn[a] = cos((a + 0.5) / AZIMUTHS * PI);
    for (int k = 0; k < NODES; k++) {
        const double theta_m = theta_of((double)k / (NODES - 1));
        const double flat = sin(theta_m) * sin(theta), upright = cos(theta_m) * cos(theta);
        double seen = 0.0;
        for (int a = 0; a < AZIMUTHS; a++)
            seen += fmax(flat * turn[a] + upright, 0.0);
        sum += g->ndf[k] * solid_angle(k) * seen / AZIMUTHS;
    }
    return sum;
}

/* D is the retroreflection times sigma, and sigma an integral over D: both in turn. */
static void find_normals(gonio *g)
{
    double retro[NODES];
    for (int k = 0; k < NODES; k++) {
        const double theta = theta_of((double)k / (NODES - 1));
        retro[k] = retroreflection(g->material, theta);
        g->sigma[k] = 0.3 + 0.7 * cos(theta);
    }
    for (int i = 0; i < ITERATIONS; i++) {
        double area = 0.0;
        for (int k = 0; k < NODES; k++) {
            g->ndf[k] = retro[k] * g->sigma[k];
            area += g->ndf[k] * solid_angle(k) * cos(theta_of((double)k / (NODES - 1)));
        }
        for (int k = 0; k < NODES; k++)
            g->ndf[k] = (1.0 - SPREAD_SHARE) * g->ndf[k] / area +
                        SPREAD_SHARE * spread_normals(theta_of((double)k / (NODES - 1)));
        for (int k = 0; k < NODES; k++)
            g->sigma[k] = projected_area(g, theta_of((double)k / (NODES - 1)));
    }
}

/* ---- One incident direction ------------------------------------------------------------------ */

static void fill_density(const gonio *g, double theta, float density[NODES][NODES])
{
    double wi[3], m[3];
    direction(theta, 0.0, wi);
    for (int y = 0; y < NODES; y++)
        for (int x = 0; x < NODES; x++) {
            const double u = (double)x / (NODES - 1);
            direction(theta_of(u), (2.0 * y / (NODES - 1) - 1.0) * PI, m);
            density[y][x] =
                (float)(between_nodes(g->ndf, u) * fmax(dot(m, wi), 0.0) * sin(theta_of(u)) * u);
        }
}

/* Where in [0, 1] a density that goes from p to q has the integral r. */
static double root(double p, double q, double r)
{
    const double sum = p + sqrt(fmax(p * p + 2 * r * (q - p), 0.0));
    return sum > 0.0 ? fmin(2 * r / sum, 1.0) : 0.0;
}

/* The normal that the warp has at s, as u: sampling of visible normals. */
static void warp(const rgl_node *nodes, const rgl_row *rows, const double s[2], double u[2])
{
    int x = 0, y = 0;
    while (y < NODES - 2 && (double)rows[y + 1].below < s[1])
        y++;
    const double r0 = (double)rows[y].total, r1 = (double)rows[y + 1].total;
    const double b = root(r0, r1, s[1] - (double)rows[y].below);
    const rgl_node *n0 = nodes + y * NODES, *n1 = n0 + NODES;
    const double wanted = s[0] * ((1 - b) * r0 + b * r1);
    while (x < NODES - 2 &&
           (1 - b) * (double)n0[x + 1].below + b * (double)n1[x + 1].below < wanted)
        x++;
    const double left = (1 - b) * (double)n0[x].density + b * (double)n1[x].density;
    const double right = (1 - b) * (double)n0[x + 1].density + b * (double)n1[x + 1].density;
    const double below = (1 - b) * (double)n0[x].below + b * (double)n1[x].below;
    u[0] = (x + root(left, right, wanted - below)) / (NODES - 1);
    u[1] = (y + b) / (NODES - 1);
}

/* The view direction that a normal mirrors wi to, but none below the lowest that is measured; its
 * true cosine is returned. */
static double mirror(const double wi[3], const double u[2], double wo[3])
{
    double m[3];
    direction(theta_of(u[0]), (2 * u[1] - 1) * PI, m);
    const double twice = 2 * dot(m, wi);
    for (int c = 0; c < 3; c++)
        wo[c] = twice * m[c] - wi[c];
    const double cosine = fmax(wo[2], LEAST_COSINE);
    if (wo[2] >= LOWEST)
        return cosine;
    const double across = sqrt(wo[0] * wo[0] + wo[1] * wo[1]);
    const double factor = sqrt(1 - LOWEST * LOWEST) / fmax(across, 1e-9);
    wo[0] *= factor;
    wo[1] *= factor;
    wo[2] = LOWEST;
    return cosine;
}

static void fill_colours(const gonio *g, int slice)
{
    const rgl_node *nodes = g->tables->nodes + (size_t)slice * NODES * NODES;
    const rgl_row *rows = g->tables->rows + (size_t)slice * NODES;
    const double theta = g->tables->theta[slice];
    const double sigma = between_nodes(g->sigma, sqrt(theta * (2 / PI)));
    float *rgb = g->tables->rgb + (size_t)slice * SIDE * SIDE * 3;
    double wi[3], wo[3], f[3], u[2];
    direction(fmin(theta, acos(LOWEST)), 0.0, wi);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const double s[2] = {(double)x / (SIDE - 1), (double)y / (SIDE - 1)};
            warp(nodes, rows, s, u);
            const double cosine = mirror(wi, u, wo);
            hnbrdf_procedural_eval(g->material, wi, wo, f);
            const double jacobian = fmax(between_nodes(g->ndf, u[0]) / (4 * sigma), 1e-9);
            for (int c = 0; c < 3; c++)
                rgb[(y * SIDE + x) * 3 + c] =
                    (float)fmin(fmax(f[c] * cosine / jacobian, -1e9), 1e9);
        }
}

static int measure(gonio *g, float density[NODES][NODES])
{
    rgl *t = g->tables;
    find_normals(g);
    for (int k = 0; k < INCIDENT; k++) { /* about evenly in the cosine, as the database's are */
        const double share = pow((double)k / (INCIDENT - 1), g->material->incidence);
        t->theta[k] = acos(fmax(1.0 - share, 0.0));
        fill_density(g, t->theta[k], density);
        if (!hnbrdf_rgl_warp(t, (size_t)k, &density[0][0]))
            return 0;
        fill_colours(g, k);
    }
    for (size_t k = 0; k < NODES; k++) {
        t->ndf.values[k] = t->ndf.values[k + NODES] = (float)g->ndf[k];
        t->sigma.values[k] = t->sigma.values[k + NODES] = (float)g->sigma[k];
    }
    return 1;
}

/* ---- Memory ---------------------------------------------------------------------------------- */

static int make_grid(rgl_grid *grid)
{
    grid->width = NODES;
    grid->height = 2;
    grid->values = malloc(2 * NODES * sizeof *grid->values);
    return grid->values != NULL;
}

static rgl *make_tables(void)
{
    rgl *t = calloc(1, sizeof *t);
    if (!t)
        return NULL;
    t->phi_count = 1;
    t->theta_count = INCIDENT;
    t->isotropic = t->reduction = t->jacobian = 1;
    t->warp_width = t->warp_height = NODES;
    t->side = SIDE;
    t->phi = calloc(1, sizeof *t->phi);
    t->theta = malloc(INCIDENT * sizeof *t->theta);
    t->nodes = malloc((size_t)INCIDENT * NODES * NODES * sizeof *t->nodes);
    t->rows = malloc((size_t)INCIDENT * NODES * sizeof *t->rows);
    t->rgb = malloc((size_t)INCIDENT * SIDE * SIDE * 3 * sizeof *t->rgb);
    if (make_grid(&t->ndf) && make_grid(&t->sigma) && t->phi && t->theta && t->nodes && t->rows &&
        t->rgb)
        return t;
    hnbrdf_rgl_release(t);
    return NULL;
}

rgl *hnbrdf_procedural_measure(const procedural *material)
{
    float(*density)[NODES] = malloc(NODES * sizeof *density);
    gonio g = {.material = material, .tables = make_tables()};
    const int done = density && g.tables && measure(&g, density);
    free(density);
    if (!done) {
        hnbrdf_rgl_release(g.tables);
        return NULL;
    }
    return g.tables;
}
