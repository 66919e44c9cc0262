/* test_measured_merl.c: MERL tables are looked up bin by bin as the authors' reader does, invalid
 * bins are no measurements, and every broken file is refused with one line. The tables are made
 * here. */
#include "measured_support.h"

static const double PI = 3.14159265358979323846;
enum { TH = 90, TD = 90, PD = 180, BINS = TH * TD * PD, FILE_SIZE = 12 + 24 * BINS };

static size_t sample_at(int channel, int bin)
{
    return 12 + 8 * ((size_t)channel * BINS + (size_t)bin);
}

/* Red tells the bin: f_r = bin / 1500; green and blue are 1500 / 1.15 and 1500 / 1.66, so f = 1. */
static test_bytes numbered_table(void)
{
    test_bytes file = {malloc(FILE_SIZE), FILE_SIZE};
    assert_non_null(file.data);
    put_le(file.data, TH, 4);
    put_le(file.data + 4, TD, 4);
    put_le(file.data + 8, PD, 4);
    for (int bin = 0; bin < BINS; bin++) {
        put_double(file.data + sample_at(0, bin), (double)bin);
        put_double(file.data + sample_at(1, bin), 1500 / 1.15);
        put_double(file.data + sample_at(2, bin), 1500 / 1.66);
    }
    return file;
}

static int looked_up(const float f[3])
{
    return (int)floor((double)f[0] * 1500 + 0.5);
}

static test_bytes table;
static hnbrdf_measured *numbered;

static int set_up(void **state)
{
    (void)state;
    table = numbered_table();
    numbered = expect_opens(table.data, table.size, "numbered.binary");
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    hnbrdf_measured_close(numbered);
    free(table.data);
    return 0;
}

/* ---- Lookup ---------------------------------------------------------------------------------- */

/* Directions as floats are off by 1e-7, and the half vector of two that point apart by 1e-7 /
 * cos(theta_d). That blurs phi_d by `blur`; bins of half a degree to either side are left out
 * where it is more than half of that. In theta the edges are farther away. */
static void the_centre_of_every_bin_finds_that_bin(void **state)
{
    int found = 0;
    (void)state;
    for (int bin = 0; bin < BINS; bin += 7) { /* prime to 90 and 180: meets every row and column */
        int i = bin / (TD * PD), j = bin / PD % TD, k = bin % PD;
        double theta_h = (i + 0.5) / TH * (i + 0.5) / TH * PI / 2,
               theta_d = (j + 0.5) / TD * PI / 2;
        float wi[3], wo[3], f[3];
        double blur = 1e-7 / sin(theta_d) + 1e-7 / (cos(theta_d) * sin(theta_h));
        if (blur > 0.25 * PI / PD ||
            !pair_at(theta_h, theta_d, (k + 0.5) / PD * PI, bin % 6, wi, wo))
            continue;
        assert_int_equal(hnbrdf_measured_eval(numbered, wi, wo, f), 1);
        assert_int_equal(looked_up(f), bin);
        assert_int_equal(hnbrdf_measured_eval(numbered, wo, wi, f), 1); /* phi_d + pi */
        assert_int_equal(looked_up(f), bin);
        found++;
    }
    assert_in_range(found, 1080000 / 7, 1120000 / 7); /* 76 % of the bins lie above the horizon */
}

/* Six pairs and the bins that the published reader finds for them, degrees. */
static void published_pairs_find_their_bins(void **state)
{
    static const struct {
        double angles[4];
        int bin;
    } pairs[] = {{{10, -35, 42, 70}, 684386},  {{45.2, 20, 43.1, 203}, 202374},
                 {{30, 110, 87, 285}, 820445}, {{50, 140, 48, 143}, 1069511},
                 {{65, -75, 40, 20}, 994975},  {{72, 10, 70.5, 186}, 385477}};
    (void)state;
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        double angles[4];
        float f[3];
        for (int k = 0; k < 4; k++)
            angles[k] = pairs[i].angles[k] * PI / 180;
        assert_int_equal(eval_angles(numbered, angles, f), 1);
        assert_int_equal(looked_up(f), pairs[i].bin);
    }
}

