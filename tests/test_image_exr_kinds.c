/* test_image_exr_kinds.c: which part of an OpenEXR file is the picture, and what colours and
 * windows mean; each kind of file on its own, written by OpenEXR itself. */
#include "exr_writer.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char notes[2000];

static void keep_note(void *user, const char *line)
{
    (void)user;
    assert_true(strlen(notes) + strlen(line) + 2 < sizeof notes);
    strcat(strcat(notes, line), "\n");
}

static hnbrdf_result read_parts(const exr_part_description *parts, int count, const char *layer,
                                render_image *image, hnbrdf_error *error)
{
    const render_read_options limits = {.notes = {keep_note, NULL}, .layer = layer};
    render_bytes bytes = exr_write_parts(parts, count);
    assert_true(bytes.size > 0);
    notes[0] = 0;
    memset(image, 0, sizeof *image);
    const hnbrdf_result result =
        render_exr_decode(bytes.data, bytes.size, "x.exr", &limits, image, error);
    free(bytes.data);
    return result;
}

static render_image expect_read(const exr_part_description *parts, int count, const char *layer)
{
    render_image image;
    hnbrdf_error error;
    if (read_parts(parts, count, layer, &image, &error) != HNBRDF_OK)
        fail_msg("%s", error.text);
    return image;
}

static void expect_refused(const exr_part_description *parts, int count, const char *layer,
                           hnbrdf_result expected, const char *text)
{
    render_image image;
    hnbrdf_error error = {""};
    assert_int_equal(read_parts(parts, count, layer, &image, &error), expected);
    assert_null(image.rgb);
    if (!strstr(error.text, text))
        fail_msg("'%s' does not say '%s'", error.text, text);
}

static void expect_near(const float *rgb, float r, float g, float b, float tolerance)
{
    const float want[3] = {r, g, b};
    for (int k = 0; k < 3; k++)
        if (!(fabsf(rgb[k] - want[k]) <= tolerance))
            fail_msg("(%g, %g, %g), not (%g, %g, %g)", (double)rgb[0], (double)rgb[1],
                     (double)rgb[2], (double)r, (double)g, (double)b);
}

/* Channel k has the value user[k] everywhere. */
static float constant(const void *user, int channel, int x, int y)
{
    (void)x, (void)y;
    return ((const float *)user)[channel];
}

