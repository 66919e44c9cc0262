/* test_measured_nbrdf.c: networks of Neural-BRDF from six .npy files: values, every storage that
 * NumPy may choose, and files that are refused. The files are made here. */
#include "nbrdf_support.h"

#include "measured/nbrdf.h"

#include <unistd.h>

static char directory[64];

static int make_directory(void **state)
{
    (void)state;
    snprintf(directory, sizeof directory, "/tmp/hnbrdf_nbrdf_XXXXXX");
    return mkdtemp(directory) == NULL;
}

static int remove_directory(void **state)
{
    (void)state;
    return rmdir(directory); /* fails if a test left something */
}

static hnbrdf_measured *open_path(const char *path)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error = {""};
    if (hnbrdf_measured_open(path, NULL, &measured, &error) != HNBRDF_OK)
        fail_msg("%s", error.text);
    return measured;
}

static hnbrdf_measured *open_part(const char *name, const char *ending)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s%s", directory, name, ending);
    return open_path(path);
}

/* Over many pairs, to the last bit. */
static void expect_same_values(const hnbrdf_measured *a, const hnbrdf_measured *b)
{
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 5, 0);
    for (int k = 0; k < 500; k++) {
        float wi[3], wo[3], first[3], second[3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_GRID, &rng, wi, wo);
        assert_int_equal(hnbrdf_measured_eval(a, wi, wo, first), 1);
        assert_int_equal(hnbrdf_measured_eval(b, wi, wo, second), 1);
        assert_memory_equal(first, second, sizeof first);
    }
}

/* ---- Values ---------------------------------------------------------------------------------- */

static void any_of_the_six_files_opens_the_material(void **state)
{
    test_network network;
    (void)state;
    test_network_make(&network, 21, 21, 1);
    test_write_npy(directory, "ma_te_rgb", &network);
    hnbrdf_measured *whole = open_part("ma_te_rgb", "");
    assert_string_equal(hnbrdf_measured_name(whole), "ma_te");
    assert_int_equal(hnbrdf_measured_format_of(whole), HNBRDF_MEASURED_NBRDF);
    assert_int_equal(hnbrdf_measured_is_isotropic(whole), 1);
    assert_non_null(strstr(hnbrdf_measured_summary(whole), "6-21-21-3"));
    for (int k = 0; k < TEST_PARTS; k++) {
        hnbrdf_measured *part = open_part("ma_te_rgb", test_part_ending(k));
        assert_string_equal(hnbrdf_measured_name(part), "ma_te");
        expect_same_values(whole, part);
        hnbrdf_measured_close(part);
    }
    hnbrdf_measured_close(whole);
    test_remove_npy(directory, "ma_te_rgb");
}

/* Within the rounding of sums in floats, for widths that fill no vector and that fill one. */
static void values_follow_the_formulas(void **state)
{
    static const size_t widths[][2] = {{21, 21}, {1, 32}, {32, 1}, {8, 16}, {7, 9}};
    (void)state;
    for (size_t n = 0; n < sizeof widths / sizeof widths[0]; n++) {
        test_network network;
        hnbrdf_rng rng;
        int positive = 0;
        test_network_make(&network, widths[n][0], widths[n][1], 2 + n);
        test_write_npy(directory, "a", &network);
        hnbrdf_measured *measured = open_part("a", "_fc1.npy");
        hnbrdf_rng_seed(&rng, n, 0);
        for (int k = 0; k < 2000; k++) {
            float wi[3], wo[3], f[3];
            double i[3], o[3], expected[3], bound[3];
            hnbrdf_sampler_draw(k % 2 ? HNBRDF_SAMPLER_GRID : HNBRDF_SAMPLER_UNIFORM, &rng, wi, wo);
            if (k % 50 == 0) {
                memcpy(wo, wi, sizeof wo); /* theta_d = 0 */
            } else if (k % 50 == 1) {
                wo[0] = -wi[0]; /* theta_h = 0 */
                wo[1] = -wi[1];
                wo[2] = wi[2];
            }
            double li = 0.0, lo = 0.0;
            for (int c = 0; c < 3; c++) {
                li += (double)wi[c] * (double)wi[c];
                lo += (double)wo[c] * (double)wo[c];
            }
            for (int c = 0; c < 3; c++) {
                i[c] = (double)wi[c] / sqrt(li);
                o[c] = (double)wo[c] / sqrt(lo);
            }
            test_network_eval(&network, i, o, expected, bound);
            assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
            for (int c = 0; c < 3; c++) {
                positive += f[c] > 0.0f;
                if (!(fabs((double)f[c] - expected[c]) <= bound[c]))
                    fail_msg("%zu-%zu, pair %d, channel %d: %.9g, expected %.9g within %.3g",
                             widths[n][0], widths[n][1], k, c, (double)f[c], expected[c], bound[c]);
            }
        }
        assert_true(positive > 1000); /* not all clamped to 0 */
        hnbrdf_measured_close(measured);
        test_remove_npy(directory, "a");
    }
}

