/* test_image_radiance.c: pixels of Radiance pictures arrive with their values and in their places,
 * whatever orientation, coding and colours a file has; damaged ones are refused in one line. */
#include "radiance_writer.h"

#include <math.h>

static const char rgbe_header[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
static const char xyze_header[] = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n";

/* Every pixel of a picture of up to 20 rows is another one, but that each third row is one run; the
 * planes have runs of all lengths. As the format wants it, one mantissa is 128 or more. */
static void pixel_at(int x, int y, unsigned char rgbe[4])
{
    const int u = y % 3 == 2 ? 0 : x;
    rgbe[0] = (unsigned char)(128 + (u + 3 * y) % 128);
    rgbe[1] = (unsigned char)(u / 128 * 7 + y);
    rgbe[2] = (unsigned char)(u < 6 ? 9 : u % 256 < 140 ? 200 : 0);
    rgbe[3] = (unsigned char)(x == 3 && y == 1 ? 0 : 120 + y % 17);
}

/* RGB to XYZ: Radiance's standard primaries (x, y, 1 - x - y) and their shares of luminance, which
 * are what equal energy white (1, 1, 1) is the sum of, solved in fractions. */
static void xyz_of_rgb(const float rgb[3], double xyz[3])
{
    static const double points[3][3] = {{.640, .330, .030}, {.290, .600, .110}, {.150, .060, .790}};
    static const double luminance[3] = {10021.0 / 37800, 2533.0 / 3780, 2449.0 / 37800};
    for (int i = 0; i < 3; i++) {
        xyz[i] = 0.0;
        for (int k = 0; k < 3; k++)
            xyz[i] += (double)rgb[k] * luminance[k] * points[k][i] / points[k][1];
    }
}

/* RGB has the value to the bit. XYZ goes through a matrix whose entries are up to 2.6: three
 * products, each with a rounded entry, a rounded product and two rounded sums, are off by at most
 * 4 3 2.6 2^-24 of the largest value; primaries that are floats may cost as much again. */
static void expect_pixel(const render_image *image, int x, int y, int is_xyz)
{
    const float *rgb = image->rgb + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
    unsigned char rgbe[4];
    double want[3], have[3] = {(double)rgb[0], (double)rgb[1], (double)rgb[2]}, largest = 0.0;
    pixel_at(x, y, rgbe);
    for (int k = 0; k < 3; k++) {
        want[k] = rgbe[3] ? rgbe[k] / 256.0 * exp2(rgbe[3] - 128) : 0.0;
        largest = fmax(largest, want[k]);
    }
    if (is_xyz)
        xyz_of_rgb(rgb, have);
    for (int k = 0; k < 3; k++)
        if (!(fabs(have[k] - want[k]) <= (is_xyz ? 64.0 * 0x1p-24 * largest : 0.0)))
            fail_msg("column %d, row %d: %.9g, not %.9g", x, y, have[k], want[k]);
}

static void every_orientation_coding_and_format_is_read(void **state)
{
    (void)state;
    static const int sizes[][2] = {{5, 4}, {1, 20}, {8, 7}, {13, 9}, {300, 9}, {700, 3}};
    for (int i = 0; i < (int)(sizeof sizes / sizeof *sizes); i++)
        for (int kind = 0; kind < RADIANCE_ORIENTATIONS * 3 * 2; kind++) {
            const int orientation = kind % 8, is_xyz = kind / 24;
            const radiance_coding coding = (radiance_coding)(kind / 8 % 3);
            render_bytes bytes = radiance_write(is_xyz ? xyze_header : rgbe_header, sizes[i][0],
                                                sizes[i][1], orientation, coding, pixel_at);
            render_image image = radiance_expect(bytes.data, bytes.size);
            assert_int_equal(image.width, sizes[i][0]);
            assert_int_equal(image.height, sizes[i][1]);
            for (int y = 0; y < image.height; y++)
                for (int x = 0; x < image.width; x++)
                    expect_pixel(&image, x, y, is_xyz);
            render_image_free(&image);
            free(bytes.data);
        }
}

/* 32767 pixels are the most in planes; more are flat; old runs have counts of one and two bytes. */
static void long_scanlines_are_read(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2 * 3 * 3; kind++) {
        const int length = (const int[3]){32767, 32768, 65536}[kind / 6];
        const int orientation = kind % 2 ? 4 : 0;
        const radiance_coding coding = (radiance_coding)(kind / 2 % 3);
        const int width = orientation ? 3 : length, height = orientation ? length : 3;
        render_bytes bytes =
            radiance_write(rgbe_header, width, height, orientation, coding, pixel_at);
        render_image image = radiance_expect(bytes.data, bytes.size);
        for (int i = 0; i < length; i += length / 97)
            for (int k = 0; k < 3; k++)
                expect_pixel(&image, orientation ? k : i, orientation ? i : k, 0);
        render_image_free(&image);
        free(bytes.data);
    }
}

