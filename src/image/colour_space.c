/* colour_space.c: primaries, whites and the matrices between them. */
#include "image/colour_space.h"

#include "base/error.h"
#include "base/number.h"

#include <math.h>

const colour_primaries colour_rec709 = {{.64f, .33f}, {.30f, .60f}, {.15f, .06f}, {.3127f, .3290f}};

int colour_is_near(const float a[2], const float b[2])
{
    return fabsf(a[0] - b[0]) <= 5e-4f && fabsf(a[1] - b[1]) <= 5e-4f;
}

int colour_are_near(const colour_primaries *a, const colour_primaries *b)
{
    return colour_is_near(a->red, b->red) && colour_is_near(a->green, b->green) &&
           colour_is_near(a->blue, b->blue) && colour_is_near(a->white, b->white);
}

static void multiply(colour_matrix a, colour_matrix b, colour_matrix out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

/* 0, or -1 if there is none: chromaticities that are floats turn a determinant of 0 into one of
 * about 1e-8, and real primaries have 0.1 and more. */
static int invert(colour_matrix m, colour_matrix out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            out[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    const double determinant = m[0][0] * out[0][0] + m[0][1] * out[1][0] + m[0][2] * out[2][0];
    if (!(fabs(determinant) > 1e-6))
        return -1;
    for (int i = 0; i < 9; i++)
        out[i / 3][i % 3] /= determinant;
    return 0;
}

static void xyz_of(const float point[2], double xyz[3])
{
    const double x = (double)point[0], y = (double)point[1];
    xyz[0] = x / y;
    xyz[1] = 1.0;
    xyz[2] = (1.0 - x - y) / y;
}

int colour_to_xyz(const colour_primaries *c, colour_matrix out)
{
    const float *points[3] = {c->red, c->green, c->blue};
    colour_matrix primaries, inverse;
    double white[3];
    if (!(fabs((double)c->white[1]) > 1e-6))
        return -1;
    xyz_of(c->white, white);
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

int colour_from_xyz(const colour_primaries *primaries, colour_matrix out)
{
    colour_matrix to_xyz;
    return colour_to_xyz(primaries, to_xyz) == 0 ? invert(to_xyz, out) : -1;
}

/* XYZ seen under one white to XYZ that looks the same under another (Bradford). */
static void adapt(const double from[3], const double to[3], colour_matrix out)
{
    colour_matrix cone = {
        {0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
    colour_matrix back, scaled;
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

void colour_to_rec709(colour_matrix to_xyz, const float neutral[2], float out[3][3])
{
    colour_matrix to_709, all;
    (void)colour_from_xyz(&colour_rec709, to_709);
    multiply(to_709, to_xyz, all);
    if (neutral) {
        colour_matrix adapted, xyz;
        double from[3], to[3];
        xyz_of(neutral, from);
        xyz_of(colour_rec709.white, to);
        adapt(from, to, adapted);
        multiply(adapted, to_xyz, xyz);
        multiply(to_709, xyz, all);
    }
    for (int i = 0; i < 9; i++)
        out[i / 3][i % 3] = (float)all[i / 3][i % 3];
}

void colour_convert(float matrix[3][3], float *rgb, int count)
{
    for (int x = 0; x < count; x++, rgb += 3) {
        const float in[3] = {rgb[0], rgb[1], rgb[2]};
        for (int k = 0; k < 3; k++)
            rgb[k] = matrix[k][0] * in[0] + matrix[k][1] * in[1] + matrix[k][2] * in[2];
    }
}

void colour_tell(const hnbrdf_notes *notes, const char *name, const colour_primaries *c,
                 const char *more)
{
    hnbrdf_note(notes,
                "%s: converted to Rec. 709 from its own primaries, red (%s, %s) green (%s, %s) "
                "blue (%s, %s) white (%s, %s)%s",
                name, HNBRDF_NUMBER(c->red[0]), HNBRDF_NUMBER(c->red[1]),
                HNBRDF_NUMBER(c->green[0]), HNBRDF_NUMBER(c->green[1]), HNBRDF_NUMBER(c->blue[0]),
                HNBRDF_NUMBER(c->blue[1]), HNBRDF_NUMBER(c->white[0]), HNBRDF_NUMBER(c->white[1]),
                more);
}
