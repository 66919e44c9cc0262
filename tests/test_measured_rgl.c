/* test_measured_rgl.c: RGL files are evaluated as the reference loader does. The files are made
 * here. */
#include "measured_support.h"

static const double PI = 3.14159265358979323846;

/* ---- Values ---------------------------------------------------------------------------------- */

typedef struct checkpoint {
    test_circle circle;
    double wi[3], wo[3], fcos[3];
} checkpoint;

/* From the reference loader of the database on the same formulas, six digits. */
static const checkpoint CHECKPOINTS[] = {
    {TEST_ISOTROPIC,
     {0.383022219, 0.321393818, 0.866025388},
     {-0.769751132, -0.280166507, 0.57357645},
     {0.137833, 0.266254, 0.239428}},
    {TEST_ISOTROPIC,
     {-0.167731255, 0.951251268, 0.258819044},
     {-0.0818996057, -0.936116815, 0.342020154},
     {0.263402, 0.252452, 0.253398}},
    {TEST_WHOLE,
     {0.383022219, 0.321393818, 0.866025388},
     {-0.769751132, -0.280166507, 0.57357645},
     {0.194415, 0.286776, 0.334076}},
    {TEST_WHOLE,
     {0.195373088, -0.0711099878, 0.978147626},
     {0.969846308, 0.171010077, 0.173648179},
     {0.225206, 0.280076, 0.365735}},
    {TEST_HALF,
     {0.383022219, 0.321393818, 0.866025388},
     {-0.769751132, -0.280166507, 0.57357645},
     {0.196084, 0.304813, 0.175397}},
    {TEST_HALF,
     {-0.567547798, -0.676377118, 0.469471574},
     {0.0885213241, 0.330366075, 0.939692616},
     {0.237483, 0.31559, 0.2095}},
    {TEST_QUARTER,
     {0.383022219, 0.321393818, 0.866025388},
     {-0.769751132, -0.280166507, 0.57357645},
     {0.193398, 0.223213, 0.218777}},
    {TEST_QUARTER,
     {-0.731854796, 0.12904574, 0.669130623},
     {0.694272041, -0.323744357, 0.642787635},
     {0.25231, 0.30381, 0.207896}},
};

/* Tolerance: the reference computes in float (1e-4 would do; these agree to 3e-6) and
 * prints six digits. */
static void values_are_those_of_the_reference_loader(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof CHECKPOINTS / sizeof CHECKPOINTS[0]; k++) {
        const checkpoint *point = &CHECKPOINTS[k];
        float wi[3], wo[3], f[3];
        for (int i = 0; i < 3; i++) {
            wi[i] = (float)point->wi[i];
            wo[i] = (float)point->wo[i];
        }
        test_bytes file = test_rgl(point->circle);
        hnbrdf_measured *measured = expect_opens(file.data, file.size, "synthetic_rgb.bsdf");
        assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)f[c] * point->wo[2] - point->fcos[c]) < 1e-5 * point->fcos[c]);
        hnbrdf_measured_close(measured);
        free(file.data);
    }
}

/* Of the isotropic file. */
static void set_colours(test_bytes *file, float value)
{
    size_t first = test_data_at(file, "rgb");
    for (size_t i = 0; i < 1 * 3 * 3 * 4 * 4; i++)
        put_float(file->data + first + 4 * i, value);
}

