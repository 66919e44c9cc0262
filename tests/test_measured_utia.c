/* test_measured_utia.c: UTIA tables are looked up as the format's description says, in its three
 * modes, and every broken file is refused with one line. The tables are made here: no real one
 * was at hand. */
#include "measured_support.h"

static const double PI = 3.14159265358979323846;
enum { THETAS = 6, PHIS = 48, PAIRS = THETAS * PHIS * THETAS * PHIS, SAMPLES = 3 * PAIRS };
static const size_t FILE_SIZE = (size_t)SAMPLES * 8;

static size_t sample_at(int c, int it_i, int ip_i, int it_v, int ip_v)
{
    return 8 * (size_t)(c * 82944 + 288 * (48 * it_i + ip_i) + 48 * it_v + ip_v);
}

static test_bytes constant_table(double value)
{
    test_bytes file = {malloc(FILE_SIZE), FILE_SIZE};
    assert_non_null(file.data);
    for (size_t k = 0; k < SAMPLES; k++)
        put_double(file.data + 8 * k, value);
    return file;
}

/* A small table from a formula. */
static test_bytes synthetic_table(void)
{
    test_bytes file = constant_table(0.0);
    for (int k = 0; k < SAMPLES; k++) {
        int c = k / PAIRS, it_i = k / 13824 % 6, ip_i = k / 288 % 48, it_v = k / 48 % 6,
            ip_v = k % 48;
        double v = 0.2 * (c + 1) + 0.05 * it_i + 0.002 * ip_i - 0.04 * it_v + 0.001 * ip_v;
        put_double(file.data + sample_at(c, it_i, ip_i, it_v, ip_v), c == 1 ? 10 * v : v);
    }
    return file;
}

static test_bytes table;

static int set_up(void **state)
{
    (void)state;
    table = synthetic_table();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    free(table.data);
    return 0;
}

static hnbrdf_measured *open_table(hnbrdf_utia_mode mode)
{
    return expect_opens_with(table.data, table.size, "fabric001.bin",
                             &(hnbrdf_measured_options){.utia_mode = mode});
}

/* theta_i, phi_i, theta_v, phi_v in degrees. */
static int eval_degrees(const hnbrdf_measured *measured, const double degrees[4], float f[3])
{
    double radians[4];
    for (int k = 0; k < 4; k++)
        radians[k] = degrees[k] * PI / 180;
    return eval_angles(measured, radians, f);
}

/* ---- Values ---------------------------------------------------------------------------------- */

/* Values worked out by hand; those of djb are dj_brdf's own. Tolerance: six digits are given,
 * directions and samples are floats. */
static void values_are_those_of_the_description(void **state)
{
    static const struct {
        double degrees[4], f[3][3]; /* djb, raw, srgb */
    } rows[] = {
        {{20, 33, 40, 200},
         {{0.0108064, 0.218635, 0.0329205},
          {0.195467, 3.95467, 0.595467},
          {0.0324904, 24.8768, 0.314419}}},
        {{70, 358, 10, 3},
         {{0.0238906, 0.351383, 0.0460047},
          {0.432133, 6.32133, 0.832133},
          {0.159457, 75.8403, 0.663463}}},
        {{80, 100, 85, 250},
         {{0.0165856, 0.276426, 0.0386997}, {0.3, 5, 0.7}, {0.0703937, 42.1449, 0.444159}}},
        {{0, 0, 45, 90},
         {{0.00508625, 0.161433, 0.0272004},
          {0.092, 2.92, 0.492},
          {0.00882583, 12.0382, 0.206711}}},
        {{52.5, 187.5, 37.5, 352.5},
         {{0.0205661, 0.316295, 0.0426802}, {0.372, 5.72, 0.772}, {0.11516, 59.4505, 0.558855}}}};
    double worst = 0.0;
    (void)state;
    for (int mode = 0; mode < 3; mode++) {
        hnbrdf_measured *measured = open_table((hnbrdf_utia_mode)mode);
        for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
            float f[3];
            assert_int_equal(eval_degrees(measured, rows[i].degrees, f), 1);
            for (int c = 0; c < 3; c++)
                worst = fmax(worst, fabs((double)f[c] / rows[i].f[mode][c] - 1));
        }
        hnbrdf_measured_close(measured);
    }
    print_message("    worst %.2g\n", worst);
    assert_true(worst < 5e-6);
}

