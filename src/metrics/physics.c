/* physics.c: energy, reciprocity and positivity of a material, by evaluating it over all angles. */
#include "hnbrdf/metrics.h"

#include <math.h>
#include <string.h>

/* ---- Directional albedo -------------------------------------------------------------------------
 * wi is charted by  * the normal h that mirrors wo to it, by its slopes in units of the roughness
 * on a scale that is  * linear near 0 and logarithmic far out, x = asinh(h.x/(h.z a)). That
 * resolves a narrow lobe and  * the diffuse rest together; the midpoint rule on it converges like
 * one on a smooth function. */

enum { SIDE = 72, BLOCK = 72, ANGLES = 23, AZIMUTHS = 8 };

static const double PI = 3.14159265358979323846;

typedef struct chart {
    double cosine, sine; /* of the rotation */
    /* widths; those of the lobe, but not so wide that the far side is missed */
    double a[2];
    double wo[3];  /* in the tangent frame */
    double end[2]; /* beyond, wi is below the horizon */
} chart;

static chart chart_make(const hnbrdf_material *m, hnbrdf_kind kind, const float wo[3])
{
    chart c;
    c.cosine = cos((double)m->rotation);
    c.sine = sin((double)m->rotation);
    c.wo[0] = c.cosine * (double)wo[0] + c.sine * (double)wo[1];
    c.wo[1] = c.cosine * (double)wo[1] - c.sine * (double)wo[0];
    c.wo[2] = (double)wo[2];
    for (int k = 0; k < 2; k++) { /* wi.z > 0 leaves h.z >= wo.z/2, a slope of at most 2/wo.z */
        c.a[k] = kind == HNBRDF_KIND_NEURAL ? 0.05 : (double)m->alpha[k];
        c.end[k] = asinh(2.0 / (c.wo[2] * c.a[k]));
    }
    return c;
}

/* wi at a point of the chart, and wi.z times the solid angle per dx dy; 0 below the horizon. */
static double chart_direction(const chart *c, double x, double y, float wi[3])
{
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
    return i[2] * 4.0 * dot * c->a[0] * c->a[1] * cosh(x) * cosh(y) / (length * length * length);
}

/* One line of the chart, evaluated together. */
static void add_line(const hnbrdf_model *model, const hnbrdf_material *m, const chart *c,
                     const float wo[3], double x, double dy, double albedo[3])
{
    float wi[BLOCK][3], towards[BLOCK][3], f[BLOCK][3];
    double weight[BLOCK];
    size_t count = 0;
    for (int k = 0; k < SIDE; k++) {
        weight[count] = chart_direction(c, x, (k + 0.5) * dy - c->end[1], wi[count]);
        memcpy(towards[count], wo, sizeof towards[count]);
        count += weight[count] > 0.0;
    }
    hnbrdf_eval_batch(model, m, count, wi[0], 0, towards[0], 0, f[0], 0);
    for (size_t k = 0; k < count; k++)
        for (int channel = 0; channel < 3; channel++)
            albedo[channel] += (double)f[k][channel] * weight[k];
}

void hnbrdf_albedo(const hnbrdf_model *model, const hnbrdf_material *material, const float wo[3],
                   double albedo[3])
{
    hnbrdf_model_desc desc;
    double sum[3] = {0.0, 0.0, 0.0};
    hnbrdf_model_describe(model, &desc);
    chart c = chart_make(material, desc.kind, wo);
    double dx = 2.0 * c.end[0] / SIDE, dy = 2.0 * c.end[1] / SIDE;
    for (int k = 0; k < SIDE && wo[2] > 0.0f; k++)
        add_line(model, material, &c, wo, (k + 0.5) * dx - c.end[0], dy, sum);
    for (int channel = 0; channel < 3; channel++)
        albedo[channel] = sum[channel] * dx * dy;
}

static void find_albedo(const hnbrdf_model *model, const hnbrdf_material *material,
                        hnbrdf_physics *physics)
{
    int azimuths = material->alpha[0] == material->alpha[1] ? 1 : AZIMUTHS;
    for (int t = 0; t < ANGLES; t++)
        for (int a = 0; a < azimuths; a++) {
            double theta = t * 4.0 * PI / 180.0, albedo[3];
            double phi = (double)material->rotation + PI * a / azimuths;
            const float wo[3] = {(float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                                 (float)cos(theta)};
            hnbrdf_albedo(model, material, wo, albedo);
            for (int c = 0; c < 3; c++)
                if (albedo[c] > physics->albedo) {
                    physics->albedo = albedo[c];
                    physics->albedo_theta = theta;
                    physics->albedo_channel = c;
                }
        }
}

/* ---- Reciprocity, positivity ----------------------------------------------------------------- */

static void compare_swapped(const hnbrdf_model *model, const hnbrdf_material *material,
                            hnbrdf_physics *physics)
{
    enum { PAIRS = 4096 };
    hnbrdf_rng rng;
    double sum = 0.0, worst = 0.0;
    size_t black = 0;
    physics->valid = 1;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int k = 0; k < PAIRS; k++) {
        float wi[3], wo[3], f[2][3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
        hnbrdf_eval(model, material, wi, wo, f[0]);
        hnbrdf_eval(model, material, wo, wi, f[1]);
        for (int c = 0; c < 3; c++) {
            double error = hnbrdf_smape((double)f[0][c], (double)f[1][c]);
            sum += error;
            worst = fmax(worst, error);
            black += f[0][c] == 0.0f;
            physics->valid &= isfinite(f[0][c]) && f[0][c] >= 0.0f;
        }
    }
    physics->reciprocity = sum / (3 * PAIRS);
    physics->reciprocity_worst = worst;
    physics->black = (double)black / (3 * PAIRS);
}

void hnbrdf_physics_of(const hnbrdf_model *model, const hnbrdf_material *material,
                       hnbrdf_physics *physics)
{
    memset(physics, 0, sizeof *physics);
    find_albedo(model, material, physics);
    compare_swapped(model, material, physics);
}