static void negative_colours_are_clipped_to_zero_and_stay_valid(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    float f[3];
    (void)state;
    set_colours(&file, -1.0f);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    assert_int_equal(eval_angles(measured, (double[4]){0.5, 0.1, 0.7, 2.0}, f), 1);
    assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
    assert_non_null(strstr(hnbrdf_measured_summary(measured), "100.0 % of them negative"));
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* The same factor of opposite sign. */
static void signed_colours_are_kept_on_request(void **state)
{
    const hnbrdf_measured_options keep = {.rgl_signed = 1};
    const double angles[4] = {0.5, 0.1, 0.7, 2.0};
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    float f[3], g[3];
    (void)state;
    set_colours(&file, -1.0f);
    hnbrdf_measured *negative = expect_opens_with(file.data, file.size, "x", &keep);
    set_colours(&file, 1.0f);
    hnbrdf_measured *positive = expect_opens_with(file.data, file.size, "x", &keep);
    assert_int_equal(eval_angles(negative, angles, f), 1);
    assert_int_equal(eval_angles(positive, angles, g), 1);
    for (int c = 0; c < 3; c++)
        assert_true(g[c] > 0.0f && f[c] == -g[c]);
    hnbrdf_measured_close(negative);
    set_colours(&file, -3.4e38f);
    negative = expect_opens_with(file.data, file.size, "x", &keep);
    assert_int_equal(eval_angles(negative, (double[4]){0.5, 0.1, 1.57, 2.0}, f), 1);
    assert_true(f[0] == -HNBRDF_MAX_VALUE);
    hnbrdf_measured_close(negative);
    hnbrdf_measured_close(positive);
    free(file.data);
}

static void huge_colours_are_clamped_to_the_largest_value(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    float f[3];
    (void)state;
    set_colours(&file, 3.4e38f);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    assert_int_equal(eval_angles(measured, (double[4]){0.5, 0.1, 1.57, 2.0}, f), 1);
    assert_true(f[0] == HNBRDF_MAX_VALUE && f[1] == HNBRDF_MAX_VALUE && f[2] == HNBRDF_MAX_VALUE);
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* Rows 2 and 3 of the six get no density at all: half vectors between them are invisible. */
static void an_invisible_normal_is_no_measurement(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    size_t first = test_data_at(&file, "vndf");
    float f[3] = {1, 1, 1}, wi[3], wo[3];
    (void)state;
    for (size_t slice = 0; slice < 3; slice++)
        for (size_t i = 2 * 5; i < 4 * 5; i++)
            put_float(file.data + first + 4 * (slice * 30 + i), 0.0f);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    /* rows are phi_m - phi_i: row 2.5 of 0..5 is 0, towards wi */
    wi[0] = 0.3f, wi[1] = 0.0f, wi[2] = sqrtf(1 - 0.09f);
    wo[0] = 0.5f, wo[1] = 0.0f, wo[2] = sqrtf(1 - 0.25f);
    assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 0);
    assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
    wo[0] = -0.5f; /* the half vector turns away from wi: row 0 */
    assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
    hnbrdf_measured_close(measured);
    free(file.data);
}

static void without_jacobian_the_colours_stand_alone(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    float f[3];
    (void)state;
    set_colours(&file, 0.25f);
    file.data[test_data_at(&file, "jacobian")] = 0;
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    assert_int_equal(eval_angles(measured, (double[4]){0.5, 0.1, PI / 3, 2.0}, f), 1);
    for (int c = 0; c < 3; c++) /* f wo.z = 0.25 at wo.z = 1/2; float roundings */
        assert_true(fabs((double)f[c] - 0.5) < 1e-6);
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* The first and the last row of the tables both stand for a half vector that turns away from wi;
 * exactly there the first one holds. Tilting wo by 1e-6 moves f by less than
 * 1e-4. */
static void the_seam_of_the_azimuth_belongs_to_the_first_row(void **state)
{
    const float wi[3] = {0.3f, 0.0f, 0.95f};
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    float at[3], first[3], last[3];
    (void)state;
    hnbrdf_measured_eval(measured, wi, (float[3]){-0.5f, 0.0f, 0.86f}, at);
    hnbrdf_measured_eval(measured, wi, (float[3]){-0.5f, -1e-6f, 0.86f}, first);
    hnbrdf_measured_eval(measured, wi, (float[3]){-0.5f, 1e-6f, 0.86f}, last);
    assert_true(fabs((double)at[0] - (double)first[0]) < 1e-4);
    assert_true(fabs((double)at[0] - (double)last[0]) > 1e-2);
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* The synthetic sigma depends on the azimuth of wi, which makes even the isotropic file
 * turn-dependent; with equal rows, as in every real file, it is not. Turning rounds directions by
 * 1e-7. */
static void isotropic_files_do_not_feel_a_turn(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    size_t sigma = test_data_at(&file, "sigma");
    hnbrdf_measured *uneven = expect_opens(file.data, file.size, "x");
    (void)state;
    assert_int_equal(hnbrdf_measured_is_isotropic(uneven), 0);
    hnbrdf_measured_close(uneven);
    memcpy(file.data + sigma + 16, file.data + sigma, 16);
    memcpy(file.data + sigma + 32, file.data + sigma, 16);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    assert_int_equal(hnbrdf_measured_is_isotropic(measured), 1);
    for (double turn = 0.0; turn < 6.2; turn += 0.37) {
        float f[3], g[3];
        eval_angles(measured, (double[4]){0.5, 0.1, 0.9, 2.0}, f);
        eval_angles(measured, (double[4]){0.5, 0.1 + turn, 0.9, 2.0 + turn}, g);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)f[c] - (double)g[c]) < 1e-5);
    }
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* ---- Edges of what is accepted --------------------------------------------------------------- */

static void minor_versions_and_unknown_fields_do_not_matter(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    (void)state;
    file.data[13] = 7; /* version 1.7 */
    memcpy(file.data + test_record(&file, "version") + 2, "xersion", 7);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    assert_non_null(strstr(hnbrdf_measured_summary(measured), "version 1.7"));
    hnbrdf_measured_close(measured);
    free(file.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_those_of_the_reference_loader),
        cmocka_unit_test(negative_colours_are_clipped_to_zero_and_stay_valid),
        cmocka_unit_test(signed_colours_are_kept_on_request),
        cmocka_unit_test(huge_colours_are_clamped_to_the_largest_value),
        cmocka_unit_test(an_invisible_normal_is_no_measurement),
        cmocka_unit_test(without_jacobian_the_colours_stand_alone),
        cmocka_unit_test(the_seam_of_the_azimuth_belongs_to_the_first_row),
        cmocka_unit_test(isotropic_files_do_not_feel_a_turn),
        cmocka_unit_test(minor_versions_and_unknown_fields_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
