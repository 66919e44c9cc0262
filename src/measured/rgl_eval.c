/* rgl_eval.c: evaluate an RGL material (Dupuy and Jakob 2018, An Adaptive Parameterization for
 * Efficient Material Acquisition and Rendering): the half vector is warped by the cumulative
 * density of visible normals, and the colours lie on a regular grid of the warped square. */
#include "measured/rgl.h"
#include "hnbrdf/hnbrdf.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

typedef struct slice_weight {
    size_t slice;
    double weight;
} slice_weight;

/* Where u in [0, 1] falls on a grid axis: between node and node + 1. */
typedef struct axis_cell {
    size_t node;
    double fraction;
} axis_cell;

static double clamp01(double x)
{
    return x > 1.0 ? 1.0 : x > 0.0 ? x : 0.0;
}

static axis_cell locate(double u, size_t nodes)
{
    double x = clamp01(u) * (double)(nodes - 1);
    size_t node = (size_t)x < nodes - 2 ? (size_t)x : nodes - 2;
    return (axis_cell){node, x - (double)node};
}

static double mix(double a, double b, double t)
{
    return a + t * (b - a);
}

static double bilinear(const rgl_grid *grid, double ux, double uy)
{
    axis_cell x = locate(ux, grid->width), y = locate(uy, grid->height);
    const float *row0 = grid->values + y.node * grid->width + x.node, *row1 = row0 + grid->width;
    return mix(mix((double)row0[0], (double)row0[1], x.fraction),
               mix((double)row1[0], (double)row1[1], x.fraction), y.fraction);
}

/* The last node not above value, at most count - 2, and how far value lies towards the next one.
 * Outside the nodes the end is used; azimuths do not wrap. */
static axis_cell bracket(const double *nodes, size_t count, double value)
{
    if (count == 1)
        return (axis_cell){0, 0.0};
    size_t low = 0, high = count - 1;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (nodes[middle] <= value)
            low = middle;
        else
            high = middle;
    }
    return (axis_cell){low, clamp01((value - nodes[low]) / (nodes[low + 1] - nodes[low]))};
}

/* The 1 to 4 slices to blend; those of weight 0 are left out. */
static int neighbours(const rgl *material, double phi_i, double theta_i, slice_weight slices[4])
{
    axis_cell p = bracket(material->phi, material->phi_count, phi_i);
    axis_cell t = bracket(material->theta, material->theta_count, theta_i);
    int count = 0;
    for (size_t k = 0; k < 4; k++) {
        double weight =
            (k & 2 ? p.fraction : 1.0 - p.fraction) * (k & 1 ? t.fraction : 1.0 - t.fraction);
        if (weight > 0.0)
            slices[count++] =
                (slice_weight){(p.node + k / 2) * material->theta_count + t.node + k % 2, weight};
    }
    return count;
}

/* The inverse of sampling visible normals: u to s, by the blended cumulative tables. All tables are
 * linear in the density, so the sums are blended, not the tables. 0 if the row has no density. */
static int invert_warp(const rgl *material, const slice_weight *slices, int count,
                       const double u[2], double s[2])
{
    size_t width = material->warp_width, height = material->warp_height;
    axis_cell x = locate(u[0], width), y = locate(u[1], height);
    double a = x.fraction, b = y.fraction, along = 0.0, total = 0.0, below = 0.0;
    for (int k = 0; k < count; k++) {
        size_t row = slices[k].slice * height + y.node;
        const rgl_node *n0 = material->nodes + row * width + x.node, *n1 = n0 + width;
        const rgl_row *r = material->rows + row;
        double left = mix((double)n0[0].density, (double)n1[0].density, b);
        double right = mix((double)n0[1].density, (double)n1[1].density, b);
        double r0 = (double)r[0].total, r1 = (double)r[1].total, w = slices[k].weight;
        along += w * (a * (left + a * (right - left) / 2) +
                      mix((double)n0[0].below, (double)n1[0].below, b));
        total += w * mix(r0, r1, b);
        below += w * ((double)r[0].below + b * (r0 + b * (r1 - r0) / 2));
    }
    if (!(total > 0.0))
        return 0;
    s[0] = clamp01(along / total);
    s[1] = clamp01(below);
    return 1;
}

/* The nodes of the colour grid to blend, 4 of each slice; the first of slice k is node[k]. */
typedef struct colour_cell {
    int slices;
    size_t node[4], side;
    double slice_weight[4], weight[4]; /* of the corners: (x, y), (x+1, y), (x, y+1), (x+1, y+1) */
    double factor;                     /* of the blended colour, to be f */
} colour_cell;

static void find_colours(const rgl *material, const slice_weight *slices, int count,
                         const double s[2], colour_cell *cell)
{
    axis_cell x = locate(s[0], material->side), y = locate(s[1], material->side);
    cell->slices = count;
    cell->side = material->side;
    for (int k = 0; k < count; k++) {
        cell->node[k] = (slices[k].slice * material->side + y.node) * material->side + x.node;
        cell->slice_weight[k] = slices[k].weight;
    }
    cell->weight[0] = (1 - x.fraction) * (1 - y.fraction);
    cell->weight[1] = x.fraction * (1 - y.fraction);
    cell->weight[2] = (1 - x.fraction) * y.fraction;
    cell->weight[3] = x.fraction * y.fraction;
}

