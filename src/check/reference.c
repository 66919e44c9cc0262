/* reference.c: what the C library says of a set of direction pairs. */
#include "check/reference.h"

#include "base/error.h"
#include "check/half.h"
#include "core/compose.h"
#include "core/encoding.h"
#include "core/prepared.h"

#include <stdlib.h>
#include <string.h>

const char *check_stage_name(check_stage stage)
{
    static const char *const names[CHECK_STAGES] = {"encoding",  "network", "analytic", "value",
                                                    "direction", "density", "weight"};
    return names[stage];
}

int check_stage_stride(check_stage stage)
{
    static const int strides[CHECK_STAGES] = {6, 6, 3, 3, 3, 2, 3};
    return strides[stage];
}

int check_stage_components(const hnbrdf_model_desc *desc, check_stage stage)
{
    switch (stage) {
    case CHECK_STAGE_ENCODING:
        return desc->kind == HNBRDF_KIND_GGX ? 0 : HNBRDF_ENCODING_SIZE;
    case CHECK_STAGE_NETWORK:
        return desc->kind == HNBRDF_KIND_GGX ? 0 : hnbrdf_layer_outputs(desc, desc->layers);
    case CHECK_STAGE_ANALYTIC:
        return desc->kind == HNBRDF_KIND_NEURAL ? 0 : 3;
    default:
        return check_stage_stride(stage);
    }
}

/* ---- Memory ---------------------------------------------------------------------------------- */

hnbrdf_result check_reference_open(size_t count, hnbrdf_glsl_precision precision,
                                   check_reference *reference, hnbrdf_error *error)
{
    memset(reference, 0, sizeof *reference);
    reference->precision = precision;
    reference->count = count;
    reference->pairs = calloc(count, 6 * sizeof(float));
    reference->u = calloc(count, 2 * sizeof(float));
    reference->classes = calloc(count, sizeof *reference->classes);
    int complete = reference->pairs && reference->u && reference->classes;
    for (int stage = 0; stage < CHECK_STAGES; stage++) {
        reference->stages[stage] =
            calloc(count, (size_t)check_stage_stride((check_stage)stage) * sizeof(float));
        complete = complete && reference->stages[stage];
    }
    if (complete)
        return HNBRDF_OK;
    check_reference_close(reference);
    return hnbrdf_fail(error, HNBRDF_ERROR_MEMORY, "verify: no memory for %zu pairs", count);
}

void check_reference_close(check_reference *reference)
{
    free(reference->pairs);
    free(reference->u);
    free(reference->classes);
    for (int stage = 0; stage < CHECK_STAGES; stage++)
        free(reference->stages[stage]);
    memset(reference, 0, sizeof *reference);
}

/* ---- Values ---------------------------------------------------------------------------------- */

void check_reference_eval(const hnbrdf_model *model, hnbrdf_glsl_precision precision,
                          const hnbrdf_material *material, const float wi[3], const float wo[3],
                          float f[3])
{
    if (precision == HNBRDF_GLSL_HALF)
        check_half_eval(model, material, wi, wo, f);
    else
        hnbrdf_eval(model, material, wi, wo, f);
}

static void encode(const hnbrdf_prepared *prepared, const float pair[6], float x[6])
{
    hnbrdf_pair p = hnbrdf_pair_in_frame(prepared, pair, pair + 3);
    hnbrdf_pair seen = hnbrdf_prepared_seen(prepared, &p);
    hnbrdf_encode(prepared->model->desc.encoding, &seen, x);
}

/* 0, the largest below 1, ends of quadrants, a tiny one; four of five are anything. */
static float draw_number(hnbrdf_rng *rng)
{
    static const float edges[] = {0.0f, 0x1.fffffep-1f, 0.25f, 0.75f, 0.125f, 0x1p-24f};
    uint32_t which = hnbrdf_rng_u32(rng);
    float any = hnbrdf_rng_float(rng);
    return which % 5 == 0 ? edges[which / 5 % 6] : any;
}

static void fill_sample(const hnbrdf_prepared *prepared, const hnbrdf_material *material, size_t k,
                        check_reference *reference)
{
    const float *pair = reference->pairs + 6 * k, *wo = pair + 3;
    float *wi = reference->stages[CHECK_STAGE_DIRECTION] + 3 * k, f[3];
    float *density = reference->stages[CHECK_STAGE_DENSITY] + 2 * k;
    float *weight = reference->stages[CHECK_STAGE_WEIGHT] + 3 * k;
    density[0] = hnbrdf_prepared_draw(prepared, wo, reference->u + 2 * k, wi);
    density[1] = hnbrdf_prepared_pdf(prepared, pair, wo);
    memset(weight, 0, 3 * sizeof *weight);
    if (!(density[0] > 0.0f))
        return;
    check_reference_eval(prepared->model, reference->precision, material, wi, wo, f);
    for (int c = 0; c < 3; c++)
        weight[c] = hnbrdf_finish(f[c] * wi[2] / density[0]);
}

static void fill_values(const hnbrdf_prepared *prepared, const hnbrdf_material *material, size_t k,
                        check_reference *reference)
{
    const hnbrdf_model *model = prepared->model;
    const float *pair = reference->pairs + 6 * k;
    if (model->desc.kind != HNBRDF_KIND_GGX) {
        float *encoded = reference->stages[CHECK_STAGE_ENCODING] + 6 * k;
        float *out = reference->stages[CHECK_STAGE_NETWORK] + 6 * k;
        encode(prepared, pair, encoded);
        if (reference->precision == HNBRDF_GLSL_HALF)
            check_half_network(&model->desc, material->latent, encoded, out);
        else
            hnbrdf_network(&model->desc, material->latent, encoded, out);
    }
    hnbrdf_eval_analytic(model, material, pair, pair + 3,
                         reference->stages[CHECK_STAGE_ANALYTIC] + 3 * k);
    check_reference_eval(model, reference->precision, material, pair, pair + 3,
                         reference->stages[CHECK_STAGE_VALUE] + 3 * k);
}

void check_reference_fill(const hnbrdf_model *model, const hnbrdf_material *material,
                          hnbrdf_rng *rng, check_reference *reference)
{
    hnbrdf_prepared prepared;
    hnbrdf_prepare_analytic(model, material, &prepared);
    hnbrdf_prepare_lobes(model, material, &prepared);
    float pair[6] = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f};
    for (size_t k = 0; k < reference->count; k++) {
        reference->classes[k] = check_pair_draw(rng, k, pair);
        memcpy(reference->pairs + 6 * k, pair, sizeof pair);
    }
    for (size_t k = 0; k < 2 * reference->count; k++)
        reference->u[k] = draw_number(rng);
    for (size_t k = 0; k < reference->count; k++) {
        fill_values(&prepared, material, k, reference);
        fill_sample(&prepared, material, k, reference);
    }
}
