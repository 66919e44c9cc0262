/* backends.c: the C library as it is called: singly, in batches, in every state the caller's FPU
 * may be in. */
#include "check/stability.h"

#include <fenv.h>
#include <stdio.h>
#include <string.h>

#if defined(__SSE__) || defined(__x86_64__)
#include <xmmintrin.h>
#define CAN_FLUSH 1
#else
#define CAN_FLUSH 0
#endif

/* Directed rounding errs by up to an ulp, not half of one, and always to the same side. */
#define DIRECTED 4.0

/* The rounding mode of <fenv.h>; -1 where there is none. */
static int rounding_of(stability_state state)
{
    switch (state) {
#ifdef FE_UPWARD
    case STABILITY_UP:
        return FE_UPWARD;
#endif
#ifdef FE_DOWNWARD
    case STABILITY_DOWN:
        return FE_DOWNWARD;
#endif
#ifdef FE_TOWARDZERO
    case STABILITY_TO_ZERO:
        return FE_TOWARDZERO;
#endif
    case STABILITY_NEAREST:
    case STABILITY_FLUSH:
        return FE_TONEAREST;
    default:
        return -1;
    }
}

static int can_be_in(stability_state state)
{
    return rounding_of(state) >= 0 && (state != STABILITY_FLUSH || CAN_FLUSH);
}

/* What the FPU is set to while the library runs, and only then. */
static unsigned enter(stability_state state)
{
    unsigned before = 0;
#if CAN_FLUSH
    const unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x40;
    before = _mm_getcsr();
    if (state == STABILITY_FLUSH)
        _mm_setcsr(before | flush_to_zero | denormals_are_zero);
#endif
    if (state != STABILITY_FLUSH)
        fesetround(rounding_of(state));
    return before;
}

static void leave(stability_state state, unsigned before)
{
    if (state != STABILITY_FLUSH)
        fesetround(FE_TONEAREST);
#if CAN_FLUSH
    _mm_setcsr(before);
#else
    (void)before;
#endif
}

/* How the library is called. Single calls are those a backend without a form makes. */
typedef enum call_form {
    FORM_SINGLE = 0,
    FORM_PREPARED, /* the material prepared once: value, pdf, sample */
    FORM_BATCH,    /* hnbrdf_eval_batch(), hnbrdf_eval_analytic_batch() */
    FORM_MANY,     /* hnbrdf_eval_many(): materials and pairs in an order of their own */
    FORMS
} call_form;

static void put_sample(const hnbrdf_sample_result *sample, float pdf,
                       float values[STABILITY_NUMBERS])
{
    memcpy(values, sample->wi, sizeof sample->wi);
    memcpy(values + 3, sample->weight, sizeof sample->weight);
    values[6] = sample->pdf;
    values[7] = pdf;
}

static void run_single(const hnbrdf_model *model, stability_stage stage,
                       const stability_block *block,
                       float values[STABILITY_BLOCK][STABILITY_NUMBERS])
{
    const hnbrdf_material *material = &block->material;
    for (int k = 0; k < STABILITY_BLOCK; k++) {
        const float *wi = block->pairs[k], *wo = wi + 3;
        hnbrdf_sample_result sample;
        if (stage == STABILITY_ANALYTIC)
            hnbrdf_eval_analytic(model, material, wi, wo, values[k]);
        else if (stage == STABILITY_VALUE)
            hnbrdf_eval(model, material, wi, wo, values[k]);
        else if (stage == STABILITY_PDF)
            values[k][0] = hnbrdf_pdf(model, material, wi, wo);
        else {
            hnbrdf_sample(model, material, wo, block->u[k], &sample);
            put_sample(&sample, hnbrdf_pdf(model, material, sample.wi, wo), values[k]);
        }
    }
}

static void run_prepared(const hnbrdf_model *model, stability_stage stage,
                         const stability_block *block,
                         float values[STABILITY_BLOCK][STABILITY_NUMBERS])
{
    hnbrdf_prepared prepared;
    hnbrdf_prepare(model, &block->material, &prepared);
    for (int k = 0; k < STABILITY_BLOCK; k++) {
        const float *wi = block->pairs[k], *wo = wi + 3;
        hnbrdf_sample_result sample;
        if (stage == STABILITY_VALUE)
            hnbrdf_prepared_eval(&prepared, wi, wo, values[k]);
        else if (stage == STABILITY_PDF)
            values[k][0] = hnbrdf_prepared_pdf(&prepared, wi, wo);
        else {
            hnbrdf_prepared_sample(&prepared, wo, block->u[k], &sample);
            put_sample(&sample, hnbrdf_prepared_pdf(&prepared, sample.wi, wo), values[k]);
        }
    }
}

static void run_batch(const hnbrdf_model *model, stability_stage stage,
                      const stability_block *block,
                      float values[STABILITY_BLOCK][STABILITY_NUMBERS])
{
    const size_t pair = sizeof block->pairs[0], value = sizeof values[0];
    const float *wi = block->pairs[0], *wo = wi + 3;
    if (stage == STABILITY_ANALYTIC)
        hnbrdf_eval_analytic_batch(model, &block->material, STABILITY_BLOCK, wi, pair, wo, pair,
                                   values[0], value);
    else
        hnbrdf_eval_batch(model, &block->material, STABILITY_BLOCK, wi, pair, wo, pair, values[0],
                          value);
}

