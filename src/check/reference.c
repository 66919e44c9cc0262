/* reference.c: what the C library says of a set of direction pairs, and how a device differs. */
#include "check/reference.h"

#include "core/encoding.h"
#include "base/error.h"
#include "core/prepared.h"
#include "check/half.h"

#include <stdlib.h>
#include <string.h>

const char *check_stage_name(check_stage stage)
{
    static const char *const names[CHECK_STAGES] = {"encoding", "network", "analytic", "value"};
    return names[stage];
}

int check_stage_stride(check_stage stage)
{
    return stage == CHECK_STAGE_ENCODING || stage == CHECK_STAGE_NETWORK ? 6 : 3;
}

/* Numbers a pair that mean something; 0: this kind of model has no such stage. */
static int stage_components(const hnbrdf_model_desc *desc, check_stage stage)
{
    switch (stage) {
    case CHECK_STAGE_ENCODING:
        return desc->kind == HNBRDF_KIND_GGX ? 0 : HNBRDF_ENCODING_SIZE;
    case CHECK_STAGE_NETWORK:
        return desc->kind == HNBRDF_KIND_GGX ? 0 : hnbrdf_layer_outputs(desc, desc->layers);
    case CHECK_STAGE_ANALYTIC:
        return desc->kind == HNBRDF_KIND_NEURAL ? 0 : 3;
    default:
        return 3;
    }
}

hnbrdf_result check_reference_open(size_t count, hnbrdf_glsl_precision precision,
                                   check_reference *reference, hnbrdf_error *error)
{
    memset(reference, 0, sizeof *reference);
    reference->precision = precision;
    reference->count = count;
    reference->pairs = calloc(count, 6 * sizeof(float));
    reference->classes = calloc(count, sizeof *reference->classes);
    int complete = reference->pairs && reference->classes;
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
    free(reference->classes);
    for (int stage = 0; stage < CHECK_STAGES; stage++)
        free(reference->stages[stage]);
    memset(reference, 0, sizeof *reference);
}

static void encode(const hnbrdf_prepared *prepared, const float pair[6], float x[6])
{
    hnbrdf_pair p = hnbrdf_pair_in_frame(prepared, pair, pair + 3);
    hnbrdf_pair seen = hnbrdf_prepared_seen(prepared, &p);
    hnbrdf_encode(prepared->model->desc.encoding, &seen, x);
}

void check_reference_fill(const hnbrdf_model *model, const hnbrdf_material *material,
                          hnbrdf_rng *rng, check_reference *reference)
{
    int half = reference->precision == HNBRDF_GLSL_HALF;
    void (*network)(const hnbrdf_model_desc *, const float *, const float *, float *) =
        half ? check_half_network : hnbrdf_network;
    void (*eval)(const hnbrdf_model *, const hnbrdf_material *, const float *, const float *,
                 float *) = half ? check_half_eval : hnbrdf_eval;
    hnbrdf_prepared prepared;
    hnbrdf_prepare_analytic(model, material, &prepared);
    float pair[6] = {0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.0f};
    for (size_t k = 0; k < reference->count; k++) {
        reference->classes[k] = check_pair_draw(rng, k, pair);
        memcpy(reference->pairs + 6 * k, pair, sizeof pair);
        if (model->desc.kind != HNBRDF_KIND_GGX) {
            float *encoded = reference->stages[CHECK_STAGE_ENCODING] + 6 * k;
            encode(&prepared, pair, encoded);
            network(&model->desc, material->latent, encoded,
                    reference->stages[CHECK_STAGE_NETWORK] + 6 * k);
        }
        hnbrdf_eval_analytic(model, material, pair, pair + 3,
                             reference->stages[CHECK_STAGE_ANALYTIC] + 3 * k);
        eval(model, material, pair, pair + 3, reference->stages[CHECK_STAGE_VALUE] + 3 * k);
    }
}

/* ---- Comparison ------------------------------------------------------------------------------ */

/* What errors are related to: see check_comparison. */
static double size_of(double reference, int must_be_value)
{
    return fmax(fabs(reference), must_be_value ? 0x1p-10 : 1.0);
}

static double spacing_of_floats(double size)
{
    float rounded = (float)size;
    return (double)(nextafterf(rounded, INFINITY) - rounded);
}

/* Is the first worth telling before the second? */
static int worse(int outside, double ulp, const check_comparison *so_far)
{
    if (so_far->outside > 0)
        return 0;
    return outside || ulp > so_far->worst_ulp;
}