/* Nodes (1,2,3,4,5) and (2,5,47,5,47) of (c, theta_i, phi_i, theta_v, phi_v). */
static void nodes_give_their_samples(void **state)
{
    hnbrdf_measured *measured = open_table(HNBRDF_UTIA_RAW);
    float f[3];
    (void)state;
    assert_int_equal(sample_at(1, 2, 3, 4, 5), 8 * 111653);
    assert_int_equal(sample_at(2, 5, 47, 5, 47), 8 * 248831);
    eval_degrees(measured, (double[4]){30, 22.5, 60, 37.5}, f);
    assert_true(fabs((double)f[1] - 3.51) < 1e-5);
    eval_degrees(measured, (double[4]){75, 352.5, 75, 352.5}, f);
    assert_true(fabs((double)f[2] - 0.791) < 1e-5);
    hnbrdf_measured_close(measured);
}

/* Half way from phi = 352.5 to 360 is half way from the last azimuth to the first, for light and
 * viewer; at the pole of both azimuths the value does not jump. */
static void azimuths_wrap_around(void **state)
{
    hnbrdf_measured *measured = open_table(HNBRDF_UTIA_RAW);
    float last[3], first[3], between[3], below[3];
    (void)state;
    eval_degrees(measured, (double[4]){30, 352.5, 45, 352.5}, last);
    eval_degrees(measured, (double[4]){30, 0, 45, 0}, first);
    eval_degrees(measured, (double[4]){30, 356.25, 45, 356.25}, between);
    eval_degrees(measured, (double[4]){30, -1e-7, 45, -1e-7}, below);
    assert_true(fabs((double)(last[0] - first[0])) > 0.1);
    assert_true(fabs(0.5 * (double)(last[0] + first[0]) - (double)between[0]) < 1e-6);
    assert_true(fabs((double)(below[0] - first[0])) < 1e-5);
    /* so little below 0 that 360 degrees are added to it and nothing is left */
    const float wi[3] = {0.5f, -1e-30f, 0.8f}, on_axis[3] = {0.5f, 0.0f, 0.8f};
    hnbrdf_measured_eval(measured, wi, wi, below);
    hnbrdf_measured_eval(measured, on_axis, on_axis, first);
    assert_memory_equal(below, first, sizeof first);
    hnbrdf_measured_close(measured);
}

/* 5.4/140 lies between djb's threshold 0.0375 and that of sRGB: 100
 * ((0.0385714+0.055)/1.055)^2.4. */
