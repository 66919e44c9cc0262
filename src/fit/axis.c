/* axis.c: the direction about which an anisotropic material is symmetric. */
#include "fit/axis.h"

#include <math.h>

enum { AXIS_PAIRS = 1024, AXIS_STEPS = 36, AXIS_HALVINGS = 6 };
#define QUARTER 1.57079632679489662

typedef struct axis_pair {
    float wi[3], wo[3], f[3];
} axis_pair;

/* w in the mirror that holds n and the direction at `angle`. */
static void mirror(const float w[3], double angle, float out[3])
{
    double c = cos(2.0 * angle), s = sin(2.0 * angle);
    out[0] = (float)(c * (double)w[0] + s * (double)w[1]);
    out[1] = (float)(s * (double)w[0] - c * (double)w[1]);
    out[2] = w[2];
}

/* Mean SMAPE of f against itself in that mirror and in the one across it. */
static double unlike(const hnbrdf_measured *measured, const axis_pair *pairs, int count,
                     double angle)
{
    double sum = 0.0;
    int used = 0;
    for (int k = 0; k < 2 * count; k++) {
        const axis_pair *p = &pairs[k / 2];
        double plane = angle + (k % 2 ? QUARTER : 0.0);
        float wi[3], wo[3], f[3];
        mirror(p->wi, plane, wi);
        mirror(p->wo, plane, wo);
        if (!hnbrdf_measured_eval(measured, wi, wo, f))
            continue;
        for (int c = 0; c < 3; c++)
            if (f[c] != p->f[c])
                sum += fabs((double)f[c] - (double)p->f[c]) /
                       (fabs((double)f[c]) + fabs((double)p->f[c]));
        used += 3;
    }
    return used ? 2.0 * sum / used : 2.0;
}

double hnbrdf_fit_axis(const hnbrdf_measured *measured)
{
    axis_pair pairs[AXIS_PAIRS];
    hnbrdf_rng rng;
    int count = 0;
    hnbrdf_rng_seed(&rng, 0, UINT64_C(4) << 40);
    for (int k = 0; k < AXIS_PAIRS; k++) {
        axis_pair *p = &pairs[count];
        hnbrdf_sampler_draw(k % 2 ? HNBRDF_SAMPLER_GRID : HNBRDF_SAMPLER_UNIFORM, &rng, p->wi,
                            p->wo);
        count += hnbrdf_measured_eval(measured, p->wi, p->wo, p->f) != 0;
    }
    double step = QUARTER / AXIS_STEPS, best = 0.0, least = INFINITY;
    for (int k = 0; k < AXIS_STEPS; k++) {
        double found = unlike(measured, pairs, count, k * step);
        best = found < least ? k * step : best;
        least = fmin(least, found);
    }
    for (int k = 0; k < AXIS_HALVINGS; k++) {
        step /= 2.0;
        double centre = best;
        for (int side = -1; side <= 1; side += 2) {
            double found = unlike(measured, pairs, count, centre + side * step);
            best = found < least ? centre + side * step : best;
            least = fmin(least, found);
        }
    }
    return best;
}
