/* compare.c: what a device returned for the pairs of a reference, beside C and the bounds. */
#include "check/compare.h"

#include "base/error.h"
#include "check/bounds_draw.h"
#include "core/compose.h"
#include "core/prepared.h"
#include "check/tracked.h"

#include <math.h>
#include <string.h>

typedef struct comparer {
    const check_rules *rules;
    const hnbrdf_model *model;
    const hnbrdf_material *material;
    const check_reference *reference;
    const float *const *device;
    check_comparison *comparisons;
    hnbrdf_prepared prepared;
    int repeats; /* every operation gives C's bits: so does every stage, and no bound is derived */
    hnbrdf_error *error;
} comparer;

static int repeats_all(const check_rules *rules, hnbrdf_glsl_precision precision)
{
    return (precision == HNBRDF_GLSL_FLOAT || rules->repeats_half) && rules->repeats_basic &&
           rules->repeats_divide && rules->repeats_sqrt && rules->repeats_functions &&
           rules->tiny == 0.0;
}

/* Every way to be no number, and both zeros, count as one. */
static int same_bits(float a, float b)
{
    return a == b || (a != a && b != b);
}

static const float *device_at(const comparer *c, check_stage stage, size_t k)
{
    return c->device[stage] + k * (size_t)check_stage_stride(stage);
}

static const float *reference_at(const comparer *c, check_stage stage, size_t k)
{
    return c->reference->stages[stage] + k * (size_t)check_stage_stride(stage);
}

/* One number; derived is NULL where place->bound holds as it is. */
static hnbrdf_result take(comparer *c, check_stage stage, const check_tracked *derived,
                          check_number_kind number, check_place *place)
{
    if (derived) {
        place->bound = derived->e;
        if (!same_bits(derived->v, place->reference))
            return hnbrdf_fail(c->error, HNBRDF_ERROR_FORMAT,
                               "verify: %s[%d] is %.9g in C but %.9g where its bound is derived",
                               check_stage_name(stage), place->component, (double)place->reference,
                               (double)derived->v);
    }
    check_comparison_take(&c->comparisons[stage], place, number);
    return HNBRDF_OK;
}

/* ---- What the pair gives --------------------------------------------------------------------- */

static const check_tracked *stage_bounds(const check_bounds *bounds, check_stage stage)
{
    return stage == CHECK_STAGE_ENCODING   ? bounds->encoding
           : stage == CHECK_STAGE_NETWORK  ? bounds->fed
           : stage == CHECK_STAGE_ANALYTIC ? bounds->analytic
                                           : bounds->value;
}

static hnbrdf_result compare_values(comparer *c, size_t k, check_place place)
{
    const float *w = place.pair;
    int finite = place.class_of_pair != CHECK_PAIR_NOT_FINITE;
    int above = w[2] > 0.0f && w[5] > 0.0f, derived = finite && above && !c->repeats;
    hnbrdf_result result = HNBRDF_OK;
    check_bounds bounds;
    if (derived)
        check_bounds_make(c->rules, &c->model->desc, c->reference->precision, c->material, w, w + 3,
                          0.0, &bounds);
    for (int s = CHECK_STAGE_ENCODING; s <= CHECK_STAGE_VALUE; s++) {
        const check_stage stage = (check_stage)s;
        int is_value = stage == CHECK_STAGE_ANALYTIC || stage == CHECK_STAGE_VALUE;
        for (int i = 0; i < check_stage_components(&c->model->desc, stage) && !result; i++) {
            place.component = i;
            place.device = device_at(c, stage, k)[i];
            place.reference = reference_at(c, stage, k)[i];
            /* Below the horizon f is 0 on every device; the other stages do not matter there. */
            place.bound = finite && (above ? 1 : is_value) ? 0.0 : (double)INFINITY;
            result = take(c, stage, derived ? &stage_bounds(&bounds, stage)[i] : NULL,
                          is_value ? CHECK_NUMBER_VALUE : CHECK_NUMBER_ANY, &place);
        }
    }
    return result;
}

