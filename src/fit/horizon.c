/* horizon.c: the data near the horizon, held to an albedo of at most 1 and continued to it. */
#include "fit/horizon.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* No sampler draws a cosine below the first, and from the last on data are taken as they are. */
static const double knots[FIT_HORIZON_KNOTS] = {0.01, 0.0175, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2};

/* What an albedo above 1 is held to there, for the error of a fit is largest where the last pairs
 * are. An albedo that a material can have stays as it is. */
static const double most_albedo[FIT_HORIZON_KNOTS] = {0.50, 0.56, 0.66, 0.80,
                                                      0.90, 0.96, 0.98, 1.00};
/* Held from here on, and wholly; quadrature errs by less than that. */
#define HELD_FROM 1.01
#define HELD_WHOLLY 1.03
#define LEAST_HELD 0.001 /* cosine of a pair that is drawn where data are held */
#define NEAR 0.1         /* cosines below are near the horizon */

/* ---- Albedo ---------------------------------------------------------------------------------- */

/* The chart of metrics/albedo.c, of the narrowest lobes there are. */
enum { LINES = 96, TURNS = 4 };
#define WIDTH 1e-4

/* The direction w whose half vector with `seen` has these slopes, and w.z times its solid angle;
 * 0 below the horizon. */
static double chart_direction(const double seen[3], double x, double y, float w[3])
{
    const double h[3] = {WIDTH * sinh(x), WIDTH * sinh(y), 1.0};
    const double length2 = h[0] * h[0] + h[1] * h[1] + 1.0, length = sqrt(length2);
    const double dot = (seen[0] * h[0] + seen[1] * h[1] + seen[2]) / length;
    double d[3];
    for (int k = 0; k < 3; k++)
        d[k] = 2.0 * dot * h[k] / length - seen[k];
    if (!(dot > 0.0 && d[2] > 0.0))
        return 0.0;
    for (int k = 0; k < 3; k++)
        w[k] = (float)d[k];
    return d[2] * 4.0 * dot * WIDTH * WIDTH * cosh(x) * cosh(y) / (length2 * length);
}

/* The largest channel of the albedo of light that leaves at this cosine (swapped: comes from
 * there). Of isotropic data one side of the plane of incidence says all. */
static double albedo_at(const hnbrdf_measured *measured, double cosine, double azimuth, int swapped)
{
    const int both = !hnbrdf_measured_is_isotropic(measured);
    const double sine = sqrt(1.0 - cosine * cosine);
    const double seen[3] = {sine * cos(azimuth), sine * sin(azimuth), cosine};
    const float given[3] = {(float)seen[0], (float)seen[1], (float)seen[2]};
    const double end = asinh(2.0 / (cosine * WIDTH)), step = 2.0 * end / LINES;
    double sum[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < LINES; i++)
        for (int j = both ? 0 : LINES / 2; j < LINES; j++) {
            float w[3], f[3];
            const double weight =
                chart_direction(seen, (i + 0.5) * step - end, (j + 0.5) * step - end, w);
            if (weight > 0.0 && (swapped ? hnbrdf_measured_eval(measured, given, w, f)
                                         : hnbrdf_measured_eval(measured, w, given, f)))
                for (int c = 0; c < 3; c++)
                    sum[c] += weight * (double)f[c];
        }
    return fmax(sum[0], fmax(sum[1], sum[2])) * step * step * (both ? 1.0 : 2.0);
}

/* The largest over azimuths. */
static double largest_albedo(const hnbrdf_measured *measured, double cosine, int swapped)
{
    const int turns = hnbrdf_measured_is_isotropic(measured) ? 1 : TURNS;
    double largest = 0.0;
    for (int turn = 0; turn < turns; turn++)
        largest = fmax(largest, albedo_at(measured, cosine, PI * turn / TURNS, swapped));
    return largest;
}

static double factor_of(double albedo, double most)
{
    const double x = (albedo - HELD_FROM) / (HELD_WHOLLY - HELD_FROM);
    return albedo > HELD_FROM ? 1.0 + fmin(x, 1.0) * (most / albedo - 1.0) : 1.0;
}

