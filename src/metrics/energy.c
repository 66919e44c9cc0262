/* energy.c: the factor k(wi.z) k(wo.z) that keeps the albedo of a material at most 1.
 *
 * The albedo of many views is held apart by the cosine of the light, so that a factor is tried by
 * some multiplications: k grows with the cosine, hence k at the upper end of a part is at least k
 * within. */
#include "metrics/albedo.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

enum { VIEWS = 72, PARTS = 48, AZIMUTHS = HNBRDF_ALBEDO_AZIMUTHS };

/* Cosines from here to 1, of views and of the ends of parts: evenly in the logarithm. */
#define LEAST_COSINE 1.745e-3 /* of 89.9 degrees */
/* What is left of 1 is for the error of an albedo, 0.5 %, and of what is between two views. */
#define MOST_ALBEDO 0.99
#define NEEDED_ABOVE 0.995

typedef struct table {
    int azimuths;
    float cosines[PARTS]; /* ends of parts; also the cosines of views */
    double parts[VIEWS][AZIMUTHS][PARTS][3];
} table;

static float cosine_at(int k, int count)
{
    return (float)exp(log(LEAST_COSINE) * (1.0 - (double)k / (count - 1)));
}

static void fill(const hnbrdf_model *model, const hnbrdf_material *material, table *t)
{
    t->azimuths = material->alpha[0] == material->alpha[1] ? 1 : AZIMUTHS;
    for (int k = 0; k < PARTS; k++)
        t->cosines[k] = cosine_at(k, PARTS);
    for (int v = 0; v < VIEWS; v++)
        for (int a = 0; a < t->azimuths; a++) {
            const double cosine = (double)cosine_at(v, VIEWS), sine = sqrt(1.0 - cosine * cosine);
            const double phi = (double)material->rotation + PI * a / t->azimuths;
            const float wo[3] = {(float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine};
            hnbrdf_albedo_parts(model, material, wo, t->cosines, PARTS, t->parts[v][a]);
        }
}

/* ---- Trying ---------------------------------------------------------------------------------- */

/* k that is 1 from this cosine on. */
typedef struct ramp {
    double horizon, end;
} ramp;

static double at(const ramp *r, double cosine)
{
    return fmin(1.0, r->horizon + (1.0 - r->horizon) * cosine / r->end);
}

/* The largest albedo with this factor; *kept: the mean over views and channels. */
static double albedo_with(const table *t, const ramp *r, double *kept)
{
    double largest = 0.0, factors[PARTS], sum = 0.0, weights = 0.0;
    for (int k = 0; k < PARTS; k++)
        factors[k] = at(r, (double)t->cosines[k]);
    for (int v = 0; v < VIEWS; v++)
        for (int a = 0; a < t->azimuths; a++) {
            const double cosine = (double)cosine_at(v, VIEWS), weight = cosine * cosine;
            for (int c = 0; c < 3; c++) {
                double albedo = 0.0;
                for (int k = 0; k < PARTS; k++)
                    albedo += factors[k] * t->parts[v][a][k][c];
                albedo *= at(r, cosine);
                largest = fmax(largest, albedo);
                sum += weight * albedo; /* views are even in ln cos: cos d cos is cos^2 of that */
                weights += weight;
            }
        }
    *kept = sum / weights;
    return largest;
}

/* The largest k at the horizon that keeps the albedo; -1: there is none. */
static double find_horizon(const table *t, double end, double *kept)
{
    ramp r = {0.0, end};
    if (albedo_with(t, &r, kept) > MOST_ALBEDO)
        return -1.0;
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 20; k++) {
        r.horizon = 0.5 * (low + high);
        if (albedo_with(t, &r, kept) > MOST_ALBEDO)
            high = r.horizon;
        else
            low = r.horizon;
    }
    r.horizon = low;
    albedo_with(t, &r, kept);
    return low;
}

/* Ends beyond 1 are for materials whose albedo is above 1 everywhere: k is below 1 throughout. */
enum { ENDS = 64, FAR_ENDS = 24 };

static hnbrdf_energy find(const table *t)
{
    hnbrdf_energy energy = {0.0f, 0.0f};
    double best = -1.0;
    for (int k = 0; k < ENDS + FAR_ENDS; k++) {
        double kept;
        const double end = k < ENDS ? (double)cosine_at(k, ENDS) : pow(2.0, 0.5 * (k - ENDS + 1));
        const double horizon = find_horizon(t, end, &kept);
        if (horizon >= 0.0 && kept > best) {
            best = kept;
            energy.horizon = (float)horizon;
            energy.slope = (float)((1.0 - horizon) / end);
        }
    }
    return energy;
}

hnbrdf_result hnbrdf_energy_fit(const hnbrdf_model *model, const hnbrdf_material *material,
                                hnbrdf_energy *energy, hnbrdf_error *error)
{
    const ramp none = {1.0, 1.0};
    const hnbrdf_energy as_it_is = {0.0f, 0.0f};
    hnbrdf_material plain = *material;
    double kept;
    table *t = malloc(sizeof *t);
    if (!t)
        return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "no memory for a table of albedos");
    plain.energy = as_it_is;
    fill(model, &plain, t);
    *energy = albedo_with(t, &none, &kept) > NEEDED_ABOVE ? find(t) : as_it_is;
    free(t);
    return HNBRDF_OK;
}