/* hnbrdf_pdf() of the wi of the pair. */
static hnbrdf_result compare_density(comparer *c, size_t k, check_place place)
{
    const float *w = place.pair;
    int finite = place.class_of_pair != CHECK_PAIR_NOT_FINITE;
    int derived = finite && w[2] > 0.0f && w[5] > 0.0f && !c->repeats;
    check_tracked density;
    if (derived)
        density = check_density_make(c->rules, &c->prepared, w, w + 3, 0.0);
    place.component = 1;
    place.device = device_at(c, CHECK_STAGE_DENSITY, k)[1];
    place.reference = reference_at(c, CHECK_STAGE_DENSITY, k)[1];
    place.bound = finite ? 0.0 : (double)INFINITY;
    return take(c, CHECK_STAGE_DENSITY, derived ? &density : NULL, CHECK_NUMBER_VALUE, &place);
}

/* ---- What is drawn --------------------------------------------------------------------------- */

/* The direction. *bound: whether a device may have another one. */
static hnbrdf_result compare_direction(comparer *c, size_t k, check_place place, double *bound)
{
    const float *wo = place.pair + 3;
    int finite = place.class_of_pair != CHECK_PAIR_NOT_FINITE;
    int derived = finite && wo[2] > 0.0f && !c->repeats;
    check_tracked wi[3];
    hnbrdf_result result = HNBRDF_OK;
    if (derived)
        check_draw_make(c->rules, &c->prepared, wo, c->reference->u + 2 * k, wi);
    *bound = 0.0;
    for (int i = 0; i < 3 && !result; i++) {
        place.component = i;
        place.device = device_at(c, CHECK_STAGE_DIRECTION, k)[i];
        place.reference = reference_at(c, CHECK_STAGE_DIRECTION, k)[i];
        place.bound = finite ? 0.0 : (double)INFINITY;
        result =
            take(c, CHECK_STAGE_DIRECTION, derived ? &wi[i] : NULL, CHECK_NUMBER_FINITE, &place);
        *bound = fmax(*bound, place.bound);
    }
    return result;
}

/* Nothing was drawn: C draws nothing either, or may; the weight is 0 and the direction the normal.
 */
static hnbrdf_result compare_nothing(comparer *c, size_t k, check_place place, double bound)
{
    place.device = device_at(c, CHECK_STAGE_DENSITY, k)[0];
    place.reference = reference_at(c, CHECK_STAGE_DENSITY, k)[0];
    place.bound = bound == (double)INFINITY ? bound : 0.0;
    check_comparison_take(&c->comparisons[CHECK_STAGE_DENSITY], &place, CHECK_NUMBER_VALUE);
    int finite = place.class_of_pair != CHECK_PAIR_NOT_FINITE;
    for (int i = 0; i < 3; i++) {
        place.component = i;
        place.device = device_at(c, CHECK_STAGE_WEIGHT, k)[i];
        place.reference = 0.0f;
        place.bound = finite ? 0.0 : (double)INFINITY;
        check_comparison_take(&c->comparisons[CHECK_STAGE_WEIGHT], &place, CHECK_NUMBER_VALUE);
    }
    return HNBRDF_OK;
}

/* f wi.z / density */
static check_tracked weigh(const check_rules *k, check_tracked f, float z, check_tracked density)
{
    num weight = divide(k, multiply(k, f, given(k, z)), density);
    return clamp(weight, 0.0f, HNBRDF_MAX_VALUE);
}

/* The direction is what the shader made, k h - wo, with up to three more roundings where it is
 * turned back; where its operations may be ordered anew, its sum with wo and the difference need
 * not be those of the rounded one. */
static double drift_of(const check_rules *rules, const float w[6])
{
    double size = 0.0;
    for (int i = 0; i < 6; i++)
        size += fabs((double)w[i]);
    return rules->repeats_basic ? 0.0 : 4 * rules->basic * size;
}

