/* sampling_statistics.c: chart and chi-squared of sampling_statistics.h. */
#include "sampling_statistics.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { FINE = SAMPLING_LINE / SAMPLING_SIDE };

/* ---- The chart ------------------------------------------------------------------------------- */

sampling_chart sampling_chart_make(const hnbrdf_material *m, const float wo[3])
{
    sampling_chart c;
    c.cosine = cos((double)m->rotation);
    c.sine = sin((double)m->rotation);
    c.wo[0] = c.cosine * (double)wo[0] + c.sine * (double)wo[1];
    c.wo[1] = c.cosine * (double)wo[1] - c.sine * (double)wo[0];
    c.wo[2] = (double)wo[2];
    for (int k = 0; k < 2; k++) { /* wi.z > 0 leaves h.z >= wo.z/2, a slope of at most 2/wo.z */
        c.a[k] = (double)m->alpha[k];
        c.end[k] = asinh(2.0 / (c.wo[2] * c.a[k]));
    }
    return c;
}

double sampling_chart_point(const sampling_chart *c, int point, float wi[3])
{
    double dx = 2.0 * c->end[0] / SAMPLING_LINE, dy = 2.0 * c->end[1] / SAMPLING_LINE;
    double x = (point / SAMPLING_LINE + 0.5) * dx - c->end[0],
           y = (point % SAMPLING_LINE + 0.5) * dy - c->end[1];
    double h[3] = {c->a[0] * sinh(x), c->a[1] * sinh(y), 1.0}, i[3];
    double length = sqrt(h[0] * h[0] + h[1] * h[1] + 1.0);
    double dot = (c->wo[0] * h[0] + c->wo[1] * h[1] + c->wo[2]) / length;
    for (int k = 0; k < 3; k++)
        i[k] = 2.0 * dot * h[k] / length - c->wo[k];
    if (!(dot > 0.0 && i[2] > 0.0))
        return 0.0;
    wi[0] = (float)(c->cosine * i[0] - c->sine * i[1]);
    wi[1] = (float)(c->cosine * i[1] + c->sine * i[0]);
    wi[2] = (float)i[2];
    /* d(wi) = 4 (wo.h) d(h), d(h) = h.z^3 d(slopes), d(slope) = a cosh dx. */
    return 4.0 * dot * c->a[0] * c->a[1] * cosh(x) * cosh(y) * dx * dy / (length * length * length);
}

int sampling_chart_cell_of_point(int point)
{
    return point / SAMPLING_LINE / FINE * SAMPLING_SIDE + point % SAMPLING_LINE / FINE;
}

int sampling_chart_cell(const sampling_chart *c, const float wi[3])
{
    double s[3] = {c->cosine * (double)wi[0] + c->sine * (double)wi[1] + c->wo[0],
                   c->cosine * (double)wi[1] - c->sine * (double)wi[0] + c->wo[1],
                   (double)wi[2] + c->wo[2]};
    int cell[2];
    for (int k = 0; k < 2; k++) {
        double x = asinh(s[k] / (s[2] * c->a[k]));
        cell[k] = (int)((x / c->end[k] + 1.0) * (0.5 * SAMPLING_SIDE));
        cell[k] = cell[k] < 0 ? 0 : cell[k] >= SAMPLING_SIDE ? SAMPLING_SIDE - 1 : cell[k];
    }
    return cell[0] * SAMPLING_SIDE + cell[1];
}

/* ---- Statistics ------------------------------------------------------------------------------ */

/* Pearson's statistic as a standard normal deviate (Wilson and Hilferty 1931). Cells that expect
 * fewer than 10 draws are pooled with the rejected ones; what is expected of those, 1 less an
 * integral, is known to its error. */
