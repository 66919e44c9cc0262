/* test_metrics.c: the error figures have their known values, bounds and seeds. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hnbrdf/metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PAIRS = 1000, MERL_BINS = 90 * 90 * 180 };

/* ---- What is compared: constants, so that every figure is known in closed form --------------- */

/* A neural 1x1 model of weights 0: f = exp(bias), the same for every pair. */
static hnbrdf_model *constant_model(const float value[3])
{
    static const float first[6 + 1] = {0}, last[3] = {0}, first_bias[1] = {0};
    float last_bias[3];
    for (int c = 0; c < 3; c++)
        last_bias[c] = logf(value[c]);
    hnbrdf_material material;
    hnbrdf_material_init(&material);
    const char *name = "constant";
    hnbrdf_model_desc desc = {.kind = HNBRDF_KIND_NEURAL,
                              .encoding = HNBRDF_ENCODING_HALF_DIFFERENCE,
                              .hidden = 1,
                              .layers = 1,
                              .latent = 1,
                              .weights = {first, last},
                              .biases = {first_bias, last_bias},
                              .material_count = 1,
                              .materials = &material,
                              .names = &name};
    hnbrdf_model *model = NULL;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
    return model;
}

static hnbrdf_model *ggx_model(void)
{
    hnbrdf_material material;
    hnbrdf_material_init(&material);
    const char *name = "ggx";
    hnbrdf_model_desc desc = {
        .kind = HNBRDF_KIND_GGX, .material_count = 1, .materials = &material, .names = &name};
    hnbrdf_model *model = NULL;
    assert_int_equal(hnbrdf_model_create(&desc, NULL, &model, NULL), HNBRDF_OK);
    return model;
}

/* A MERL table that stores `value` in every bin from `first` on and -1, never measured, before
 * it. */
static hnbrdf_measured *constant_merl(double value, int first)
{
    static const unsigned char header[12] = {90, 0, 0, 0, 90, 0, 0, 0, 180, 0, 0, 0};
    const double numbers[2] = {value, -1.0};
    unsigned char pattern[2][8];
    for (int k = 0; k < 2; k++) {
        uint64_t bits;
        memcpy(&bits, &numbers[k], sizeof bits);
        for (int byte = 0; byte < 8; byte++)
            pattern[k][byte] = (unsigned char)(bits >> (8 * byte));
    }
    size_t size = sizeof header + 3u * MERL_BINS * 8u;
    unsigned char *bytes = malloc(size);
    assert_non_null(bytes);
    memcpy(bytes, header, sizeof header);
    for (size_t k = 0; k < 3u * MERL_BINS; k++)
        memcpy(bytes + sizeof header + 8 * k, pattern[(int)(k % MERL_BINS) < first], 8);
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error;
    hnbrdf_result result =
        hnbrdf_measured_open_memory(bytes, size, "constant.binary", NULL, &measured, &error);
    free(bytes);
    if (result != HNBRDF_OK)
        fail_msg("%s", error.text);
    return measured;
}

static hnbrdf_measured *builtin(int index)
{
    hnbrdf_measured *measured = NULL;
    assert_int_equal(hnbrdf_measured_open_builtin(index, &measured, NULL), HNBRDF_OK);
    return measured;
}

static hnbrdf_comparison compare(const hnbrdf_model *model, const hnbrdf_measured *measured,
                                 hnbrdf_sampler sampler, uint64_t seed)
{
    hnbrdf_comparison comparison;
    hnbrdf_error error;
    if (hnbrdf_compare(model, hnbrdf_model_material(model, 0), measured, sampler, PAIRS, seed,
                       &comparison, &error) != HNBRDF_OK)
        fail_msg("%s", error.text);
    return comparison;
}

static void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance * fabs(expected)))
        fail_msg("%.17g, expected %.17g within %g of it", value, expected, tolerance);
}

/* ---- SMAPE ----------------------------------------------------------------------------------- */