static void swapping_directions_gives_the_same_bits(void **state)
{
    hnbrdf_rng rng;
    (void)state;
    hnbrdf_rng_seed(&rng, 5, 5);
    for (int i = 0; i < 300000; i++) {
        float wi[3], wo[3], f[3], g[3];
        hnbrdf_sampler_draw((hnbrdf_sampler)(i % 3), &rng, wi, wo);
        assert_int_equal(hnbrdf_measured_eval(numbered, wi, wo, f),
                         hnbrdf_measured_eval(numbered, wo, wi, g));
        assert_memory_equal(f, g, sizeof f);
    }
}

static void the_poles_find_the_first_bins(void **state)
{
    const float n[3] = {0, 0, 1}, w[3] = {0.6f, 0.0f, 0.8f};
    float f[3];
    (void)state;
    assert_int_equal(hnbrdf_measured_eval(numbered, n, n, f), 1);
    assert_int_equal(looked_up(f), 0);
    assert_int_equal(hnbrdf_measured_eval(numbered, n, w, f), 1); /* phi_d = pi, the same as 0 */
    assert_int_equal(looked_up(f) % PD, 0);
    assert_int_equal(hnbrdf_measured_eval(numbered, w, n, f), 1);
    assert_int_equal(looked_up(f) % PD, 0);
    assert_int_equal(hnbrdf_measured_eval(numbered, w, w, f), 1); /* retro: theta_d = 0 */
    assert_int_equal(looked_up(f) / PD % TD, 0);
}

/* float32 storage of a product rounded in double: 2^-24 relative. */
static void channels_carry_their_scale(void **state)
{
    float f[3];
    (void)state;
    assert_int_equal(eval_angles(numbered, (double[4]){0.3, 0.2, 0.9, 1.9}, f), 1);
    assert_true(fabs((double)f[1] - 1.0) < 1e-7 && fabs((double)f[2] - 1.0) < 1e-7);
}

/* ---- Validity -------------------------------------------------------------------------------- */

static void a_bin_with_a_bad_channel_is_no_measurement(void **state)
{
    static const double bad[] = {-1.0, -1e-300, NAN, INFINITY, -INFINITY, 1e300};
    const double angles[4] = {0.3, 0.2, 0.9, 1.9};
    float f[3];
    (void)state;
    eval_angles(numbered, angles, f);
    int bin = looked_up(f);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i += 2) {
        int channel = (int)(i / 2);
        unsigned char saved[8];
        memcpy(saved, table.data + sample_at(channel, bin), 8);
        for (size_t k = i; k < i + 2; k++) {
            put_double(table.data + sample_at(channel, bin), bad[k]);
            hnbrdf_measured *measured = expect_opens(table.data, table.size, "x");
            assert_int_equal(eval_angles(measured, angles, f), 0);
            assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
            hnbrdf_measured_close(measured);
        }
        memcpy(table.data + sample_at(channel, bin), saved, 8);
    }
}

static void measured_zeros_are_measurements(void **state)
{
    float f[3] = {1, 1, 1};
    test_bytes file = numbered_table();
    (void)state;
    memset(file.data + 12, 0, FILE_SIZE - 12);
    put_double(file.data + sample_at(1, 0), -0.0);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    assert_int_equal(eval_angles(measured, (double[4]){0, 0, 0, 0}, f), 1);
    assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
    hnbrdf_measured_close(measured);
    free(file.data);
}

static void the_summary_tells_the_valid_share(void **state)
{
    (void)state;
    assert_non_null(strstr(hnbrdf_measured_summary(numbered), "100.0 % valid (unusual"));
    for (int bin = 0; bin < BINS / 4; bin++)
        put_double(table.data + sample_at(0, bin), -1.0);
    hnbrdf_measured *measured = expect_opens(table.data, table.size, "x");
    for (int bin = 0; bin < BINS / 4; bin++)
        put_double(table.data + sample_at(0, bin), (double)bin);
    assert_non_null(strstr(hnbrdf_measured_summary(measured), "75.0 % valid"));
    assert_null(strstr(hnbrdf_measured_summary(measured), "unusual"));
    hnbrdf_measured_close(measured);
}

/* ---- Refusals -------------------------------------------------------------------------------- */

static void expect_header(uint32_t a, uint32_t b, uint32_t c, size_t size, hnbrdf_result result,
                          const char *words)
{
    unsigned char saved[12];
    memcpy(saved, table.data, 12);
    put_le(table.data, a, 4);
    put_le(table.data + 4, b, 4);
    put_le(table.data + 8, c, 4);
    expect_refusal(table.data, size, result, words);
    memcpy(table.data, saved, 12);
}

