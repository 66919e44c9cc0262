/* exr_colour.c: linear Rec. 709 from the channels of an OpenEXR picture: RGB of any primaries, CIE
 * XYZ, luminance with chroma at half size, luminance alone.
 *
 * What (Y, RY, BY) mean, the filter between the chroma values and what is done about pixels that
 * come out more saturated than all around them are those of the format's reference
 * (ImfRgbaYca.h): RY = (R - Y)/Y, BY = (B - Y)/Y, Y = (R, G, B) . weights, which are the
 * luminances of the primaries. */
#include "image/colour_space.h"
#include "image/exr.h"

#include "base/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- What the file says ---------------------------------------------------------------------- */

/* The neutral that the file adopts for viewing, unless it is that of Rec. 709. */
static int adopted_neutral(const exr_input *in, int part, float neutral[2])
{
    exr_attr_v2f_t v;
    if (exr_attr_get_v2f(in->context, part, "adoptedNeutral", &v) != EXR_ERR_SUCCESS)
        return 0;
    neutral[0] = v.x;
    neutral[1] = v.y;
    return v.y > 0.01f && v.y < 1.0f && v.x > 0.01f && v.x < 1.0f &&
           !colour_is_near(neutral, colour_rec709.white);
}

/* Can these primaries tell the picture's colours? G is what R and B leave of Y, over the luminance
 * of the green primary: where that is below the rounding of a half-precision Y, nothing of G is
 * left in it. */
static int are_usable(const exr_picture *picture, const colour_primaries *c)
{
    colour_matrix to_xyz;
    return colour_to_xyz(c, to_xyz) == 0 &&
           (picture->colours != EXR_CHROMA || to_xyz[1][1] > 1.0 / 2048);
}

static int own_primaries(const exr_input *in, int part, colour_primaries *own)
{
    exr_attr_chromaticities_t c;
    if (exr_attr_get_chromaticities(in->context, part, "chromaticities", &c) != EXR_ERR_SUCCESS)
        return 0;
    *own = (colour_primaries){
        {c.red_x, c.red_y}, {c.green_x, c.green_y}, {c.blue_x, c.blue_y}, {c.white_x, c.white_y}};
    return 1;
}

/* Reads primaries and white of RGB and chroma, and decides what is converted. */
static void read_primaries(const exr_input *in, exr_colour *colour)
{
    const exr_picture *picture = colour->picture;
    colour_primaries own = colour_rec709;
    float neutral[2];
    colour_matrix to_xyz;
    const int adapted = adopted_neutral(in, picture->part, neutral);
    if (!own_primaries(in, picture->part, &own) || colour_are_near(&own, &colour_rec709)) {
        own = colour_rec709;
    } else if (!are_usable(picture, &own)) {
        hnbrdf_note(&in->options.notes, "%s: its chromaticities are none: taken as Rec. 709",
                    in->name);
        own = colour_rec709;
    }
    (void)colour_to_xyz(&own, to_xyz);
    const double sum = to_xyz[1][0] + to_xyz[1][1] + to_xyz[1][2];
    for (int k = 0; k < 3; k++)
        colour->weights[k] = (float)(to_xyz[1][k] / sum);
    if (picture->colours != EXR_GREY && (adapted || !colour_are_near(&own, &colour_rec709))) {
        colour_to_rec709(to_xyz, adapted ? neutral : NULL, colour->matrix);
        colour->converts = 1;
        colour_tell(&in->options.notes, in->name, &own,
                    adapted ? ", adapted from its neutral" : "");
    }
}

/* ---- Chroma ---------------------------------------------------------------------------------- */

enum { TAPS = 14 }; /* values around a place that has none, half of them on either side */
static const float filter[TAPS] = {0.002128f,  -0.007540f, 0.019597f,  -0.043159f, 0.087929f,
                                   -0.186077f, 0.627123f,  0.627123f,  -0.186077f, 0.087929f,
                                   -0.043159f, 0.019597f,  -0.007540f, 0.002128f};

static int clamp(int value, int most)
{
    return value < 0 ? 0 : value < most ? value : most;
}

/* The chroma of all pixels of the lines that have any. */
static void widen_chroma(const exr_picture *picture, float *chroma)
{
    for (int k = 0; k < 2; k++) {
        const exr_plane *plane = &picture->planes[1 + k];
        for (int y = 0; y < plane->height; y++) {
            const float *line = plane->values + (size_t)y * (size_t)plane->width;
            float *out = chroma + 2 * (size_t)y * (size_t)picture->width + k;
            for (int x = 0; x < picture->width; x++) {
                float sum = line[x / plane->step];
                if (x % plane->step != 0) {
                    sum = 0.0f;
                    for (int i = 0; i < TAPS; i++)
                        sum += filter[i] * line[clamp(x / 2 - TAPS / 2 + 1 + i, plane->width - 1)];
                }
                out[2 * x] = sum;
            }
        }
    }
}

/* R, G and B of a pixel before conversion. */
static void rgb_of_chroma(const float weights[3], float y, float ry, float by, float rgb[3])
{
    if (ry == 0.0f && by == 0.0f) { /* grey stays exactly grey */
        rgb[0] = rgb[1] = rgb[2] = y;
        return;
    }
    rgb[0] = (ry + 1.0f) * y;
    rgb[2] = (by + 1.0f) * y;
    rgb[1] = (y - rgb[0] * weights[0] - rgb[2] * weights[2]) / weights[1];
}

/* A row before saturated pixels are mended; rows outside, which only serve as neighbours, continue
 * the picture. */
