/* eval.c: f(wi, wo), one pair and batches with the same bits. */
#include "core/compose.h"
#include "core/encoding.h"
#include "core/frame.h"
#include "core/microfacet.h"
#include "core/network.h"

static int above_horizon(const float wi[3], const float wo[3])
{
    return wi[2] > 0.0f && wo[2] > 0.0f;
}

static hnbrdf_pair pair_in_frame(hnbrdf_frame frame, const float wi[3], const float wo[3])
{
    float i[3], o[3];
    hnbrdf_to_tangent(frame, wi, i);
    hnbrdf_to_tangent(frame, wo, o);
    return hnbrdf_pair_make(i, o);
}

static void analytic(const hnbrdf_material *material, const hnbrdf_pair *pair, float f[3])
{
    float specular = hnbrdf_specular(pair, material->alpha[0], material->alpha[1]);
    for (int c = 0; c < 3; c++)
        f[c] = hnbrdf_microfacet(material->kd[c], material->eta[c], pair->c, specular);
}

/* Channel c of the value from the network's outputs and the analytic part. */
static float compose(const hnbrdf_model_desc *desc, const float *out, int stride, const float f_a[3], int c)
{
    if (desc->kind == HNBRDF_KIND_NEURAL)
        return hnbrdf_compose_neural(out[c * stride], desc->scale, desc->shift, desc->floor);
    return hnbrdf_compose_hybrid(out[c * stride], out[(c + 3) * stride], f_a[c], desc->scale, desc->shift,
                                 desc->floor);
}

void hnbrdf_eval(const hnbrdf_model *model, const hnbrdf_material *material, const float wi[3],
                 const float wo[3], float f[3])
{
    const hnbrdf_model_desc *desc = &model->desc;
    f[0] = f[1] = f[2] = 0.0f;
    if (!above_horizon(wi, wo))
        return;
    hnbrdf_pair pair = pair_in_frame(hnbrdf_frame_of(material), wi, wo);
    float f_a[3], x[HNBRDF_ENCODING_SIZE], out[HNBRDF_MAX_OUTPUTS];
    analytic(material, &pair, f_a);
    if (desc->kind == HNBRDF_KIND_GGX) {
        for (int c = 0; c < 3; c++)
            f[c] = hnbrdf_finish(f_a[c]);
        return;
    }
    hnbrdf_encode(desc->encoding, &pair, x);
    hnbrdf_network(desc, material->latent, x, out);
    for (int c = 0; c < 3; c++)
        f[c] = compose(desc, out, 1, f_a, c);
}

void hnbrdf_eval_analytic(const hnbrdf_model *model, const hnbrdf_material *material, const float wi[3],
                          const float wo[3], float f[3])
{
    f[0] = f[1] = f[2] = 0.0f;
    if (!above_horizon(wi, wo) || model->desc.kind == HNBRDF_KIND_NEURAL)
        return;
    hnbrdf_pair pair = pair_in_frame(hnbrdf_frame_of(material), wi, wo);
    float f_a[3];
    analytic(material, &pair, f_a);
    for (int c = 0; c < 3; c++)
        f[c] = hnbrdf_finish(f_a[c]);
}

static const float *at(const float *first, size_t stride, size_t index)
{
    return (const float *)((const char *)first + index * stride);
}

/* Up to HNBRDF_LANES pairs; lanes beyond count repeat the last pair and are not written. */
static void eval_block(const hnbrdf_model_desc *desc, const hnbrdf_material *material, hnbrdf_frame frame,
                       size_t count, const float *wi, size_t wi_stride, const float *wo, size_t wo_stride,
                       float *f, size_t f_stride)
{
    float x[HNBRDF_ENCODING_SIZE][HNBRDF_LANES], out[HNBRDF_MAX_OUTPUTS][HNBRDF_LANES];
    float f_a[HNBRDF_LANES][3];
    for (size_t l = 0; l < HNBRDF_LANES; l++) {
        size_t k = l < count ? l : count - 1;
        hnbrdf_pair pair = pair_in_frame(frame, at(wi, wi_stride, k), at(wo, wo_stride, k));
        float encoded[HNBRDF_ENCODING_SIZE];
        hnbrdf_encode(desc->encoding, &pair, encoded);
        for (int i = 0; i < HNBRDF_ENCODING_SIZE; i++)
            x[i][l] = encoded[i];
        analytic(material, &pair, f_a[l]);
    }
    hnbrdf_network_block(desc, material->latent, x, out);
    for (size_t l = 0; l < count; l++) {
        float *to = (float *)((char *)f + l * f_stride);
        int above = above_horizon(at(wi, wi_stride, l), at(wo, wo_stride, l));
        for (int c = 0; c < 3; c++)
            to[c] = above ? compose(desc, &out[0][l], HNBRDF_LANES, f_a[l], c) : 0.0f;
    }
}

void hnbrdf_eval_batch(const hnbrdf_model *model, const hnbrdf_material *material, size_t count,
                       const float *wi, size_t wi_stride, const float *wo, size_t wo_stride, float *f,
                       size_t f_stride)
{
    wi_stride = wi_stride ? wi_stride : 3 * sizeof(float);
    wo_stride = wo_stride ? wo_stride : 3 * sizeof(float);
    f_stride = f_stride ? f_stride : 3 * sizeof(float);
    if (model->desc.kind == HNBRDF_KIND_GGX) {
        for (size_t k = 0; k < count; k++)
            hnbrdf_eval(model, material, at(wi, wi_stride, k), at(wo, wo_stride, k),
                        (float *)((char *)f + k * f_stride));
        return;
    }
    hnbrdf_frame frame = hnbrdf_frame_of(material);
    for (size_t k = 0; k < count; k += HNBRDF_LANES) {
        size_t left = count - k;
        eval_block(&model->desc, material, frame, left < HNBRDF_LANES ? left : HNBRDF_LANES,
                   at(wi, wi_stride, k), wi_stride, at(wo, wo_stride, k), wo_stride,
                   (float *)((char *)f + k * f_stride), f_stride);
    }
}
