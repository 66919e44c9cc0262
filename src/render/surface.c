/* surface.c: what can be put on the sphere, and the choice of directions for what has no sampler of its
 * own. */
#include "render/render.h"

#include "core/error.h"

#include <math.h>
#include <string.h>

static void eval_model(const render_surface *surface, size_t count, const float *wi, const float *wo,
                       float *f)
{
    hnbrdf_eval_batch(surface->model, &surface->material, count, wi, 0, wo, 0, f, 0);
}

static void eval_analytic(const render_surface *surface, size_t count, const float *wi, const float *wo,
                          float *f)
{
    for (size_t i = 0; i < count; i++)
        hnbrdf_eval_analytic(surface->model, &surface->material, wi + 3 * i, wo + 3 * i, f + 3 * i);
}

static void eval_measured(const render_surface *surface, size_t count, const float *wi, const float *wo,
                          float *f)
{
    for (size_t i = 0; i < count; i++)
        if (!hnbrdf_measured_eval(surface->measured, wi + 3 * i, wo + 3 * i, f + 3 * i))
            memset(f + 3 * i, 0, 3 * sizeof(float));
}

static void sample_model(const render_surface *surface, const float wo[3], const float u[3],
                         hnbrdf_sample_result *result)
{
    hnbrdf_sample(surface->model, &surface->material, wo, u, result);
}

static float pdf_model(const render_surface *surface, const float wi[3], const float wo[3])
{
    return hnbrdf_pdf(surface->model, &surface->material, wi, wo);
}

static void sample_guided(const render_surface *surface, const float wo[3], const float u[3],
                          hnbrdf_sample_result *result)
{
    hnbrdf_sample(surface->guide, &surface->guide_material, wo, u, result);
    if (!(result->pdf > 0.0f))
        return;
    float f[3];
    surface->eval(surface, 1, result->wi, wo, f);
    for (int k = 0; k < 3; k++)
        result->weight[k] = f[k] * result->wi[2] / result->pdf;
}

static float pdf_guided(const render_surface *surface, const float wi[3], const float wo[3])
{
    return hnbrdf_pdf(surface->guide, &surface->guide_material, wi, wo);
}

static void guide_by(render_surface *surface, const hnbrdf_model *guide,
                     const hnbrdf_material *material)
{
    surface->guide = guide;
    surface->guide_material = *material;
    surface->sample = sample_guided;
    surface->pdf = pdf_guided;
}

render_surface render_surface_model(const hnbrdf_model *model, const hnbrdf_material *material)
{
    return (render_surface){.eval = eval_model,
                            .sample = sample_model,
                            .pdf = pdf_model,
                            .model = model,
                            .material = *material};
}

render_surface render_surface_analytic(const hnbrdf_model *model, const hnbrdf_material *material)
{
    render_surface surface = {.eval = eval_analytic, .model = model, .material = *material};
    guide_by(&surface, model, material);
    return surface;
}

render_surface render_surface_measured(const hnbrdf_measured *measured, const hnbrdf_model *guide,
                                       const hnbrdf_material *guide_material)
{
    render_surface surface = {.eval = eval_measured, .measured = measured};
    guide_by(&surface, guide, guide_material);
    return surface;
}

/* ---- Guides
 * ------------------------------------------------------------------------------------------ */

/* Each as a dielectric over a diffuse base and as a metal. */
static const float guide_alphas[][2] = {{0.005f, 0.005f}, {0.015f, 0.015f}, {0.04f, 0.04f},
                                        {0.08f, 0.08f},   {0.16f, 0.16f},   {0.3f, 0.3f},
                                        {0.55f, 0.55f},   {0.3f, 0.08f},    {0.08f, 0.3f}};
enum {
    ALPHAS = sizeof guide_alphas / sizeof *guide_alphas,
    GUIDES = 2 * ALPHAS,
    VIEWS = 8,
    DRAWS = 32 * GUIDES
};

hnbrdf_result render_guide_create(hnbrdf_model **guide, hnbrdf_error *error)
{
    hnbrdf_material materials[GUIDES];
    char texts[GUIDES][16];
    const char *names[GUIDES];
    for (int i = 0; i < GUIDES; i++) {
        hnbrdf_material_init(&materials[i]);
        memcpy(materials[i].alpha, guide_alphas[i % ALPHAS], sizeof materials[i].alpha);
        for (int k = 0; k < 3 && i >= ALPHAS; k++) {
            materials[i].kd[k] = 0.02f;
            materials[i].eta[k] = 5.0f;
        }
        snprintf(texts[i], sizeof texts[i], "guide %d", i);
        names[i] = texts[i];
    }
    hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = GUIDES, .materials = materials, .names = names};
    return hnbrdf_model_create(&desc, NULL, guide, error);
}

/* Second moments of f wi.z / pdf for every guide at one view. All are estimated from one set of
 * directions drawn from the even mixture of the guides, whose density never misses a lobe that one of
 * them has: E_mix[(f wi.z)^2 / (pdf_k pdf_mix)]. Invisible materials leave all of them 0. */
static void second_moments(const render_surface *surface, const hnbrdf_model *guide, const float wo[3],
                           hnbrdf_rng *rng, double moments[GUIDES])
{
    memset(moments, 0, GUIDES * sizeof *moments);
    for (int draw = 0; draw < DRAWS; draw++) {
        float u[3] = {hnbrdf_rng_float(rng), hnbrdf_rng_float(rng), hnbrdf_rng_float(rng)}, f[3];
        double pdf[GUIDES], mixture = 0.0;
        hnbrdf_sample_result drawn;
        hnbrdf_sample(guide, hnbrdf_model_material(guide, draw % GUIDES), wo, u, &drawn);
        if (!(drawn.pdf > 0.0f))
            continue;
        for (int k = 0; k < GUIDES; k++) {
            pdf[k] = (double)hnbrdf_pdf(guide, hnbrdf_model_material(guide, k), drawn.wi, wo);
            mixture += pdf[k] / GUIDES;
        }
        surface->eval(surface, 1, drawn.wi, wo, f);
        double value = ((double)f[0] + (double)f[1] + (double)f[2]) * (double)drawn.wi[2];
        for (int k = 0; k < GUIDES; k++)
            if (pdf[k] > 0.0)
                moments[k] += value * value / (pdf[k] * mixture);
    }
}

void render_guide_choose(render_surface *surface, const hnbrdf_model *guide)
{
    double scores[GUIDES] = {0.0};
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    for (int view = 0; view < VIEWS; view++) {
        float z = sqrtf(((float)view + 0.5f) / VIEWS); /* even in the area a sphere shows */
        float wo[3] = {sqrtf(1.0f - z * z), 0.0f, z};
        double moments[GUIDES], least;
        second_moments(surface, guide, wo, &rng, moments);
        least = moments[0];
        for (int k = 1; k < GUIDES; k++)
            least = moments[k] < least ? moments[k] : least;
        for (int k = 0; k < GUIDES && least > 0.0; k++)
            scores[k] += moments[k] / least;
    }
    int best = 0;
    for (int k = 1; k < GUIDES; k++)
        best = scores[k] < scores[best] ? k : best;
    guide_by(surface, guide, hnbrdf_model_material(guide, best));
}
