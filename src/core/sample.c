/* sample.c: draw wi given wo from a cosine lobe and the GGX lobes of the material, and the
 * density of that. */
#include "core/kernel.h"
#include "core/sampling.h"

/* ---- Lobes ----------------------------------------------------------------------------------- */

void hnbrdf_lobes_paper(hnbrdf_lobes *lobes)
{
    static const hnbrdf_lobes paper = {{-1.0f, 0.0f}, {{0.5f, 0.5f, 0.5f, 0.5f}, {0.0f}}};
    *lobes = paper;
}

/* ---- Density --------------------------------------------------------------------------------- */

float hnbrdf_prepared_pdf(const hnbrdf_prepared *prepared, const float wi[3], const float wo[3])
{
    if (!(wi[2] > 0.0f && wo[2] > 0.0f))
        return 0.0f;
    const hnbrdf_lobe lobes[HNBRDF_LOBES] = {hnbrdf_lobe_of(prepared, 0),
                                             hnbrdf_lobe_of(prepared, 1)};
    hnbrdf_pair pair = hnbrdf_pair_in_frame(prepared, wi, wo);
    return hnbrdf_density(lobes, &pair);
}

float hnbrdf_pdf(const hnbrdf_model *model, const hnbrdf_material *material, const float wi[3],
                 const float wo[3])
{
    hnbrdf_prepared prepared;
    hnbrdf_prepare_analytic(model, material, &prepared);
    hnbrdf_prepare_lobes(model, material, &prepared);
    return hnbrdf_prepared_pdf(&prepared, wi, wo);
}

/* ---- Drawing --------------------------------------------------------------------------------- */

float hnbrdf_prepared_draw_turned(const hnbrdf_prepared *prepared, const float wo[3], float u0,
                                  float u1, float turn, float wi[3])
{
    const hnbrdf_lobe lobes[HNBRDF_LOBES] = {hnbrdf_lobe_of(prepared, 0),
                                             hnbrdf_lobe_of(prepared, 1)};
    const hnbrdf_frame frame = {prepared->cosine, prepared->sine};
    float o[3], i[3], drawn[3];
    wi[0] = wi[1] = 0.0f;
    wi[2] = 1.0f;
    if (!(wo[2] > 0.0f))
        return 0.0f;
    hnbrdf_to_tangent(frame, wo, o);
    const hnbrdf_choice choice = hnbrdf_choose(lobes, o[2], u0, turn);
    if (!hnbrdf_draw_chosen(&choice, o, u1, i))
        return 0.0f;
    hnbrdf_from_tangent(frame, i, drawn);
    float pdf = hnbrdf_prepared_pdf(prepared, drawn, wo);
    for (int c = 0; c < 3 && pdf > 0.0f; c++)
        wi[c] = drawn[c];
    return pdf;
}

float hnbrdf_prepared_draw(const hnbrdf_prepared *prepared, const float wo[3], const float u[2],
                           float wi[3])
{
    return hnbrdf_prepared_draw_turned(prepared, wo, u[0], u[1], 0.0f, wi);
}

void hnbrdf_prepared_sample(const hnbrdf_prepared *prepared, const float wo[3], const float u[2],
                            hnbrdf_sample_result *result)
{
    float f[3];
    result->pdf = hnbrdf_prepared_draw(prepared, wo, u, result->wi);
    result->weight[0] = result->weight[1] = result->weight[2] = 0.0f;
    if (!(result->pdf > 0.0f))
        return;
    hnbrdf_prepared_eval(prepared, result->wi, wo, f);
    for (int c = 0; c < 3; c++)
        result->weight[c] = hnbrdf_finish(f[c] * result->wi[2] / result->pdf);
}

void hnbrdf_sample(const hnbrdf_model *model, const hnbrdf_material *material, const float wo[3],
                   const float u[2], hnbrdf_sample_result *result)
{
    hnbrdf_prepared prepared;
    hnbrdf_prepare(model, material, &prepared);
    hnbrdf_prepared_sample(&prepared, wo, u, result);
}

/* ---- Batches --------------------------------------------------------------------------------- */

static const size_t DENSE_3 = 3 * sizeof(float);

static hnbrdf_draws draws_of(size_t count, const float *wo, size_t wo_stride, const float *u,
                             size_t u_stride, hnbrdf_sample_result *results, size_t result_stride)
{
    return (hnbrdf_draws){.count = count,
                          .wo = wo,
                          .u = u,
                          .results = results,
                          .wo_stride = wo_stride ? wo_stride : DENSE_3,
                          .u_stride = u_stride ? u_stride : 2 * sizeof(float),
                          .result_stride = result_stride ? result_stride : sizeof *results};
}

static hnbrdf_pairs densities_of(size_t count, const float *wi, size_t wi_stride, const float *wo,
                                 size_t wo_stride, float *pdf, size_t pdf_stride)
{
    return (hnbrdf_pairs){.count = count,
                          .wi = wi,
                          .wo = wo,
                          .f = pdf,
                          .wi_stride = wi_stride ? wi_stride : DENSE_3,
                          .wo_stride = wo_stride ? wo_stride : DENSE_3,
                          .f_stride = pdf_stride ? pdf_stride : sizeof(float)};
}

void hnbrdf_prepared_sample_batch(const hnbrdf_prepared *prepared, size_t count, const float *wo,
                                  size_t wo_stride, const float *u, size_t u_stride,
                                  hnbrdf_sample_result *results, size_t result_stride)
{
    const hnbrdf_materials of = {.model = prepared->model, .prepared = prepared};
    const hnbrdf_draws draws = draws_of(count, wo, wo_stride, u, u_stride, results, result_stride);
    prepared->model->kernel->sample(&of, &draws);
}

void hnbrdf_sample_many(const hnbrdf_model *model, const hnbrdf_material *materials,
                        const int *index, size_t count, const float *wo, size_t wo_stride,
                        const float *u, size_t u_stride, hnbrdf_sample_result *results,
                        size_t result_stride)
{
    const hnbrdf_materials of = {.model = model, .materials = materials, .index = index};
    const hnbrdf_draws draws = draws_of(count, wo, wo_stride, u, u_stride, results, result_stride);
    model->kernel->sample(&of, &draws);
}

void hnbrdf_prepared_pdf_batch(const hnbrdf_prepared *prepared, size_t count, const float *wi,
                               size_t wi_stride, const float *wo, size_t wo_stride, float *pdf,
                               size_t pdf_stride)
{
    const hnbrdf_materials of = {.model = prepared->model, .prepared = prepared};
    const hnbrdf_pairs pairs = densities_of(count, wi, wi_stride, wo, wo_stride, pdf, pdf_stride);
    prepared->model->kernel->pdf(&of, &pairs);
}

void hnbrdf_pdf_many(const hnbrdf_model *model, const hnbrdf_material *materials, const int *index,
                     size_t count, const float *wi, size_t wi_stride, const float *wo,
                     size_t wo_stride, float *pdf, size_t pdf_stride)
{
    const hnbrdf_materials of = {.model = model, .materials = materials, .index = index};
    const hnbrdf_pairs pairs = densities_of(count, wi, wi_stride, wo, wo_stride, pdf, pdf_stride);
    model->kernel->pdf(&of, &pairs);
}
