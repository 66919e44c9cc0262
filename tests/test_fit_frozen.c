/* test_fit_frozen.c: the search for the latent code of a new material on a network that stays. */
#include "sanitized.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "fit/frozen.h"
#include "hnbrdf/fit.h"
#include "hnbrdf/metrics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KNOWN = 4, LATENT = 5, POOL = SANITIZED ? 2048 : 8192 };
static const char path[] = "test_fit_frozen.bin";
static hnbrdf_measured *data[KNOWN];
static hnbrdf_model *known;

static int make_known(void **state)
{
    (void)state;
    hnbrdf_fit_options o = {.hidden = 16, .latent = LATENT, .steps = 400, .pool = 8192, .seed = 2};
    for (int m = 0; m < KNOWN; m++)
        if (hnbrdf_measured_open_builtin(2 * m, &data[m], NULL))
            return -1;
    return (int)hnbrdf_fit((const hnbrdf_measured *const *)data, KNOWN - 1, &o, &known, NULL, NULL);
}

static int free_known(void **state)
{
    (void)state;
    for (int m = 0; m < KNOWN; m++)
        hnbrdf_measured_close(data[m]);
    hnbrdf_model_free(known);
    remove(path);
    return 0;
}

static hnbrdf_model *fit(const hnbrdf_measured *of, const hnbrdf_fit_options *o,
                         hnbrdf_fit_report *report)
{
    hnbrdf_model *model = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_fit(&of, 1, o, &model, report, &error))
        fail_msg("%s", error.text);
    return model;
}

/* ---- Codes that there are -------------------------------------------------------------------- */

static int values_of_prepared(const void *prepared, const float wi[3], const float wo[3],
                              float f[3])
{
    hnbrdf_prepared_eval(prepared, wi, wo, f);
    return 1;
}

/* Values of the network itself with a code that no known material has, once nearly that of one and
 * once far from all: found so well that the pairs differ by
 * four thousandths. */
static void a_code_that_made_the_data_is_found(void **state)
{
    (void)state;
    for (int far = 0; far < 2; far++) {
        hnbrdf_material hidden = *hnbrdf_model_material(known, 0);
        const float *other = hnbrdf_model_material(known, 1)->latent;
        for (int j = 0; j < LATENT; j++)
            hidden.latent[j] += (far ? 0.5f : 0.1f) * (other[j] - hidden.latent[j]);
        hnbrdf_prepared prepared;
        hnbrdf_prepare(known, &hidden, &prepared);
        const hnbrdf_measured_custom description = {.name = "hidden",
                                                    .isotropic = 1,
                                                    .eval = values_of_prepared,
                                                    .user = (void *)(uintptr_t)&prepared};
        hnbrdf_measured *made = NULL;
        assert_int_equal(hnbrdf_measured_create_custom(&description, &made, NULL), HNBRDF_OK);
        hnbrdf_fit_worth worth;
        hnbrdf_fit_report report;
        hnbrdf_fit_options o = {
            .freeze = known, .pool = POOL, .lobes_none = 1, .materials = &hidden, .worth = &worth};
        hnbrdf_model *model = fit(made, &o, &report);
        print_message("%s: SMAPE %.2g, loss %.2g\n", far ? "far" : "near", worth.smape,
                      report.best_loss);
        assert_true(report.best_loss < 4e-3);
        assert_true(worth.smape < 4e-3 && !worth.worse);
        hnbrdf_model_free(model);
        hnbrdf_measured_close(made);
    }
}

/* ---- Steps ----------------------------------------------------------------------------------- */

static void expect_same(const hnbrdf_model *found, const hnbrdf_model *wanted)
{
    assert_memory_equal(hnbrdf_model_material(found, 0), hnbrdf_model_material(wanted, 0),
                        sizeof(hnbrdf_material));
}

static int stop_at(void *user, const hnbrdf_fit_progress *p)
{
    return strcmp(p->stage, "network") == 0 && p->step >= *(const long *)user;
}

/* In each phase, with kd, eta and alpha and without them: it ends as if it had not been. */
static void a_search_that_was_interrupted_ends_the_same(void **state)
{
    (void)state;
    for (int joint = 0; joint < 2; joint++) {
        hnbrdf_fit_report report;
        hnbrdf_fit_options o = {.freeze = known,
                                .pool = SANITIZED ? 1024 : 4096,
                                .steps = 20,
                                .analytic = joint ? HNBRDF_FIT_JOINT : HNBRDF_FIT_FAITHFUL};
        hnbrdf_model *wanted = fit(data[KNOWN - 1], &o, &report);
        assert_int_equal(report.steps, 20);
        const double loss = report.best_loss;
        for (long at = 3; at < 20; at += 7) {
            o.checkpoint = path;
            o.progress = stop_at;
            o.progress_user = &at;
            hnbrdf_model_free(fit(data[KNOWN - 1], &o, &report));
            assert_true(report.stopped && report.steps >= at && report.steps < 20);
            o.progress = NULL;
            o.resume = 1;
            o.threads = 3;
            hnbrdf_model *found = fit(data[KNOWN - 1], &o, &report);
            expect_same(found, wanted);
            assert_int_equal(report.steps, 20);
            assert_true(report.best_loss == loss);
            hnbrdf_model_free(found);
            o.resume = 0;
        }
        hnbrdf_model_free(wanted);
    }
}