static void djb_decodes_from_its_own_threshold_on(void **state)
{
    test_bytes file = constant_table(5.4);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    float f[3];
    (void)state;
    eval_degrees(measured, (double[4]){40, 10, 50, 20}, f);
    assert_true(fabs((double)f[0] / 0.298495591 - 1) < 5e-6);
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* Half way between samples of -1 and 1 djb sees half of 1/140, raw their mean 0. Directions are
 * floats. */
static void djb_clamps_samples_before_it_blends_them(void **state)
{
    test_bytes file = constant_table(1.0);
    float f[3];
    (void)state;
    for (int k = 0; k < SAMPLES; k++)
        if (k % 2)
            put_double(file.data + 8 * (size_t)k, -1.0);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    eval_degrees(measured, (double[4]){40, 10, 50, 18.75}, f);
    assert_true(fabs((double)f[0] / 0.027642636 - 1) < 5e-6);
    hnbrdf_measured_close(measured);
    measured = expect_opens_with(file.data, file.size, "x",
                                 &(hnbrdf_measured_options){.utia_mode = HNBRDF_UTIA_RAW});
    eval_degrees(measured, (double[4]){40, 10, 50, 18.75}, f);
    assert_true((double)f[0] < 1e-5);
    hnbrdf_measured_close(measured);
    free(file.data);
}

static void the_material_is_anisotropic_and_its_format_named(void **state)
{
    hnbrdf_measured *measured = open_table(HNBRDF_UTIA_DJB);
    float f[3], turned[3];
    (void)state;
    assert_int_equal(hnbrdf_measured_format_of(measured), HNBRDF_MEASURED_UTIA);
    assert_string_equal(hnbrdf_measured_format_name(HNBRDF_MEASURED_UTIA), "UTIA");
    assert_string_equal(hnbrdf_measured_name(measured), "fabric001");
    assert_int_equal(hnbrdf_measured_is_isotropic(measured), 0);
    eval_degrees(measured, (double[4]){40, 10, 50, 20}, f);
    eval_degrees(measured, (double[4]){40, 100, 50, 110}, turned);
    assert_true(fabs((double)(f[0] / turned[0]) - 1) > 0.05);
    hnbrdf_measured_close(measured);
}

static void the_scale_multiplies_the_final_value(void **state)
{
    (void)state;
    for (int mode = 0; mode < 3; mode++) {
        hnbrdf_measured_options options = {.utia_mode = (hnbrdf_utia_mode)mode, .utia_scale = 2.5};
        hnbrdf_measured *one = open_table((hnbrdf_utia_mode)mode);
        hnbrdf_measured *scaled = expect_opens_with(table.data, table.size, "x", &options);
        float f[3], g[3];
        eval_degrees(one, (double[4]){40, 10, 50, 20}, f);
        eval_degrees(scaled, (double[4]){40, 10, 50, 20}, g);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)g[c] / (double)f[c] - 2.5) < 1e-6);
        assert_non_null(strstr(hnbrdf_measured_summary(scaled), "scaled"));
        assert_null(strstr(hnbrdf_measured_summary(one), "scaled"));
        hnbrdf_measured_close(one);
        hnbrdf_measured_close(scaled);
    }
}

/* v falls by 0.04 from 60 to 75 degrees of the viewer, so by 0.04 more to 90, unless it is held. */
static void beyond_75_degrees_values_go_on_or_are_held(void **state)
{
    hnbrdf_measured_options options = {.utia_mode = HNBRDF_UTIA_RAW, .utia_no_extrapolate = 1};
    hnbrdf_measured *goes_on = open_table(HNBRDF_UTIA_RAW);
    hnbrdf_measured *held = expect_opens_with(table.data, table.size, "x", &options);
    float at_75[3], beyond[3];
    (void)state;
    eval_degrees(goes_on, (double[4]){30, 0, 75, 0}, at_75);
    eval_degrees(goes_on, (double[4]){30, 0, 82.5, 0}, beyond);
    assert_true(fabs((double)(at_75[0] - beyond[0]) - 0.02) < 1e-6);
    eval_degrees(held, (double[4]){30, 0, 82.5, 0}, beyond);
    assert_true(fabs((double)(at_75[0] - beyond[0])) < 1e-6);
    assert_non_null(strstr(hnbrdf_measured_summary(held), "not extrapolated"));
    hnbrdf_measured_close(goes_on);
    hnbrdf_measured_close(held);
}

/* Samples of 0 at 75 degrees and 1 before go on to -1 at 90: never below 0 in any mode. */
static void extrapolation_below_zero_is_zero_and_valid(void **state)
{
    test_bytes file = constant_table(1.0);
    (void)state;
    for (int k = 0; k < SAMPLES; k++)
        if (k / 48 % 6 == 5)
            put_double(file.data + 8 * (size_t)k, 0.0);
    for (int mode = 0; mode < 3; mode++) {
        hnbrdf_measured_options options = {.utia_mode = (hnbrdf_utia_mode)mode, .rgl_signed = 1};
        hnbrdf_measured *measured = expect_opens_with(file.data, file.size, "x", &options);
        float f[3] = {1, 1, 1};
        assert_int_equal(eval_degrees(measured, (double[4]){10, 0, 85, 0}, f), 1);
        for (int c = 0; c < 3; c++)
            assert_true(f[c] == 0.0f);
        hnbrdf_measured_close(measured);
    }
    free(file.data);
}