/* Density and weight of the direction that the device drew, which is in place.pair. */
static hnbrdf_result compare_drawn(comparer *c, size_t k, check_place place)
{
    const float *wi = place.pair, *wo = place.pair + 3;
    int finite = place.class_of_pair != CHECK_PAIR_NOT_FINITE && isfinite(wi[0] + wi[1] + wi[2]);
    int derived = finite && wi[2] > 0.0f && wo[2] > 0.0f && !c->repeats;
    check_tracked density = {0.0f, 0.0}, weights[3] = {{0.0f, 0.0}};
    float f[3];
    place.device = device_at(c, CHECK_STAGE_DENSITY, k)[0];
    place.reference = hnbrdf_prepared_pdf(&c->prepared, wi, wo);
    check_reference_eval(c->model, c->reference->precision, c->material, wi, wo, f);
    if (derived) {
        const double drift = drift_of(c->rules, place.pair);
        check_bounds bounds;
        check_bounds_make(c->rules, &c->model->desc, c->reference->precision, c->material, wi, wo,
                          drift, &bounds);
        density = check_density_make(c->rules, &c->prepared, wi, wo, drift);
        for (int i = 0; i < 3; i++)
            weights[i] = weigh(c->rules, bounds.value[i], wi[2], density);
    }
    float pdf = place.reference;
    place.bound = finite ? 0.0 : (double)INFINITY;
    hnbrdf_result result =
        take(c, CHECK_STAGE_DENSITY, derived ? &density : NULL, CHECK_NUMBER_VALUE, &place);
    for (int i = 0; i < 3 && !result; i++) {
        place.component = i;
        place.device = device_at(c, CHECK_STAGE_WEIGHT, k)[i];
        place.reference = pdf > 0.0f ? hnbrdf_finish(f[i] * wi[2] / pdf) : 0.0f;
        place.bound = finite ? 0.0 : (double)INFINITY;
        result = take(c, CHECK_STAGE_WEIGHT, derived && pdf > 0.0f ? &weights[i] : NULL,
                      CHECK_NUMBER_VALUE, &place);
    }
    return result;
}

static hnbrdf_result compare_sample(comparer *c, size_t k, check_place place)
{
    double bound;
    hnbrdf_result result = compare_direction(c, k, place, &bound);
    if (result)
        return result;
    memcpy(place.pair, device_at(c, CHECK_STAGE_DIRECTION, k), 3 * sizeof(float));
    return device_at(c, CHECK_STAGE_DENSITY, k)[0] == 0.0f ? compare_nothing(c, k, place, bound)
                                                           : compare_drawn(c, k, place);
}

/* ---- All of it ------------------------------------------------------------------------------- */

hnbrdf_result check_compare(const check_rules *rules, const hnbrdf_model *model,
                            const hnbrdf_material *material, const check_reference *reference,
                            const float *const device[CHECK_STAGES],
                            check_comparison comparisons[CHECK_STAGES], hnbrdf_error *error)
{
    comparer c = {.rules = rules,
                  .model = model,
                  .material = material,
                  .reference = reference,
                  .device = device,
                  .comparisons = comparisons,
                  .repeats = repeats_all(rules, reference->precision),
                  .error = error};
    hnbrdf_result result = HNBRDF_OK;
    hnbrdf_prepare_analytic(model, material, &c.prepared);
    hnbrdf_prepare_lobes(model, material, &c.prepared);
    memset(comparisons, 0, CHECK_STAGES * sizeof *comparisons);
    for (int stage = 0; stage < CHECK_STAGES; stage++)
        comparisons[stage].applies = check_stage_components(&model->desc, (check_stage)stage) > 0;
    for (size_t k = 0; k < reference->count && !result; k++) {
        check_place place = {.class_of_pair = reference->classes[k]};
        memcpy(place.pair, reference->pairs + 6 * k, sizeof place.pair);
        result = compare_values(&c, k, place);
        if (!result)
            result = compare_density(&c, k, place);
        if (!result)
            result = compare_sample(&c, k, place);
    }
    return result;
}
