/* variants_sweep.c: models, materials and directions that are the same on every machine. */
#include "variants_sweep.h"

#include "core/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

uint32_t sweep_u32(sweep *s)
{
    s->state ^= s->state >> 12;
    s->state ^= s->state << 25;
    s->state ^= s->state >> 27;
    return (uint32_t)((s->state * 0x2545f4914f6cdd1du) >> 32);
}

float sweep_unit(sweep *s)
{
    return (float)(sweep_u32(s) >> 8) * 0x1p-24f;
}

float sweep_range(sweep *s, float low, float high)
{
    return low + (high - low) * sweep_unit(s);
}

static void unit_vector(sweep *s, float w[3])
{
    float length2 = 0.0f;
    while (!(length2 > 0.01f && length2 <= 1.0f)) {
        w[0] = sweep_range(s, -1.0f, 1.0f);
        w[1] = sweep_range(s, -1.0f, 1.0f);
        w[2] = sweep_unit(s);
        length2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    }
    for (int k = 0; k < 3; k++)
        w[k] /= sqrtf(length2);
}

void sweep_pair(sweep *s, float wi[3], float wo[3])
{
    static const float odd[] = {0.0f,           -0.0f,     -0.5f, 1e-7f, 1e-42f,
                                1.1754944e-38f, 1e-20f,    2.0f,  1e18f, 3e38f,
                                INFINITY,       -INFINITY, NAN,   1.0f,  1e-3f};
    unit_vector(s, wi);
    unit_vector(s, wo);
    uint32_t choice = sweep_u32(s) % 32;
    float *w = choice & 1 ? wi : wo;
    if (choice < 4)
        w[sweep_u32(s) % 3] = odd[sweep_u32(s) % (sizeof odd / sizeof odd[0])];
    else if (choice < 6)
        w[2] = odd[sweep_u32(s) % (sizeof odd / sizeof odd[0])];
    else if (choice < 8) /* the mirror, off by little */
        for (int k = 0; k < 3; k++)
            wi[k] = k < 2 ? sweep_range(s, -1e-4f, 1e-4f) - wo[k] : wo[k];
    else if (choice == 8)
        for (int k = 0; k < 3; k++)
            wi[k] = wo[k];
}

void sweep_material(sweep *s, int wild, hnbrdf_material *material)
{
    static const float alphas[] = {1e-4f, 1e-3f, 0.01f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f};
    static const float odd[] = {0.0f, -0.0f, -1.0f, 1e-42f, 1e30f, INFINITY, -INFINITY, NAN};
    for (int c = 0; c < 3; c++) {
        material->kd[c] = sweep_unit(s);
        material->eta[c] = sweep_u32(s) % 8 ? sweep_range(s, 1.05f, 4.0f) : 1.0f + 0x1p-23f;
    }
    for (int k = 0; k < 2; k++)
        material->alpha[k] = alphas[sweep_u32(s) % 8];
    material->rotation = sweep_u32(s) % 2 ? 0.0f : sweep_range(s, -3.0f, 3.0f);
    for (int i = 0; i < HNBRDF_MAX_LATENT; i++)
        material->latent[i] = sweep_range(s, -1.5f, 1.5f);
    memset(&material->lobes, 0, sizeof material->lobes);
    memset(&material->fitted, 0, sizeof material->fitted);
    memset(&material->energy, 0, sizeof material->energy);
    for (int k = 0; k < HNBRDF_LOBES && sweep_u32(s) % 2; k++) {
        material->lobes.scale[k] = (sweep_u32(s) % 4 ? 1.0f : -1.0f) * sweep_range(s, 0.01f, 3.0f);
        for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
            material->lobes.share[k][j] = sweep_range(s, 0.0f, 1.0f - material->lobes.share[0][j]);
    }
    if (wild && sweep_u32(s) % 4 == 0)
        ((float *)material)[sweep_u32(s) % (offsetof(hnbrdf_material, fitted) / sizeof(float))] =
            odd[sweep_u32(s) % 8];
}

hnbrdf_model *sweep_model(sweep *s, hnbrdf_kind kind, hnbrdf_encoding encoding, int hidden,
                          int layers, int latent)
{
    static float weights[HNBRDF_MAX_LAYERS + 1][HNBRDF_MAX_HIDDEN * HNBRDF_MAX_HIDDEN];
    static float biases[HNBRDF_MAX_LAYERS + 1][HNBRDF_MAX_HIDDEN];
    static const char *const names[] = {"a", "b"};
    hnbrdf_material materials[2];
    hnbrdf_model_desc desc = {
        .kind = kind, .material_count = 2, .materials = materials, .names = names};
    for (int i = 0; i < 2; i++)
        sweep_material(s, 0, &materials[i]);
    if (kind != HNBRDF_KIND_GGX) {
        desc.encoding = encoding;
        desc.hidden = hidden;
        desc.layers = layers;
        desc.latent = latent;
        desc.scale = 0.75f;
        desc.shift = -0.5f;
        desc.floor = 0.002f;
        for (int k = 0; k <= layers; k++) {
            int inputs = hnbrdf_layer_inputs(&desc, k), outputs = hnbrdf_layer_outputs(&desc, k);
            float size = 2.0f / sqrtf((float)inputs);
            for (int i = 0; i < inputs * outputs; i++)
                weights[k][i] = sweep_range(s, -size, size);
            for (int i = 0; i < outputs; i++)
                biases[k][i] = i % 5 == 0 ? -0.0f : sweep_range(s, -0.5f, 0.5f);
            desc.weights[k] = weights[k];
            desc.biases[k] = biases[k];
        }
    }
    desc.variant = HNBRDF_VARIANT_PLAIN;
    hnbrdf_model *model = NULL;
    return hnbrdf_model_create(&desc, NULL, &model, NULL) ? NULL : model;
}

hnbrdf_model *sweep_variant(const hnbrdf_model *model, hnbrdf_variant variant)
{
    hnbrdf_model_desc desc;
    hnbrdf_model *made = NULL;
    hnbrdf_model_describe(model, &desc);
    desc.variant = variant;
    return hnbrdf_model_create(&desc, NULL, &made, NULL) ? NULL : made;
}
