/* mix_pairs.c: directions in which a mixture is looked at, and directional albedo over them.
 *
 * wi is charted by the normal h that mirrors wo to it, by its slopes x = asinh(slope / width):
 * linear within a lobe and logarithmic beyond, so that few points see the lobe and the rest. The
 * weights are those of the midpoint rule. The library's own exp and log: the same pairs on every
 * machine. */
#include "edit/mix.h"

#include "core/frame.h"
#include "core/math.h"
#include "core/model.h"

#include <math.h>
#include <string.h>

/* wo: sine and cosine of its angle, then cosine and sine of its azimuth. The bounded ones are at 0,
 * 30 and 60 degrees; 80 shows what is seen at grazing angles. Those with an azimuth are for
 * materials that change with it. */
static const float views[MIX_MAX_VIEWS][4] = {{0.0f, 1.0f, 1.0f, 0.0f},
                                              {0.5f, 0.866025404f, 1.0f, 0.0f},
                                              {0.866025404f, 0.5f, 1.0f, 0.0f},
                                              {0.984807753f, 0.173648178f, 1.0f, 0.0f},
                                              {0.5f, 0.866025404f, 0.0f, 1.0f},
                                              {0.866025404f, 0.5f, 0.0f, 1.0f},
                                              {0.866025404f, 0.5f, 0.707106781f, 0.707106781f}};
enum { ROUND_VIEWS = 4 };

/* Of the roughness: parts of a measured material are sharper than its GGX lobe. */
static const double width_of_alpha = 0.7;
static const double neural_width = 0.05; /* alpha means nothing there */

/* 1 if f changes neither with the azimuth nor with the side of wo on which wi lies. */
static int is_round(const hnbrdf_model *model, const hnbrdf_material *m)
{
    const hnbrdf_encoding encoding = model->desc.encoding;
    if (model->desc.kind != HNBRDF_KIND_GGX &&
        (encoding == HNBRDF_ENCODING_DIRECTIONS || hnbrdf_encoding_sees_azimuth(encoding)))
        return 0;
    return model->desc.kind == HNBRDF_KIND_NEURAL ||
           (m->alpha[0] == m->alpha[1] && m->fitted.alpha[0] == m->fitted.alpha[1]);
}

typedef struct chart {
    hnbrdf_frame frame;
    float wo[3];
    double towards[3]; /* wo in the tangent frame */
    double width[2], end[2], step[2];
} chart;

static chart make_chart(const hnbrdf_model *model, const hnbrdf_material *m, const float view[4],
                        int side)
{
    chart c = {.frame = hnbrdf_frame_of(m), .wo = {view[0] * view[2], view[0] * view[3], view[1]}};
    float towards[3];
    hnbrdf_to_tangent(c.frame, c.wo, towards);
    for (int k = 0; k < 3; k++)
        c.towards[k] = (double)towards[k];
    for (int k = 0; k < 2; k++) { /* wi.z > 0 leaves h.z >= wo.z/2: a slope of at most 2/wo.z */
        c.width[k] = model->desc.kind == HNBRDF_KIND_NEURAL ? neural_width
                                                            : width_of_alpha * (double)m->alpha[k];
        double x = 2.0 / (c.towards[2] * c.width[k]);
        c.end[k] = (double)hnbrdf_log((float)(x + sqrt(x * x + 1.0))); /* asinh */
        c.step[k] = 2.0 * c.end[k] / side;
    }
    return c;
}

/* One point; counted if it is above the horizon. */
static void add_pair(const chart *c, double x, double y, double share, int view, mix_pairs *pairs)
{
    const double up[2] = {(double)hnbrdf_exp((float)x), (double)hnbrdf_exp((float)y)};
    double h[3] = {0.0, 0.0, 1.0}, stretch = 1.0, in[3];
    for (int k = 0; k < 2; k++) {
        h[k] = c->width[k] * 0.5 * (up[k] - 1.0 / up[k]);
        stretch *= c->width[k] * 0.5 * (up[k] + 1.0 / up[k]) * c->step[k];
    }
    double length = sqrt((h[0] * h[0] + h[1] * h[1]) + 1.0);
    double dot = ((c->towards[0] * h[0] + c->towards[1] * h[1]) + c->towards[2]) / length;
    for (int k = 0; k < 3; k++)
        in[k] = 2.0 * dot * h[k] / length - c->towards[k];
    if (!(dot > 0.0 && in[2] > 0.0))
        return;
    const float tangent[3] = {(float)in[0], (float)in[1], (float)in[2]};
    const int n = pairs->count++;
    hnbrdf_from_tangent(c->frame, tangent, pairs->wi[n]);
    memcpy(pairs->wo[n], c->wo, sizeof c->wo);
    pairs->view[n] = view;
    /* d(wi) = 4 (wo.h) d(h), d(h) = h.z^3 d(slopes), d(slope) = width cosh(x) dx. */
    pairs->weight[n] = share * in[2] * 4.0 * dot * stretch / (length * length * length);
}

void hnbrdf_mix_pairs_make(const hnbrdf_model *model, const hnbrdf_material *material, int side,
                           int bounded, mix_pairs *pairs)
{
    const int halved = is_round(model, material);
    const int count = bounded ? (int)MIX_BOUNDED : halved ? (int)ROUND_VIEWS : (int)MIX_MAX_VIEWS;
    pairs->count = 0;
    for (int view = 0; view < count; view++) {
        const chart c = make_chart(model, material, views[view], side);
        for (int i = 0; i < side; i++)
            for (int j = halved ? side / 2 : 0; j < side; j++)
                add_pair(&c, (i + 0.5) * c.step[0] - c.end[0], (j + 0.5) * c.step[1] - c.end[1],
                         halved ? 2.0 : 1.0, view, pairs);
    }
}

void hnbrdf_mix_eval(const hnbrdf_model *model, const hnbrdf_material *material,
                     const mix_pairs *pairs, mix_values f)
{
    hnbrdf_eval_batch(model, material, (size_t)pairs->count, pairs->wi[0], 0, pairs->wo[0], 0, f[0],
                      0);
}

mix_albedo hnbrdf_mix_albedo_of(const mix_pairs *pairs, const float *f)
{
    mix_albedo albedo = {{{0.0}}};
    for (int n = 0; n < pairs->count; n++)
        for (int c = 0; pairs->view[n] < MIX_BOUNDED && c < 3; c++)
            albedo.at[pairs->view[n]][c] += (double)f[3 * n + c] * pairs->weight[n];
    return albedo;
}