/* One channel of values[slice][y][x][channels]. */
static double blend(const colour_cell *cell, const float *values, size_t channels, size_t channel)
{
    double sum = 0.0;
    for (int k = 0; k < cell->slices; k++) {
        const float *row0 = values + cell->node[k] * channels + channel;
        const float *row1 = row0 + cell->side * channels;
        sum += cell->slice_weight[k] *
               (cell->weight[0] * (double)row0[0] + cell->weight[1] * (double)row0[channels] +
                cell->weight[2] * (double)row1[0] + cell->weight[3] * (double)row1[channels]);
    }
    return sum;
}

/* Turns both vectors into the part of the circle that an anisotropic file covers: by pi for
 * reduction 2, mirrored in each axis for reduction 4. Signs are those of wi. */
static void reduce(int reduction, double wi[3], double wo[3])
{
    int flip_y = reduction > 1 && !signbit(wi[1]);
    int flip_x = reduction == 2 ? flip_y : reduction == 4 && !signbit(wi[0]);
    if (flip_x) {
        wi[0] = -wi[0];
        wo[0] = -wo[0];
    }
    if (flip_y) {
        wi[1] = -wi[1];
        wo[1] = -wo[1];
    }
}

static double theta_to_u(double theta)
{
    return sqrt(theta * (2 / PI));
}

static double phi_to_u(double phi)
{
    return (phi + PI) / (2 * PI);
}

/* The azimuth of m, in an isotropic material against that of wi (0 at the pole). */
static double half_azimuth(const rgl *material, const double wi[3], const double m[3])
{
    if (!material->isotropic || (wi[0] == 0.0 && wi[1] == 0.0))
        return atan2(m[1], m[0]);
    return atan2(wi[0] * m[1] - wi[1] * m[0], wi[0] * m[0] + wi[1] * m[1]);
}

/* Everything but the colours. 0 where the normal is invisible from wi. */
static int find(const rgl *material, const double wi_given[3], const double wo_given[3],
                colour_cell *cell)
{
    double wi[3] = {wi_given[0], wi_given[1], wi_given[2]};
    double wo[3] = {wo_given[0], wo_given[1], wo_given[2]};
    reduce(material->reduction, wi, wo);

    double m[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
    double theta_m = atan2(sqrt(m[0] * m[0] + m[1] * m[1]), m[2]);
    double theta_i = atan2(sqrt(wi[0] * wi[0] + wi[1] * wi[1]), wi[2]);
    double phi_i = material->needs_phi_i ? atan2(wi[1], wi[0]) : 0.0;
    double u_m[2] = {theta_to_u(theta_m), phi_to_u(half_azimuth(material, wi, m))};
    u_m[1] -= floor(u_m[1]);

    slice_weight slices[4];
    int count = neighbours(material, phi_i, theta_i, slices);
    double s[2];
    if (!invert_warp(material, slices, count, u_m, s))
        return 0;
    find_colours(material, slices, count, s, cell);

    cell->factor = 1.0 / wo[2]; /* the tables hold f wo.z */
    if (material->jacobian)
        cell->factor *= bilinear(&material->ndf, u_m[0], u_m[1]) /
                        (4.0 * bilinear(&material->sigma, theta_to_u(theta_i), phi_to_u(phi_i)));
    return 1;
}

int hnbrdf_rgl_eval(const void *data, const double wi[3], const double wo[3], double f[3])
{
    const rgl *material = data;
    colour_cell cell;
    if (!find(material, wi, wo, &cell))
        return 0;
    for (size_t c = 0; c < 3; c++)
        f[c] = cell.factor * blend(&cell, material->rgb, 3, c);
    return 1;
}

/* Where nm falls among the wavelengths; the ends hold beyond them. */
static axis_cell bracket_wavelength(const rgl *material, float nm)
{
    const float *nodes = material->wavelengths;
    size_t low = 0, high = material->wavelength_count - 1;
    if (high == 0)
        return (axis_cell){0, 0.0};
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (nodes[middle] <= nm)
            low = middle;
        else
            high = middle;
    }
    double left = (double)nodes[low], right = (double)nodes[low + 1];
    return (axis_cell){low, clamp01(((double)nm - left) / (right - left))};
}

int hnbrdf_rgl_eval_spectrum(const void *data, const double wi[3], const double wo[3], size_t count,
                             const float *nm, float *f)
{
    const rgl *material = data;
    size_t channels = material->wavelength_count;
    colour_cell cell;
    if (!find(material, wi, wo, &cell))
        return 0;
    for (size_t k = 0; k < count; k++) {
        axis_cell at = bracket_wavelength(material, nm[k]);
        double value = blend(&cell, material->spectra, channels, at.node);
        if (at.fraction > 0.0)
            value = mix(value, blend(&cell, material->spectra, channels, at.node + 1), at.fraction);
        value *= cell.factor;
        double limit = (double)HNBRDF_MAX_VALUE;
        f[k] = (float)(value > limit     ? limit
                       : value > -limit  ? value
                       : value <= -limit ? -limit
                                         : 0.0);
    }
    return 1;
}