static void expect_row(const char *data, size_t size, int count, const unsigned char *mantissas)
{
    render_bytes bytes = {0};
    char line[40];
    radiance_put(&bytes, rgbe_header, sizeof rgbe_header - 1);
    radiance_put(&bytes, line, (size_t)snprintf(line, sizeof line, "-Y 1 +X %d\n", count));
    radiance_put(&bytes, data, size);
    render_image image = radiance_expect(bytes.data, bytes.size);
    for (int x = 0; x < count; x++)
        assert_true(image.rgb[3 * x] == (float)mantissas[x] / 128.0f);
    render_image_free(&image);
    free(bytes.data);
}
#define EXPECT_ROW(text, ...)                                                         \
    expect_row((text), sizeof(text) - 1, (int)sizeof((unsigned char[]){__VA_ARGS__}), \
               (const unsigned char[]){__VA_ARGS__})

static void special_rows_are_read(void **state)
{
    (void)state;
    /* planes with fewer than 8 pixels, as some programs write them */
    EXPECT_ROW("\2\2\0\3\3\200\201\202\203\0\203\0\203\201", 128, 129, 130);
    /* (2, 2) of another pixel is a pixel where no planes can be */
    EXPECT_ROW("\2\2\0\201\200\0\0\201", 2, 128);
    /* after another pixel the digits begin anew */
    EXPECT_ROW("\200\0\0\201\1\1\1\1\220\0\0\201\1\1\1\2", 128, 128, 144, 144, 144);
    /* a run of none, and then 256 times as much for the next */
    EXPECT_ROW("\200\0\0\201\1\1\1\0\220\0\0\201", 128, 144);
    /* as long as pixels without runs: no runs, though the pixel is not as the format wants it */
    EXPECT_ROW("\200\0\0\201\1\1\1\201\1\1\1\201\220\0\0\201", 128, 1, 1, 144);
}

static void runs_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *name, *data;
        size_t size;
    } cases[] = {
#define CASE(name, data) {name, data, sizeof(data) - 1}
        CASE("(1, 1, 1, n) without a pixel", "\1\1\1\7\200\0\0\201...."),
        CASE("does not fit", "\200\0\0\201\1\1\1\10"),
        CASE("does not fit", "\200\0\0\201\1\1\1\0\1\1\1\1"),
        CASE("does not fit", "\200\0\0\201\1\1\1\0\1\1\1\0\1\1\1\0\1\1\1\0\1\1\1\1"),
        CASE("does not fit", "\2\2\0\10\211........"),
        CASE("does not fit", "\2\2\0\10\0\200\200\200\200"),
        CASE("ends inside", "\200\0\0\201\1\1\1\6"),
        CASE("ends inside", "\2\2\0\10\10....."),
        CASE("another length", "\2\2\0\11\210\200\210\200\210\200\210\200"),
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        render_bytes bytes = {0};
        radiance_put(&bytes, "#?RGBE\n\n-Y 1 +X 8\n", 18);
        radiance_put(&bytes, cases[i].data, cases[i].size);
        radiance_expect_refused(bytes.data, bytes.size, HNBRDF_ERROR_FORMAT, cases[i].name);
        radiance_expect_refused(bytes.data, bytes.size, HNBRDF_ERROR_FORMAT, "at byte ");
        free(bytes.data);
    }
}

