/* test_image_radiance_header.c: what the lines of a Radiance header mean: blanks and line ends,
 * formats, primaries, and what is left in the pixels and told. */
#include "radiance_writer.h"

#include <math.h>

/* A picture of one pixel (2, 1, 0.5) with this header and resolution. */
static render_image read_header(const char *header, const char *resolution)
{
    render_bytes bytes = {0};
    radiance_put(&bytes, header, strlen(header));
    radiance_put(&bytes, resolution, strlen(resolution));
    radiance_put(&bytes, "\200\100\040\202", 4);
    render_image image = radiance_expect(bytes.data, bytes.size);
    free(bytes.data);
    return image;
}

static void expect_rgb(render_image *image, double r, double g, double b, double tolerance)
{
    const double want[3] = {r, g, b};
    for (int k = 0; k < 3; k++)
        if (!(fabs((double)image->rgb[k] - want[k]) <= tolerance))
            fail_msg("(%.9g, %.9g, %.9g), not (%.9g, %.9g, %.9g)", (double)image->rgb[0],
                     (double)image->rgb[1], (double)image->rgb[2], r, g, b);
    render_image_free(image);
}

static void expect_plain(const char *header, const char *resolution)
{
    render_image image = read_header(header, resolution);
    expect_rgb(&image, 2, 1, 0.5, 0);
    assert_string_equal(radiance_notes, "");
}

static void expect_note(const char *header, const char *note)
{
    render_image image = read_header(header, "-Y 1 +X 1\n");
    render_image_free(&image);
    if (strcmp(radiance_notes, note) != 0)
        fail_msg("'%s' instead of '%s'", radiance_notes, note);
}