/* ---- Summary --------------------------------------------------------------------------------- */

/* A constant f has the albedo pi f; djb reads 7 as 7/140 = 0.05: decoded and times 100 0.9875. */
static void the_summary_tells_mode_and_albedo(void **state)
{
    static const struct {
        hnbrdf_utia_mode mode;
        double value;
        const char *words;
    } rows[] = {
        {HNBRDF_UTIA_RAW, 0.25, "mode raw, directional albedo 0.785 at 0 and 0.785 at 45 degrees;"},
        {HNBRDF_UTIA_SRGB, 0.5, "mode srgb, directional albedo 0.672 at 0 and 0.672 at 45"},
        {HNBRDF_UTIA_DJB, 1.0, "mode djb, directional albedo 0.174 at 0 and 0.174 at 45"},
        {HNBRDF_UTIA_RAW, 0.5, "1.571 at 45 degrees (WARNING: more than arrives); 0 of 248832"},
        {HNBRDF_UTIA_RAW, 1e30, "directional albedo over 9999 at 0"},
        {HNBRDF_UTIA_RAW, 0.0, "0.000 at 45 degrees; 0 of 248832 samples negative"},
        {HNBRDF_UTIA_RAW, -1.0, "0.000 at 45 degrees; 248832 of 248832 samples negative"}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        test_bytes file = constant_table(rows[i].value);
        hnbrdf_measured *measured = expect_opens_with(
            file.data, file.size, "x", &(hnbrdf_measured_options){.utia_mode = rows[i].mode});
        if (!strstr(hnbrdf_measured_summary(measured), rows[i].words))
            fail_msg("no \"%s\" in: %s", rows[i].words, hnbrdf_measured_summary(measured));
        hnbrdf_measured_close(measured);
        free(file.data);
    }
}

/* ---- Refusals -------------------------------------------------------------------------------- */

static void expect_wrong(const char *path, const void *data, size_t size, hnbrdf_result result,
                         const char *words)
{
    hnbrdf_error error = {""};
    hnbrdf_measured *measured = NULL;
    hnbrdf_measured_options options = {.max_bytes = (size_t)2 << 30};
    assert_int_equal(hnbrdf_measured_open_memory(data, size, path, &options, &measured, &error),
                     result);
    assert_null(measured);
    if (!strstr(error.text, words) || !strstr(error.text, path))
        fail_msg("no \"%s\" in: %s", words, error.text);
}

static void every_other_size_is_refused_naming_both(void **state)
{
    static const size_t sizes[] = {1, 8, 1990648, 1990655};
    unsigned char *longer = calloc(1, FILE_SIZE + 1);
    (void)state;
    assert_non_null(longer);
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        char words[80];
        snprintf(words, sizeof words, "%zu bytes, expected a UTIA .bin of exactly 1990656",
                 sizes[i]);
        expect_wrong("m.bin", table.data, sizes[i], HNBRDF_ERROR_FORMAT, words);
    }
    expect_wrong("m.bin", longer, FILE_SIZE + 1, HNBRDF_ERROR_FORMAT, "1990657 bytes, expected");
    expect_wrong("m.bin", longer, 0, HNBRDF_ERROR_FORMAT, "empty");
    expect_wrong("m.dat", longer, FILE_SIZE + 1, HNBRDF_ERROR_FORMAT,
                 "a UTIA .bin (1990656 bytes)");
    free(longer);
}