/* ---- Damage ---------------------------------------------------------------------------------- */

static void truncated_files_are_refused(void **state)
{
    (void)state;
    for (int coding = 0; coding < 3; coding++) {
        render_bytes bytes =
            radiance_write(rgbe_header, 13, 4, 0, (radiance_coding)coding, pixel_at);
        for (size_t size = 0; size < bytes.size; size++) {
            hnbrdf_error error;
            render_image image;
            assert_int_not_equal(radiance_read(bytes.data, size, &image, &error), HNBRDF_OK);
        }
        free(bytes.data);
    }
}

static void damaged_files_never_crash(void **state)
{
    (void)state;
    static const unsigned char values[] = {0, 1, 2, 10, 32, 127, 128, 129, 255};
    for (int coding = 0; coding < 3; coding++) {
        render_bytes bytes =
            radiance_write(xyze_header, 13, 4, 0, (radiance_coding)coding, pixel_at);
        for (size_t at = 0; at < bytes.size; at++)
            for (size_t v = 0; v < sizeof values; v++) {
                hnbrdf_error error;
                render_image image;
                const unsigned char kept = bytes.data[at];
                bytes.data[at] = values[v];
                (void)radiance_read(bytes.data, bytes.size, &image, &error);
                render_image_free(&image);
                bytes.data[at] = kept;
            }
        free(bytes.data);
    }
}

static void absurd_files_are_refused(void **state)
{
    (void)state;
    static const struct {
        hnbrdf_result expected;
        const char *text, *name;
    } cases[] = {
        {HNBRDF_ERROR_FORMAT, "", "starts with '#?'"},
        {HNBRDF_ERROR_FORMAT, "RADIANCE\n\n-Y 1 +X 1\n....", "starts with '#?'"},
        {HNBRDF_ERROR_FORMAT, "\n\nFORMAT=32-bit_rle_rgbe\n", "starts with '#?'"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n", "ends inside the header"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n", "before the line with the resolution"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n-Y 0 +X 5\n", "'-Y 0 +X 5': expected"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n-Y 99999999999999999999 +X 1\n", "expected '-Y"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n-Y 65537 +X 1\n", "sides of 1 to 65536"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n-Y -5 +X 5\n", "expected '-Y"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n-Y 5 +Y 5\n", "expected '-Y"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n-Y 5\n", "expected '-Y"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\nY 5 +X 5\n", "expected '-Y"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n-Y 5 +Z 5\n", "expected '-Y"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n-Y 5 +X 5 7\n", "expected '-Y"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n-Y 5 +X 5x\n", "expected '-Y"},
        {HNBRDF_ERROR_FORMAT, "#?RADIANCE\n\n-Y 4096 +X 4096\n", "0 bytes of pixels"},
        {HNBRDF_ERROR_LIMIT, "#?RADIANCE\n\n-Y 65536 +X 65536\n", "65536 x 65536 pixels"},
        {HNBRDF_ERROR_UNSUPPORTED, "#?RADIANCE\nFORMAT=Radiance_rle_spectra\n\n-Y 1 +X 1\n.....",
         "'Radiance_rle_spectra'"},
        {HNBRDF_ERROR_UNSUPPORTED, "#?RADIANCE\nFORMAT=\n\n-Y 1 +X 1\n....", "FORMAT ''"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        radiance_expect_refused(cases[i].text, strlen(cases[i].text), cases[i].expected,
                                cases[i].name);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_orientation_coding_and_format_is_read),
        cmocka_unit_test(long_scanlines_are_read),
        cmocka_unit_test(special_rows_are_read),
        cmocka_unit_test(runs_that_do_not_fit_are_refused),
        cmocka_unit_test(truncated_files_are_refused),
        cmocka_unit_test(damaged_files_never_crash),
        cmocka_unit_test(absurd_files_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