static void compare_value(const check_place *place, int must_be_value, check_comparison *comparison)
{
    double device = (double)place->device, reference = (double)place->reference;
    int invalid = must_be_value && !(isfinite(place->device) && place->device >= 0.0f);
    int equal = device == reference || (isnan(device) && isnan(reference));
    if (!invalid && !(place->bound < (double)INFINITY)) {
        comparison->unbounded++;
        return;
    }
    double error = equal ? 0.0 : fabs(device - reference), size = size_of(reference, must_be_value);
    check_place here = *place;
    here.ulp = invalid || isnan(error) ? (double)INFINITY : error / spacing_of_floats(size);
    int outside = invalid || !(here.ulp == 0.0 || error <= here.bound);
    double share = here.ulp == 0.0 ? 0.0 : here.bound > 0.0 ? error / here.bound : (double)INFINITY;
    if (worse(outside, here.ulp, comparison))
        comparison->worst = here;
    comparison->values++;
    comparison->identical += equal && !invalid;
    comparison->outside += (size_t)outside;
    comparison->sum_ulp += here.ulp;
    comparison->worst_ulp = fmax(comparison->worst_ulp, here.ulp);
    double relative = isnan(error) ? (double)INFINITY : error / size;
    comparison->sum_relative += relative;
    comparison->worst_relative = fmax(comparison->worst_relative, relative);
    comparison->worst_share = fmax(comparison->worst_share, share);
}

void check_comparison_add(check_comparison *sum, const check_comparison *more)
{
    if (more->applies && (!sum->applies || worse(more->outside > 0, more->worst_ulp, sum)))
        sum->worst = more->worst;
    sum->applies |= more->applies;
    sum->values += more->values;
    sum->identical += more->identical;
    sum->outside += more->outside;
    sum->unbounded += more->unbounded;
    sum->sum_ulp += more->sum_ulp;
    sum->sum_relative += more->sum_relative;
    sum->worst_ulp = fmax(sum->worst_ulp, more->worst_ulp);
    sum->worst_relative = fmax(sum->worst_relative, more->worst_relative);
    sum->worst_share = fmax(sum->worst_share, more->worst_share);
}

static const check_tracked *stage_bounds(const check_bounds *bounds, int stage)
{
    const check_tracked *const stages[CHECK_STAGES] = {bounds->encoding, bounds->fed,
                                                       bounds->analytic, bounds->value};
    return stages[stage];
}

/* Every operation of this build gives C's bits: so does every stage then, and no bound is
 * derived. */
static int repeats_all(const check_rules *rules, hnbrdf_glsl_precision precision)
{
    return (precision == HNBRDF_GLSL_FLOAT || rules->repeats_half) && rules->repeats_basic &&
           rules->repeats_divide && rules->repeats_sqrt && rules->repeats_functions &&
           rules->tiny == 0.0;
}

static int same_bits(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0 || a == b || (a != a && b != b);
}

hnbrdf_result check_compare(const check_rules *rules, const hnbrdf_model *model,
                            const hnbrdf_material *material, const check_reference *reference,
                            const float *const device[CHECK_STAGES],
                            check_comparison comparisons[CHECK_STAGES], hnbrdf_error *error)
{
    const hnbrdf_model_desc *desc = &model->desc;
    memset(comparisons, 0, CHECK_STAGES * sizeof *comparisons);
    for (size_t k = 0; k < reference->count; k++) {
        const float *pair = reference->pairs + 6 * k;
        check_place place = {.class_of_pair = reference->classes[k]};
        memcpy(place.pair, pair, sizeof place.pair);
        int finite = place.class_of_pair != CHECK_PAIR_NOT_FINITE;
        int above = pair[2] > 0.0f && pair[5] > 0.0f;
        int derived = finite && above && !repeats_all(rules, reference->precision);
        check_bounds bounds;
        if (derived)
            check_bounds_make(rules, desc, reference->precision, material, pair, pair + 3, &bounds);
        for (int stage = 0; stage < CHECK_STAGES; stage++) {
            int components = stage_components(desc, (check_stage)stage);
            int must_be_value = stage == CHECK_STAGE_ANALYTIC || stage == CHECK_STAGE_VALUE;
            size_t first = k * (size_t)check_stage_stride((check_stage)stage);
            comparisons[stage].applies = components > 0;
            for (int c = 0; c < components; c++) {
                place.component = c;
                place.device = device[stage][first + (size_t)c];
                place.reference = reference->stages[stage][first + (size_t)c];
                /* Below the horizon f is 0 on every device; the other stages do not matter there.
                 * */
                place.bound = finite && (above ? 1 : must_be_value) ? 0.0 : (double)INFINITY;
                if (derived) {
                    check_tracked tracked = stage_bounds(&bounds, stage)[c];
                    place.bound = tracked.e;
                    if (!same_bits(tracked.v, place.reference))
                        return hnbrdf_fail(
                            error, HNBRDF_ERROR_FORMAT,
                            "verify: %s[%d] is %.9g in C but %.9g where its bound is derived",
                            check_stage_name((check_stage)stage), c, (double)place.reference,
                            (double)tracked.v);
                }
                compare_value(&place, must_be_value, &comparisons[stage]);
            }
        }
    }
    return HNBRDF_OK;
}
