/* albedo.c: directional albedo of a material, whole and by the cosine of the light.
 *
 * wi is charted by the normal h that mirrors wo to it, by its slopes in units of the roughness on a
 * scale that is linear near 0 and logarithmic far out, x = asinh(h.x/(h.z a)). That resolves a
 * narrow lobe and the diffuse rest together; the midpoint rule on it converges like one on a smooth
 * function. */
#include "metrics/albedo.h"

#include <math.h>
#include <string.h>

enum { SIDE = 72, BLOCK = 72 };

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

/* The part that wi.z belongs to. */
static int part_of(float z, const float *cosines, int parts)
{
    int k = 0;
    while (k < parts - 1 && z > cosines[k])
        k++;
    return k;
}

/* One line of the chart, evaluated together. */
static void add_line(const hnbrdf_model *model, const hnbrdf_material *m, const chart *c,
                     const float wo[3], double x, double dy, const float *cosines, int parts,
                     double (*albedo)[3])
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
    for (size_t k = 0; k < count; k++) {
        double *sum = albedo[part_of(wi[k][2], cosines, parts)];
        for (int channel = 0; channel < 3; channel++)
            sum[channel] += (double)f[k][channel] * weight[k];
    }
}

void hnbrdf_albedo_parts(const hnbrdf_model *model, const hnbrdf_material *material,
                         const float wo[3], const float *cosines, int parts, double (*albedo)[3])
{
    hnbrdf_model_desc desc;
    memset(albedo, 0, (size_t)parts * sizeof *albedo);
    hnbrdf_model_describe(model, &desc);
    chart c = chart_make(material, desc.kind, wo);
    double dx = 2.0 * c.end[0] / SIDE, dy = 2.0 * c.end[1] / SIDE;
    for (int k = 0; k < SIDE && wo[2] > 0.0f; k++)
        add_line(model, material, &c, wo, (k + 0.5) * dx - c.end[0], dy, cosines, parts, albedo);
    for (int k = 0; k < parts; k++)
        for (int channel = 0; channel < 3; channel++)
            albedo[k][channel] *= dx * dy;
}

void hnbrdf_albedo(const hnbrdf_model *model, const hnbrdf_material *material, const float wo[3],
                   double albedo[3])
{
    const float all = 1.0f;
    hnbrdf_albedo_parts(model, material, wo, &all, 1, (double(*)[3])albedo);
}