/* Searches that no fit has: phase and count are wrong in turn. */
static void a_checkpoint_with_wrong_searches_is_refused(void **state)
{
    (void)state;
    long at = 5;
    hnbrdf_fit_options o = {.freeze = known,
                            .pool = 4096,
                            .steps = 20,
                            .checkpoint = path,
                            .progress = stop_at,
                            .progress_user = &at};
    hnbrdf_fit_report report;
    hnbrdf_model_free(fit(data[KNOWN - 1], &o, &report));
    FILE *file = fopen(path, "rb");
    static unsigned char bytes[1 << 20];
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    assert_int_equal(fclose(file), 0);
    assert_true(size > 1000 && size < sizeof bytes);
    o.progress = NULL;
    o.resume = 1;
    const int64_t wrong[] = {-1, 1000};
    const size_t searches = size - sizeof(fit_searches); /* of the one material, at the end */
    for (int k = 0; k < 4; k++) {
        static unsigned char changed[sizeof bytes];
        hnbrdf_error error;
        hnbrdf_model *model = NULL;
        const hnbrdf_measured *const third = data[KNOWN - 1];
        memcpy(changed, bytes, size);
        memcpy(changed + searches + 8 * (size_t)(k / 2), &wrong[k % 2], 8);
        file = fopen(path, "wb");
        assert_int_equal(fwrite(changed, 1, size, file), size);
        assert_int_equal(fclose(file), 0);
        assert_int_equal(hnbrdf_fit(&third, 1, &o, &model, NULL, &error), HNBRDF_ERROR_FORMAT);
        assert_non_null(strstr(error.text, "damaged"));
    }
}

/* More steps only lead down, and 48 of them, the default, far from where one leads. */
static void more_steps_are_better(void **state)
{
    (void)state;
    double before = INFINITY;
    static const long steps[] = {1, 12, 48};
    for (int k = 0; k < 3; k++) {
        hnbrdf_fit_report report;
        hnbrdf_fit_options o = {.freeze = known, .pool = POOL, .lobes_none = 1, .steps = steps[k]};
        hnbrdf_model_free(fit(data[KNOWN - 1], &o, &report));
        assert_true(report.best_loss < before);
        before = report.best_loss;
    }
}

/* kd, eta and alpha move along, and the analytic part alone stays near the fit of GGX. */
static void a_joint_analytic_part_moves_and_stays_near_ggx(void **state)
{
    (void)state;
    hnbrdf_comparison c[2];
    hnbrdf_fit_report report[2];
    for (int joint = 0; joint < 2; joint++) {
        hnbrdf_fit_options o = {.freeze = known,
                                .pool = SANITIZED ? 4096 : 0,
                                .analytic = joint ? HNBRDF_FIT_JOINT : HNBRDF_FIT_FAITHFUL};
        hnbrdf_model *model = fit(data[KNOWN - 1], &o, &report[joint]);
        assert_int_equal(hnbrdf_compare(model, hnbrdf_model_material(model, 0), data[KNOWN - 1],
                                        HNBRDF_SAMPLER_UNIFORM, 20000, 3, &c[joint], NULL),
                         HNBRDF_OK);
        assert_int_equal(report[joint].left_alone, 0);
        hnbrdf_model_free(model);
    }
    print_message("loss %.4f and joint %.4f, analytic %.4f and %.4f\n", report[0].best_loss,
                  report[1].best_loss, c[0].smape_analytic, c[1].smape_analytic);
    assert_true(c[1].smape_analytic != c[0].smape_analytic);
    assert_true(c[1].smape_analytic <= 1.07 * c[0].smape_analytic);
}

/* A limit in seconds ends it, however many steps that makes; the logarithm alone can be asked
 * for, and a neural network's codes are found as well. */
static void limits_losses_and_kinds_are_obeyed(void **state)
{
    (void)state;
    hnbrdf_fit_report report;
    hnbrdf_fit_options o = {.freeze = known, .pool = 1024, .seconds = 0.3};
    hnbrdf_model_free(fit(data[KNOWN - 1], &o, &report));
    assert_true(report.steps > 1);
    o = (hnbrdf_fit_options){.freeze = known, .pool = 1024, .loss = HNBRDF_FIT_LOG};
    hnbrdf_model_free(fit(data[KNOWN - 1], &o, &report));
    assert_true(isfinite(report.best_loss));
    hnbrdf_fit_options neural = {
        .kind = HNBRDF_KIND_NEURAL, .hidden = 12, .latent = 6, .steps = 300, .pool = 4096};
    hnbrdf_model *network = NULL;
    assert_int_equal(
        hnbrdf_fit((const hnbrdf_measured *const *)data, 2, &neural, &network, NULL, NULL),
        HNBRDF_OK);
    double losses[2];
    for (int k = 0; k < 2; k++) {
        o = (hnbrdf_fit_options){.freeze = network, .pool = 4096, .steps = k ? 48 : 1};
        hnbrdf_model_free(fit(data[KNOWN - 1], &o, &report));
        losses[k] = report.best_loss;
    }
    assert_true(losses[1] < losses[0]);
    hnbrdf_model_free(network);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_code_that_made_the_data_is_found),
        cmocka_unit_test(a_search_that_was_interrupted_ends_the_same),
        cmocka_unit_test(a_checkpoint_with_wrong_searches_is_refused),
        cmocka_unit_test(more_steps_are_better),
        cmocka_unit_test(a_joint_analytic_part_moves_and_stays_near_ggx),
        cmocka_unit_test(limits_losses_and_kinds_are_obeyed),
    };
    return cmocka_run_group_tests(tests, make_known, free_known);
}