static void smape_of_one_value_has_its_definition(void **state)
{
    (void)state;
    assert_true(hnbrdf_smape(0.0, 0.0) == 0.0);
    assert_true(hnbrdf_smape(0.7, 0.7) == 0.0);
    assert_true(hnbrdf_smape(0.0, 1e-30) == 2.0);
    assert_true(hnbrdf_smape(5.0, 0.0) == 2.0);
    assert_true(hnbrdf_smape(1.0, 3.0) == 1.0);
    assert_true(hnbrdf_smape(3.0, 1.0) == 1.0);
}

static void smape_is_symmetric_and_between_0_and_2(void **state)
{
    (void)state;
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 3, 1);
    for (int k = 0; k < 10000; k++) {
        double f = exp(40.0 * (double)hnbrdf_rng_float(&rng) - 20.0);
        double reference = exp(40.0 * (double)hnbrdf_rng_float(&rng) - 20.0);
        double smape = hnbrdf_smape(f, reference);
        assert_true(smape >= 0.0 && smape <= 2.0);
        assert_true(smape == hnbrdf_smape(reference, f));
    }
}

/* ---- Comparisons ----------------------------------------------------------------------------- */

static void constants_compare_to_their_closed_form(void **state)
{
    (void)state;
    const float value[3] = {0.5f, 1.0f, 2.0f};
    const double scale[3] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0}; /* of MERL */
    hnbrdf_model *model = constant_model(value);
    hnbrdf_measured *measured = constant_merl(1500.0, 0);
    double smape = 0.0, mae = 0.0, mse = 0.0;
    for (int c = 0; c < 3; c++) {
        double reference = 1500.0 * scale[c], difference = fabs((double)value[c] - reference);
        smape += 2.0 * difference / ((double)value[c] + reference) / 3.0;
        mae += difference / 3.0;
        mse += difference * difference / 3.0;
    }
    for (int s = 0; s < 3; s++) {
        hnbrdf_comparison comparison = compare(model, measured, (hnbrdf_sampler)s, 1);
        /* exp(log(value)) in float and the table's float scale: 1e-6 relative to the values, whose
         * smallest difference is 0.15. */
        assert_close(comparison.smape, smape, 1e-5);
        assert_close(comparison.mae, mae, 1e-5);
        assert_close(comparison.mse, mse, 1e-5);
        assert_true(comparison.smape_analytic == 2.0); /* a neural model has none: 0 */
        assert_int_equal(comparison.pairs, PAIRS);
    }
    hnbrdf_measured_close(measured);
    hnbrdf_model_free(model);
}

static void pairs_without_a_measurement_are_drawn_again(void **state)
{
    (void)state;
    const float value[3] = {1.0f, 1.0f, 1.0f};
    hnbrdf_model *model = constant_model(value);
    /* theta_h above 22.5 degrees */
    hnbrdf_measured *measured = constant_merl(1500.0, MERL_BINS / 2);
    hnbrdf_comparison comparison = compare(model, measured, HNBRDF_SAMPLER_GRID, 1);
    assert_int_equal(comparison.pairs, PAIRS);
    assert_true(comparison.smape < 0.3); /* never the 2 of a bin taken for black */
    hnbrdf_measured_close(measured);
    hnbrdf_model_free(model);
}

static void no_valid_pair_is_an_error_and_changes_nothing(void **state)
{
    (void)state;
    const float value[3] = {1.0f, 1.0f, 1.0f};
    hnbrdf_model *model = constant_model(value);
    /* Only the last bin is valid, theta_h and theta_d near 90 degrees: one direction of such a
     * pair is below the horizon. */
    hnbrdf_measured *measured = constant_merl(1500.0, MERL_BINS - 1);
    hnbrdf_comparison comparison = {.pairs = 77};
    hnbrdf_error error;
    hnbrdf_result result = hnbrdf_compare(model, hnbrdf_model_material(model, 0), measured,
                                          HNBRDF_SAMPLER_UNIFORM, 10, 1, &comparison, &error);
    assert_int_equal(result, HNBRDF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "constant"));
    assert_int_equal(comparison.pairs, 77);
    hnbrdf_measured_close(measured);
    hnbrdf_model_free(model);
}