/* Every third pair has another material beside it, so that lanes do not share theirs. */
static void run_many(const hnbrdf_model *model, const stability_block *block,
                     float values[STABILITY_BLOCK][STABILITY_NUMBERS])
{
    hnbrdf_material materials[2] = {block->material};
    int index[2 * STABILITY_BLOCK], from[2 * STABILITY_BLOCK], count = 0;
    float pairs[2 * STABILITY_BLOCK][6], f[2 * STABILITY_BLOCK][3];
    hnbrdf_material_init(&materials[1]);
    for (int k = 0; k < STABILITY_BLOCK; k++)
        for (int other = 0; other <= (k % 3 == 0); other++) {
            index[count] = other;
            from[count] = k;
            memcpy(pairs[count++], block->pairs[k], sizeof pairs[0]);
        }
    hnbrdf_eval_many(model, materials, index, (size_t)count, pairs[0], sizeof pairs[0],
                     pairs[0] + 3, sizeof pairs[0], f[0], sizeof f[0]);
    for (int k = 0; k < count; k++)
        if (index[k] == 0)
            memcpy(values[from[k]], f[k], sizeof f[0]);
}

static void end(stability_backend *backend)
{
    hnbrdf_model_free(backend->model);
    backend->model = NULL;
}

static hnbrdf_result begin(stability_backend *backend, const hnbrdf_model *model,
                           hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    desc.variant = (hnbrdf_variant)backend->variant;
    return hnbrdf_model_create(&desc, NULL, &backend->model, error);
}

static hnbrdf_result run(stability_backend *backend, stability_stage stage,
                         const stability_block *block,
                         float values[STABILITY_BLOCK][STABILITY_NUMBERS], hnbrdf_error *error)
{
    (void)error;
    unsigned before = enter(backend->state);
    switch ((call_form)backend->form) {
    case FORM_PREPARED:
        run_prepared(backend->model, stage, block, values);
        break;
    case FORM_BATCH:
        run_batch(backend->model, stage, block, values);
        break;
    case FORM_MANY:
        run_many(backend->model, block, values);
        break;
    default:
        run_single(backend->model, stage, block, values);
        break;
    }
    leave(backend->state, before);
    return HNBRDF_OK;
}

/* ---- The list -------------------------------------------------------------------------------- */

static const struct {
    const char *suffix;
    int stages;
} forms[FORMS] = {
    [FORM_SINGLE] = {"", (1 << STABILITY_STAGES) - 1},
    [FORM_PREPARED] = {", prepared",
                       1 << STABILITY_VALUE | 1 << STABILITY_PDF | 1 << STABILITY_SAMPLE},
    [FORM_BATCH] = {", batch", 1 << STABILITY_ANALYTIC | 1 << STABILITY_VALUE},
    [FORM_MANY] = {", many", 1 << STABILITY_VALUE},
};

static void add(stability_backend *backends, int *count, hnbrdf_variant variant, call_form form,
                stability_state state)
{
    static const char *const suffixes[STABILITY_STATES] = {
        "", ", rounding up", ", rounding down", ", rounding to zero", ", flushing subnormals"};
    stability_backend *b = &backends[(*count)++];
    double loosen = state == STABILITY_NEAREST || state == STABILITY_FLUSH ? 1.0 : DIRECTED;
    *b = (stability_backend){.stages = forms[form].stages,
                             .loosen = loosen,
                             .loosen_value = loosen,
                             .state = state,
                             .exact = 1,
                             .begin = begin,
                             .run = run,
                             .end = end,
                             .variant = (int)variant,
                             .form = (int)form};
    snprintf(b->name, sizeof b->name, "c %s%s%s", hnbrdf_variant_name(variant), forms[form].suffix,
             suffixes[state]);
}

int stability_c_backends(stability_backend backends[STABILITY_C_BACKENDS])
{
    int count = 0;
    hnbrdf_variant fastest = HNBRDF_VARIANT_PLAIN;
    for (int v = HNBRDF_VARIANT_PLAIN; hnbrdf_variant_name((hnbrdf_variant)v); v++) {
        if (!hnbrdf_variant_available((hnbrdf_variant)v) ||
            !hnbrdf_variant_is_exact((hnbrdf_variant)v))
            continue;
        fastest = (hnbrdf_variant)v;
        for (int f = 0; f < FORMS; f++)
            add(backends, &count, fastest, (call_form)f, STABILITY_NEAREST);
    }
    for (int state = STABILITY_NEAREST + 1; state < STABILITY_STATES; state++) {
        if (!can_be_in((stability_state)state))
            continue;
        add(backends, &count, HNBRDF_VARIANT_PLAIN, FORM_SINGLE, (stability_state)state);
        if (fastest != HNBRDF_VARIANT_PLAIN)
            add(backends, &count, fastest, FORM_BATCH, (stability_state)state);
    }
    return count;
}
