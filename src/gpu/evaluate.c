/* evaluate.c: the exported shader of a model on one device as a function: any material, any
 * directions. */
#include "gpu/evaluate.h"

#include "base/error.h"
#include "gpu/compile.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The texts of shaders/evaluate.comp and shaders/hybrid_brdf.glsl. */
extern const char hnbrdf_evaluate_comp[], hnbrdf_hybrid_brdf_glsl[];

/* Floats of one evaluation: wi, wo, kd, eta, alpha, cosine and sine of the rotation, latent,
 * scales and shares of the lobes, u, fitted kd, eta and alpha, energy. */
enum {
    AT_KD = 6,
    AT_ETA = 9,
    AT_ALPHA = 12,
    AT_ROTATION = 14,
    AT_LATENT = 16,
    AT_SCALE = 32,
    AT_SHARE = 34,
    AT_U = 42,
    AT_FITTED = 44,
    AT_ENERGY = 52,
    INPUTS = 56
};

/* The fields that the exporter gives to the struct of a scene that is anisotropic, turned and
 * editable. */
static void write_reader(const hnbrdf_model_desc *desc, char text[1024])
{
    int vectors = desc->kind == HNBRDF_KIND_GGX ? 0 : (desc->latent + 3) / 4;
    int length =
        snprintf(text, 1024, "hnbrdf_material read_material(uint at)\n{\n    hnbrdf_material m;\n");
    if (desc->kind != HNBRDF_KIND_NEURAL)
        length += snprintf(text + length, 1024 - (size_t)length,
                           "    m.kd = read3(at + %d);\n    m.eta = read3(at + %d);\n    m.alpha = "
                           "read4(at + %d).xy;\n",
                           AT_KD, AT_ETA, AT_ALPHA);
    if (desc->kind == HNBRDF_KIND_HYBRID)
        length += snprintf(text + length, 1024 - (size_t)length,
                           "    m.fitted_kd = read3(at + %d);\n    m.fitted_eta = read3(at + "
                           "%d);\n"
                           "    m.fitted_alpha = vec2(inputs[at + %d], inputs[at + %d]);\n",
                           AT_FITTED, AT_FITTED + 3, AT_FITTED + 6, AT_FITTED + 7);
    length += snprintf(text + length, 1024 - (size_t)length,
                       "    m.rotation = read4(at + %d).xy;\n", AT_ROTATION);
    for (int v = 0; v < vectors; v++)
        length += snprintf(text + length, 1024 - (size_t)length,
                           "    m.latent%d = read4(at + %d);\n", v, AT_LATENT + 4 * v);
    snprintf(text + length, 1024 - (size_t)length,
             "    m.lobe_scale = read4(at + %d).xy;\n    m.lobe_share_0 = read4(at + %d);\n"
             "    m.lobe_share_1 = read4(at + %d);\n    m.energy_ramp = read4(at + %d).xy;\n"
             "    return m;\n}\n",
             AT_SCALE, AT_SHARE, AT_SHARE + HNBRDF_LOBE_KNOTS, AT_ENERGY);
}

/* The same network with one material that has everything a material can have. */
static hnbrdf_result general_model(const hnbrdf_model *model, hnbrdf_model **general,
                                   hnbrdf_error *error)
{
    static const char *const name = "any";
    hnbrdf_model_desc desc;
    hnbrdf_material material;
    hnbrdf_model_describe(model, &desc);
    hnbrdf_material_init(&material);
    material.alpha[1] = 0.25f;
    material.rotation = 1.0f;
    material.energy.horizon = 0.5f;
    desc.materials = &material;
    desc.names = &name;
    desc.material_count = 1;
    return hnbrdf_model_create(&desc, NULL, general, error);
}

static hnbrdf_result export_scene(const hnbrdf_model *general, const gpu_style *style,
                                  gpu_text *scene, gpu_text *weights, hnbrdf_error *error)
{
    const hnbrdf_glsl_options options = {
        .weights = style->weights, .precision = style->precision, .editable = 1};
    hnbrdf_result result = hnbrdf_export_shader(general, &options, gpu_text_append, scene, error);
    if (!result && style->weights == HNBRDF_GLSL_UNIFORM && hnbrdf_weights_size(general) > 0)
        result = hnbrdf_export_weights(general, &options, gpu_text_append, weights, error);
    return result;
}

static hnbrdf_result open_program(gpu_evaluator *e, const hnbrdf_model *general,
                                  const gpu_style *style, const gpu_text *scene,
                                  const gpu_text *weights, hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    char reader[1024];
    hnbrdf_model_describe(general, &desc);
    write_reader(&desc, reader);
    const gpu_include includes[] = {{"hybrid_brdf.glsl", hnbrdf_hybrid_brdf_glsl},
                                    {"scene.glsl", scene->bytes},
                                    {"material.glsl", reader}};
    const char *const defines[] = {
        style->build == CHECK_BUILD_EXACT ? "HNBRDF_EXACT=1" : "HNBRDF_EXACT=0",
        e->device->has_half ? "HNBRDF_HALF_NATIVE=1" : "HNBRDF_HALF_NATIVE=0", NULL};
    const gpu_buffer *const buffers[] = {&e->inputs, &e->values, &e->weights};
    uint32_t *spirv = NULL;
    size_t size = 0;
    hnbrdf_result result = HNBRDF_OK;
    if (weights->size > 0)
        result = gpu_uniform_open(e->device, weights->bytes, weights->size, &e->weights, error);
    if (!result)
        result = gpu_compile(hnbrdf_evaluate_comp, includes, 3, defines, &spirv, &size, error);
    if (!result)
        result = gpu_program_open(e->device, spirv, size, buffers, weights->size > 0 ? 3 : 2,
                                  sizeof(uint32_t), &e->program, error);
    free(spirv);
    return result;
}

