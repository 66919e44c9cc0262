/* test_measured_files.c: opening by path: names, limits, and files that are none. Files are
 * written to the working directory and removed. */
#include "measured_support.h"

#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "measured-XXXXXX";

static int set_up(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    return rmdir(folder);
}

static void in_folder(char path[512], const char *name)
{
    snprintf(path, 512, "%s/%s", folder, name);
}

static void write_file(const char *path, const void *data, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void expect_open_fails(const char *path, const hnbrdf_measured_options *options,
                              hnbrdf_result result, const char *words)
{
    hnbrdf_error error = {""};
    hnbrdf_measured *measured = NULL;
    assert_int_equal(hnbrdf_measured_open(path, options, &measured, &error), result);
    assert_null(measured);
    if (!strstr(error.text, path) || !strstr(error.text, words) || strchr(error.text, '\n'))
        fail_msg("expected one line with %s and \"%s\": %s", path, words, error.text);
}

static void a_file_and_its_bytes_give_the_same_values(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    char path[512];
    float f[3], g[3];
    (void)state;
    in_folder(path, "some.material_rgb.bsdf");
    write_file(path, file.data, file.size);
    hnbrdf_measured *from_file = NULL, *from_bytes = expect_opens(file.data, file.size, path);
    assert_int_equal(hnbrdf_measured_open(path, NULL, &from_file, NULL), HNBRDF_OK);
    assert_string_equal(hnbrdf_measured_name(from_file), "some.material");
    assert_string_equal(hnbrdf_measured_name(from_bytes), "some.material");
    assert_int_equal(hnbrdf_measured_format_of(from_file), HNBRDF_MEASURED_RGL);
    eval_angles(from_file, (double[4]){0.4, 1, 0.8, 2}, f);
    eval_angles(from_bytes, (double[4]){0.4, 1, 0.8, 2}, g);
    assert_memory_equal(f, g, sizeof f);
    hnbrdf_measured_close(from_file);
    hnbrdf_measured_close(from_bytes);
    remove(path);
    free(file.data);
}

static void missing_empty_and_foreign_files_are_refused(void **state)
{
    char path[512];
    (void)state;
    in_folder(path, "none.bsdf");
    expect_open_fails(path, NULL, HNBRDF_ERROR_IO, "cannot be opened");
    expect_open_fails(folder, NULL, HNBRDF_ERROR_IO, "expected a regular file");
    write_file(path, "", 0);
    expect_open_fails(path, NULL, HNBRDF_ERROR_FORMAT, "empty, expected an RGL .bsdf");
    write_file(path, "%PDF-1.7 is not a material", 26);
    expect_open_fails(path, NULL, HNBRDF_ERROR_FORMAT, "a PDF document, expected an RGL .bsdf");
    remove(path);
}

/* Each says what it is and what is expected; the content counts before the name, but for formats
 * whose content looks like one that is read. */
static void other_formats_of_the_field_are_named(void **state)
{
    static const struct {
        const char *name, *content, *expected;
    } cases[] = {
        {"gold.PBSDF", NULL, "a polarised BRDF"},
        {"gold.pbsdf", "", "a polarised BRDF"},
        {"gold.hpbrdf", "tensor_file", "a hyperspectral polarised BRDF"},
        {"gold.axf", "\x89HDF\r\n\x1a\n", "an AxF material"},
        {"glass.bsdf", "<?xml version=\"1.0\"?><WindowElement>",
         "an XML text: matrices of Radiance"},
        {"glass.xml", "<WindowElement xmlns=", "an XML text of matrices of Radiance or WINDOW"},
        {"lens.bsdf", "#Data\nSource  Measured\n", "a text, not RGL's .bsdf"},
        {"data.mat", "MATLAB 5.0 MAT-file, Platform", "a MATLAB file"},
        {"data.mat", "anything", "a MATLAB file"},
        {"lamp.ies", "IESNA:LM-63-2002\n", "photometric data of a lamp"},
        {"lamp.ies", "IESNA91\n", "photometric data of a lamp"},
        {"steel.mbsdf", "NVIDIA ARC MBSDF V1\n", "an MBSDF measurement"},
        {"steel.astm", "VERSION 1\n", "a BRDF as ASTM E1392"},
        {"steel.ddr", "; Integra\n", "a BRDF of Integra"},
        {"steel.exr", "\x76\x2f\x31\x01\x02", "an OpenEXR picture"},
        {"sky.binary", "#?RADIANCE\n", "a Radiance picture"},
        {"gold.binary", "analytic\n::begin parameters\n",
         "make a model of it first: hnbrdf import"},
        {"scan.tif", "MM", NULL}, /* two bytes are of no format */
    };
    test_bytes rgl = test_rgl(TEST_ISOTROPIC);
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        const char *content = cases[k].content;
        const void *data = content ? (const void *)content : rgl.data;
        hnbrdf_measured *measured = NULL;
        hnbrdf_error error;
        char path[400];
        snprintf(path, sizeof path, "%0300d/%s", 0, cases[k].name);
        assert_int_equal(hnbrdf_measured_open_memory(data, content ? strlen(content) : rgl.size,
                                                     path, NULL, &measured, &error),
                         HNBRDF_ERROR_FORMAT);
        const char *expected =
            cases[k].expected ? cases[k].expected : "2 bytes starting with 4d 4d";
        if (!strstr(error.text, expected) || !strstr(error.text, ", expected "))
            fail_msg("%s: \"%s\", expected \"%s\"", cases[k].name, error.text, expected);
        assert_int_equal(error.text[strlen(error.text) - 1], ')'); /* not cut */
    }
    free(rgl.data);
}

