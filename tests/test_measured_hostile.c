/* test_measured_hostile.c: every broken RGL file is refused with one line that says what was
 * found and what was expected, and none crashes. The files are made here. */
#include "measured_support.h"

static const double PI = 3.14159265358979323846;

/* ---- Refusals -------------------------------------------------------------------------------- */

static void every_truncation_is_refused_or_harmless(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    /* what follows is not read as values */
    size_t last = test_data_at(&file, "rgb") + 3 * 3 * 16 * 4;
    (void)state;
    for (size_t size = 1; size < file.size; size++)
        if (size < last)
            expect_refusal(file.data, size, HNBRDF_ERROR_FORMAT, "expected");
        else
            expect_sane(file.data, size);
    expect_refusal(file.data, 0, HNBRDF_ERROR_FORMAT, "empty");
    expect_refusal(file.data, 5, HNBRDF_ERROR_FORMAT, "truncated tensor file: 5 bytes");
    free(file.data);
}

/* Records whose data are the magic itself, so that nothing but the end of the file is wrong. */
static void records_cut_anywhere_are_refused(void **state)
{
    enum { FIELDS = 3, RECORD = 2 + 5 + 2 + 1 + 8 + 16, WHOLE = 18 + FIELDS * RECORD };
    unsigned char data[WHOLE] = "tensor_file\0\1";
    (void)state;
    put_le(data + 14, FIELDS, 4);
    for (size_t i = 0; i < FIELDS; i++) {
        unsigned char *record = data + 18 + i * RECORD;
        put_le(record, 5, 2);
        memcpy(record + 2, i == 0 ? "alpha" : i == 1 ? "gamma" : "delta", 5);
        put_le(record + 7, 2, 2);
        put_le(record + 9, 1, 1);
        put_le(record + 18, 2, 8);
        put_le(record + 26, 3, 8);
    }
    for (size_t size = 18 + FIELDS * 13; size < WHOLE; size++)
        expect_refusal(data, size, HNBRDF_ERROR_FORMAT, "truncated in the record of field");
    expect_refusal(data, WHOLE, HNBRDF_ERROR_FORMAT, "no field \"phi_i\" among 3");
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

static uint64_t float_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static void broken_spectra_are_refused(void **state)
{
    test_bytes file = test_rgl_spectral(0);
    size_t nodes = test_data_at(&file, "wavelengths");
    const patch patches[] = {
        {test_record(&file, "wavelengths") + 2, 'X', 1, HNBRDF_ERROR_FORMAT,
         "no field \"wavelengths\""},
        {test_record(&file, "spectra") + 2, 'X', 1, HNBRDF_ERROR_FORMAT, "no field \"rgb\""},
        {test_type_at(&file, "spectra"), 5, 1, HNBRDF_ERROR_FORMAT,
         "is u32 with 5 axes, expected f32"},
        {test_type_at(&file, "wavelengths"), 5, 1, HNBRDF_ERROR_FORMAT, "is u32 with 1 axes"},
        {test_shape_at(&file, "spectra", 2), 3, 8, HNBRDF_ERROR_FORMAT,
         "expected 4 (one a wavelength)"},
        {test_shape_at(&file, "wavelengths", 0), 3, 8, HNBRDF_ERROR_FORMAT,
         "expected 3 (one a wavelength)"},
        {test_shape_at(&file, "spectra", 4), 2, 8, HNBRDF_ERROR_FORMAT,
         "expected 4 (as luminance)"},
        {test_data_at(&file, "spectra") + 4, float_bits(NAN), 4, HNBRDF_ERROR_FORMAT,
         "element 1 of"},
        {nodes + 4, float_bits(INFINITY), 4, HNBRDF_ERROR_FORMAT, "is not finite"},
        {nodes + 8, float_bits(500.0f), 4, HNBRDF_ERROR_FORMAT, "expected increasing wavelengths"},
        {nodes + 12, float_bits(-1.0f), 4, HNBRDF_ERROR_FORMAT, "expected increasing wavelengths"},
    };
    (void)state;
    expect_refused_patches(&file, patches, sizeof patches / sizeof patches[0]);
    free(file.data);
}

/* Only where spectra are read is anything expected of them. */
static void an_empty_field_name_is_no_wavelength(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    size_t name = test_record(&file, "spare");
    (void)state;
    /* "spare" becomes a field without a name: its record moves up, the rest is padding no one
     * reads */
    memmove(file.data + name + 2, file.data + name + 7, 2 + 1 + 8 + 8);
    put_le(file.data + name, 0, 2);
    expect_sane(file.data, file.size);
    hnbrdf_measured_close(expect_opens(file.data, file.size, "x"));
    free(file.data);
}

static void wrong_types_and_shapes_are_refused(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    const patch patches[] = {
        {test_type_at(&file, "theta_i"), 6, 1, HNBRDF_ERROR_FORMAT,
         "is i32 with 1 axes, expected f32"},
        {test_type_at(&file, "jacobian"), 2, 1, HNBRDF_ERROR_FORMAT,
         "is i8 with 1 axes, expected u8"},
        {test_shape_at(&file, "theta_i", 0), 2, 8, HNBRDF_ERROR_FORMAT,
         "expected 2 (one a theta_i node)"},
        {test_shape_at(&file, "vndf", 1), 2, 8, HNBRDF_ERROR_FORMAT,
         "size 2 along axis 1, expected 3"},
        {test_shape_at(&file, "luminance", 3), 2, 8, HNBRDF_ERROR_FORMAT, "expected 4 (square)"},
        {test_shape_at(&file, "rgb", 2), 2, 8, HNBRDF_ERROR_FORMAT,
         "expected 3 (red, green, blue)"},
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
                                   &(patch){test_data_at(&file, fields[i]) + 4, float_bits(bad[k]),
                                            4, HNBRDF_ERROR_FORMAT, "element 1 of"},
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

/* ---- Random damage --------------------------------------------------------------------------- */

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

/* Of the four circles, and of the spectral files, read as RGB and as spectra. */
static void random_damage_never_crashes(void **state)
{
    (void)state;
    for (int circle = 0; circle < 6; circle++) {
        test_bytes file =
            circle < 4 ? test_rgl((test_circle)circle) : test_rgl_spectral(circle == 5);
        hnbrdf_measured_options options = {.rgl_signed = circle == 4, .rgl_spectra = circle > 3};
        unsigned char *damaged = malloc(file.size);
        hnbrdf_rng rng;
        assert_non_null(damaged);
        hnbrdf_rng_seed(&rng, 2026, (uint64_t)circle);
        for (int i = 0; i < 4000; i++) {
            memcpy(damaged, file.data, file.size);
            for (uint32_t k = 0, count = 1 + hnbrdf_rng_u32(&rng) % 3; k < count; k++)
                mutate(damaged, file.size, &rng);
            expect_sane_with(
                damaged, hnbrdf_rng_u32(&rng) % 8 ? file.size : hnbrdf_rng_u32(&rng) % file.size,
                "damaged.bsdf", &options);
        }
        free(damaged);
        free(file.data);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_truncation_is_refused_or_harmless),
        cmocka_unit_test(records_cut_anywhere_are_refused),
        cmocka_unit_test(a_broken_header_is_refused),
        cmocka_unit_test(more_fields_than_the_limit_are_refused),
        cmocka_unit_test(broken_records_are_refused),
        cmocka_unit_test(overflowing_products_are_refused),
        cmocka_unit_test(duplicate_names_are_refused),
        cmocka_unit_test(missing_fields_are_named),
        cmocka_unit_test(broken_spectra_are_refused),
        cmocka_unit_test(an_empty_field_name_is_no_wavelength),
        cmocka_unit_test(wrong_types_and_shapes_are_refused),
        cmocka_unit_test(wrong_values_are_refused),
        cmocka_unit_test(negative_densities_and_areas_are_refused),
        cmocka_unit_test(an_unknown_part_of_the_circle_is_refused),
        cmocka_unit_test(random_damage_never_crashes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