static const float counted[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

static exr_part_description flat(const char *channels)
{
    return (exr_part_description){.compression = 3,
                                  .data = {0, 0, 6, 4},
                                  .channels = channels,
                                  .value = constant,
                                  .user = counted};
}

/* The first pixel of a part of constants is this colour. */
static void expect_colour(const exr_part_description *parts, int count, const char *layer, float r,
                          float g, float b)
{
    render_image image = expect_read(parts, count, layer);
    expect_near(image.rgb, r, g, b, 0.0f);
    render_image_free(&image);
}

/* ---- Channels -------------------------------------------------------------------------------- */

static void three_halves_of_which_some_are_passed_over(void **state)
{
    (void)state;
    static const char *const channels[] = {"G:h Z:h id:h", "Y:h Z:h N:h", "Y:h A:h Z:h"};
    for (size_t i = 0; i < sizeof channels / sizeof *channels; i++)
        for (int compression = 0; compression < EXR_COMPRESSIONS; compression++) {
            exr_part_description part = flat(channels[i]);
            part.compression = compression;
            render_image image = expect_read(&part, 1, NULL);
            const float y = i > 0 ? 1.0f : 0.0f;
            expect_near(image.rgb, y, 1, y, 0.01f);
            render_image_free(&image);
        }
}

static void missing_colours_are_0_and_said(void **state)
{
    (void)state;
    exr_part_description part = flat("G:f B:h");
    expect_colour(&part, 1, NULL, 0, 1, 2);
    assert_string_equal(notes, "x.exr: no channel R, taken as 0\n");
}

static void grey_is_y_alone(void **state)
{
    (void)state;
    static const char *const channels[] = {"Y:h RY:h2", "Y:h BY:h2", "X:h Y:h",    "Y:h R:h",
                                           "Z:f",       "u:h v:h",   "r:h g:h b:h"};
    exr_part_description part = flat("Y:h Z:f");
    expect_colour(&part, 1, NULL, 1, 1, 1);
    for (size_t i = 0; i < sizeof channels / sizeof *channels; i++) {
        part = flat(channels[i]);
        expect_refused(&part, 1, NULL, HNBRDF_ERROR_UNSUPPORTED, "no colour picture: its channels");
    }
    expect_refused(&part, 1, NULL, HNBRDF_ERROR_UNSUPPORTED, "b, g, r, expected");
}

static void channels_that_cannot_be_are_named(void **state)
{
    (void)state;
    exr_part_description part = flat("R:h G:u B:h");
    expect_refused(&part, 1, NULL, HNBRDF_ERROR_UNSUPPORTED, "channel G is of integers");
    part = flat("R:h G:h2 B:h");
    expect_refused(&part, 1, NULL, HNBRDF_ERROR_UNSUPPORTED, "channel G has values at every 2.");
    part = flat("Y:h RY:h4 BY:h4");
    part.data[2] = part.data[3] = 8;
    expect_refused(&part, 1, NULL, HNBRDF_ERROR_UNSUPPORTED, "channel RY has values at every 4.");
    part = flat("Y:h RY:h2 BY:h");
    expect_refused(&part, 1, NULL, HNBRDF_ERROR_UNSUPPORTED, "RY has fewer values than BY");
    part = flat("R:h G:h B:h Z:f");
    part.layout = EXR_DEEP;
    part.compression = 2;
    part.name = "deep";
    expect_refused(&part, 1, NULL, HNBRDF_ERROR_UNSUPPORTED, "deep data");
}

/* ---- Layers, parts, views -------------------------------------------------------------------- */

static void plain_names_are_the_picture(void **state)
{
    (void)state;
    exr_part_description part = flat("B:h G:h R:h diffuse.B:h diffuse.G:h diffuse.R:h N.X:f N.Y:f "
                                     "N.Z:f mask.R:h");
    expect_colour(&part, 1, NULL, 3, 2, 1);
    expect_colour(&part, 1, "diffuse", 6, 5, 4);
    assert_string_equal(notes, "");
    expect_colour(&part, 1, "mask", 10, 0, 0);
    expect_refused(&part, 1, "specular", HNBRDF_ERROR_ARGUMENT,
                   "no layer 'specular': there are '', 'N', 'diffuse', 'mask'");
    render_image image = expect_read(&part, 1, "N"); /* X, Y, Z because it was asked for */
    assert_non_null(strstr(notes, "CIE XYZ"));
    render_image_free(&image);
}

static void the_only_layer_is_taken(void **state)
{
    (void)state;
    exr_part_description part =
        flat("Layer~1.B:h Layer~1.G:h Layer~1.R:h N.X:h N.Y:h N.Z:h depth.Z:f");
    expect_colour(&part, 1, NULL, 3, 2, 1);
    expect_colour(&part, 1, "Layer 1", 3, 2, 1);
    part = flat("a.b.Y:h a.b.A:h");
    expect_colour(&part, 1, NULL, 1, 1, 1);
    part = flat("N.X:h N.Y:h N.Z:h"); /* directions, not colours */
    expect_refused(&part, 1, NULL, HNBRDF_ERROR_UNSUPPORTED, "its channels are N.X, N.Y, N.Z");
}

static void several_layers_are_named(void **state)
{
    (void)state;
    exr_part_description part = flat("glossy.B:h glossy.G:h glossy.R:h a.B:h a.G:h a.R:h soft.Y:h");
    expect_refused(&part, 1, NULL, HNBRDF_ERROR_ARGUMENT,
                   "several layers, 'a', 'glossy', 'soft': choose one: --layer NAME, or layer NAME "
                   "in a scene");
    expect_colour(&part, 1, "a", 6, 5, 4);
    expect_colour(&part, 1, "soft", 7, 7, 7);
    char many[4000] = "";
    for (int i = 0; i < 90; i++)
        sprintf(many + strlen(many), "quite_a_long_name_%d.Y:h ", i);
    static const float zeros[90];
    part = flat(many);
    part.user = zeros;
    expect_refused(&part, 1, NULL, HNBRDF_ERROR_ARGUMENT, " more: choose one");
}

static void the_picture_may_be_in_a_later_part(void **state)
{
    (void)state;
    exr_part_description parts[3] = {flat("Z:f"), flat("B:h G:h R:h"), flat("id:u")};
    parts[0].name = "depth";
    parts[1].name = "beauty";
    parts[2].name = "numbers";
    parts[1].layout = EXR_TILES;
    expect_colour(parts, 3, NULL, 3, 2, 1);
    parts[2] = flat("R:h G:h B:h");
    parts[2].name = "second";
    expect_refused(parts, 3, NULL, HNBRDF_ERROR_ARGUMENT, "several layers, 'beauty', 'second'");
    expect_colour(parts, 3, "second", 1, 2, 3);
    parts[2].channels = "second.R:h second.G:h second.B:h";
    expect_colour(parts, 3, "second", 1, 2, 3);
    parts[2].channels = "soft.R:h soft.G:h soft.B:h";
    expect_colour(parts, 3, NULL, 3, 2, 1);
    expect_colour(parts, 3, "second.soft", 1, 2, 3);
    expect_colour(parts, 3, "soft", 1, 2, 3);
}

static void the_default_view_is_taken(void **state)
{
    (void)state;
    exr_part_description part = flat("left.B:h left.G:h left.R:h right.B:h right.G:h right.R:h");
    part.views = "right left";
    expect_colour(&part, 1, NULL, 6, 5, 4);
    assert_string_equal(notes, "x.exr: view 'right' taken, the first of 2\n");
    expect_colour(&part, 1, "left", 3, 2, 1);
    part.channels = "V.left.B:h V.left.G:h V.left.R:h V.right.B:h V.right.G:h V.right.R:h";
    expect_colour(&part, 1, NULL, 6, 5, 4);
    exr_part_description parts[3] = {flat("Z:f"), flat("B:h G:h R:h"), flat("R:h G:h B:h")};
    for (int i = 0; i < 3; i++) {
        parts[i].name = (const char *[]){"depth", "rgba_right", "rgba_left"}[i];
        parts[i].view = (const char *[]){"left", "right", "left"}[i];
    }
    expect_colour(parts, 3, NULL, 3, 2, 1);
    assert_string_equal(notes, "x.exr: view 'right' taken, the first of 2\n");
    expect_colour(parts, 3, "rgba_left", 1, 2, 3);
}

/* ---- Colours --------------------------------------------------------------------------------- */

/* Y = 1; RY grows along the columns and BY down the rows, as far as a line through the values. */
static float ramps(const void *user, int channel, int x, int y)
{
    (void)user;
    return channel == 0 ? 1.0f : channel == 1 ? (float)x / 64.0f - 0.25f : (float)y / 64.0f - 0.25f;
}

static void chroma_between_its_values_lies_on_a_line(void **state)
{
    (void)state;
    exr_part_description part = {
        .compression = 3, .data = {-2, 4, 40, 36}, .channels = "Y:f RY:f2 BY:f2", .value = ramps};
    render_image image = expect_read(&part, 1, NULL);
    for (int y = 14; y < 22; y++) /* the filter reaches 13 pixels */
        for (int x = 14; x < 26; x++) {
            const float *rgb = image.rgb + 3 * (y * 40 + x);
            const float r = 1.0f + ramps(NULL, 1, x, y), b = 1.0f + ramps(NULL, 2, x, y);
            expect_near(rgb, r, (1.0f - 0.2126390f * r - 0.0721923f * b) / 0.7151687f, b, 1e-5f);
        }
    render_image_free(&image);
}

/* Two columns of pure red in grey, so that the filter brings the pixels between them twice as much
 * of its negative lobes as there is red. */
static float red_columns(const void *user, int channel, int x, int y)
{
    (void)user, (void)y;
    const int is_red = x == 20 || x == 26;
    return channel == 0 ? 1.0f : channel == 1 ? (is_red ? 3.5f : 0.0f) : (is_red ? -1.0f : 0.0f);
}

/* Neighbours without any saturation allow 3/4. */
static void pixels_are_not_more_colourful_than_all_around(void **state)
{
    (void)state;
    exr_part_description part = {.compression = 0,
                                 .data = {0, 0, 40, 8},
                                 .channels = "Y:f RY:f2 BY:f2",
                                 .value = red_columns};
    render_image image = expect_read(&part, 1, NULL);
    for (int x = 0; x < 40; x++) {
        const float *rgb = image.rgb + 3 * (4 * 40 + x);
        const float most = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
        const float least = fminf(rgb[0], fminf(rgb[1], rgb[2]));
        const float y = 0.2126390f * rgb[0] + 0.7151687f * rgb[1] + 0.0721923f * rgb[2];
        assert_true(least >= 0.0f);
        assert_true(fabsf(y - 1.0f) < 1e-4f);
        if (x == 23)
            assert_true(fabsf(1.0f - least / most - 0.75f) < 1e-4f);
    }
    render_image_free(&image);
}

static void chroma_uses_the_weights_of_the_primaries(void **state)
{
    (void)state;
    /* The primaries of XYZ: Y is G itself. */
    static const float xyz[8] = {1, 0, 0, 1, 0, 0, 1.0f / 3, 1.0f / 3};
    static const float values[3] = {0.5f, 0.25f, -0.5f};
    exr_part_description part = flat("Y:f RY:f2 BY:f2");
    part.chromaticities = xyz;
    part.user = values;
    render_image image = expect_read(&part, 1, NULL);
    const float x = 0.5f * 1.25f, y = 0.5f, z = 0.5f * 0.5f;
    expect_near(image.rgb, 3.2409699f * x - 1.5373832f * y - 0.4986108f * z,
                -0.9692436f * x + 1.8759675f * y + 0.0415551f * z,
                0.0556301f * x - 0.2039770f * y + 1.0569715f * z, 1e-5f);
    render_image_free(&image);
}

static void chroma_needs_a_green_that_has_luminance(void **state)
{
    (void)state;
    /* Those of XYZ in another order: all of Y is R, and nothing tells G. */
    static const float dark_green[8] = {0, 1, 1, 0, 0, 0, 1.0f / 3, 1.0f / 3};
    static const float values[3] = {0.5f, 0.25f, -0.5f};
    exr_part_description part = flat("Y:f RY:f2 BY:f2");
    part.user = values;
    render_image plain = expect_read(&part, 1, NULL);
    part.chromaticities = dark_green;
    render_image image = expect_read(&part, 1, NULL);
    expect_near(image.rgb, plain.rgb[0], plain.rgb[1], plain.rgb[2], 0.0f);
    assert_non_null(strstr(notes, "its chromaticities are none"));
    render_image_free(&plain);
    render_image_free(&image);
}

static void primaries_are_converted_and_said(void **state)
{
    (void)state;
    static const float rec2020[8] = {0.708f, 0.292f, 0.170f,  0.797f,
                                     0.131f, 0.046f, 0.3127f, 0.3290f};
    static const float rec709[8] = {0.6401f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.31271f, 0.32902f};
    static const float none[8] = {0};
    exr_part_description part = flat("R:f G:f B:f");
    part.chromaticities = rec709;
    expect_colour(&part, 1, NULL, 1, 2, 3);
    assert_string_equal(notes, "");
    part.chromaticities = rec2020; /* ITU-R BT.2087 has this matrix */
    render_image image = expect_read(&part, 1, NULL);
    expect_near(image.rgb, 1.6605f - 2 * 0.5876f - 3 * 0.0728f,
                -0.1246f + 2 * 1.1329f - 3 * 0.0083f, -0.0182f - 2 * 0.1006f + 3 * 1.1187f, 3e-4f);
    assert_non_null(strstr(notes, "converted to Rec. 709 from its own primaries, red (0.708, "));
    render_image_free(&image);
    part.chromaticities = none;
    expect_colour(&part, 1, NULL, 1, 2, 3);
    assert_non_null(strstr(notes, "its chromaticities are none"));
    part = flat("Y:f");
    part.chromaticities = rec2020;
    expect_colour(&part, 1, NULL, 1, 1, 1);
}

/* What the file says is neutral is neutral. */
static void the_adopted_neutral_becomes_white(void **state)
{
    (void)state;
    static const float aces[8] = {0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f};
    static const float ones[3] = {2, 2, 2};
    exr_part_description part = flat("R:f G:f B:f");
    part.chromaticities = aces;
    part.user = ones;
    part.neutral = aces + 6;
    render_image image = expect_read(&part, 1, NULL);
    expect_near(image.rgb, 2, 2, 2, 1e-4f);
    assert_non_null(strstr(notes, "adapted from its neutral"));
    render_image_free(&image);
    part.neutral = NULL; /* as the colour that it is */
    image = expect_read(&part, 1, NULL);
    assert_true(image.rgb[0] > 2.05f && image.rgb[2] < 1.9f);
    render_image_free(&image);
}

/* ---- Windows --------------------------------------------------------------------------------- */

static float place(const void *user, int channel, int x, int y)
{
    (void)user;
    return (float)(1000 * channel + 10 * y + x + 1);
}

static void a_crop_is_placed(void **state)
{
    (void)state;
    exr_part_description part = {.compression = 2,
                                 .data = {3, 5, 4, 2},
                                 .display = {1, 1, 16, 8},
                                 .channels = "R:f G:f B:f A:f",
                                 .value = place};
    render_image image = expect_read(&part, 1, NULL);
    assert_int_equal(image.width, 16);
    assert_int_equal(image.height, 8);
    for (int i = 0; i < 16 * 8; i++) {
        const int x = i % 16 - 2, y = i / 16 - 4;
        const int in = x >= 0 && x < 4 && y >= 0 && y < 2;
        assert_true(image.rgb[3 * i + 2] == (in ? place(NULL, 2, x, y) : 0.0f));
        assert_true(image.alpha[i] == (in ? place(NULL, 3, x, y) : 0.0f));
    }
    assert_string_equal(notes,
                        "x.exr: data window of 4 x 2 at (2, 4), black outside it in 16 x 8\n");
    render_image_free(&image);
}

static void a_window_outside_is_black_and_said(void **state)
{
    (void)state;
    exr_part_description part = {.compression = 2,
                                 .data = {30, 0, 4, 2},
                                 .display = {0, 0, 16, 8},
                                 .channels = "R:f G:f B:f",
                                 .value = place};
    render_image image = expect_read(&part, 1, NULL);
    for (int i = 0; i < 3 * 16 * 8; i++)
        assert_true(image.rgb[i] == 0.0f);
    assert_non_null(strstr(notes, "outside the display window"));
    render_image_free(&image);
}

static void a_map_fills_its_data_window(void **state)
{
    (void)state;
    exr_part_description part = {.compression = 2,
                                 .data = {3, 5, 4, 2},
                                 .display = {0, 0, 16, 8},
                                 .channels = "R:f G:f B:f",
                                 .envmap = 1,
                                 .value = place};
    render_image image = expect_read(&part, 1, NULL);
    assert_int_equal(image.width, 4);
    assert_int_equal(image.map, RENDER_MAP_LATLONG);
    assert_true(image.rgb[0] == place(NULL, 0, 0, 0));
    render_image_free(&image);
}

/* ---- What is not finite ---------------------------------------------------------------------- */

static void holes_are_filled_from_their_rims(void **state)
{
    (void)state;
    const hnbrdf_notes told = {keep_note, NULL};
    render_image image;
    hnbrdf_error error;
    assert_int_equal(render_image_create(5, 5, 1, &image, NULL), HNBRDF_OK);
    for (int i = 0; i < 25; i++) {
        const int x = i % 5, y = i / 5, is_hole = x > 0 && x < 4 && y > 0 && y < 4;
        for (int k = 0; k < 3; k++)
            image.rgb[3 * i + k] = is_hole && k == i % 3 ? NAN : (float)x;
        image.alpha[i] = is_hole ? INFINITY : 1.0f;
    }
    assert_int_equal(render_image_check(&image, "x.exr", &error), HNBRDF_ERROR_FORMAT);
    assert_non_null(strstr(error.text, "9 pixels are not finite, the first at column 1, row 1: ("));
    notes[0] = 0;
    assert_int_equal(render_image_repair(&image, "x.exr", &told, &error), HNBRDF_OK);
    assert_string_equal(
        notes, "x.exr: 9 pixels were not finite, replaced by the mean of their neighbours\n");
    expect_near(image.rgb + 3 * 6, 0.6f, 0.6f, 0.6f, 1e-6f); /* a corner has five */
    expect_near(image.rgb + 3 * 7, 2, 2, 2, 1e-6f);          /* an edge three */
    expect_near(image.rgb + 3 * 12, 2, 2, 2, 1e-6f);         /* the middle those before */
    expect_near(image.rgb + 3 * 18, 3.4f, 3.4f, 3.4f, 1e-6f);
    for (int i = 0; i < 25; i++)
        assert_true(fabsf(image.alpha[i] - 1.0f) < 1e-6f);
    assert_int_equal(render_image_check(&image, "x.exr", &error), HNBRDF_OK);
    for (int i = 0; i < 75; i++)
        image.rgb[i] = NAN;
    assert_int_equal(render_image_repair(&image, "x.exr", &told, &error), HNBRDF_OK);
    assert_int_equal(render_image_check(&image, "x.exr", &error), HNBRDF_ERROR_FORMAT);
    render_image_free(&image);
}

/* ---- Cube maps ------------------------------------------------------------------------------- */

static float face_number(const void *user, int channel, int x, int y)
{
    (void)user, (void)x;
    return (float)(y / 4 + 1) * (float)(channel + 1);
}

/* Row and column of the map that show a direction, as OpenEXR has them: +z in the middle. */
static const float *seen(const render_image *map, float x, float y, float z)
{
    const double pi = 3.14159265358979323846;
    const double down = acos((double)y) / pi, along = 0.5 - atan2((double)x, (double)z) / (2 * pi);
    const int row = (int)(down * map->height * 0.999999),
              column = (int)(along * map->width * 0.999999);
    return map->rgb + 3 * (row * map->width + column);
}

static void a_cube_is_unfolded(void **state)
{
    (void)state;
    static const float axes[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                     {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    hnbrdf_error error;
    exr_part_description part = {.compression = 3,
                                 .data = {0, 0, 4, 24},
                                 .channels = "R:f G:f B:f",
                                 .layout = EXR_MIPMAP,
                                 .envmap = 2,
                                 .value = face_number};
    render_image image = expect_read(&part, 1, NULL);
    assert_int_equal(image.map, RENDER_MAP_CUBE);
    assert_int_equal(image.height, 24);
    assert_int_equal(render_image_unfold(&image, "x.exr", &error), HNBRDF_OK);
    assert_int_equal(image.width, 16);
    assert_int_equal(image.height, 8);
    for (int face = 0; face < 6; face++) {
        const float n = (float)(face + 1);
        expect_near(seen(&image, axes[face][0], axes[face][1], axes[face][2]), n, 2 * n, 3 * n,
                    1e-5f);
    }
    render_image_free(&image);
    part.data[3] = 23;
    image = expect_read(&part, 1, NULL);
    assert_int_equal(render_image_unfold(&image, "x.exr", &error), HNBRDF_ERROR_FORMAT);
    assert_non_null(strstr(error.text, "a cube map of 4 x 23: expected six square faces"));
    render_image_free(&image);
}

/* The direction that a pixel of a face shows, by OpenEXR's CubeMap::direction(). */
static void direction_of(int face, double x, double y, int side, double d[3])
{
    const double u = 2.0 * x / (side - 1) - 1.0, v = 1.0 - 2.0 * y / (side - 1);
    const double table[6][3] = {{1, v, u},   {-1, v, -u}, {u, 1, v},
                                {u, -1, -v}, {-u, v, 1},  {u, v, -1}};
    memcpy(d, table[face], sizeof table[face]);
}

enum { SIDE = 33 };

/* A smooth function of the direction, so that its map is known everywhere. */
static float of_direction(const double d[3], int channel)
{
    const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return (float)(2.0 + d[channel] / length);
}

static float smooth_cube(const void *user, int channel, int x, int y)
{
    double d[3];
    (void)user;
    direction_of(y / SIDE, x, y % SIDE, SIDE, d);
    return of_direction(d, channel);
}

static void faces_are_turned_as_openexr_has_them(void **state)
{
    (void)state;
    exr_part_description part = {.compression = 3,
                                 .data = {0, 0, SIDE, 6 * SIDE},
                                 .channels = "R:f G:f B:f",
                                 .envmap = 2,
                                 .value = smooth_cube};
    render_image map = expect_read(&part, 1, NULL);
    assert_int_equal(render_image_unfold(&map, "x.exr", NULL), HNBRDF_OK);
    for (int y = 0; y < map.height; y++)
        for (int x = 0; x < map.width; x++) {
            const double pi = 3.14159265358979323846, polar = pi * (y + 0.5) / map.height;
            const double longitude = pi - 2.0 * pi * (x + 0.5) / map.width;
            const double d[3] = {sin(polar) * sin(longitude), cos(polar),
                                 sin(polar) * cos(longitude)};
            expect_near(map.rgb + 3 * (y * map.width + x), of_direction(d, 0), of_direction(d, 1),
                        of_direction(d, 2), 2e-3f);
        }
    render_image_free(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_halves_of_which_some_are_passed_over),
        cmocka_unit_test(missing_colours_are_0_and_said),
        cmocka_unit_test(grey_is_y_alone),
        cmocka_unit_test(channels_that_cannot_be_are_named),
        cmocka_unit_test(plain_names_are_the_picture),
        cmocka_unit_test(the_only_layer_is_taken),
        cmocka_unit_test(several_layers_are_named),
        cmocka_unit_test(the_picture_may_be_in_a_later_part),
        cmocka_unit_test(the_default_view_is_taken),
        cmocka_unit_test(chroma_between_its_values_lies_on_a_line),
        cmocka_unit_test(pixels_are_not_more_colourful_than_all_around),
        cmocka_unit_test(chroma_uses_the_weights_of_the_primaries),
        cmocka_unit_test(chroma_needs_a_green_that_has_luminance),
        cmocka_unit_test(primaries_are_converted_and_said),
        cmocka_unit_test(the_adopted_neutral_becomes_white),
        cmocka_unit_test(a_crop_is_placed),
        cmocka_unit_test(a_window_outside_is_black_and_said),
        cmocka_unit_test(a_map_fills_its_data_window),
        cmocka_unit_test(holes_are_filled_from_their_rims),
        cmocka_unit_test(a_cube_is_unfolded),
        cmocka_unit_test(faces_are_turned_as_openexr_has_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
