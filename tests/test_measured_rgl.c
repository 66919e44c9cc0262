/* test_measured_rgl.c: RGL files are evaluated as docs/FORMATS.md 3.5 says, and every broken one is
 * refused with one line that says what was expected. The files are made here. */
#include "measured_support.h"

static const double PI = 3.14159265358979323846;

/* ---- Values -------------------------------------------------------------------------------------- */

typedef struct checkpoint {
    test_circle circle;
    double wi[3], wo[3], fcos[3];
} checkpoint;

/* From the reference loader of the database on the same formulas, six digits (FORMATS 6.2). */
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

/* Tolerance: the reference computes in float (FORMATS 6.1 grants 1e-4; these agree to 3e-6) and prints
 * six digits. */
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

/* The synthetic sigma depends on the azimuth of wi, which makes even the isotropic file turn-dependent;
 * with equal rows, as in every real file, it is not. Turning rounds directions by 1e-7. */
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

/* ---- Edges of what is accepted ------------------------------------------------------------------- */

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

/* ---- Refusals ------------------------------------------------------------------------------------ */

static void every_truncation_is_refused_or_harmless(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    size_t last = test_data_at(&file, "rgb") + 3 * 3 * 16 * 4; /* what follows is not read as values */
    (void)state;
    for (size_t size = 1; size < file.size; size++) {
        if (size < last)
            expect_refusal(file.data, size, HNBRDF_ERROR_FORMAT, "expected");
        else
            expect_sane(file.data, size);
    }
    expect_refusal(file.data, 0, HNBRDF_ERROR_FORMAT, "empty");
    expect_refusal(file.data, 5, HNBRDF_ERROR_FORMAT, "truncated tensor file: 5 bytes");
    free(file.data);
}

/* One change to a good file, and what the refusal must say. */
typedef struct patch {
    size_t at;
    uint64_t value;
    int bytes;
    hnbrdf_result result;
    const char *words;
} patch;

static void expect_refused_patches(const test_bytes *file, const patch *patches, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        unsigned char saved[8];
        memcpy(saved, file->data + patches[i].at, 8);
        put_le(file->data + patches[i].at, patches[i].value, patches[i].bytes);
        expect_refusal(file->data, file->size, patches[i].result, patches[i].words);
        memcpy(file->data + patches[i].at, saved, 8);
    }
}

static void a_broken_header_is_refused(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    const patch patches[] = {
        {0, 'T', 1, HNBRDF_ERROR_FORMAT, "expected an RGL .bsdf"},
        {11, '!', 1, HNBRDF_ERROR_FORMAT, "expected an RGL .bsdf"},
        {12, 2, 1, HNBRDF_ERROR_UNSUPPORTED, "version 2.0, expected 1.0"},
        {14, 0, 4, HNBRDF_ERROR_FORMAT, "no field \"phi_i\" among 0"},
        {14, 0xffffffffu, 4, HNBRDF_ERROR_FORMAT, "claims 4294967295 fields"},
        {14, 12, 4, HNBRDF_ERROR_FORMAT, ""}, /* one more than there are: runs into the data */
    };
    (void)state;
    expect_refused_patches(&file, patches, sizeof patches / sizeof patches[0]);
    free(file.data);
}

static void more_fields_than_the_limit_are_refused(void **state)
{
    size_t size = 18 + 13 * 257;
    unsigned char *data = calloc(1, size);
    (void)state;
    assert_non_null(data);
    memcpy(data, "tensor_file\0\1\0", 14);
    put_le(data + 14, 257, 4);
    expect_refusal(data, size, HNBRDF_ERROR_LIMIT, "257 fields, expected at most 256");
    free(data);
}

static void broken_records_are_refused(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    size_t name = test_record(&file, "rgb"), type = test_type_at(&file, "rgb");
    size_t offset = test_offset_at(&file, "rgb"), shape = test_shape_at(&file, "rgb", 0);
    const patch patches[] = {
        {name, 0xffff, 2, HNBRDF_ERROR_FORMAT, "truncated in the record"},
        {type - 2, 0, 2, HNBRDF_ERROR_FORMAT, "has 0 axes, expected 1 to 8"},
        {type - 2, 9, 2, HNBRDF_ERROR_FORMAT, "has 9 axes, expected 1 to 8"},
        {type - 2, 0xffff, 2, HNBRDF_ERROR_FORMAT, "has 65535 axes"},
        {type, 0, 1, HNBRDF_ERROR_FORMAT, "element type 0, expected 1 to 11"},
        {type, 12, 1, HNBRDF_ERROR_FORMAT, "element type 12"},
        {type, 11, 1, HNBRDF_ERROR_FORMAT, "\"rgb\""}, /* f64: twice the bytes, or the wrong type */
        {offset, file.size, 8, HNBRDF_ERROR_FORMAT, "inside the file"},
        {offset, UINT64_MAX, 8, HNBRDF_ERROR_FORMAT, "inside the file"},
        {offset, UINT64_MAX - 100, 8, HNBRDF_ERROR_FORMAT, "inside the file"},
        {shape, 0, 8, HNBRDF_ERROR_FORMAT, "size 0 along axis 0"},
        {shape + 8, UINT64_MAX, 8, HNBRDF_ERROR_FORMAT, "more than the whole file"},
        {shape + 8, (uint64_t)1 << 62, 8, HNBRDF_ERROR_FORMAT, "more than the whole file"},
        {shape + 8, ((uint64_t)1 << 61) + 1, 8, HNBRDF_ERROR_FORMAT, "more than the whole file"},
    };
    (void)state;
    expect_refused_patches(&file, patches, sizeof patches / sizeof patches[0]);
    free(file.data);
}