static void every_wrong_header_is_refused(void **state)
{
    (void)state;
    expect_header(180, 90, 90, FILE_SIZE, HNBRDF_ERROR_FORMAT,
                  "180 90 90 bins, expected 90 90 180");
    expect_header(90, 180, 90, FILE_SIZE, HNBRDF_ERROR_FORMAT,
                  "90 180 90 bins, expected 90 90 180");
    expect_header(1, 1, 1458000, FILE_SIZE, HNBRDF_ERROR_FORMAT, "1 1 1458000 bins");
    expect_header(0, 0, 0, FILE_SIZE, HNBRDF_ERROR_FORMAT, "0 0 0 bins");
    expect_header(0xffffffff, 90, 180, FILE_SIZE, HNBRDF_ERROR_FORMAT, "4294967295 90 180 bins");
    expect_header(90, 90, 360, FILE_SIZE, HNBRDF_ERROR_FORMAT, "expected 69984012");
    expect_header(180, 90, 90, 400, HNBRDF_ERROR_FORMAT, "180 90 90 bins");
    expect_header(91, 90, 180, 400, HNBRDF_ERROR_FORMAT, "expected an RGL .bsdf");
}

static void every_truncation_is_refused(void **state)
{
    static const size_t sizes[] = {
        12,           13, 19, 20, 12 + 8 * BINS - 1, 12 + 8 * BINS, 12 + 16 * BINS, FILE_SIZE - 8,
        FILE_SIZE - 1};
    hnbrdf_rng rng;
    (void)state;
    for (size_t size = 1; size < 12; size++)
        expect_refusal(table.data, size, HNBRDF_ERROR_FORMAT, "expected an RGL .bsdf");
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        expect_refusal(table.data, sizes[i], HNBRDF_ERROR_FORMAT, "truncated");
    hnbrdf_rng_seed(&rng, 1, 1);
    for (int i = 0; i < 20; i++)
        expect_refusal(table.data, 12 + hnbrdf_rng_u32(&rng) % (FILE_SIZE - 12),
                       HNBRDF_ERROR_FORMAT, "expected 34992012");
}

static void bytes_after_the_table_are_mentioned(void **state)
{
    test_bytes file = {realloc(numbered_table().data, FILE_SIZE + 5), FILE_SIZE + 5};
    (void)state;
    assert_non_null(file.data);
    memset(file.data + FILE_SIZE, 0, 5);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    assert_non_null(strstr(hnbrdf_measured_summary(measured), "5 bytes after the table ignored"));
    hnbrdf_measured_close(measured);
    free(file.data);
}

static void a_table_without_any_valid_bin_is_refused(void **state)
{
    test_bytes file = numbered_table();
    (void)state;
    for (int bin = 0; bin < BINS; bin++)
        put_double(file.data + sample_at(bin % 3, bin), -1.0);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_FORMAT, "all 1458000 MERL bins are negative");
    free(file.data);
}

/* ---- Tables over the full circle of phi_d ---------------------------------------------------- */

enum { FULL = 2 * PD, FULL_SIZE = 12 + 48 * BINS };

static size_t full_sample_at(int channel, int bin, int half)
{
    return 12 + 8 * ((size_t)channel * BINS * 2 + (size_t)(bin / PD) * FULL + (size_t)(bin % PD) +
                     (size_t)half * PD);
}

/* numbered_table() with every phi_d twice. */
static test_bytes full_table(void)
{
    test_bytes file = {malloc(FULL_SIZE), FULL_SIZE};
    assert_non_null(file.data);
    memcpy(file.data, table.data, 8);
    put_le(file.data + 8, FULL, 4);
    for (int channel = 0; channel < 3; channel++)
        for (int row = 0; row < TH * TD; row++)
            for (int half = 0; half < 2; half++)
                memcpy(file.data + full_sample_at(channel, row * PD, half),
                       table.data + sample_at(channel, row * PD), (size_t)PD * 8);
    return file;
}

static void assert_equal_values(const hnbrdf_measured *a, const hnbrdf_measured *b)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 6, 6);
    for (int i = 0; i < 100000; i++) {
        float wi[3], wo[3], f[3], g[3];
        hnbrdf_sampler_draw((hnbrdf_sampler)(i % 3), &rng, wi, wo);
        assert_int_equal(hnbrdf_measured_eval(a, wi, wo, f), hnbrdf_measured_eval(b, wi, wo, g));
        assert_memory_equal(f, g, sizeof f);
    }
}

