/* tabulated.c: importance sampling of a whole tabulated BRDF (Lawrence et al. 2004). */
#include "render/tabulated.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { VIEWS = 90, RINGS = 90, TURNS = 180, SUB = 2 /* points along each side of a cell */ };
static const double pi = 3.14159265358979323846, spread = 0.01;

/* Of each view: the inclusive sums over its rings, and in each ring over its cells, all up to 1. */
struct render_table {
    float rings[VIEWS][RINGS];
    float cells[VIEWS][RINGS][TURNS];
};

size_t render_table_bytes(void)
{
    return sizeof(render_table);
}

/* ---- The chart ------------------------------------------------------------------------------- */

/* wi at a point of the chart for a view at azimuth 0, and the solid angle per d(theta_h)
 * d(phi_h). 0 below the horizon. */
static double direction_of(const double wo[3], double theta, double phi, double wi[3])
{
    double h[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
    double c = wo[0] * h[0] + wo[1] * h[1] + wo[2] * h[2];
    for (int k = 0; k < 3; k++)
        wi[k] = 2.0 * c * h[k] - wo[k];
    return c > 0.0 && wi[2] > 0.0 ? 4.0 * c * sin(theta) : 0.0;
}

/* The view below and the weight of the one above it. */
static int view_below(double z, double *weight)
{
    double place = fmin(fmax(acos(fmin(z, 1.0)) / (0.5 * pi) * VIEWS - 0.5, 0.0), VIEWS - 1.0);
    int view = place < VIEWS - 2 ? (int)place : VIEWS - 2;
    *weight = place - view;
    return view;
}

/* ---- Making ---------------------------------------------------------------------------------- */

typedef struct scratch {
    float wi[RINGS * TURNS * SUB * SUB][3], wo[RINGS * TURNS * SUB * SUB][3],
        f[RINGS * TURNS * SUB * SUB][3];
    double area[RINGS * TURNS * SUB * SUB];
    int cell[RINGS * TURNS * SUB * SUB];
    double mass[RINGS * TURNS];
} scratch;

/* f wi.z, mean of the channels, times the solid angle of each cell. */
static void fill_view(const render_surface *surface, int view, scratch *s)
{
    double theta_o = (view + 0.5) / VIEWS * 0.5 * pi, wo[3] = {sin(theta_o), 0.0, cos(theta_o)};
    size_t count = 0;
    for (int n = 0; n < RINGS * SUB * TURNS * SUB; n++) {
        double u = (n / (TURNS * SUB) + 0.5) / (RINGS * SUB),
               v = (n % (TURNS * SUB) + 0.5) / (TURNS * SUB), wi[3];
        double area = direction_of(wo, u * u * 0.5 * pi, 2.0 * pi * v, wi);
        if (!(area > 0.0))
            continue;
        for (int k = 0; k < 3; k++) {
            s->wi[count][k] = (float)wi[k];
            s->wo[count][k] = (float)wo[k];
        }
        s->area[count] = area * wi[2] * u;
        s->cell[count++] = n / (TURNS * SUB * SUB) * TURNS + n % (TURNS * SUB) / SUB;
    }
    surface->eval(surface, count, s->wi[0], s->wo[0], s->f[0]);
    memset(s->mass, 0, sizeof s->mass);
    for (size_t k = 0; k < count; k++)
        s->mass[s->cell[k]] +=
            s->area[k] * ((double)s->f[k][0] + (double)s->f[k][1] + (double)s->f[k][2]);
}

static void sum_view(render_table *table, int view, scratch *s)
{
    double total = 0.0, all = 0.0, even = 0.0, sum = 0.0;
    for (int n = 0; n < RINGS * TURNS; n++) {
        double u = (n / TURNS + 0.5) / RINGS;
        total += s->mass[n];
        even += u * sin(u * u * 0.5 * pi);
    }
    for (int n = 0; n < RINGS * TURNS; n++) {
        double u = (n / TURNS + 0.5) / RINGS, share = total > 0.0 ? spread : 1.0;
        s->mass[n] = (total > 0.0 ? (1.0 - share) * s->mass[n] / total : 0.0) +
                     share * u * sin(u * u * 0.5 * pi) / even;
        all += s->mass[n];
    }
    for (int r = 0; r < RINGS; r++) {
        double ring = 0.0, part = 0.0;
        for (int t = 0; t < TURNS; t++)
            ring += s->mass[r * TURNS + t];
        for (int t = 0; t < TURNS; t++)
            table->cells[view][r][t] = (float)((part += s->mass[r * TURNS + t]) / ring);
        table->rings[view][r] = (float)((sum += ring) / all);
        table->cells[view][r][TURNS - 1] = 1.0f;
    }
    table->rings[view][RINGS - 1] = 1.0f;
}

hnbrdf_result render_table_create(const render_surface *surface, render_table **table,
                                  hnbrdf_error *error)
{
    render_table *made = malloc(sizeof *made);
    scratch *s = malloc(sizeof *s);
    hnbrdf_result result = HNBRDF_OK;
    if (made && s) {
        for (int view = 0; view < VIEWS; view++) {
            fill_view(surface, view, s);
            sum_view(made, view, s);
        }
        *table = made;
    } else {
        free(made);
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for a tabulated sampler");
    }
    free(s);
    return result;
}

void render_table_free(render_table *table)
{
    free(table);
}

/* ---- Sampling -------------------------------------------------------------------------------- */

static double step(const float *sums, int index)
{
    return (double)sums[index] - (index > 0 ? (double)sums[index - 1] : 0.0);
}

/* The first of count ascending sums above x, and where x lies in its step, [0, 1). */
static int find(const float *sums, int count, double x, double *within)
{
    int low = 0, high = count - 1;
    while (low < high) {
        int middle = (low + high) / 2;
        if ((double)sums[middle] > x)
            high = middle;
        else
            low = middle + 1;
    }
    *within = (x - (low > 0 ? (double)sums[low - 1] : 0.0)) / step(sums, low);
    return low;
}

static float table_pdf(const render_surface *surface, const float wi[3], const float wo[3])
{
    const render_table *table = surface->table;
    double h[3], length = 0.0, weight;
    if (!(wi[2] > 0.0f && wo[2] > 0.0f))
        return 0.0f;
    for (int k = 0; k < 3; k++) {
        h[k] = (double)wi[k] + (double)wo[k];
        length += h[k] * h[k];
    }
    length = sqrt(length);
    double theta = acos(fmin(h[2] / length, 1.0));
    double turn = (atan2(h[1], h[0]) - atan2((double)wo[1], (double)wo[0])) / (2.0 * pi),
           u = sqrt(theta / (0.5 * pi));
    int ring = (int)fmin(u * RINGS, RINGS - 1.0),
        cell = (int)fmin((turn - floor(turn)) * TURNS, TURNS - 1.0);
    int view = view_below((double)wo[2], &weight);
    double mass = 0.0;
    for (int k = 0; k < 2; k++)
        mass += (k ? weight : 1.0 - weight) * step(table->rings[view + k], ring) *
                step(table->cells[view + k][ring], cell);
    /* A cell is pi u / RINGS by 2 pi / TURNS; d(wi) = 4 wo.h sin(theta_h) d(theta_h) d(phi_h),
     * wo.h = |h|/2. */
    double area = pi * u / RINGS * (2.0 * pi / TURNS) * sin(theta) * 2.0 * length;
    return area > 0.0 ? (float)fmin(mass / area, 3e38) : 0.0f;
}

static float table_sample(const render_surface *surface, const float wo[3], const float u[3],
                          float wi[3])
{
    const render_table *table = surface->table;
    double weight, within[2], z = (double)wo[2], local[3];
    if (!(wo[2] > 0.0f))
        return 0.0f;
    int view = view_below(z, &weight);
    view += (double)u[0] < weight;
    int ring = find(table->rings[view], RINGS, (double)u[1], &within[0]);
    int cell = find(table->cells[view][ring], TURNS, (double)u[2], &within[1]);
    double v = (ring + within[0]) / RINGS, phi = (cell + within[1]) / TURNS * 2.0 * pi;
    double side = sqrt(fmax(0.0, 1.0 - z * z)), angle = atan2((double)wo[1], (double)wo[0]);
    const double straight[3] = {side, 0.0, z};
    if (!(direction_of(straight, v * v * 0.5 * pi, phi, local) > 0.0))
        return 0.0f;
    wi[0] = (float)(local[0] * cos(angle) - local[1] * sin(angle));
    wi[1] = (float)(local[0] * sin(angle) + local[1] * cos(angle));
    wi[2] = (float)local[2];
    return table_pdf(surface, wi, wo);
}

void render_surface_tabulate(render_surface *surface, const render_table *table)
{
    surface->table = table;
    surface->sample = table_sample;
    surface->pdf = table_pdf;
}
