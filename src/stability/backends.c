/* backends.c: the C library as it is called: singly, in batches, in every state the caller's FPU may be
 * in. */
#include "stability/stability.h"

#include <fenv.h>
#include <stdio.h>
#include <string.h>

#if defined(__SSE__) || defined(__x86_64__)
#include <xmmintrin.h>
#define CAN_FLUSH 1
#else
#define CAN_FLUSH 0
#endif

/* What the FPU is set to while the library runs, and only then. */
enum { MODE_FLUSH = -1 }; /* otherwise a rounding mode of <fenv.h> */

/* Directed rounding errs by up to an ulp, not half of one, and always to the same side. */
#define DIRECTED 4.0

static unsigned enter(int mode)
{
    unsigned before = 0;
#if CAN_FLUSH
    const unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x40;
    before = _mm_getcsr();
    if (mode == MODE_FLUSH)
        _mm_setcsr(before | flush_to_zero | denormals_are_zero);
#endif
    if (mode != MODE_FLUSH)
        fesetround(mode);
    return before;
}

static void leave(int mode, unsigned before)
{
    if (mode != MODE_FLUSH)
        fesetround(FE_TONEAREST);
#if CAN_FLUSH
    _mm_setcsr(before);
#else
    (void)before;
#endif
}

static void evaluate(const hnbrdf_model *model, stability_stage stage, const hnbrdf_material *material,
                     const float pair[6], const float u[3], float values[STABILITY_NUMBERS])
{
    hnbrdf_sample_result sample;
    switch (stage) {
    case STABILITY_ANALYTIC:
        hnbrdf_eval_analytic(model, material, pair, pair + 3, values);
        break;
    case STABILITY_VALUE:
        hnbrdf_eval(model, material, pair, pair + 3, values);
        break;
    case STABILITY_PDF:
        values[0] = hnbrdf_pdf(model, material, pair, pair + 3);
        break;
    case STABILITY_SAMPLE:
    default:
        hnbrdf_sample(model, material, pair + 3, u, &sample);
        memcpy(values, sample.wi, sizeof sample.wi);
        memcpy(values + 3, sample.weight, sizeof sample.weight);
        values[6] = sample.pdf;
        values[7] = hnbrdf_pdf(model, material, sample.wi, pair + 3);
        break;
    }
}

static hnbrdf_result begin(stability_backend *backend, const hnbrdf_model *model, hnbrdf_error *error)
{
    (void)error;
    backend->model = model;
    return HNBRDF_OK;
}

static hnbrdf_result run_single(stability_backend *backend, stability_stage stage,
                                const stability_block *block,
                                float values[STABILITY_BLOCK][STABILITY_NUMBERS], hnbrdf_error *error)
{
    (void)error;
    unsigned before = enter(backend->mode);
    for (int k = 0; k < STABILITY_BLOCK; k++)
        evaluate(backend->model, stage, &block->material, block->pairs[k], block->u[k], values[k]);
    leave(backend->mode, before);
    return HNBRDF_OK;
}

static hnbrdf_result run_batch(stability_backend *backend, stability_stage stage,
                               const stability_block *block,
                               float values[STABILITY_BLOCK][STABILITY_NUMBERS], hnbrdf_error *error)
{
    (void)stage;
    (void)error;
    hnbrdf_eval_batch(backend->model, &block->material, STABILITY_BLOCK, block->pairs[0],
                      sizeof block->pairs[0], block->pairs[0] + 3, sizeof block->pairs[0], values[0],
                      sizeof values[0]);
    return HNBRDF_OK;
}

int stability_c_backends(stability_backend backends[STABILITY_C_BACKENDS])
{
    static const struct {
        const char *name;
        int mode;
        double loosen;
    } modes[] = {
        {"c", FE_TONEAREST, 1.0},
#ifdef FE_UPWARD
        {"c, rounding up", FE_UPWARD, DIRECTED},
#endif
#ifdef FE_DOWNWARD
        {"c, rounding down", FE_DOWNWARD, DIRECTED},
#endif
#ifdef FE_TOWARDZERO
        {"c, rounding to zero", FE_TOWARDZERO, DIRECTED},
#endif
#if CAN_FLUSH
        {"c, subnormals flushed", MODE_FLUSH, 1.0},
#endif
    };
    int count = 0;
    for (size_t k = 0; k < sizeof modes / sizeof modes[0]; k++) {
        stability_backend single = {.stages = (1 << STABILITY_STAGES) - 1,
                                    .loosen = modes[k].loosen,
                                    .begin = begin,
                                    .run = run_single,
                                    .mode = modes[k].mode};
        snprintf(single.name, sizeof single.name, "%s", modes[k].name);
        backends[count++] = single;
        if (k > 0)
            continue;
        stability_backend batch = {.name = "c-batch",
                                   .stages = 1 << STABILITY_VALUE,
                                   .loosen = 1.0,
                                   .begin = begin,
                                   .run = run_batch};
        backends[count++] = batch;
    }
    return count;
}