static double chi_squared(const double *share, const double *counts, int count, double total,
                          double rejected)
{
    double statistic = 0, pooled_expected = SAMPLING_DRAWS * fmax(0.0, 1.0 - total);
    double pooled = rejected, error = SAMPLING_DRAWS * SAMPLING_QUADRATURE;
    int cells = 0;
    for (int k = 0; k < count; k++) {
        double mean = SAMPLING_DRAWS * share[k];
        if (mean < 10.0) {
            pooled_expected += mean;
            pooled += counts[k];
            continue;
        }
        statistic += (counts[k] - mean) * (counts[k] - mean) / mean;
        cells++;
    }
    if (pooled_expected >= 10.0) {
        statistic += (pooled - pooled_expected) * (pooled - pooled_expected) /
                     (pooled_expected + error * error);
        cells++;
    }
    if (cells < 4)
        fail_msg("%d cells are too few for a statistic", cells);
    double n = cells - 1, v = 2.0 / (9.0 * n);
    return (cbrt(statistic / n) - (1.0 - v)) / sqrt(v);
}

int sampling_cell_in_order(int place, int by_y)
{
    return by_y ? place % SAMPLING_SIDE * SAMPLING_SIDE + place / SAMPLING_SIDE : place;
}

/* Cells joined along x, or along y, into 16 groups that expect as many draws each: they see a few
 * per cent that many cells have in common. */
static double chi_squared_of_groups(const sampling_expected *expected,
                                    const sampling_counted *counted, int by_y)
{
    enum { GROUPS = 16 };
    double share[GROUPS] = {0}, counts[GROUPS] = {0}, so_far = 0.0;
    for (int place = 0; place < SAMPLING_CELLS; place++) {
        int cell = sampling_cell_in_order(place, by_y);
        int group =
            (int)(GROUPS * (so_far + 0.5 * expected->share[cell]) / fmax(expected->total, 1e-30));
        group = group < GROUPS ? group : GROUPS - 1;
        share[group] += expected->share[cell];
        counts[group] += counted->counts[cell];
        so_far += expected->share[cell];
    }
    return chi_squared(share, counts, GROUPS, expected->total, counted->rejected);
}

double sampling_deviate(const sampling_expected *expected, const sampling_counted *counted)
{
    double share = fmin(1.0, fmax(0.0, 1.0 - expected->total));
    double variance =
        share * (1.0 - share) / SAMPLING_DRAWS + SAMPLING_QUADRATURE * SAMPLING_QUADRATURE;
    double deviate = fabs(counted->rejected / SAMPLING_DRAWS - share) / sqrt(variance);
    if (!(expected->total <= 1.0 + SAMPLING_QUADRATURE))
        return (double)INFINITY;
    deviate = fmax(deviate, chi_squared(expected->share, counted->counts, SAMPLING_CELLS,
                                        expected->total, counted->rejected));
    for (int by_y = 0; by_y < 2; by_y++)
        deviate = fmax(deviate, chi_squared_of_groups(expected, counted, by_y));
    return deviate;
}

/* ---- The shipped model ----------------------------------------------------------------------- */

hnbrdf_model *sampling_shipped_model(const char *path)
{
    enum { MOST = 64 };
    hnbrdf_material materials[2 * MOST];
    char made[MOST][HNBRDF_MAX_NAME + 1];
    const char *names[2 * MOST];
    hnbrdf_model *model = NULL, *both = NULL;
    hnbrdf_model_desc desc;
    hnbrdf_error error = {""};
    if (hnbrdf_model_load(path, NULL, &model, &error))
        fail_msg("%s", error.text);
    hnbrdf_model_describe(model, &desc);
    int count = desc.material_count;
    assert_true(count <= MOST);
    for (int k = 0; k < count; k++) {
        hnbrdf_material *turned = &materials[count + k];
        materials[k] = *turned = desc.materials[k];
        turned->alpha[0] = fminf(2.0f * turned->alpha[0], HNBRDF_MAX_ALPHA);
        turned->alpha[1] = fmaxf(0.25f * turned->alpha[1], HNBRDF_MIN_ALPHA);
        turned->rotation = 0.4f + 0.5f * (float)k;
        if (hnbrdf_lobes_fit(model, turned, &turned->lobes, &error))
            fail_msg("%s", error.text);
        snprintf(made[k], sizeof made[k], "%.100s, anisotropic", desc.names[k]);
        names[k] = desc.names[k];
        names[count + k] = made[k];
    }
    desc.materials = materials;
    desc.names = names;
    desc.material_count = 2 * count;
    if (hnbrdf_model_create(&desc, NULL, &both, &error))
        fail_msg("%s", error.text);
    hnbrdf_model_free(model);
    return both;
}
