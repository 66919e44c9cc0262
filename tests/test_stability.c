/* test_stability.c: would `hnbrdf stability` notice? Implementations that are wrong on purpose,
 * in the ways such code has been wrong, against the same cases, and the library itself in the
 * short form. */
#include "check/stability.h"

#include "core/math.h"
#include "core_support.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static hnbrdf_result begin(stability_backend *backend, const hnbrdf_model *model,
                           hnbrdf_error *error)
{
    hnbrdf_model_desc desc;
    hnbrdf_model_describe(model, &desc);
    return hnbrdf_model_create(&desc, NULL, &backend->model, error);
}

static void end(stability_backend *backend)
{
    hnbrdf_model_free(backend->model);
}

/* D with 1 - (n.h)^2, as viewers write it. */
HNBRDF_DIVIDES_AS_IEEE
static float naive_analytic(const hnbrdf_material *m, const float *wi, const float *wo, int c)
{
    float s[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
    float length = sqrtf(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]), nh = s[2] / length,
          a = m->alpha[0];
    float t = nh * nh * (a * a - 1.0f) + 1.0f, d = a * a / (3.14159265f * t * t), v[2];
    for (int i = 0; i < 2; i++) {
        float z = i ? wo[2] : wi[2];
        v[i] = 1.0f / (z + sqrtf(z * z + a * a * (1.0f - z * z)));
    }
    float g2 = m->eta[c] * m->eta[c] - 1.0f, cosine = 0.5f * length,
          g = sqrtf(g2 + cosine * cosine);
    float p = (g - cosine) / (g + cosine),
          q = (cosine * (g + cosine) - 1.0f) / (cosine * (g - cosine) + 1.0f);
    return m->kd[c] * 0.318309886f + 0.5f * p * p * (1.0f + q * q) * d * v[0] * v[1];
}

enum { MISTAKE_NAIVE, MISTAKE_NAN, MISTAKE_NEGATIVE, MISTAKE_EPSILON, MISTAKE_PDF, MISTAKE_VALUE };

HNBRDF_DIVIDES_AS_IEEE /* 0/0 is one of the mistakes */
    static hnbrdf_result
    run(stability_backend *backend, stability_stage stage, const stability_block *block,
        float values[STABILITY_BLOCK][STABILITY_NUMBERS], hnbrdf_error *error)
{
    (void)error;
    for (int k = 0; k < STABILITY_BLOCK; k++) {
        const float *wi = block->pairs[k], *wo = wi + 3;
        hnbrdf_sample_result sample;
        hnbrdf_eval_analytic(backend->model, &block->material, wi, wo, values[k]);
        if (stage == STABILITY_VALUE)
            hnbrdf_eval(backend->model, &block->material, wi, wo, values[k]);
        int above = wi[2] > 0.0f && wo[2] > 0.0f;
        for (int c = 0; c < 3; c++) {
            if (backend->form == MISTAKE_NAIVE && above)
                values[k][c] = naive_analytic(&block->material, wi, wo, c);
            if (backend->form == MISTAKE_NAN)
                values[k][c] += 0.0f * (wi[2] / wi[2]); /* 0/0 at the horizon */
            if (backend->form == MISTAKE_NEGATIVE)
                values[k][c] -= 1e-6f;
            /* more than rounding in the network's sums can explain */
            if (backend->form == MISTAKE_VALUE)
                values[k][c] *= 1.00005f;
            if (backend->form == MISTAKE_EPSILON) /* + 1e-6 in a denominator of 4 wi.z wo.z */
                values[k][c] *= wi[2] * wo[2] / (wi[2] * wo[2] + 2.5e-7f);
        }
        if (stage == STABILITY_SAMPLE) {
            hnbrdf_sample(backend->model, &block->material, wo, block->u[k], &sample);
            memcpy(values[k], sample.wi, sizeof sample.wi);
            memcpy(values[k] + 3, sample.weight, sizeof sample.weight);
            values[k][6] = values[k][7] = sample.pdf;
            if (sample.pdf > 0.0f) /* of the pair exchanged */
                values[k][7] = hnbrdf_pdf(backend->model, &block->material, wo, sample.wi);
        }
    }
    return HNBRDF_OK;
}

static stability_row *rows_of(const hnbrdf_model *model, stability_backend *backends, int count)
{
    const stability_options options = {.blocks = 3};
    hnbrdf_error error = {""};
    stability_row *rows =
        calloc((size_t)(stability_case_count * count * STABILITY_STAGES), sizeof *rows);
    assert_non_null(rows);
    if (stability_run(model, &options, backends, count, rows, &error))
        fail_msg("%s", error.text);
    return rows;
}