/* One unit lets the exponent through as it stands: f = exp(x) - 1, from tiny to far too large. */
static void the_exponential_is_exact_to_the_last_bit_of_a_float(void **state)
{
    static const float exponents[] = {0x1p-60f, 1e-20f, 1e-7f, 0.01f, 0.34f, 0.35f,  0.7f, 1.0f,
                                      3.5f,     20.0f,  40.0f, 87.0f, 89.0f, 150.0f, 1e30f};
    (void)state;
    for (size_t k = 0; k < sizeof exponents / sizeof exponents[0]; k++) {
        const float up[3] = {0.0f, 0.0f, 1.0f};
        float f[3];
        test_network network;
        test_network_make(&network, 1, 1, 1);
        for (int part = 0; part < TEST_PARTS; part++)
            memset(network.values[part], 0, sizeof network.values[part]);
        network.values[5][0] = exponents[k];
        network.values[5][1] = -exponents[k];
        test_write_npy(directory, "e", &network);
        hnbrdf_measured *measured = open_part("e", "");
        assert_int_equal(hnbrdf_measured_eval(measured, up, up, f), 1);
        double exact = expm1((double)exponents[k]), most = (double)HNBRDF_MAX_VALUE;
        exact = exact < most ? exact : most;
        if (!(fabs((double)f[0] - exact) <= 0.501 * 0x1p-23 * exact))
            fail_msg("exp(%g) - 1: %.9g, expected %.9g", (double)exponents[k], (double)f[0], exact);
        assert_true(f[1] == 0.0f && f[2] == 0.0f);
        hnbrdf_measured_close(measured);
        test_remove_npy(directory, "e");
    }
}

static void below_the_horizon_there_is_no_value(void **state)
{
    const float up[3] = {0.6f, 0.0f, 0.8f}, down[3] = {0.6f, 0.0f, -0.8f};
    float f[3] = {1.0f, 1.0f, 1.0f};
    test_network network;
    (void)state;
    test_network_make(&network, 21, 21, 1);
    test_write_npy(directory, "h", &network);
    hnbrdf_measured *measured = open_part("h", "");
    assert_int_equal(hnbrdf_measured_eval(measured, up, down, f), 0);
    assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
    assert_int_equal(hnbrdf_measured_eval(measured, down, up, f), 0);
    hnbrdf_measured_close(measured);
    test_remove_npy(directory, "h");
}

/* ---- Storage --------------------------------------------------------------------------------- */

/* Doubles, the other byte order, columns first (as PyTorch's transposed weights are saved). */
static void every_storage_gives_the_same_values(void **state)
{
    static const char *const types[] = {"<f4", ">f4", "<f8", ">f8"};
    test_network network;
    (void)state;
    test_network_make(&network, 21, 21, 3);
    test_write_npy(directory, "a", &network);
    hnbrdf_measured *usual = open_part("a", "");
    for (int n = 0; n < 24; n++) {
        char path[256];
        for (int k = 0; k < TEST_PARTS; k++) {
            test_bytes file = test_npy(&network, k, types[n % 4], n / 4 % 2, n / 8 + 1);
            snprintf(path, sizeof path, "%s/b%s", directory, test_part_ending(k));
            test_write_file(path, file.data, file.size);
            free(file.data);
        }
        hnbrdf_measured *other = open_part("b", "_b2.npy");
        expect_same_values(usual, other);
        hnbrdf_measured_close(other);
    }
    hnbrdf_measured_close(usual);
    test_remove_npy(directory, "a");
    test_remove_npy(directory, "b");
}

/* ---- Refusals -------------------------------------------------------------------------------- */

static void expect_path_refused(const char *path, hnbrdf_result expected, const char *words)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error = {""};
    hnbrdf_result result = hnbrdf_measured_open(path, NULL, &measured, &error);
    assert_null(measured);
    if (result != expected || !strstr(error.text, words) || strchr(error.text, '\n'))
        fail_msg("result %d, expected %d and \"%s\": %s", (int)result, (int)expected, words,
                 error.text);
}