/* Of the right size whatever its name; what says it is something else is that. */
static void content_comes_before_the_name(void **state)
{
    unsigned char *data = calloc(1, FILE_SIZE);
    (void)state;
    assert_non_null(data);
    hnbrdf_measured *measured = expect_opens(data, FILE_SIZE, "no_extension");
    assert_int_equal(hnbrdf_measured_format_of(measured), HNBRDF_MEASURED_UTIA);
    hnbrdf_measured_close(measured);
    memcpy(data, "tensor_file\0\1\0", 14);
    expect_wrong("m.bin", data, FILE_SIZE, HNBRDF_ERROR_FORMAT, "no field \"phi_i\"");
    memset(data, 0, 14);
    put_le(data, 90, 4);
    put_le(data + 4, 90, 4);
    put_le(data + 8, 180, 4);
    expect_wrong("m.bin", data, FILE_SIZE, HNBRDF_ERROR_FORMAT, "MERL table is truncated");
    free(data);
}

/* 1.5 GB of address space that is never touched. */
static void the_dense_set_is_refused_as_such(void **state)
{
    size_t size = 1505433600;
    unsigned char *data = calloc(1, size);
    (void)state;
    if (!data)
        skip();
    expect_wrong("m.bin", data, size, HNBRDF_ERROR_UNSUPPORTED, "the dense UTIA set");
    free(data);
}

static void samples_that_are_not_finite_are_refused(void **state)
{
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300};
    static const int places[] = {0, 100000, SAMPLES - 1};
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        for (size_t k = 0; k < 3; k++) {
            unsigned char *at = table.data + 8 * (size_t)places[k], saved[8];
            char words[60];
            memcpy(saved, at, 8);
            put_double(at, bad[i]);
            snprintf(words, sizeof words, "UTIA sample %d of 248832 is not finite", places[k]);
            expect_wrong("m.bin", table.data, table.size, HNBRDF_ERROR_FORMAT, words);
            memcpy(at, saved, 8);
        }
}

static void random_damage_never_crashes(void **state)
{
    unsigned char *damaged = malloc(FILE_SIZE);
    hnbrdf_rng rng;
    (void)state;
    assert_non_null(damaged);
    hnbrdf_rng_seed(&rng, 2026, 11);
    for (int i = 0; i < 60; i++) {
        hnbrdf_measured_options options = {.utia_mode = (hnbrdf_utia_mode)(i % 3),
                                           .utia_scale = i % 5 ? 1.0 : 1e38};
        memcpy(damaged, table.data, FILE_SIZE);
        for (int k = 0; k < 2000; k++) /* whole bytes, but seldom in an exponent: most files open */
            damaged[hnbrdf_rng_u32(&rng) % FILE_SIZE / 8 * 8 + (size_t)(k % 300 ? k % 6 : 7)] =
                (unsigned char)(hnbrdf_rng_u32(&rng) & (k % 300 ? 255 : 0x7f));
        expect_sane_with(damaged, i % 7 ? FILE_SIZE : hnbrdf_rng_u32(&rng) % FILE_SIZE,
                         "damaged.bin", &options);
    }
    free(damaged);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_those_of_the_description),
        cmocka_unit_test(nodes_give_their_samples),
        cmocka_unit_test(azimuths_wrap_around),
        cmocka_unit_test(djb_decodes_from_its_own_threshold_on),
        cmocka_unit_test(djb_clamps_samples_before_it_blends_them),
        cmocka_unit_test(the_material_is_anisotropic_and_its_format_named),
        cmocka_unit_test(the_scale_multiplies_the_final_value),
        cmocka_unit_test(beyond_75_degrees_values_go_on_or_are_held),
        cmocka_unit_test(extrapolation_below_zero_is_zero_and_valid),
        cmocka_unit_test(the_summary_tells_mode_and_albedo),
        cmocka_unit_test(every_other_size_is_refused_naming_both),
        cmocka_unit_test(content_comes_before_the_name),
        cmocka_unit_test(the_dense_set_is_refused_as_such),
        cmocka_unit_test(samples_that_are_not_finite_are_refused),
        cmocka_unit_test(random_damage_never_crashes),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