/* Products that wrap to something small in 64 bits: 2^32 * 2^32 elements. */
static void overflowing_products_are_refused(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    (void)state;
    for (int axis = 0; axis < 4; axis++)
        put_le(file.data + test_shape_at(&file, "rgb", axis), (uint64_t)1 << 32, 8);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_FORMAT, "more than the whole file");
    for (int axis = 0; axis < 5; axis++) /* fits in 64 bits, not in the file */
        put_le(file.data + test_shape_at(&file, "rgb", axis), 40, 8);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_FORMAT, "more than the whole file");
    free(file.data);
}

static void duplicate_names_are_refused(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    (void)state;
    memcpy(file.data + test_record(&file, "spare") + 2, "sigma", 5);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_FORMAT, "both named \"sigma\"");
    free(file.data);
}

static void missing_fields_are_named(void **state)
{
    static const char *const fields[] = {"phi_i", "theta_i",   "ndf", "sigma",
                                         "vndf",  "luminance", "rgb"};
    (void)state;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        test_bytes file = test_rgl(TEST_WHOLE);
        char words[40];
        snprintf(words, sizeof words, "no field \"%s\"", fields[i]);
        file.data[test_record(&file, fields[i]) + 2] = 'X';
        expect_refusal(file.data, file.size, HNBRDF_ERROR_FORMAT, words);
        free(file.data);
    }
}

static void spectral_files_are_refused_as_such(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    (void)state;
    memcpy(file.data + test_record(&file, "version") + 2, "spectra", 7);
    file.data[test_record(&file, "rgb") + 2] = 'X';
    expect_refusal(file.data, file.size, HNBRDF_ERROR_UNSUPPORTED, "spectral RGL file");
    free(file.data);
}

static void wrong_types_and_shapes_are_refused(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    const patch patches[] = {
        {test_type_at(&file, "theta_i"), 6, 1, HNBRDF_ERROR_FORMAT, "is i32 with 1 axes, expected f32"},
        {test_type_at(&file, "jacobian"), 2, 1, HNBRDF_ERROR_FORMAT, "is i8 with 1 axes, expected u8"},
        {test_shape_at(&file, "theta_i", 0), 2, 8, HNBRDF_ERROR_FORMAT,
         "expected 2 (one a theta_i node)"},
        {test_shape_at(&file, "vndf", 1), 2, 8, HNBRDF_ERROR_FORMAT, "size 2 along axis 1, expected 3"},
        {test_shape_at(&file, "luminance", 3), 2, 8, HNBRDF_ERROR_FORMAT, "expected 4 (square)"},
        {test_shape_at(&file, "rgb", 2), 2, 8, HNBRDF_ERROR_FORMAT, "expected 3 (red, green, blue)"},
        {test_shape_at(&file, "rgb", 3), 2, 8, HNBRDF_ERROR_FORMAT, "expected 4 (as luminance)"},
        {test_shape_at(&file, "rgb", 4), 3, 8, HNBRDF_ERROR_FORMAT, "expected 4 (as luminance)"},
        {test_shape_at(&file, "ndf", 0), 1, 8, HNBRDF_ERROR_FORMAT, "expected at least 2"},
        {test_shape_at(&file, "sigma", 1), 1, 8, HNBRDF_ERROR_FORMAT, "expected at least 2"},
        {test_shape_at(&file, "vndf", 3), 1, 8, HNBRDF_ERROR_FORMAT, "expected at least 2"},
    };
    (void)state;
    expect_refused_patches(&file, patches, sizeof patches / sizeof patches[0]);
    free(file.data);
}

static uint64_t float_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static void wrong_values_are_refused(void **state)
{
    static const char *const fields[] = {"phi_i", "theta_i",   "ndf", "sigma",
                                         "vndf",  "luminance", "rgb"};
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    test_bytes file = test_rgl(TEST_WHOLE);
    (void)state;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++)
        for (size_t k = 0; k < 3; k++)
            expect_refused_patches(&file,
                                   &(patch){test_data_at(&file, fields[i]) + 4, float_bits(bad[k]), 4,
                                            HNBRDF_ERROR_FORMAT, "element 1 of"},
                                   1);
    const patch patches[] = {
        {test_data_at(&file, "theta_i") + 8, float_bits(0.8f), 4, HNBRDF_ERROR_FORMAT,
         "increasing nodes"},
        {test_data_at(&file, "theta_i") + 8, float_bits(1.6f), 4, HNBRDF_ERROR_FORMAT,
         "larger than pi/2"},
        {test_data_at(&file, "theta_i"), float_bits(-0.1f), 4, HNBRDF_ERROR_FORMAT,
         "element 0 of 3 is negative"},
        {test_data_at(&file, "phi_i") + 4, float_bits(9.0f), 4, HNBRDF_ERROR_FORMAT,
         "increasing nodes"},
    };
    expect_refused_patches(&file, patches, sizeof patches / sizeof patches[0]);
    free(file.data);
}