/* A part whose file is `file` makes opening fail, whichever part is named. */
static void expect_part_refused(const test_network *network, int part, test_bytes file,
                                hnbrdf_result result, const char *words)
{
    char path[256], named[512];
    test_write_npy(directory, "bad", network);
    snprintf(path, sizeof path, "%s/bad%s", directory, test_part_ending(part));
    test_write_file(path, file.data, file.size);
    snprintf(named, sizeof named, "bad%s: %s", test_part_ending(part), words);
    snprintf(path, sizeof path, "%s/bad_b3.npy", directory);
    expect_path_refused(path, result, named);
    snprintf(path, sizeof path, "%s/bad", directory);
    expect_path_refused(path, result, named);
    test_remove_npy(directory, "bad");
    free(file.data);
}

static void wrong_shapes_are_named(void **state)
{
    test_network good, other;
    (void)state;
    test_network_make(&good, 21, 20, 4);
    test_network_make(&other, 19, 18, 4);
    static const char *const words[TEST_PARTS] = {
        NULL,                             /* another width of the first layer */
        "shape 19, expected 21",          /* b1 */
        "shape 19 x 18, expected 21 x N", /* fc2 */
        "shape 18, expected 20",          /* b2 */
        "shape 18 x 3, expected 20 x 3",  /* fc3 */
        NULL                              /* b3 is the same */
    };
    for (int k = 0; k < TEST_PARTS; k++)
        if (words[k])
            expect_part_refused(&good, k, test_npy(&other, k, "<f4", 0, 1), HNBRDF_ERROR_FORMAT,
                                words[k]);
    other = good;
    other.rows[0] = 7;
    expect_part_refused(&good, 0, test_npy(&other, 0, "<f4", 0, 1), HNBRDF_ERROR_FORMAT,
                        "shape 7 x 21, expected 6 x N, N from 1 to 1024");
    other = good;
    other.columns[4] = other.columns[5] = 4;
    expect_part_refused(&good, 4, test_npy(&other, 4, "<f4", 0, 1), HNBRDF_ERROR_FORMAT,
                        "shape 20 x 4, expected 20 x 3");
    expect_part_refused(&good, 5, test_npy(&other, 5, "<f4", 0, 1), HNBRDF_ERROR_FORMAT,
                        "shape 4, expected 3");
    expect_part_refused(&good, 3, test_npy(&good, 2, "<f4", 0, 1), HNBRDF_ERROR_FORMAT,
                        "shape 21 x 20, expected 20");
}

static void weights_that_are_not_finite_are_refused(void **state)
{
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    (void)state;
    for (int k = 0; k < TEST_PARTS; k++) {
        test_network good, network;
        char words[64];
        test_network_make(&good, 21, 21, 4);
        network = good;
        size_t last = network.rows[k] * network.columns[k];
        network.values[k][last - 1] = bad[k % 3];
        snprintf(words, sizeof words, "number %zu of %zu is not finite", last, last);
        expect_part_refused(&good, k, test_npy(&network, k, "<f4", 0, 1), HNBRDF_ERROR_FORMAT,
                            words);
    }
    /* a double beyond the floats */
    test_network good;
    test_network_make(&good, 21, 21, 4);
    test_bytes file = test_npy(&good, 5, "<f8", 0, 1);
    put_double(file.data + file.size - 8, 1e300);
    expect_part_refused(&good, 5, file, HNBRDF_ERROR_FORMAT, "number 3 of 3 is not finite");
}

/* The header of part 0 with `from` replaced by `to`, of the same length. */
static test_bytes replaced(const test_network *network, const char *from, const char *to)
{
    test_bytes file = test_npy(network, 0, "<f4", 0, 1);
    size_t at = 0, length = strlen(from);
    assert_int_equal(length, strlen(to));
    while (memcmp(file.data + at, from, length) != 0)
        assert_true(++at + length < file.size);
    memcpy(file.data + at, to, length);
    return file;
}