hnbrdf_result gpu_evaluator_open(const gpu_device *device, const hnbrdf_model *model,
                                 const gpu_style *style, size_t capacity, gpu_evaluator *evaluator,
                                 hnbrdf_error *error)
{
    gpu_evaluator e = {.device = device, .model = model, .capacity = capacity};
    gpu_text scene = {0}, weights = {0};
    hnbrdf_model *general = NULL;
    hnbrdf_result result = general_model(model, &general, error);
    if (!result)
        result = export_scene(general, style, &scene, &weights, error);
    e.packed = calloc(capacity, INPUTS * sizeof *e.packed);
    if (!result && !e.packed)
        result = hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "evaluating: no memory for %zu pairs",
                             capacity);
    if (!result)
        result = gpu_buffer_open(device, capacity * INPUTS * sizeof(float), &e.inputs, error);
    if (!result)
        result = gpu_buffer_open(device, capacity * GPU_EVALUATION_NUMBERS * sizeof(float),
                                 &e.values, error);
    if (!result)
        result = open_program(&e, general, style, &scene, &weights, error);
    for (int what = 0; what < GPU_EVALUATIONS && !result; what++)
        result = gpu_pipeline_open(device, &e.program, what, &e.pipelines[what], error);
    free(scene.bytes);
    free(weights.bytes);
    hnbrdf_model_free(general);
    if (result)
        gpu_evaluator_close(&e);
    else
        *evaluator = e;
    return result;
}

void gpu_evaluator_close(gpu_evaluator *e)
{
    if (!e->device)
        return;
    for (int what = 0; what < GPU_EVALUATIONS; what++)
        vkDestroyPipeline(e->device->handle, e->pipelines[what], NULL);
    gpu_program_close(e->device, &e->program);
    gpu_buffer_close(e->device, &e->inputs);
    gpu_buffer_close(e->device, &e->values);
    gpu_buffer_close(e->device, &e->weights);
    free(e->packed);
    memset(e, 0, sizeof *e);
}

/* One that does not know what it was fitted with is unedited. */
static hnbrdf_fitted fitted_of(const hnbrdf_material *m)
{
    hnbrdf_fitted fitted = m->fitted;
    if (!hnbrdf_material_is_edited(m)) {
        memcpy(fitted.kd, m->kd, sizeof fitted.kd);
        memcpy(fitted.eta, m->eta, sizeof fitted.eta);
        memcpy(fitted.alpha, m->alpha, sizeof fitted.alpha);
    }
    return fitted;
}

hnbrdf_result gpu_evaluator_run(gpu_evaluator *e, gpu_evaluation what,
                                const hnbrdf_material *material, const float *pairs, const float *u,
                                size_t count, float (*values)[GPU_EVALUATION_NUMBERS],
                                hnbrdf_error *error)
{
    hnbrdf_prepared prepared;
    uint32_t push = (uint32_t)count;
    if (count > e->capacity)
        return hnbrdf_fail(error, HNBRDF_ERROR_LIMIT, "evaluating: %zu pairs, expected at most %zu",
                           count, e->capacity);
    hnbrdf_prepare(e->model, material,
                   &prepared); /* the lobes that are guessed, as the exporter writes them */
    const hnbrdf_fitted fitted = fitted_of(material);
    for (size_t k = 0; k < count; k++) {
        float *to = e->packed + k * INPUTS;
        memcpy(to, pairs + 6 * k, 6 * sizeof *to);
        memcpy(to + AT_KD, material->kd, sizeof material->kd);
        memcpy(to + AT_ETA, material->eta, sizeof material->eta);
        memcpy(to + AT_ALPHA, material->alpha, sizeof material->alpha);
        to[AT_ROTATION] = prepared.cosine;
        to[AT_ROTATION + 1] = prepared.sine;
        memcpy(to + AT_LATENT, material->latent, sizeof material->latent);
        memcpy(to + AT_SCALE, prepared.lobes.scale, sizeof prepared.lobes.scale);
        memcpy(to + AT_SHARE, prepared.lobes.share, sizeof prepared.lobes.share);
        memcpy(to + AT_U, u + 2 * k, 2 * sizeof *to);
        memcpy(to + AT_FITTED, &fitted, sizeof fitted);
        to[AT_ENERGY] = prepared.energy.horizon;
        to[AT_ENERGY + 1] = prepared.energy.slope;
    }
    hnbrdf_result result =
        gpu_upload(e->device, &e->inputs, e->packed, count * INPUTS * sizeof(float), error);
    if (!result)
        result =
            gpu_dispatch(e->device, &e->program, e->pipelines[what], &push, count, 1, NULL, error);
    if (!result)
        result = gpu_download(e->device, &e->values, values, count * sizeof *values, error);
    return result;
}