static const stability_row *find(const stability_row *rows, const char *name, stability_stage stage)
{
    for (int k = 0; k < stability_case_count * STABILITY_STAGES; k++)
        if (strcmp(rows[k].what->name, name) == 0 && rows[k].stage == stage)
            return &rows[k];
    fail_msg("no case %s", name);
    return NULL;
}

static void mistakes_are_noticed_where_they_show(void **state)
{
    (void)state;
    rng r = rng_make(1);
    hnbrdf_model *model = random_model(&r, HNBRDF_KIND_HYBRID, HNBRDF_ENCODING_ANGLES, 12, 2, 4);
    static const struct {
        int mistake;
        stability_stage stage;
        const char *shows_in;
    } mistakes[] = {{MISTAKE_NAIVE, STABILITY_ANALYTIC, "alpha"},
                    {MISTAKE_NAIVE, STABILITY_ANALYTIC, "eta"},
                    {MISTAKE_NAN, STABILITY_ANALYTIC, "at-zero"},
                    {MISTAKE_NEGATIVE, STABILITY_ANALYTIC, "at-zero"},
                    {MISTAKE_EPSILON, STABILITY_ANALYTIC, "grazing"},
                    {MISTAKE_VALUE, STABILITY_VALUE, "ordinary"},
                    {MISTAKE_PDF, STABILITY_SAMPLE, "ordinary"}};
    for (size_t k = 0; k < sizeof mistakes / sizeof mistakes[0]; k++) {
        stability_backend wrong = {.name = "wrong",
                                   .stages = 1 << mistakes[k].stage,
                                   .loosen = 1.0,
                                   .loosen_value = 1.0,
                                   .begin = begin,
                                   .run = run,
                                   .end = end,
                                   .form = mistakes[k].mistake};
        stability_row *rows = rows_of(model, &wrong, 1);
        const stability_row *row = find(rows, mistakes[k].shows_in, mistakes[k].stage);
        assert_true(row->applies && row->values > 0);
        if (row->within)
            fail_msg("mistake %d is not noticed in %s", mistakes[k].mistake, mistakes[k].shows_in);
        free(rows);
    }
    hnbrdf_model_free(model);
}

/* Every kind and encoding: finite everywhere, the analytic part, pdf and samples within the bars.
 * (Of the value that is asked of trained networks, by the command's test: random ones have no
 * floor under them.) */
static void the_library_keeps_the_bars_in_every_kind_and_encoding(void **state)
{
    (void)state;
    rng r = rng_make(2);
    for (int k = 0; k < 6; k++) {
        hnbrdf_kind kind = k < 5 ? HNBRDF_KIND_HYBRID : HNBRDF_KIND_NEURAL;
        hnbrdf_model *model = random_model(&r, kind, (hnbrdf_encoding)(k % 5), 12, 2, 4);
        stability_backend backends[STABILITY_C_BACKENDS];
        int count = stability_c_backends(backends);
        stability_row *rows = rows_of(model, backends, count);
        double worst[2] = {0.0, 0.0};
        for (int i = 0; i < stability_case_count * count * STABILITY_STAGES; i++) {
            const stability_row *row = &rows[i];
            int value = row->stage == STABILITY_VALUE;
            int valid = row->not_finite + row->negative + row->inconsistent == 0;
            if (!valid || (!value && !row->within))
                fail_msg("encoding %d, %s, %s, %s: %zu not finite, %zu negative, %zu inconsistent, "
                         "%.3g of the bar",
                         k, row->what->name, row->backend, stability_stage_name(row->stage),
                         row->not_finite, row->negative, row->inconsistent, row->worst_share);
            int nearest = row->state == STABILITY_NEAREST;
            if (nearest && isfinite(row->bar) && row->what->demand == STABILITY_ACCURATE)
                worst[value] = fmax(worst[value], row->worst_scale);
            if (row->exact) /* every variant, however it is called, and in every state of the FPU */
                assert_int_equal(row->differs, 0);
        }
        print_message("    %s %s: worst %.2g, value %.2g\n", hnbrdf_kind_name(kind),
                      hnbrdf_encoding_name((hnbrdf_encoding)(k % 5)), worst[0], worst[1]);
        free(rows);
        hnbrdf_model_free(model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_are_noticed_where_they_show),
        cmocka_unit_test(the_library_keeps_the_bars_in_every_kind_and_encoding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