static void files_above_the_limit_are_refused_at_the_limit(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    hnbrdf_measured_options options = {.max_bytes = file.size - 1};
    hnbrdf_measured *measured = NULL;
    char path[512];
    (void)state;
    in_folder(path, "large.bsdf");
    write_file(path, file.data, file.size);
    expect_open_fails(path, &options, HNBRDF_ERROR_LIMIT, "limit of");
    assert_int_equal(
        hnbrdf_measured_open_memory(file.data, file.size, "x", &options, &measured, NULL),
        HNBRDF_ERROR_LIMIT);
    options.max_bytes = file.size;
    assert_int_equal(hnbrdf_measured_open(path, &options, &measured, NULL), HNBRDF_OK);
    hnbrdf_measured_close(measured);
    remove(path);
    free(file.data);
}

/* A sparse file of 2 GiB: refused after the limit, not after reading it all. */
static void a_huge_file_is_refused_without_reading_it_all(void **state)
{
    hnbrdf_measured_options options = {.max_bytes = 3u << 20};
    char path[512];
    (void)state;
    in_folder(path, "huge.binary");
    write_file(path, "", 0);
    assert_int_equal(truncate(path, (off_t)1 << 31), 0);
    expect_open_fails(path, &options, HNBRDF_ERROR_LIMIT, "larger than the limit of 3145728 bytes");
    remove(path);
}

/* Larger than the first chunk that is read: the buffer has to grow. */
static void files_of_several_chunks_are_read_whole(void **state)
{
    static unsigned char zeros[(3 << 20) + 5];
    char path[512], words[64];
    (void)state;
    in_folder(path, "zeros.binary");
    for (size_t size = (1u << 20) - 1; size <= sizeof zeros;
         size += size < (1u << 20) + 1 ? 1 : 1u << 20) {
        snprintf(words, sizeof words, "%zu bytes starting with 00 00", size);
        write_file(path, zeros, size);
        expect_open_fails(path, NULL, HNBRDF_ERROR_FORMAT, words);
    }
    remove(path);
}

