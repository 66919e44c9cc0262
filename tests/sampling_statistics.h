/* sampling_statistics.h: do draws follow a density? What the tests of sampling in C and in GLSL
 * share: a chart of the directions above the horizon to integrate over and to count in, and
 * deviates that are standard normal if they do. It knows nothing of how a sampler draws.
 *
 * The chart is by the normal h that mirrors wo to wi: by its slopes in units of the roughness on
 * a logarithmic scale, x = asinh(h.x/(h.z ax)), y = asinh(h.y/(h.z ay)). It resolves a narrow
 * lobe and a wide one together. */
#ifndef HNBRDF_TESTS_SAMPLING_STATISTICS_H
#define HNBRDF_TESTS_SAMPLING_STATISTICS_H

#include "hnbrdf/hnbrdf.h"

/* Draws per experiment, cells along each side of the chart, points of integration along the
 * chart. */
enum {
    SAMPLING_DRAWS = 400000,
    SAMPLING_SIDE = 30,
    SAMPLING_CELLS = SAMPLING_SIDE * SAMPLING_SIDE,
    SAMPLING_LINE = 16 * SAMPLING_SIDE,
    SAMPLING_POINTS = SAMPLING_LINE * SAMPLING_LINE
};

typedef struct sampling_chart {
    double cosine, sine; /* rotation of the tangent frame */
    double a[2];         /* roughness */
    double wo[3];        /* in the tangent frame */
    double end[2];       /* |x| and |y| stay below, or wi is below the horizon */
} sampling_chart;

sampling_chart sampling_chart_make(const hnbrdf_material *material, const float wo[3]);
/* wi at point 0 to SAMPLING_POINTS - 1 and the solid angle that it stands for; 0 where wi is
 * below the horizon. */
double sampling_chart_point(const sampling_chart *chart, int point, float wi[3]);
int sampling_chart_cell_of_point(int point);
int sampling_chart_cell(const sampling_chart *chart, const float wi[3]);

/* Cell number `place` line by line, of constant x or, by_y, of constant y. */
int sampling_cell_in_order(int place, int by_y);

/* Share of draws that the density says each cell gets; the rest of 1 is rejected. */
typedef struct sampling_expected {
    double share[SAMPLING_CELLS], total;
} sampling_expected;

/* What came of SAMPLING_DRAWS draws. */
typedef struct sampling_counted {
    double counts[SAMPLING_CELLS], rejected;
} sampling_counted;

/* Error of the midpoint rule on the chart, from halving its step: the density of a GGX lobe ends
 * abruptly at the horizon, inside cells. */
#define SAMPLING_QUADRATURE 1.5e-4

/* Each of these deviates is a standard normal one if draws follow the density. Seeds are fixed,
 * so the threshold only has to be one that a correct sampler meets: of 400 of them all stay below
 * it with probability 0.9986. */
#define SAMPLING_THRESHOLD 4.5

/* The largest of four: the rejected share against 1 minus the integral, Pearson's statistic over
 * all cells, and over 16 groups of cells along x and along y, which notice 2 % that many cells
 * have in common. Infinite if the integral is above 1. */
double sampling_deviate(const sampling_expected *expected, const sampling_counted *counted);

/* The shipped model with each of its materials twice: as fitted, then (number + count/2)
 * anisotropic and turned, with lobes fitted to that. */
hnbrdf_model *sampling_shipped_model(const char *path);

#endif