static void chroma_row(const exr_colour *colour, int y, float *rgb)
{
    const exr_picture *picture = colour->picture;
    const int width = picture->width, lines = picture->planes[1].height;
    const int step = picture->planes[1].step;
    const int line =
        y < picture->height ? clamp(y, picture->height) : clamp(picture->height - 2, y);
    const float *luminance = picture->planes[0].values + (size_t)line * (size_t)width;
    for (int x = 0; x < width; x++) {
        float chroma[2] = {0.0f, 0.0f};
        for (int k = 0; k < 2; k++) {
            const float *column = colour->chroma + 2 * x + k;
            const size_t stride = 2 * (size_t)width;
            if (step == 1 || (y & 1) == 0) {
                chroma[k] = column[stride * (size_t)clamp(y / step, lines - 1)];
                continue;
            }
            const int first = (y - 1) / 2 - TAPS / 2 + 1;
            for (int i = 0; i < TAPS; i++)
                chroma[k] += filter[i] * column[stride * (size_t)clamp(first + i, lines - 1)];
        }
        rgb_of_chroma(colour->weights, luminance[x], chroma[0], chroma[1], rgb + 3 * x);
    }
}

/* chroma_row(), kept for the rows that have it as a neighbour. */
static const float *kept_row(exr_colour *colour, int y)
{
    const int slot = (y + 3) % 3;
    float *row = colour->rows + 3 * (size_t)slot * (size_t)colour->picture->width;
    if (colour->row[slot] != y) {
        chroma_row(colour, y, row);
        colour->row[slot] = y;
    }
    return row;
}

static float saturation(const float rgb[3])
{
    const float most = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
    return most > 0.0f ? 1.0f - fminf(rgb[0], fminf(rgb[1], rgb[2])) / most : 0.0f;
}

/* Less saturated by `share`, of the same luminance. */
static void desaturate(const float weights[3], float share, float rgb[3])
{
    const float most = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
    float before = 0.0f, after = 0.0f;
    for (int k = 0; k < 3; k++) {
        before += weights[k] * rgb[k];
        rgb[k] = fmaxf(most - (most - rgb[k]) * share, 0.0f);
        after += weights[k] * rgb[k];
    }
    for (int k = 0; k < 3 && after > 0.0f; k++)
        rgb[k] *= before / after;
}

/* Chroma that was brought from bright neighbours to dark pixels makes them too colourful: none may
 * be much more saturated than its four diagonal neighbours. */
static void mended_row(exr_colour *colour, int y, float *rgb)
{
    const int last = colour->picture->width - 1;
    const float *above = kept_row(colour, y - 1), *below = kept_row(colour, y + 1);
    memcpy(rgb, kept_row(colour, y), 3 * ((size_t)last + 1) * sizeof *rgb);
    for (int x = 0; x <= last; x++) {
        const int left = 3 * clamp(x - 1, last), right = 3 * clamp(x + 1, last);
        const float mean =
            fminf(1.0f, 0.25f * (saturation(above + left) + saturation(above + right) +
                                 saturation(below + left) + saturation(below + right)));
        const float most = fminf(1.0f, 1.0f - (1.0f - mean) * 0.25f);
        const float own = saturation(rgb + 3 * x);
        if (own > mean && own > most)
            desaturate(colour->weights, most / own, rgb + 3 * x);
    }
}

/* ---- Rows ------------------------------------------------------------------------------------ */

static void plain_row(const exr_picture *picture, int y, float *rgb)
{
    for (int k = 0; k < 3; k++) {
        const exr_plane *plane = &picture->planes[picture->colours == EXR_GREY ? 0 : k];
        const float *line = plane->values ? plane->values + (size_t)y * (size_t)plane->width : NULL;
        for (int x = 0; x < picture->width; x++)
            rgb[3 * x + k] = line ? line[x] : 0.0f;
    }
}

void exr_colour_row(exr_colour *colour, int y, float *rgb)
{
    const exr_picture *picture = colour->picture;
    if (picture->colours != EXR_CHROMA)
        plain_row(picture, y, rgb);
    else if (picture->planes[1].step == 1)
        chroma_row(colour, y, rgb);
    else
        mended_row(colour, y, rgb);
    if (colour->converts)
        colour_convert(colour->matrix, rgb, picture->width);
}

hnbrdf_result exr_colour_open(const exr_input *in, const exr_picture *picture, exr_colour *colour)
{
    const size_t width = (size_t)picture->width;
    *colour = (exr_colour){.picture = picture, .row = {-9, -9, -9}};
    if (picture->colours == EXR_XYZ) {
        colour_matrix same = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        colour_to_rec709(same, NULL, colour->matrix);
        colour->converts = 1;
        hnbrdf_note(&in->options.notes, "%s: converted to Rec. 709 from CIE XYZ", in->name);
    } else {
        read_primaries(in, colour);
    }
    if (picture->colours != EXR_CHROMA)
        return HNBRDF_OK;
    colour->chroma = malloc(2 * width * (size_t)picture->planes[1].height * sizeof(float));
    colour->rows = malloc(9 * width * sizeof(float));
    if (!colour->chroma || !colour->rows) {
        exr_colour_close(colour);
        return hnbrdf_fail(in->error, HNBRDF_ERROR_MEMORY, "%s: no memory for its chroma",
                           in->name);
    }
    widen_chroma(picture, colour->chroma);
    return HNBRDF_OK;
}

void exr_colour_close(exr_colour *colour)
{
    free(colour->chroma);
    free(colour->rows);
    colour->chroma = colour->rows = NULL;
}
