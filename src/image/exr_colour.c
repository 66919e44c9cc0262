/* exr_colour.c: linear Rec. 709 from the channels of an OpenEXR picture: RGB of any primaries, CIE
 * XYZ, luminance with chroma at half size, luminance alone.
 *
 * What (Y, RY, BY) mean, the filter between the chroma values and what is done about pixels that
 * come out more saturated than all around them are those of the format's reference
 * (ImfRgbaYca.h): RY = (R - Y)/Y, BY = (B - Y)/Y, Y = (R, G, B) . weights, which are the
 * luminances of the primaries. */
#include "image/exr.h"

#include "base/error.h"
#include "base/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef double matrix[3][3];

static const exr_attr_chromaticities_t rec709 = {.64f, .33f, .30f,   .60f,
                                                 .15f, .06f, .3127f, .3290f};

/* ---- Colour spaces --------------------------------------------------------------------------- */

static void multiply(matrix a, matrix b, matrix out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

/* 0, or -1 if there is none. */
static int invert(matrix m, matrix out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            out[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    const double determinant = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
    if (!(fabs(determinant) > 1e-9))
        return -1;
    for (int i = 0; i < 9; i++)
        out[i / 3][i % 3] /= determinant;
    return 0;
}

static void xyz_of(float x, float y, double xyz[3])
{
    xyz[0] = (double)x / (double)y;
    xyz[1] = 1.0;
    xyz[2] = (1.0 - (double)x - (double)y) / (double)y;
}

/* Linear RGB to CIE XYZ: the primaries, so scaled that their sum is the white of luminance 1. 0, or
 * -1 if these are no primaries. */
static int rgb_to_xyz(const exr_attr_chromaticities_t *c, matrix out)
{
    const float points[3][2] = {
        {c->red_x, c->red_y}, {c->green_x, c->green_y}, {c->blue_x, c->blue_y}};
    matrix primaries, inverse;
    double white[3];
    if (!(fabs((double)c->white_y) > 1e-6))
        return -1;
    xyz_of(c->white_x, c->white_y, white);
    for (int k = 0; k < 3; k++) {
        primaries[0][k] = (double)points[k][0];
        primaries[1][k] = (double)points[k][1];
        primaries[2][k] = 1.0 - (double)points[k][0] - (double)points[k][1];
    }
    if (invert(primaries, inverse))
        return -1;
    for (int k = 0; k < 3; k++) {
        const double scale =
            inverse[k][0] * white[0] + inverse[k][1] * white[1] + inverse[k][2] * white[2];
        for (int i = 0; i < 3; i++)
            out[i][k] = scale * primaries[i][k];
    }
    /* The luminance of white is 1; primaries that nearly lie on a line lose it to rounding. */
    for (int i = 0; i < 9; i++)
        if (!(fabs(out[i / 3][i % 3]) < 1e6))
            return -1;
    return fabs(out[1][0] + out[1][1] + out[1][2] - 1.0) < 1e-3 ? 0 : -1;
}

/* XYZ seen under one white to XYZ that looks the same under another (Bradford). */
static void adapt(const double from[3], const double to[3], matrix out)
{
    matrix cone = {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
    matrix back, scaled;
    (void)invert(cone, back);
    for (int i = 0; i < 3; i++) {
        double before = 0.0, after = 0.0;
        for (int k = 0; k < 3; k++) {
            before += cone[i][k] * from[k];
            after += cone[i][k] * to[k];
        }
        for (int k = 0; k < 3; k++)
            scaled[i][k] = cone[i][k] * after / before;
    }
    multiply(back, scaled, out);
}

/* Equal but for what writers round: four decimals. */
static int is_near(float a, float b)
{
    return fabsf(a - b) <= 5e-4f;
}

static int is_rec709(const exr_attr_chromaticities_t *c)
{
    return is_near(c->red_x, rec709.red_x) && is_near(c->red_y, rec709.red_y) &&
           is_near(c->green_x, rec709.green_x) && is_near(c->green_y, rec709.green_y) &&
           is_near(c->blue_x, rec709.blue_x) && is_near(c->blue_y, rec709.blue_y) &&
           is_near(c->white_x, rec709.white_x) && is_near(c->white_y, rec709.white_y);
}

/* ---- What the file says ---------------------------------------------------------------------- */

static void set_matrix(exr_colour *colour, matrix to_xyz, const exr_attr_v2f_t *neutral)
{
    matrix from_xyz, to_709, adapted, all;
    (void)rgb_to_xyz(&rec709, from_xyz);
    (void)invert(from_xyz, to_709);
    multiply(to_709, to_xyz, all);
    if (neutral) {
        double from[3], to[3];
        xyz_of(neutral->x, neutral->y, from);
        xyz_of(rec709.white_x, rec709.white_y, to);
        adapt(from, to, adapted);
        multiply(adapted, to_xyz, from_xyz);
        multiply(to_709, from_xyz, all);
    }
    for (int i = 0; i < 9; i++)
        colour->matrix[i / 3][i % 3] = (float)all[i / 3][i % 3];
    colour->converts = 1;
}

/* The neutral that the file adopts for viewing, unless it is that of Rec. 709. */
static int adopted_neutral(const exr_input *in, int part, exr_attr_v2f_t *neutral)
{
    return exr_attr_get_v2f(in->context, part, "adoptedNeutral", neutral) == EXR_ERR_SUCCESS &&
           neutral->y > 0.01f && neutral->y < 1.0f && neutral->x > 0.01f && neutral->x < 1.0f &&
           !(is_near(neutral->x, rec709.white_x) && is_near(neutral->y, rec709.white_y));
}

static void tell_primaries(const exr_input *in, const exr_attr_chromaticities_t *c, int adapted)
{
    hnbrdf_note(&in->options.notes,
                "%s: converted to Rec. 709 from its own primaries, red (%s, %s) green (%s, %s) "
                "blue (%s, %s) white (%s, %s)%s",
                in->name, HNBRDF_NUMBER(c->red_x), HNBRDF_NUMBER(c->red_y),
                HNBRDF_NUMBER(c->green_x), HNBRDF_NUMBER(c->green_y), HNBRDF_NUMBER(c->blue_x),
                HNBRDF_NUMBER(c->blue_y), HNBRDF_NUMBER(c->white_x), HNBRDF_NUMBER(c->white_y),
                adapted ? ", adapted from its neutral" : "");
}

/* Can these primaries tell the picture's colours? G is what R and B leave of Y, over the luminance
 * of the green primary: where that is below the rounding of a half-precision Y, nothing of G is
 * left in it. */
static int are_usable(const exr_picture *picture, const exr_attr_chromaticities_t *c)
{
    matrix to_xyz;
    return rgb_to_xyz(c, to_xyz) == 0 &&
           (picture->colours != EXR_CHROMA || to_xyz[1][1] > 1.0 / 2048);
}

/* Reads primaries and white of RGB and chroma, and decides what is converted. */
static void read_primaries(const exr_input *in, exr_colour *colour)
{
    const exr_picture *picture = colour->picture;
    exr_attr_chromaticities_t own = rec709;
    exr_attr_v2f_t neutral;
    matrix to_xyz;
    const int adapted = adopted_neutral(in, picture->part, &neutral);
    const int given = exr_attr_get_chromaticities(in->context, picture->part, "chromaticities",
                                                  &own) == EXR_ERR_SUCCESS;
    if (!given || is_rec709(&own)) {
        own = rec709;
    } else if (!are_usable(picture, &own)) {
        hnbrdf_note(&in->options.notes, "%s: its chromaticities are none: taken as Rec. 709",
                    in->name);
        own = rec709;
    }
    (void)rgb_to_xyz(&own, to_xyz);
    const double sum = to_xyz[1][0] + to_xyz[1][1] + to_xyz[1][2];
    for (int k = 0; k < 3; k++)
        colour->weights[k] = (float)(to_xyz[1][k] / sum);
    if (picture->colours != EXR_GREY && (adapted || !is_rec709(&own))) {
        set_matrix(colour, to_xyz, adapted ? &neutral : NULL);
        tell_primaries(in, &own, adapted);
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

static void convert_row(const exr_colour *colour, float *rgb)
{
    for (int x = 0; x < colour->picture->width; x++, rgb += 3) {
        const float in[3] = {rgb[0], rgb[1], rgb[2]};
        for (int k = 0; k < 3; k++)
            rgb[k] = colour->matrix[k][0] * in[0] + colour->matrix[k][1] * in[1] +
                     colour->matrix[k][2] * in[2];
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
        convert_row(colour, rgb);
}

hnbrdf_result exr_colour_open(const exr_input *in, const exr_picture *picture, exr_colour *colour)
{
    const size_t width = (size_t)picture->width;
    *colour = (exr_colour){.picture = picture, .row = {-9, -9, -9}};
    if (picture->colours == EXR_XYZ) {
        matrix same = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        set_matrix(colour, same, NULL);
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
