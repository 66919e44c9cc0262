/* gpu_support.c: models with pseudo-random weights, and exported texts. */
#include "fitted_support.h"
#include "gpu_support.h"

#include "hnbrdf/measured.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stddef.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Uniform with this standard deviation. */
static float spread(hnbrdf_rng *rng, float deviation)
{
    return deviation * 1.7320508f * (2.0f * hnbrdf_rng_float(rng) - 1.0f);
}

/* He initialisation; correction bias -2, gate bias 1.5, as training starts. */
static void fill_network(hnbrdf_rng *rng, const scene_shape *shape, hnbrdf_model_desc *desc,
                         float *numbers)
{
    int outputs = shape->kind == HNBRDF_KIND_HYBRID ? 6 : 3;
    for (int layer = 0; layer <= shape->layers; layer++) {
        int in = layer == 0 ? 6 + shape->latent : shape->hidden;
        int out = layer < shape->layers ? shape->hidden : outputs;
        float deviation = sqrtf(2.0f / (float)in);
        desc->weights[layer] = numbers;
        for (int i = 0; i < in * out; i++)
            *numbers++ = spread(rng, deviation);
        desc->biases[layer] = numbers;
        for (int i = 0; i < out; i++)
            *numbers++ = spread(rng, 0.3f) + (layer < shape->layers ? 0.0f : i < 3 ? -2.0f : 1.5f);
    }
}

static void fill_materials(hnbrdf_rng *rng, const scene_shape *shape, hnbrdf_material *materials)
{
    static const float alphas[SCENE_MATERIALS] = {0.35f, 0.02f, 1e-4f};
    for (int m = 0; m < SCENE_MATERIALS; m++) {
        hnbrdf_material_init(&materials[m]);
        for (int c = 0; c < 3; c++) {
            materials[m].kd[c] = hnbrdf_rng_float(rng);
            materials[m].eta[c] = 1.001f + 2.0f * hnbrdf_rng_float(rng);
        }
        materials[m].alpha[0] = alphas[m];
        materials[m].alpha[1] = shape->anisotropic && m != 1 ? 0.7f * alphas[m] + 1e-4f : alphas[m];
        materials[m].rotation = shape->rotated && m != 1 ? spread(rng, 2.0f) : 0.0f;
        for (int i = 0; i < shape->latent; i++)
            materials[m].latent[i] = spread(rng, 1.0f);
    }
    /* Sampling in every way there is: guessed, two lobes that change with the view, the paper's. */
    materials[1].lobes =
        (hnbrdf_lobes){{0.6f, 4.0f}, {{0.1f, 0.5f, 0.3f, 0.6f}, {0.8f, 0.25f, 0.6f, 0.02f}}};
    hnbrdf_lobes_paper(&materials[2].lobes);
}

hnbrdf_model *scene_model(const scene_shape *shape)
{
    static const char *const names[SCENE_MATERIALS] = {"gold-paint", "blue fabric", "count"};
    static float numbers[4 * 64 * 65 + 64 * 32];
    hnbrdf_material materials[SCENE_MATERIALS];
    hnbrdf_model_desc desc = {.kind = shape->kind,
                              .encoding = shape->encoding,
                              .hidden = shape->hidden,
                              .layers = shape->layers,
                              .latent = shape->latent,
                              .scale = shape->scale,
                              .shift = shape->shift,
                              .floor = shape->floor,
                              .material_count = SCENE_MATERIALS,
                              .materials = materials,
                              .names = names};
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 7, (uint64_t)(shape->hidden * 8 + shape->layers));
    if (shape->kind != HNBRDF_KIND_GGX)
        fill_network(&rng, shape, &desc, numbers);
    fill_materials(&rng, shape, materials);
    for (int m = 1; m < SCENE_MATERIALS && shape->edited; m++) /* as if it had been another one */
        materials[m].fitted = as_fitted(materials[m - 1]).fitted;
    if (shape->edited)
        materials[1].energy = (hnbrdf_energy){0.3f, 1.5f};
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_model_create(&desc, NULL, &model, &error))
        fail_msg("%s", error.text);
    return model;
}

typedef struct growing_text {
    char *bytes;
    size_t size;
} growing_text;

static int append(void *user, const void *data, size_t size)
{
    growing_text *text = user;
    char *grown = realloc(text->bytes, text->size + size + 1);
    if (!grown)
        return 1;
    memcpy(grown + text->size, data, size);
    text->bytes = grown;
    text->size += size;
    grown[text->size] = '\0';
    return 0;
}

char *styled_text(const hnbrdf_model *model, const hnbrdf_glsl_options *options)
{
    growing_text text = {0};
    hnbrdf_error error = {""};
    if (hnbrdf_export_shader(model, options, append, &text, &error))
        fail_msg("%s", error.text);
    return text.bytes;
}

char *scene_text(const hnbrdf_model *model, int standalone)
{
    return styled_text(model, &(hnbrdf_glsl_options){.standalone = standalone});
}

float *scene_weights(const hnbrdf_model *model, const hnbrdf_glsl_options *options, size_t *size)
{
    growing_text bytes = {0};
    hnbrdf_error error = {""};
    if (hnbrdf_export_weights(model, options, append, &bytes, &error))
        fail_msg("%s", error.text);
    *size = bytes.size;
    return (float *)(void *)bytes.bytes;
}
