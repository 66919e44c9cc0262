/* test_measured_custom.c: a BRDF given as a callback is asked, checked, clamped and released like
 * any other measurement, and can be fitted. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "hnbrdf/fit.h"
#include "hnbrdf/measured.h"
#include "hnbrdf/metrics.h"

#include <math.h>
#include <string.h>

typedef struct lobe {
    hnbrdf_material material;
    hnbrdf_model *model;
    int released;
} lobe;

static int eval_lobe(const void *user, const float wi[3], const float wo[3], float f[3])
{
    const lobe *l = user;
    hnbrdf_eval(l->model, &l->material, wi, wo, f);
    return 1;
}

static void release_lobe(void *user)
{
    ((lobe *)user)->released++;
}

/* What a caller may return: negative, the largest float; NaN or infinite in one channel towards low
 * viewers; and "no value" for grazing light. */
static int eval_odd(const void *user, const float wi[3], const float wo[3], float f[3])
{
    const float *odd = user;
    f[0] = -1.0f;
    f[1] = wo[2] > 0.5f ? 0.0f : *odd;
    f[2] = 3.4e38f;
    return wi[2] > 0.5f;
}

static void make_lobe(lobe *l)
{
    static const char *const names[] = {"lobe"};
    hnbrdf_material_init(&l->material);
    l->material.alpha[0] = l->material.alpha[1] = 0.25f;
    l->material.kd[0] = 0.1f;
    l->released = 0;
    hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = 1, .materials = &l->material, .names = names};
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &l->model, NULL), HNBRDF_OK);
}

static void it_answers_as_its_callback_does(void **state)
{
    (void)state;
    lobe l;
    make_lobe(&l);
    hnbrdf_measured *measured;
    hnbrdf_measured_custom custom = {
        .name = "lobe", .isotropic = 1, .eval = eval_lobe, .release = release_lobe, .user = &l};
    assert_int_equal(hnbrdf_measured_create_custom(&custom, &measured, NULL), HNBRDF_OK);
    assert_string_equal(hnbrdf_measured_name(measured), "lobe");
    assert_string_equal(hnbrdf_measured_summary(measured), "custom");
    assert_int_equal(hnbrdf_measured_format_of(measured), HNBRDF_MEASURED_CUSTOM);
    assert_string_equal(hnbrdf_measured_format_name(HNBRDF_MEASURED_CUSTOM), "custom");
    assert_int_equal(hnbrdf_measured_is_isotropic(measured), 1);
    assert_int_equal(hnbrdf_measured_wavelengths(measured, NULL), 0);
    float wi[3] = {0.6f, 0, 0.8f}, wo[3] = {0, -0.6f, 0.8f}, f[3], expected[3];
    hnbrdf_eval(l.model, &l.material, wi, wo, expected);
    assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
    for (int c = 0; c < 3; c++) /* the unit vectors of measured.c may differ in the last bit */
        assert_float_equal(f[c], expected[c], 1e-5f * expected[c]);
    wo[2] = -0.8f;
    assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 0);
    assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
    assert_int_equal(l.released, 0);
    hnbrdf_measured_close(measured);
    assert_int_equal(l.released, 1);
    hnbrdf_model_free(l.model);
}

static void values_are_clamped_and_missing_ones_are_told(void **state)
{
    (void)state;
    hnbrdf_measured *measured;
    float odd = NAN;
    hnbrdf_measured_custom custom = {
        .name = "odd", .summary = "an odd one", .eval = eval_odd, .user = &odd};
    assert_int_equal(hnbrdf_measured_create_custom(&custom, &measured, NULL), HNBRDF_OK);
    assert_string_equal(hnbrdf_measured_summary(measured), "an odd one");
    assert_int_equal(hnbrdf_measured_is_isotropic(measured), 0);
    float high[3] = {0, 0, 1}, low[3] = {0.9539392f, 0, 0.3f}, f[3];
    assert_int_equal(hnbrdf_measured_eval(measured, high, high, f), 1);
    assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == HNBRDF_MAX_VALUE);
    assert_int_equal(hnbrdf_measured_eval(measured, low, high, f), 0);
    assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
    for (int k = 0; k < 2; k++, odd = INFINITY) {
        assert_int_equal(hnbrdf_measured_eval(measured, high, low, f), 0);
        assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
    }
    hnbrdf_measured_close(measured);
}

/* GGX fitted to a GGX lobe given as a callback is that lobe: 2 %, as
 * ggx_fit_recovers_known_parameters in test_fit.c. */
static void it_can_be_fitted(void **state)
{
    (void)state;
    lobe l;
    make_lobe(&l);
    hnbrdf_measured *measured;
    hnbrdf_measured_custom custom = {.name = "lobe", .isotropic = 1, .eval = eval_lobe, .user = &l};
    assert_int_equal(hnbrdf_measured_create_custom(&custom, &measured, NULL), HNBRDF_OK);
    hnbrdf_fit_options options = {.kind = HNBRDF_KIND_GGX, .pool = 16384};
    hnbrdf_model *model;
    const hnbrdf_measured *data[] = {measured};
    assert_int_equal(hnbrdf_fit(data, 1, &options, &model, NULL, NULL), HNBRDF_OK);
    assert_float_equal(hnbrdf_model_material(model, 0)->alpha[0], 0.25f, 0.02f * 0.25f);
    hnbrdf_comparison comparison;
    assert_int_equal(hnbrdf_compare(model, hnbrdf_model_material(model, 0), measured,
                                    HNBRDF_SAMPLER_GRID, 2000, 1, &comparison, NULL),
                     HNBRDF_OK);
    assert_true(comparison.smape < 0.02);
    hnbrdf_model_free(model);
    hnbrdf_measured_close(measured);
    hnbrdf_model_free(l.model);
}

static void bad_descriptions_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {NULL, "", "a\nb", "\xff"};
    char longer[HNBRDF_MAX_NAME + 2];
    memset(longer, 'a', sizeof longer - 1);
    longer[sizeof longer - 1] = 0;
    for (int k = 0; k < 6; k++) {
        lobe l = {.released = 0};
        hnbrdf_measured *measured = NULL;
        hnbrdf_error error = {{0}};
        hnbrdf_measured_custom custom = {.name = k < 4    ? names[k]
                                                 : k == 4 ? longer
                                                          : "good",
                                         .eval = k < 5 ? eval_lobe : NULL,
                                         .release = release_lobe,
                                         .user = &l};
        assert_int_equal(hnbrdf_measured_create_custom(&custom, &measured, &error),
                         HNBRDF_ERROR_ARGUMENT);
        assert_null(measured);
        assert_true(error.text[0] != 0);
        assert_int_equal(l.released, 0);
    }
    assert_int_equal(hnbrdf_measured_create_custom(NULL, NULL, NULL), HNBRDF_ERROR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_answers_as_its_callback_does),
        cmocka_unit_test(values_are_clamped_and_missing_ones_are_told),
        cmocka_unit_test(it_can_be_fitted),
        cmocka_unit_test(bad_descriptions_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
