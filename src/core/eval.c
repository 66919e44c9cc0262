/* eval.c: f(wi, wo) of materials as they are, prepared, and in batches; the model's kernel does the
 * work. */
#include "core/compose.h"
#include "core/kernel.h"
#include "core/prepared.h"

/* ---- One pair -------------------------------------------------------------------------------- */

static void eval_above(const hnbrdf_prepared *prepared, const float wi[3], const float wo[3],
                       float f[3])
{
    if (prepared->edited)
        hnbrdf_edited_eval(prepared, wi, wo, f);
    else
        prepared->model->kernel->single(prepared, wi, wo, f);
    if (prepared->conserved)
        hnbrdf_prepared_conserve(prepared, wi, wo, f);
}

void hnbrdf_prepared_eval(const hnbrdf_prepared *prepared, const float wi[3], const float wo[3],
                          float f[3])
{
    if (hnbrdf_above_horizon(wi, wo))
        eval_above(prepared, wi, wo, f);
    else
        f[0] = f[1] = f[2] = 0.0f;
}

void hnbrdf_eval(const hnbrdf_model *model, const hnbrdf_material *material, const float wi[3],
                 const float wo[3], float f[3])
{
    if (hnbrdf_above_horizon(wi, wo)) {
        hnbrdf_prepared prepared;
        hnbrdf_prepare_eval(model, material, &prepared);
        eval_above(&prepared, wi, wo, f);
    } else {
        f[0] = f[1] = f[2] = 0.0f;
    }
}

void hnbrdf_eval_analytic(const hnbrdf_model *model, const hnbrdf_material *material,
                          const float wi[3], const float wo[3], float f[3])
{
    f[0] = f[1] = f[2] = 0.0f;
    if (!hnbrdf_above_horizon(wi, wo) || model->desc.kind == HNBRDF_KIND_NEURAL)
        return;
    hnbrdf_prepared prepared;
    float f_a[4];
    hnbrdf_prepare_analytic(model, material, &prepared);
    hnbrdf_pair pair = hnbrdf_pair_in_frame(&prepared, wi, wo);
    hnbrdf_prepared_analytic(&prepared, &pair, f_a);
    for (int c = 0; c < 3; c++)
        f[c] = hnbrdf_finish(f_a[c]);
}

/* ---- Batches --------------------------------------------------------------------------------- */

static hnbrdf_pairs pairs_of(size_t count, const float *wi, size_t wi_stride, const float *wo,
                             size_t wo_stride, float *f, size_t f_stride)
{
    const size_t dense = 3 * sizeof(float);
    return (hnbrdf_pairs){.count = count,
                          .wi = wi,
                          .wo = wo,
                          .f = f,
                          .wi_stride = wi_stride ? wi_stride : dense,
                          .wo_stride = wo_stride ? wo_stride : dense,
                          .f_stride = f_stride ? f_stride : dense};
}

void hnbrdf_eval_batch(const hnbrdf_model *model, const hnbrdf_material *material, size_t count,
                       const float *wi, size_t wi_stride, const float *wo, size_t wo_stride,
                       float *f, size_t f_stride)
{
    const hnbrdf_pairs pairs = pairs_of(count, wi, wi_stride, wo, wo_stride, f, f_stride);
    hnbrdf_prepared prepared;
    hnbrdf_prepare_eval(model, material, &prepared);
    const hnbrdf_materials of = {.model = model, .prepared = &prepared};
    model->kernel->eval(&of, &pairs);
}

void hnbrdf_prepared_eval_batch(const hnbrdf_prepared *prepared, size_t count, const float *wi,
                                size_t wi_stride, const float *wo, size_t wo_stride, float *f,
                                size_t f_stride)
{
    const hnbrdf_pairs pairs = pairs_of(count, wi, wi_stride, wo, wo_stride, f, f_stride);
    const hnbrdf_materials of = {.model = prepared->model, .prepared = prepared};
    prepared->model->kernel->eval(&of, &pairs);
}

void hnbrdf_eval_many(const hnbrdf_model *model, const hnbrdf_material *materials, const int *index,
                      size_t count, const float *wi, size_t wi_stride, const float *wo,
                      size_t wo_stride, float *f, size_t f_stride)
{
    const hnbrdf_pairs pairs = pairs_of(count, wi, wi_stride, wo, wo_stride, f, f_stride);
    const hnbrdf_materials of = {.model = model, .materials = materials, .index = index};
    model->kernel->eval(&of, &pairs);
}

void hnbrdf_eval_analytic_batch(const hnbrdf_model *model, const hnbrdf_material *material,
                                size_t count, const float *wi, size_t wi_stride, const float *wo,
                                size_t wo_stride, float *f, size_t f_stride)
{
    const hnbrdf_pairs pairs = pairs_of(count, wi, wi_stride, wo, wo_stride, f, f_stride);
    hnbrdf_prepared prepared;
    hnbrdf_prepare_analytic(model, material, &prepared);
    model->kernel->analytic(&prepared, &pairs);
}