static void equal_halves_are_read_as_one(void **state)
{
    (void)state;
    test_bytes file = full_table();
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "full.binary");
    assert_equal_values(measured, numbered);
    assert_non_null(strstr(hnbrdf_measured_summary(measured), "90 x 90 x 360 bins"));
    assert_non_null(strstr(hnbrdf_measured_summary(measured), "reciprocal, 100.0 % valid"));
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* 1e-3 is more than a rounding of 6e-8 and less than 1 %, what it may become. */
static void halves_equal_but_for_rounding_give_their_mean(void **state)
{
    (void)state;
    const double angles[4] = {0.3, 0.2, 0.9, 1.9};
    float f[3], g[3];
    test_bytes file = full_table();
    eval_angles(numbered, angles, f);
    const int bin = looked_up(f);
    put_double(file.data + full_sample_at(0, bin, 1), (double)bin * (1 + 1e-3));
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "full.binary");
    assert_int_equal(eval_angles(measured, angles, g), 1);
    /* the mean in double, then rounded to a float of the order of 1 by 2^-24 */
    assert_true(fabs((double)g[0] / ((double)bin / 1500 * (1 + 5e-4)) - 1) < 1.2e-7);
    assert_true(g[1] == f[1] && g[2] == f[2]);
    hnbrdf_measured_close(measured);
    free(file.data);
}

static void what_one_half_holds_is_enough(void **state)
{
    (void)state;
    test_bytes file = full_table();
    for (int bin = 0; bin < BINS; bin++)
        put_double(file.data + full_sample_at(bin % 3, bin, bin % 2), bin % 5 ? -1.0 : NAN);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "full.binary");
    assert_equal_values(measured, numbered);
    hnbrdf_measured_close(measured);
    for (int bin = 0; bin < BINS; bin++)
        put_double(file.data + full_sample_at(bin % 3, bin, 1 - bin % 2), -1.0);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_FORMAT, "all 1458000 MERL bins are negative");
    free(file.data);
}

/* In whichever channel and half. */
static void halves_that_differ_are_refused(void **state)
{
    (void)state;
    test_bytes file = full_table();
    put_double(file.data + full_sample_at(0, 700000, 0), 700000 * 1.02);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_UNSUPPORTED,
                   "1 of 1458000 differ between phi_d and phi_d + pi");
    put_double(file.data + full_sample_at(2, 3, 1), 0.0);
    put_double(file.data + full_sample_at(1, BINS - 1, 1), 1500 / 1.15 * 0.98);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_UNSUPPORTED, "3 of 1458000 differ");
    free(file.data);
}

static void a_size_of_the_other_kind_is_refused(void **state)
{
    (void)state;
    test_bytes file = full_table();
    expect_refusal(file.data, file.size - 1, HNBRDF_ERROR_FORMAT,
                   "69984011 bytes, expected 69984012");
    put_le(file.data + 8, PD, 4);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_FORMAT, "the size is that of 90 90 360");
    free(file.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_centre_of_every_bin_finds_that_bin),
        cmocka_unit_test(published_pairs_find_their_bins),
        cmocka_unit_test(swapping_directions_gives_the_same_bits),
        cmocka_unit_test(the_poles_find_the_first_bins),
        cmocka_unit_test(channels_carry_their_scale),
        cmocka_unit_test(a_bin_with_a_bad_channel_is_no_measurement),
        cmocka_unit_test(measured_zeros_are_measurements),
        cmocka_unit_test(the_summary_tells_the_valid_share),
        cmocka_unit_test(every_wrong_header_is_refused),
        cmocka_unit_test(every_truncation_is_refused),
        cmocka_unit_test(bytes_after_the_table_are_mentioned),
        cmocka_unit_test(a_table_without_any_valid_bin_is_refused),
        cmocka_unit_test(equal_halves_are_read_as_one),
        cmocka_unit_test(halves_equal_but_for_rounding_give_their_mean),
        cmocka_unit_test(what_one_half_holds_is_enough),
        cmocka_unit_test(halves_that_differ_are_refused),
        cmocka_unit_test(a_size_of_the_other_kind_is_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