static void blanks_and_line_ends_do_not_matter(void **state)
{
    (void)state;
    static const char plain[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    expect_plain(plain, "-Y 1 +X 1\n");
    expect_plain(plain, "-Y        1 +X        1\n"); /* as Radiance and libvips write it */
    expect_plain(plain, " -Y 1  +X 1 \n");
    expect_plain(plain, "-Y\t1\t+X\t1\r\n");
    expect_plain(plain, "-Y1+X1\n");
    expect_plain(plain, "-Y 0001 +X 1\n");
    expect_plain("#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n", "-Y 1 +X 1\r\n");
    expect_plain("#?RADIANCE\nFORMAT=   32-bit_rle_rgbe  \n\n", "-Y 1 +X 1\n");
    expect_plain("#?RADIANCE\nFORMAT=32-bit_rle_rgbe \n\n", "-Y 1 +X 1\n");
    expect_plain("#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n", "-Y 1 +X 1\n");
    expect_plain("#?RGBE\n\n", "-Y 1 +X 1\n");
    expect_plain("#? any program\n# a comment\n\n", "-Y 1 +X 1\n");
    /* before 1992 */
    expect_plain("rpict -x 5\nFORMAT=32-bit_rle_rgbe\npfilt -1\n\n", "-Y 1 +X 1\n");
    expect_plain("FORMAT=32-bit_rle_rgbe\r\n\r\n", "-Y 1 +X 1\n");
}

static void lines_of_cameras_and_programs_are_passed_over(void **state)
{
    (void)state;
    expect_plain("#?RADIANCE\n# Made by hand, EXPOSURE=7\nrpict -x 5 room.oct\n"
                 "VIEW= -vta -vh 360 -vv 180\nPIXASPECT=2\nSOFTWARE= one\nGAMMA=1\nCAPDATE= "
                 "2026:01:02 03:04:05\nPIXASPECT=0.5\nEXPOSURE=1\nCOLORCORR= 1 1 1\n"
                 "FORMAT=32-bit_rle_rgbe\n\n",
                 "-Y 1 +X 1\n");
    /* headers of other pictures that were put together, moved in by a tab */
    expect_plain("#?RADIANCE\nleft.hdr:\n\tEXPOSURE=4\n\tFORMAT=of another\n\tPRIMARIES= 1 0 0 1 0 "
                 "0 .3 .3\nFORMAT=32-bit_rle_rgbe\n\n",
                 "-Y 1 +X 1\n");
    char header[3000] = "#?RADIANCE\npcomb ";
    memset(header + strlen(header), 'x', 2500);
    strcat(header, "\n\n");
    expect_plain(header, "-Y 1 +X 1\n");
}

static void exposures_multiply_up_and_are_told(void **state)
{
    (void)state;
    static const char not_divided[] = "x.hdr: not divided by its ";
    char note[200];
#define EXPECT(header, text)                                                                    \
    snprintf(note, sizeof note, "%s%s: the values are those in the file\n", not_divided, text); \
    expect_note("#?RADIANCE\n" header "\n\n", note)
    EXPECT("EXPOSURE=2\nEXPOSURE= 1.5000e+00", "EXPOSURE 3");
    EXPECT("COLORCORR= 1 .5 2\nEXPOSURE=1\nCOLORCORR=1 .5 1.0 # blue", "COLORCORR 1 0.25 2");
    EXPECT("EXPOSURE=.5\nCOLORCORR=1 1 .9", "EXPOSURE 0.5 and COLORCORR 1 1 0.9");
    expect_note("#?RADIANCE\nEXPOSURE=2\nEXPOSURE=0.5\n\n", "");
    render_image image = read_header("#?RADIANCE\nEXPOSURE=2\nCOLORCORR=2 3 4\n\n", "-Y 1 +X 1\n");
    expect_rgb(&image, 2, 1, 0.5, 0);
}

static void numbers_that_are_none_are_told(void **state)
{
    (void)state;
    static const char *const lines[] = {"EXPOSURE=",     "EXPOSURE=0",      "EXPOSURE=-1",
                                        "EXPOSURE=1,5",  "EXPOSURE=bright", "EXPOSURE=1e999",
                                        "COLORCORR=1 1", "COLORCORR=1 0 1", "COLORCORR=1 1 nan",
                                        "EXPOSURE=inf"};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        char header[80], note[80];
        snprintf(header, sizeof header, "#?RADIANCE\n%s\n\n", lines[i]);
        snprintf(note, sizeof note, "x.hdr: passed over: %s\n", lines[i]);
        expect_note(header, note);
    }
}

static void control_characters_are_not_passed_on(void **state)
{
    (void)state;
    expect_note("#?RADIANCE\nEXPOSURE=\033[31m\177\r1\tx\n\n",
                "x.hdr: passed over: EXPOSURE=?[31m??1 x\n");
}

/* ---- Colours --------------------------------------------------------------------------------- */

static void usual_primaries_change_nothing(void **state)
{
    (void)state;
    /* Radiance's, as ra_xyze and libvips write them; of Rec. 709, rounded */
    expect_plain("#?RADIANCE\nPRIMARIES= 0.6400 0.3300 0.2900 0.6000 0.1500 0.0600 0.3333 "
                 "0.3333\nFORMAT=32-bit_rle_rgbe\n\n",
                 "-Y 1 +X 1\n");
    expect_plain("#?RADIANCE\nPRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .329\n\n", "-Y 1 +X 1\n");
    /* the last line of several */
    expect_plain("#?RADIANCE\nPRIMARIES=.7 .3 .2 .7 .15 .06 .3127 .329\nPRIMARIES=.64 .33 .3 .6 "
                 ".15 .06 .3127 .329\n\n",
                 "-Y 1 +X 1\n");
}

/* Rec. 2020 to Rec. 709 by the matrix that ITU-R BT.2407 prints with four decimals: three products
 * with values of 2, 1 and 0.5 are within 3.5 0.00005. */
