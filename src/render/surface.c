/* surface.c: what can be put on the sphere. */
#include "render/render.h"

#include <string.h>

static void eval_model(const render_surface *surface, size_t count, const float *wi,
                       const float *wo, float *f)
{
    hnbrdf_eval_batch(surface->model, &surface->material, count, wi, 0, wo, 0, f, 0);
}

static void eval_analytic(const render_surface *surface, size_t count, const float *wi,
                          const float *wo, float *f)
{
    for (size_t i = 0; i < count; i++)
        hnbrdf_eval_analytic(surface->model, &surface->material, wi + 3 * i, wo + 3 * i, f + 3 * i);
}

static void eval_measured(const render_surface *surface, size_t count, const float *wi,
                          const float *wo, float *f)
{
    for (size_t i = 0; i < count; i++)
        if (!hnbrdf_measured_eval(surface->measured, wi + 3 * i, wo + 3 * i, f + 3 * i))
            memset(f + 3 * i, 0, 3 * sizeof(float));
}

static float sample_model(const render_surface *surface, const float wo[3], const float u[3],
                          float wi[3])
{
    const float stratified[2] = {u[1], u[2]};
    return hnbrdf_prepared_draw(&surface->prepared, wo, stratified, wi);
}

static float pdf_model(const render_surface *surface, const float wi[3], const float wo[3])
{
    return hnbrdf_prepared_pdf(&surface->prepared, wi, wo);
}

render_surface render_surface_model(const hnbrdf_model *model, const hnbrdf_material *material)
{
    render_surface surface = {.eval = eval_model,
                              .sample = sample_model,
                              .pdf = pdf_model,
                              .model = model,
                              .material = *material};
    hnbrdf_prepare(model, material, &surface.prepared);
    return surface;
}

render_surface render_surface_analytic(const hnbrdf_model *model, const hnbrdf_material *material)
{
    render_surface surface = render_surface_model(model, material);
    surface.eval = eval_analytic;
    return surface;
}

render_surface render_surface_measured(const hnbrdf_measured *measured)
{
    return (render_surface){.eval = eval_measured, .measured = measured};
}
