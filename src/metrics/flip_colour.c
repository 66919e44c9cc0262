/* flip_colour.c: the colour spaces of FLIP (Andersson et al. 2020, section 4.1). */
#include "metrics/flip_colour.h"

#include <math.h>

/* Rec. 709 to XYZ, of the authors: white is D65 with (0.3127, 0.3290) to four digits. */
static const double RGB_TO_XYZ[3][3] = {
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}};

/* The exponent of distances; the share of the largest one that is mapped to PAST. */
static const double COLOUR_POWER = 0.7, SHARE = 0.4, PAST = 0.95;

/* The curve (a x^2 + b x)/(c x^2 + d x + e), Narkowicz's fit to that of ACES with 0.6 before it. */
static const double A = 0.6 * 0.6 * 2.51, B = 0.6 * 0.03, C = 0.6 * 0.6 * 2.43, D = 0.6 * 0.59,
                    E = 0.14;

static void multiply(const double m[3][3], const double v[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m[k][0] * v[0] + m[k][1] * v[1] + m[k][2] * v[2];
}

static void invert(double m[3][3], double out[3][3])
{
    double determinant = 0.0;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            out[c][r] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
            determinant += r == 0 ? m[r][c] * out[c][r] : 0.0;
        }
    for (int k = 0; k < 9; k++)
        out[k / 3][k % 3] /= determinant;
}

static double clamp_unit(double value)
{
    return value > 0.0 ? (value < 1.0 ? value : 1.0) : 0.0;
}

static double lightness_curve(double t)
{
    const double delta = 6.0 / 29.0;
    return t > delta * delta * delta ? cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

static void lab_of(const flip_colours *c, const double rgb[3], double lab[3])
{
    double f[3];
    multiply(c->to_xyz, rgb, f);
    for (int k = 0; k < 3; k++)
        f[k] = lightness_curve(f[k]);
    lab[0] = 116.0 * f[1] - 16.0;
    lab[1] = 0.01 * lab[0] * 500.0 * (f[0] - f[1]);
    lab[2] = 0.01 * lab[0] * 200.0 * (f[1] - f[2]);
}

void hnbrdf_flip_show(const flip_display *display, const float rgb[3], double shown[3])
{
    for (int c = 0; c < 3; c++) {
        double x = display->gain * (double)rgb[c];
        x = x > 0.0 ? fmin(x, 1e9) : 0.0;
        if (display->filmic)
            x = x * (A * x + B) / (x * (C * x + D) + E);
        shown[c] = x < 1.0 ? x : 1.0;
    }
}

double hnbrdf_flip_film_inverse(double shown)
{
    const double a = A - shown * C, b = B - shown * D, c = -shown * E;
    return (-b + sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

void hnbrdf_flip_colours(flip_colours *c)
{
    static const double green[3] = {0.0, 1.0, 0.0}, blue[3] = {0.0, 0.0, 1.0};
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        const double *row = RGB_TO_XYZ[k];
        for (int i = 0; i < 3; i++)
            c->to_xyz[k][i] = row[i] / (row[0] + row[1] + row[2]);
    }
    invert(c->to_xyz, c->to_rgb);
    lab_of(c, green, a);
    lab_of(c, blue, b);
    c->largest = hnbrdf_flip_distance(a, b);
}

void hnbrdf_flip_opponent(const flip_colours *c, const double rgb[3], double opponent[3])
{
    double xyz[3];
    multiply(c->to_xyz, rgb, xyz);
    opponent[0] = 116.0 * xyz[1] - 16.0;
    opponent[1] = 500.0 * (xyz[0] - xyz[1]);
    opponent[2] = 200.0 * (xyz[1] - xyz[2]);
}

void hnbrdf_flip_lab(const flip_colours *c, const double opponent[3], double lab[3])
{
    const double y = (opponent[0] + 16.0) / 116.0;
    const double xyz[3] = {opponent[1] / 500.0 + y, y, y - opponent[2] / 200.0};
    double rgb[3];
    multiply(c->to_rgb, xyz, rgb);
    for (int k = 0; k < 3; k++)
        rgb[k] = clamp_unit(rgb[k]);
    lab_of(c, rgb, lab);
}

double hnbrdf_flip_distance(const double a[3], const double b[3])
{
    const double da = a[1] - b[1], db = a[2] - b[2];
    return pow(fabs(a[0] - b[0]) + sqrt(da * da + db * db), COLOUR_POWER);
}

double hnbrdf_flip_spread(const flip_colours *c, double distance)
{
    const double knee = SHARE * c->largest;
    if (distance < knee)
        return PAST / knee * distance;
    return PAST + (distance - knee) / (c->largest - knee) * (1.0 - PAST);
}