static void arguments_out_of_range_are_refused(void **state)
{
    (void)state;
    hnbrdf_model *model = ggx_model();
    hnbrdf_measured *measured = builtin(0);
    const hnbrdf_material *material = hnbrdf_model_material(model, 0);
    hnbrdf_comparison comparison;
    assert_int_equal(
        hnbrdf_compare(model, material, measured, HNBRDF_SAMPLER_GRID, 0, 1, &comparison, NULL),
        HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(
        hnbrdf_compare(model, material, measured, (hnbrdf_sampler)3, 1, 1, &comparison, NULL),
        HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(
        hnbrdf_compare(NULL, material, measured, HNBRDF_SAMPLER_GRID, 1, 1, &comparison, NULL),
        HNBRDF_ERROR_ARGUMENT);
    hnbrdf_measured_close(measured);
    hnbrdf_model_free(model);
}

static void the_seed_alone_decides(void **state)
{
    (void)state;
    hnbrdf_model *model = ggx_model();
    for (int index = 0; index < hnbrdf_measured_builtin_count(); index++) {
        hnbrdf_measured *measured = builtin(index);
        hnbrdf_comparison one = compare(model, measured, HNBRDF_SAMPLER_GRID, 1);
        hnbrdf_comparison again = compare(model, measured, HNBRDF_SAMPLER_GRID, 1);
        hnbrdf_comparison other = compare(model, measured, HNBRDF_SAMPLER_GRID, 2);
        assert_true(one.smape == again.smape && one.mse == again.mse);
        assert_true(one.smape != other.smape);
        assert_true(one.smape > 0.0 && one.smape <= 2.0);
        hnbrdf_measured_close(measured);
    }
    hnbrdf_model_free(model);
}

static void a_ggx_model_is_its_analytic_part(void **state)
{
    (void)state;
    hnbrdf_model *model = ggx_model();
    hnbrdf_measured *measured = builtin(0);
    for (int s = 0; s < 3; s++) {
        hnbrdf_comparison comparison = compare(model, measured, (hnbrdf_sampler)s, 1);
        assert_true(comparison.smape == comparison.smape_analytic);
    }
    hnbrdf_measured_close(measured);
    hnbrdf_model_free(model);
}

/* ---- Images ---------------------------------------------------------------------------------- */

static void image_errors_have_their_known_values(void **state)
{
    (void)state;
    const float image[4] = {1.0f, 2.0f, 0.0f, 4.0f}, reference[4] = {1.0f, 4.0f, 0.0f, 2.0f};
    hnbrdf_image_error error;
    hnbrdf_image_compare(image, reference, 4, &error);
    assert_true(error.mae == 1.0);
    assert_true(error.mse == 2.0);
    /* 10 log10(4^2 / 2), rounded once or twice */
    assert_close(error.psnr, 9.030899869919435, 1e-15);
}

static void equal_images_have_infinite_psnr(void **state)
{
    (void)state;
    const float image[3] = {0.25f, 0.5f, 7.0f};
    hnbrdf_image_error error;
    hnbrdf_image_compare(image, image, 3, &error);
    assert_true(error.mae == 0.0 && error.mse == 0.0);
    assert_true(isinf(error.psnr) && error.psnr > 0.0);
}

static void a_tenth_of_the_error_is_20_db_more(void **state)
{
    (void)state;
    float image[2][64], reference[64];
    for (int k = 0; k < 64; k++) {
        reference[k] = (float)k;
        image[0][k] = reference[k] + 0.5f;
        image[1][k] = reference[k] + 0.05f;
    }
    hnbrdf_image_error error[2];
    for (int k = 0; k < 2; k++)
        hnbrdf_image_compare(image[k], reference, 64, &error[k]);
    /* 63.05f is known to 4e-6, 8e-5 of the difference of 0.05, 7e-4 dB. */
    assert_true(fabs(error[1].psnr - error[0].psnr - 20.0) < 1e-3);
}

/* Sum of 12 uniform numbers less 6: mean 0, variance 1, normal to what is looked at here. */
static double normal(hnbrdf_rng *rng)
{
    double sum = -6.0;
    for (int k = 0; k < 12; k++)
        sum += hnbrdf_rng_float(rng);
    return sum;
}

enum { NOISY_PIXELS = 24, TRIALS = 4000 };

/* One noisy rendering: the error of channel k is 0.1 (k + 1), its noise the same in all channels
 * but for a part of its own. The reference has none. */
static void render_noisily(hnbrdf_rng *rng, const float *reference, float *image)
{
    for (int p = 0; p < NOISY_PIXELS; p++) {
        double shared = normal(rng);
        for (int k = 0; k < 3; k++)
            image[3 * p + k] = (float)((double)reference[3 * p + k] + 0.1 * (k + 1) + 0.2 * shared +
                                       0.1 * normal(rng));
    }
}

static void the_error_by_noise_is_the_spread_of_many_renderings(void **state)
{
    (void)state;
    const double truth = (0.01 + 0.04 + 0.09) / 3.0;
    double sum = 0.0, squares = 0.0, stated = 0.0, plain = 0.0;
    float reference[3 * NOISY_PIXELS], image[2][3 * NOISY_PIXELS];
    const float *images[2] = {image[0], image[1]}, *references[2] = {reference, reference};
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 7, 0);
    for (int k = 0; k < 3 * NOISY_PIXELS; k++)
        reference[k] = (float)k;
    for (int t = 0; t < TRIALS; t++) {
        hnbrdf_image_error error;
        hnbrdf_image_noise noise;
        render_noisily(&rng, reference, image[0]);
        render_noisily(&rng, reference, image[1]);
        hnbrdf_image_compare_twice(images, references, NOISY_PIXELS, &error, &noise);
        sum += noise.mse / TRIALS;
        squares += noise.mse * noise.mse / TRIALS;
        stated += noise.mse_error * noise.mse_error / TRIALS;
        plain += error.mse / TRIALS;
        assert_true(noise.peak_error == 0.0);
    }
    double spread = sqrt(squares - sum * sum);
    /* The mean of all trials within 4 standard errors of the truth; the plain MSE above it by
     * half the noise's variance, 0.05/2. The spread of 4000 trials is known to 1/sqrt(2 * 4000) =
     * 1.1 %, and the stated variance, a mean of 4000 * 24 squares whose own spread is less than 3
     * times their mean, to 1 %. */
    assert_true(fabs(sum - truth) < 4.0 * spread / sqrt(TRIALS));
    assert_true(fabs(plain - truth - 0.025) < 4.0 * spread / sqrt(TRIALS));
    assert_true(fabs(sqrt(stated) / spread - 1.0) < 4.0 * 0.015);
}

static void without_noise_there_is_no_error_by_noise(void **state)
{
    (void)state;
    const float image[6] = {1.0f, 2.0f, 0.0f, 4.0f, 1.0f, 1.0f},
                reference[6] = {1.0f, 4.0f, 0.0f, 2.0f, 1.0f, 1.0f};
    const float *images[2] = {image, image}, *references[2] = {reference, reference};
    hnbrdf_image_error once, twice;
    hnbrdf_image_noise noise;
    hnbrdf_image_compare(image, reference, 6, &once);
    hnbrdf_image_compare_twice(images, references, 2, &twice, &noise);
    assert_true(once.mae == twice.mae && once.mse == twice.mse && once.psnr == twice.psnr);
    assert_true(noise.mse == once.mse && noise.mse_error == 0.0 && noise.psnr_error == 0.0);
    assert_true(noise.psnr_bias == 0.0 && noise.peak_error == 0.0);
    hnbrdf_image_compare_twice(references, references, 2, &twice, &noise);
    assert_true(isinf(twice.psnr) && noise.mse == 0.0 && noise.psnr_error == 0.0);
}

static void pictures_of_noise_alone_say_so(void **state)
{
    (void)state;
    /* d1 = 1, d2 = -1 in every channel: nothing is left of the error but noise. */
    const float up[3] = {3.0f, 3.0f, 3.0f}, down[3] = {1.0f, 1.0f, 1.0f},
                reference[3] = {2.0f, 2.0f, 2.0f};
    const float *images[2] = {up, down}, *references[2] = {reference, reference};
    hnbrdf_image_error error;
    hnbrdf_image_noise noise;
    hnbrdf_image_compare_twice(images, references, 1, &error, &noise);
    assert_true(error.mse == 0.0 && noise.mse == -1.0 && isinf(noise.psnr_error));
    /* A second reference of noise 1/2 about a peak of 2: 20 log10 moves by 8.686 / 4. */
    const float low[3] = {1.5f, 1.0f, 1.0f}, high[3] = {2.5f, 1.0f, 1.0f};
    const float *noisy[2] = {low, high};
    hnbrdf_image_compare_twice(images, noisy, 1, &error, &noise);
    assert_close(noise.peak_error, 20.0 / log(10.0) / 4.0, 1e-12);
}

/* A measurement in the place of a model, over the same pairs: a MERL file that holds one number
 * everywhere is a constant, which a model is too. */
static void a_measurement_compares_as_a_model_does(void **state)
{
    (void)state;
    const float value[3] = {600.0f / 1500.0f, 600.0f * 1.15f / 1500.0f, 600.0f * 1.66f / 1500.0f};
    hnbrdf_error error;
    hnbrdf_measured *data = NULL, *constant = constant_merl(600.0, 0);
    hnbrdf_model *model = constant_model(value);
    hnbrdf_comparison as_model, as_measured;
    assert_int_equal(hnbrdf_measured_open_builtin(0, &data, &error), HNBRDF_OK);
    for (int s = 0; hnbrdf_sampler_name((hnbrdf_sampler)s); s++) {
        const hnbrdf_sampler sampler = (hnbrdf_sampler)s;
        assert_int_equal(
            hnbrdf_compare_measured(constant, data, sampler, PAIRS, 1, &as_measured, &error),
            HNBRDF_OK);
        assert_int_equal(hnbrdf_compare(model, hnbrdf_model_material(model, 0), data, sampler,
                                        PAIRS, 1, &as_model, &error),
                         HNBRDF_OK);
        /* exp(log(value)) and value differ by a few places of float */
        assert_true(fabs(as_measured.smape - as_model.smape) < 1e-6);
        assert_true(fabs(as_measured.mae - as_model.mae) < 1e-6 && as_measured.mae > 0.0);
        assert_true(as_measured.smape == as_measured.smape_analytic);
        assert_int_equal(as_measured.pairs, PAIRS);
        assert_int_equal(hnbrdf_compare_measured(data, data, sampler, PAIRS, 1, &as_measured, NULL),
                         HNBRDF_OK);
        assert_true(as_measured.smape == 0.0 && as_measured.mse == 0.0);
    }
    assert_int_equal(
        hnbrdf_compare_measured(NULL, data, HNBRDF_SAMPLER_GRID, 1, 1, &as_model, &error),
        HNBRDF_ERROR_ARGUMENT);
    hnbrdf_measured_close(data);
    hnbrdf_measured_close(constant);
    hnbrdf_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smape_of_one_value_has_its_definition),
        cmocka_unit_test(smape_is_symmetric_and_between_0_and_2),
        cmocka_unit_test(constants_compare_to_their_closed_form),
        cmocka_unit_test(pairs_without_a_measurement_are_drawn_again),
        cmocka_unit_test(no_valid_pair_is_an_error_and_changes_nothing),
        cmocka_unit_test(arguments_out_of_range_are_refused),
        cmocka_unit_test(the_seed_alone_decides),
        cmocka_unit_test(a_ggx_model_is_its_analytic_part),
        cmocka_unit_test(image_errors_have_their_known_values),
        cmocka_unit_test(equal_images_have_infinite_psnr),
        cmocka_unit_test(a_tenth_of_the_error_is_20_db_more),
        cmocka_unit_test(the_error_by_noise_is_the_spread_of_many_renderings),
        cmocka_unit_test(without_noise_there_is_no_error_by_noise),
        cmocka_unit_test(pictures_of_noise_alone_say_so),
        cmocka_unit_test(a_measurement_compares_as_a_model_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