/* Data that are above 1 already where nothing is held are in another unit, or wild: they stay. */
void hnbrdf_fit_horizon_make(const hnbrdf_measured *measured, fit_horizon *horizon)
{
    enum { LAST = FIT_HORIZON_KNOTS - 1 };
    horizon->held = 0;
    for (int side = 0; side < 2; side++) {
        const int stays = !(largest_albedo(measured, knots[LAST], side) <= HELD_FROM);
        for (int k = 0; k < FIT_HORIZON_KNOTS; k++) {
            const double albedo =
                k == LAST || stays ? 0.0 : largest_albedo(measured, knots[k], side);
            horizon->most[side][k] = (float)factor_of(albedo, most_albedo[k]);
            horizon->held |= horizon->most[side][k] < 1.0f;
        }
    }
}

/* ---- Holding --------------------------------------------------------------------------------- */

static double factor_at(const float most[FIT_HORIZON_KNOTS], double cosine)
{
    int k = 0;
    while (k < FIT_HORIZON_KNOTS - 2 && cosine >= knots[k + 1])
        k++;
    const double x = fmin(fmax((cosine - knots[k]) / (knots[k + 1] - knots[k]), 0.0), 1.0);
    return (double)most[k] + x * ((double)most[k + 1] - (double)most[k]);
}

void hnbrdf_fit_horizon_hold(const fit_horizon *horizon, const float wi[3], const float wo[3],
                             float f[3])
{
    const double factor =
        factor_at(horizon->most[0], (double)wo[2]) * factor_at(horizon->most[1], (double)wi[2]);
    for (int c = 0; c < 3; c++)
        f[c] = (float)(factor * (double)f[c]);
}

/* ---- Continuing ------------------------------------------------------------------------------ */

static void direction_at(double cosine, double azimuth, float w[3])
{
    const double sine = sqrt(1.0 - cosine * cosine);
    w[0] = (float)(sine * cos(azimuth));
    w[1] = (float)(sine * sin(azimuth));
    w[2] = (float)cosine;
}

/* w, raised to this cosine if it is lower. */
static void lift_to(const float w[3], double cosine, float raised[3])
{
    memcpy(raised, w, 3 * sizeof *raised);
    if ((double)w[2] < cosine)
        direction_at(cosine, atan2((double)w[1], (double)w[0]), raised);
}

/* f of the pair raised as little as finds a measurement, or nearly. */
static int nearest(const hnbrdf_measured *measured, const float wi[3], const float wo[3],
                   float f[3])
{
    for (double cosine = knots[0]; cosine < 1.0; cosine *= 1.5) {
        float i[3], o[3];
        lift_to(wi, cosine, i);
        lift_to(wo, cosine, o);
        if (hnbrdf_measured_eval(measured, i, o, f))
            return 1;
    }
    return 0;
}

/* The reflection of w about a normal near that of the surface. */
static void reflect(const float w[3], hnbrdf_rng *rng, float reflected[3])
{
    const double u = (double)hnbrdf_rng_float(rng);
    const double azimuth = 2.0 * PI * (double)hnbrdf_rng_float(rng), tilt = 0.5 * PI * u * u;
    const double h[3] = {sin(tilt) * cos(azimuth), sin(tilt) * sin(azimuth), cos(tilt)};
    const double dot = (double)w[0] * h[0] + (double)w[1] * h[1] + (double)w[2] * h[2];
    for (int k = 0; k < 3; k++)
        reflected[k] = (float)(2.0 * dot * h[k] - (double)w[k]);
}

/* A direction near the horizon, the lower the denser, and another one: about its mirror direction
 * or anywhere. */
static void draw_low(hnbrdf_rng *rng, double least, int mirrored, float low[3], float other[3])
{
    const double u = (double)hnbrdf_rng_float(rng);
    direction_at(least + (NEAR - least) * u * u, 2.0 * PI * (double)hnbrdf_rng_float(rng), low);
    if (mirrored) {
        reflect(low, rng, other);
    } else {
        const double v = (double)hnbrdf_rng_float(rng);
        direction_at(least + (1.0 - least) * v, 2.0 * PI * (double)hnbrdf_rng_float(rng), other);
    }
}

int hnbrdf_fit_horizon_draw(const fit_horizon *horizon, const hnbrdf_measured *measured,
                            hnbrdf_rng *rng, float wi[3], float wo[3], float f[3])
{
    const double least = horizon->held ? LEAST_HELD : knots[0];
    const uint32_t choice = hnbrdf_rng_u32(rng);
    const int mirrored = choice >> 31 != 0, swapped = (choice >> 30 & 1) != 0;
    do
        draw_low(rng, least, mirrored, swapped ? wi : wo, swapped ? wo : wi);
    while (!((double)(swapped ? wo : wi)[2] >= least));
    return nearest(measured, wi, wo, f);
}