static void headers_say_what_was_expected(void **state)
{
    static const struct {
        const char *from, *to, *words;
    } cases[] = {
        {"'<f4'", "'<i4'", "found ''<i4', 'fortran_', expected a type"},
        {"'<f4'", "'|O' ", "expected a type"},
        {"False", "Maybe", "expected False"},
        {"(6, 21)", "(6, 0) ", "expected a shape"},
        {"(6, 21)", "(6,2,1)", "expected a shape"},
        {"(6, 21)", "()     ", "expected a shape"},
        {"(6, 21)", "(9999 )", "expected a shape"},
        {"(6, 21)", "(-6, 2)", "expected a shape"},
        {"'shape'", "'shapE'", "expected 'shape':"},
        {"'descr'", "'shape'", "expected"},
        {"{'descr", "['descr", "expected {"},
        {"(6, 21)", "(6, 20)", "expected 608 for 120 numbers of 4 bytes"},
        {"21), }", "21)   ", "expected }"},
        {"\x01", "\x04", "NumPy file of version 4.0, expected 1 to 3"},
    };
    test_network network;
    (void)state;
    test_network_make(&network, 21, 21, 4);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char path[256];
        hnbrdf_error error = {""};
        nbrdf_array array = {0};
        test_bytes file = replaced(&network, cases[i].from, cases[i].to);
        hnbrdf_result result = hnbrdf_npy_parse(file.data, file.size, "x.npy", &array, &error);
        if (result == HNBRDF_OK || !strstr(error.text, cases[i].words))
            fail_msg("%s: %d %s", cases[i].to, (int)result, error.text);
        snprintf(path, sizeof path, "x.npy: ");
        assert_memory_equal(error.text, path, strlen(path));
        free(file.data);
    }
}

/* Every beginning of a file is refused; nothing reads past it. */
static void truncated_files_are_refused(void **state)
{
    test_network network;
    (void)state;
    test_network_make(&network, 21, 21, 4);
    for (int version = 1; version <= 2; version++) {
        test_bytes file = test_npy(&network, 0, "<f4", 0, version);
        for (size_t size = 0; size < file.size; size++) {
            unsigned char *exact = malloc(size ? size : 1);
            nbrdf_array array = {0};
            hnbrdf_error error = {""};
            assert_non_null(exact);
            memcpy(exact, file.data, size);
            assert_int_not_equal(hnbrdf_npy_parse(exact, size, "x.npy", &array, &error), HNBRDF_OK);
            assert_non_null(strstr(error.text, "x.npy: "));
            assert_null(array.values);
            free(exact);
        }
        file.data = realloc(file.data, file.size + 1);
        assert_non_null(file.data);
        file.data[file.size] = 0;
        nbrdf_array array = {0};
        assert_int_equal(hnbrdf_npy_parse(file.data, file.size + 1, "x.npy", &array, NULL),
                         HNBRDF_ERROR_FORMAT);
        free(file.data);
    }
}

static void other_numpy_files_are_refused(void **state)
{
    test_network network;
    char path[256];
    (void)state;
    test_network_make(&network, 21, 21, 4);
    test_bytes file = test_npy(&network, 0, "<f4", 0, 1);
    expect_refusal(file.data, file.size, HNBRDF_ERROR_FORMAT, "expected one of the six");
    snprintf(path, sizeof path, "%s/lonely_fc1.npy", directory);
    test_write_file(path, file.data, file.size);
    expect_path_refused(path, HNBRDF_ERROR_IO, "lonely_b1.npy: cannot be opened");
    remove(path);
    snprintf(path, sizeof path, "%s/weights.npy", directory);
    test_write_file(path, file.data, file.size);
    expect_path_refused(path, HNBRDF_ERROR_FORMAT, "weights.npy: a NumPy file, expected one of");
    remove(path);
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error = {""};
    assert_int_equal(
        hnbrdf_measured_open_memory(file.data, file.size, "a_fc1.npy", NULL, &measured, &error),
        HNBRDF_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.text, "opened by a path"));
    free(file.data);
    snprintf(path, sizeof path, "%s/nothing", directory);
    expect_path_refused(path, HNBRDF_ERROR_IO, "nothing: cannot be opened");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_of_the_six_files_opens_the_material),
        cmocka_unit_test(values_follow_the_formulas),
        cmocka_unit_test(the_exponential_is_exact_to_the_last_bit_of_a_float),
        cmocka_unit_test(below_the_horizon_there_is_no_value),
        cmocka_unit_test(every_storage_gives_the_same_values),
        cmocka_unit_test(wrong_shapes_are_named),
        cmocka_unit_test(weights_that_are_not_finite_are_refused),
        cmocka_unit_test(headers_say_what_was_expected),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(other_numpy_files_are_refused),
    };
    return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