static void other_primaries_are_converted(void **state)
{
    (void)state;
    static const char header[] =
        "#?RADIANCE\nPRIMARIES= .708 .292 .17 .797 .131 .046 .3127 .329\n\n";
    render_image image = read_header(header, "-Y 1 +X 1\n");
    expect_rgb(&image, 2 * 1.6605 - .5876 - .5 * .0728, -2 * .1246 + 1.1329 - .5 * .0083,
               -2 * .0182 - .1006 + .5 * 1.1187, 3.5 * .00005);
    expect_note(header, "x.hdr: converted to Rec. 709 from its own primaries, red (0.708, 0.292) "
                        "green (0.17, 0.797) blue (0.131, 0.046) white (0.3127, 0.329)\n");
}

static render_image read_pixel(const char *header, const char *pixel)
{
    render_bytes bytes = {0};
    radiance_put(&bytes, header, strlen(header));
    radiance_put(&bytes, "-Y 1 +X 1\n", 10);
    radiance_put(&bytes, pixel, 4);
    render_image image = radiance_expect(bytes.data, bytes.size);
    free(bytes.data);
    return image;
}

/* Whatever its chromaticity, (1, 1, 1) is what the file calls white; a handful of roundings. */
static void white_stays_white(void **state)
{
    (void)state;
    render_image image =
        read_pixel("#?RADIANCE\nPRIMARIES=.7 .3 .2 .7 .15 .06 .3457 .3585\n\n", "\200\200\200\201");
    expect_rgb(&image, 1, 1, 1, 16 * 0x1p-24);
    assert_non_null(strstr(radiance_notes, "white (0.3457, 0.3585), adapted from its white\n"));
    image = read_pixel("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n", "\200\200\200\201");
    expect_rgb(&image, 1, 1, 1, 16 * 0x1p-24);
    assert_string_equal(
        radiance_notes,
        "x.hdr: converted to RGB from CIE XYZ by Radiance's primaries, equal energy white\n");
    /* (0.9505, 1, 1.0891) as bytes: 122, 128, 139 of 128, each cut by up to 1/128, and each of red,
     * green and blue by up to 3.3, 2 and 1.1 of that in sum with the signs of the matrix */
    image = read_pixel("#?RADIANCE\nPRIMARIES=.64 .33 .3 .6 .15 .06 .3127 .329\n"
                       "FORMAT=32-bit_rle_xyze\n\n",
                       "\172\200\213\201");
    expect_rgb(&image, 1, 1, 1, 5.3 / 128);
    assert_string_equal(radiance_notes,
                        "x.hdr: converted to Rec. 709 from CIE XYZ of white (0.3127, 0.329)\n");
}

static void primaries_that_are_none_are_told(void **state)
{
    (void)state;
    static const char *const lines[] = {"", ".64 .33 .3 .6 .15 .06 .3127", "1 2 3 4 5 6 7 8",
                                        ".1 .2 .2 .3 .3 .4 .4 .5", ".64 .33 .3 .6 .15 .06 0 0"};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        char header[80], note[120];
        snprintf(header, sizeof header, "#?RADIANCE\nPRIMARIES=%s\n\n", lines[i]);
        snprintf(note, sizeof note, "x.hdr: passed over, since these are none: PRIMARIES=%s\n",
                 lines[i]);
        expect_note(header, note);
        render_image image = read_header(header, "-Y 1 +X 1\n");
        expect_rgb(&image, 2, 1, 0.5, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blanks_and_line_ends_do_not_matter),
        cmocka_unit_test(lines_of_cameras_and_programs_are_passed_over),
        cmocka_unit_test(exposures_multiply_up_and_are_told),
        cmocka_unit_test(numbers_that_are_none_are_told),
        cmocka_unit_test(control_characters_are_not_passed_on),
        cmocka_unit_test(usual_primaries_change_nothing),
        cmocka_unit_test(other_primaries_are_converted),
        cmocka_unit_test(white_stays_white),
        cmocka_unit_test(primaries_that_are_none_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