static void names_come_from_the_file_name(void **state)
{
    static const char *const names[][2] = {
        {"gold.binary", "gold"},
        {"a/b.c/chm_mint_rgb.bsdf", "chm_mint"},
        {"/x/no_extension", "no_extension"},
        {"a/.bsdf", ".bsdf"},
        {"_rgb.bsdf", "_rgb.bsdf"},
        {"two.dots_rgb.bsdf", "two.dots"},
        {"rgb.bsdf", "rgb"},
        {"", "unnamed"},
        {"a/", "unnamed"},
        {"line\nfeed\x7f.bsdf", "line_feed_"},
        {"gr\xc3\xbcn.bsdf", "gr\xc3\xbcn"},
        {"bad\xff\xc3.bsdf", "bad__"},
        {"overlong\xc0\xaf\xed\xa0\x80.bsdf", "overlong_____"},
    };
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        hnbrdf_measured *measured = expect_opens(file.data, file.size, names[i][0]);
        assert_string_equal(hnbrdf_measured_name(measured), names[i][1]);
        hnbrdf_measured_close(measured);
    }
    free(file.data);
}

static void long_names_are_cut_at_a_character(void **state)
{
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    char path[600];
    (void)state;
    for (size_t i = 0; i < 500; i += 2)
        memcpy(path + i, "\xc3\xbc", 2);
    memcpy(path + 500, ".bsdf", 6);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, path);
    assert_int_equal(strlen(hnbrdf_measured_name(measured)), HNBRDF_MAX_NAME - 1);
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* The path loses its beginning, never the message what was found and expected. */
static void long_paths_leave_room_for_the_message(void **state)
{
    char path[2000];
    hnbrdf_error error;
    hnbrdf_measured *measured = NULL;
    (void)state;
    memset(path, 'a', sizeof path);
    memcpy(path + sizeof path - 11, "/last.data", 11);
    assert_int_equal(hnbrdf_measured_open_memory("123456789012", 12, path, NULL, &measured, &error),
                     HNBRDF_ERROR_FORMAT);
    assert_non_null(strstr(error.text, "aaa/last.data: 12 bytes starting with"));
    assert_non_null(
        strstr(error.text, "UTIA .bin (1990656 bytes) or an NBRDF .h5/.npy (HDF, NUMPY)"));
}

static void options_outside_their_range_are_refused(void **state)
{
    const hnbrdf_measured_options bad[] = {{.merl_lookup = (hnbrdf_merl_lookup)2},
                                           {.merl_node = (hnbrdf_merl_node)7},
                                           {.utia_mode = (hnbrdf_utia_mode)3},
                                           {.utia_scale = -1.0},
                                           {.utia_scale = NAN},
                                           {.utia_scale = INFINITY}};
    test_bytes file = test_rgl(TEST_ISOTROPIC);
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        hnbrdf_measured *measured = NULL;
        hnbrdf_error error = {""};
        assert_int_equal(
            hnbrdf_measured_open_memory(file.data, file.size, "x", &bad[i], &measured, &error),
            HNBRDF_ERROR_ARGUMENT);
        assert_int_equal(hnbrdf_measured_open("x", &bad[i], &measured, NULL),
                         HNBRDF_ERROR_ARGUMENT);
        assert_null(measured);
        assert_non_null(strstr(error.text, "measured options: "));
    }
    free(file.data);
}