static void negative_densities_and_areas_are_refused(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    const patch patches[] = {
        {test_data_at(&file, "ndf"), float_bits(-1e-30f), 4, HNBRDF_ERROR_FORMAT,
         "is negative, expected a density"},
        {test_data_at(&file, "vndf"), float_bits(-1.0f), 4, HNBRDF_ERROR_FORMAT,
         "is negative, expected a density"},
        {test_data_at(&file, "sigma"), float_bits(0.0f), 4, HNBRDF_ERROR_FORMAT,
         "is not positive, expected an area"},
    };
    (void)state;
    expect_refused_patches(&file, patches, sizeof patches / sizeof patches[0]);
    memset(file.data + test_data_at(&file, "vndf") + 30 * 4, 0, 30 * 4);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_FORMAT, "0 all over slice 1");
    free(file.data);
}

static void an_unknown_part_of_the_circle_is_refused(void **state)
{
    test_bytes file = test_rgl(TEST_WHOLE);
    (void)state;
    for (int i = 0; i < 5; i++) /* a third */
        put_float(file.data + test_data_at(&file, "phi_i") + 4 * (size_t)i, (float)(i * PI / 6));
    expect_refusal(file.data, file.size, HNBRDF_ERROR_UNSUPPORTED, "unknown part of the circle");
    free(file.data);
}

/* ---- Random damage ------------------------------------------------------------------------------- */

static void mutate(unsigned char *data, size_t size, hnbrdf_rng *rng)
{
    static const uint64_t interesting[] = {
        0, 1, 2, 0x7f, 0xff, 0x7fffffff, 0xffffffff, (uint64_t)1 << 62, UINT64_MAX};
    size_t limit = hnbrdf_rng_u32(rng) % 4 ? 450 : size; /* mostly the header and the records */
    size_t at = hnbrdf_rng_u32(rng) % (limit - 8);
    uint32_t kind = hnbrdf_rng_u32(rng) % 3;
    if (kind == 0)
        data[at] ^= (unsigned char)(1u << hnbrdf_rng_u32(rng) % 8);
    else if (kind == 1)
        data[at] = (unsigned char)hnbrdf_rng_u32(rng);
    else
        put_le(data + at, interesting[hnbrdf_rng_u32(rng) % 9], 1 << hnbrdf_rng_u32(rng) % 4);
}

static void random_damage_never_crashes(void **state)
{
    (void)state;
    for (int circle = 0; circle < 4; circle++) {
        test_bytes file = test_rgl((test_circle)circle);
        unsigned char *damaged = malloc(file.size);
        hnbrdf_rng rng;
        assert_non_null(damaged);
        hnbrdf_rng_seed(&rng, 2026, (uint64_t)circle);
        for (int i = 0; i < 4000; i++) {
            memcpy(damaged, file.data, file.size);
            for (uint32_t k = 0, count = 1 + hnbrdf_rng_u32(&rng) % 3; k < count; k++)
                mutate(damaged, file.size, &rng);
            expect_sane(damaged,
                        hnbrdf_rng_u32(&rng) % 8 ? file.size : hnbrdf_rng_u32(&rng) % file.size);
        }
        free(damaged);
        free(file.data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_those_of_the_reference_loader),
        cmocka_unit_test(negative_colours_are_clipped_to_zero_and_stay_valid),
        cmocka_unit_test(huge_colours_are_clamped_to_the_largest_value),
        cmocka_unit_test(an_invisible_normal_is_no_measurement),
        cmocka_unit_test(without_jacobian_the_colours_stand_alone),
        cmocka_unit_test(isotropic_files_do_not_feel_a_turn),
        cmocka_unit_test(minor_versions_and_unknown_fields_do_not_matter),
        cmocka_unit_test(every_truncation_is_refused_or_harmless),
        cmocka_unit_test(a_broken_header_is_refused),
        cmocka_unit_test(more_fields_than_the_limit_are_refused),
        cmocka_unit_test(broken_records_are_refused),
        cmocka_unit_test(overflowing_products_are_refused),
        cmocka_unit_test(duplicate_names_are_refused),
        cmocka_unit_test(missing_fields_are_named),
        cmocka_unit_test(spectral_files_are_refused_as_such),
        cmocka_unit_test(wrong_types_and_shapes_are_refused),
        cmocka_unit_test(wrong_values_are_refused),
        cmocka_unit_test(negative_densities_and_areas_are_refused),
        cmocka_unit_test(an_unknown_part_of_the_circle_is_refused),
        cmocka_unit_test(random_damage_never_crashes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