static void wrong_arguments_are_refused(void **state)
{
    hnbrdf_measured *measured = NULL;
    hnbrdf_error error = {""};
    (void)state;
    assert_int_equal(hnbrdf_measured_open(NULL, NULL, &measured, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_measured_open("x", NULL, NULL, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_measured_open_memory(NULL, 1, "x", NULL, &measured, &error),
                     HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_measured_open_memory(NULL, 0, "x", NULL, &measured, &error),
                     HNBRDF_ERROR_FORMAT);
    assert_int_equal(hnbrdf_measured_open_builtin(-1, &measured, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_measured_open_builtin(1000, &measured, &error), HNBRDF_ERROR_ARGUMENT);
    assert_int_equal(hnbrdf_measured_open_builtin(0, NULL, &error), HNBRDF_ERROR_ARGUMENT);
    assert_null(measured);
    hnbrdf_measured_close(NULL);
    assert_null(hnbrdf_measured_format_name((hnbrdf_measured_format)9));
}

static void directions_below_the_horizon_or_not_finite_are_no_measurement(void **state)
{
    static const float bad[][3] = {{0, 0, -1},       {1, 0, 0},       {0, 0, 0},
                                   {0, 0, NAN},      {NAN, 0, 1},     {0, INFINITY, 1},
                                   {0, 0, INFINITY}, {0.6f, 0, -0.0f}};
    const float good[3] = {0, 0, 1};
    test_bytes file = test_rgl(TEST_WHOLE);
    hnbrdf_measured *items[2] = {expect_opens(file.data, file.size, "x"), NULL};
    (void)state;
    assert_int_equal(hnbrdf_measured_open_builtin(0, &items[1], NULL), HNBRDF_OK);
    for (size_t i = 0; i < 2 * sizeof bad / sizeof bad[0]; i++) {
        float f[3] = {1, 1, 1}, g[3] = {1, 1, 1};
        assert_int_equal(hnbrdf_measured_eval(items[i % 2], bad[i / 2], good, f), 0);
        assert_int_equal(hnbrdf_measured_eval(items[i % 2], good, bad[i / 2], g), 0);
        assert_true(f[0] == 0.0f && f[1] == 0.0f && f[2] == 0.0f);
        assert_true(g[0] == 0.0f && g[1] == 0.0f && g[2] == 0.0f);
    }
    hnbrdf_measured_close(items[0]);
    hnbrdf_measured_close(items[1]);
    free(file.data);
}

/* Lengths are divided out: rounding of the product is all that differs. */
static void the_length_of_directions_does_not_matter(void **state)
{
    const float wi[3] = {0.3f, 0.2f, 0.9f}, wo[3] = {-0.5f, 0.1f, 0.6f};
    test_bytes file = test_rgl(TEST_WHOLE);
    hnbrdf_measured *measured = expect_opens(file.data, file.size, "x");
    (void)state;
    for (float scale = 1e-30f; scale < 1e30f; scale *= 1024.0f) {
        float a[3], b[3], f[3], g[3];
        for (int i = 0; i < 3; i++) {
            a[i] = wi[i] * scale;
            b[i] = wo[i] / scale;
        }
        assert_int_equal(hnbrdf_measured_eval(measured, wi, wo, f), 1);
        assert_int_equal(hnbrdf_measured_eval(measured, a, b, g), 1);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)f[c] - (double)g[c]) < 1e-5 * (double)f[c]);
    }
    hnbrdf_measured_close(measured);
    free(file.data);
}

/* ---- The table of formats -------------------------------------------------------------------- */

/* A format that is forgotten in the table has no name; a name stands once. */
static void every_format_has_one_row(void **state)
{
    enum { LAST = HNBRDF_MEASURED_NBRDF };
    (void)state;
    int rows = 0;
    while (hnbrdf_measured_format_at(rows))
        rows++;
    assert_null(hnbrdf_measured_format_at(-1));
    for (int format = HNBRDF_MEASURED_BUILTIN; format <= LAST; format++) {
        int found = 0;
        for (int k = 0; k < rows; k++) {
            const hnbrdf_measured_format_info *info = hnbrdf_measured_format_at(k);
            if ((int)info->format != format)
                continue;
            found++;
            assert_string_equal(hnbrdf_measured_format_name((hnbrdf_measured_format)format),
                                info->name);
            assert_true((info->files != NULL) == (info->endings != NULL));
        }
        if (found != 1)
            fail_msg("format %d has %d rows", format, found);
    }
    assert_int_equal(rows, LAST + 1);
    assert_null(hnbrdf_measured_format_name((hnbrdf_measured_format)(LAST + 1)));
    assert_null(hnbrdf_measured_format_name((hnbrdf_measured_format)-1));
}

static void files_are_known_by_their_endings(void **state)
{
    static const struct {
        const char *name;
        int format; /* -1: of none */
        size_t stem;
    } cases[] = {{"a.binary", HNBRDF_MEASURED_MERL, 1},
                 {"a_rgb.bsdf", HNBRDF_MEASURED_RGL, 5},
                 {"m01.bin", HNBRDF_MEASURED_UTIA, 3},
                 {".bin", -1, 0},
                 {"a_rgb.h5", HNBRDF_MEASURED_NBRDF, 5},
                 {"a.npy", -1, 0},
                 {"a.binary.txt", -1, 0},
                 {"", -1, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        size_t stem = 99;
        int part = 99;
        const hnbrdf_measured_format_info *info =
            hnbrdf_measured_format_of_file(cases[i].name, &stem, &part);
        assert_int_equal(info ? (int)info->format : -1, cases[i].format);
        assert_int_equal(stem, info ? cases[i].stem : 99);
        assert_int_equal(part, info ? -1 : 99);
        assert_true(hnbrdf_measured_format_of_file(cases[i].name, NULL, NULL) == info);
    }
    int part = 99;
    size_t stem = 99;
    assert_non_null(hnbrdf_measured_format_of_file("a_b_b2.npy", &stem, &part));
    assert_int_equal(stem, 3);
    assert_int_equal(part, 3);
}

/* Each option stands for one member, and 0 in all members is the default. */
static void options_are_described_once(void **state)
{
    const hnbrdf_measured_format_info *info;
    hnbrdf_measured_options zeros = {0};
    size_t offsets[32];
    int count = 0;
    (void)state;
    for (int row = 0; (info = hnbrdf_measured_format_at(row)); row++)
        for (int k = 0; k < info->option_count; k++) {
            const hnbrdf_measured_option *option = &info->options[k];
            assert_true(strlen(option->name) > 2 && strlen(option->help) > 10);
            assert_true(option->offset + sizeof(int) <= sizeof zeros);
            assert_true(!option->word || (option->word(0) && !option->word(-1)));
            for (int i = 0; i < count; i++)
                assert_true(offsets[i] != option->offset);
            offsets[count++] = option->offset;
        }
    assert_int_equal(count, 7);
    assert_string_equal(hnbrdf_merl_lookup_name(HNBRDF_MERL_TRILINEAR), "trilinear");
    assert_string_equal(hnbrdf_merl_node_name(HNBRDF_MERL_EDGE), "edge");
    assert_string_equal(hnbrdf_utia_mode_name(HNBRDF_UTIA_SRGB), "srgb");
    assert_null(hnbrdf_utia_mode_name((hnbrdf_utia_mode)3));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_and_its_bytes_give_the_same_values),
        cmocka_unit_test(missing_empty_and_foreign_files_are_refused),
        cmocka_unit_test(other_formats_of_the_field_are_named),
        cmocka_unit_test(every_format_has_one_row),
        cmocka_unit_test(files_are_known_by_their_endings),
        cmocka_unit_test(options_are_described_once),
        cmocka_unit_test(files_above_the_limit_are_refused_at_the_limit),
        cmocka_unit_test(a_huge_file_is_refused_without_reading_it_all),
        cmocka_unit_test(files_of_several_chunks_are_read_whole),
        cmocka_unit_test(names_come_from_the_file_name),
        cmocka_unit_test(long_names_are_cut_at_a_character),
        cmocka_unit_test(long_paths_leave_room_for_the_message),
        cmocka_unit_test(options_outside_their_range_are_refused),
        cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(directions_below_the_horizon_or_not_finite_are_no_measurement),
        cmocka_unit_test(the_length_of_directions_does_not_matter),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
