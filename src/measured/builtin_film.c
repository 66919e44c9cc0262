/* builtin_film.c: the colour of a thin film: Airy's sum over the visible spectrum, seen by the
 * CIE 1931 observer under equal-energy light, as linear sRGB with a flat spectrum grey. Saturated
 * colours outside the gamut come out negative and are clipped where f is, as in real RGB
 * measurements. */
#include "measured/builtin.h"

#include <complex.h>
#include <math.h>

static const double PI = 3.14159265358979323846;
enum { FIRST_NM = 380, LAST_NM = 720, STEP_NM = 5 };

/* ---- Colour: multi-lobe fits of Wyman, Sloan and Shirley 2013, Simple Analytic Approximations
 * to the CIE XYZ Color Matching Functions
 * ---------------------------------------------------------------- */

static double lobe(double nm, double peak, double below, double above)
{
    double t = (nm - peak) / (nm < peak ? below : above);
    return exp(-t * t / 2);
}

static void cie_xyz(double nm, double xyz[3])
{
    xyz[0] = 1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
             0.065 * lobe(nm, 501.1, 20.4, 26.2);
    xyz[1] = 0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1);
    xyz[2] = 1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8);
}

/* IEC 61966-2-1. */
static void srgb_from_xyz(const double xyz[3], double rgb[3])
{
    static const double M[3][3] = {
        {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
    for (int c = 0; c < 3; c++)
        rgb[c] = M[c][0] * xyz[0] + M[c][1] * xyz[1] + M[c][2] * xyz[2];
}

/* ---- Interference: Born and Wolf, Principles of Optics, 7.6; Belcour and Barla 2017 ---------- */

/* Amplitude reflected by the boundary from index n0 to n1, polarised s (0) or p (1). */
static double complex boundary(double complex n0, double complex cos0, double complex n1,
                               double complex cos1, int p)
{
    double complex a = p ? n1 * cos0 : n0 * cos0, b = p ? n0 * cos1 : n1 * cos1;
    return (a - b) / (a + b);
}

/* Airy's sum for one plate; Stokes 1862 for a pile of them. */
static double reflectance(const film_stack *film, double c, double nm)
{
    double complex base = film->base_n - film->base_k * I;
    double sine = film->outside_n * sqrt(1.0 - c * c);
    double complex cos1 = csqrt(1.0 - (sine / film->n) * (sine / film->n));
    double complex cos2 = csqrt(1.0 - (sine / base) * (sine / base));
    double complex delay = cexp(-4.0 * PI * film->n * film->thickness / nm * cos1 * I);
    double sum = 0.0;
    for (int p = 0; p < 2; p++) {
        double complex r01 = boundary(film->outside_n, c, film->n, cos1, p);
        double complex r12 = boundary(film->n, cos1, base, cos2, p) * delay;
        double amplitude = cabs((r01 + r12) / (1.0 + r01 * r12));
        sum += amplitude * amplitude;
    }
    double plate = sum / 2;
    return film->plates * plate / (1.0 + (film->plates - 1) * plate);
}

static void film_colour(const film_stack *film, double c, double rgb[3])
{
    double xyz[3] = {0}, white[3] = {0}, grey[3], weight[3];
    for (int nm = FIRST_NM; nm <= LAST_NM; nm += STEP_NM) {
        double reflected = reflectance(film, c, nm);
        cie_xyz(nm, weight);
        for (int i = 0; i < 3; i++) {
            xyz[i] += reflected * weight[i];
            white[i] += weight[i];
        }
    }
    srgb_from_xyz(xyz, rgb);
    srgb_from_xyz(white, grey);
    for (int i = 0; i < 3; i++)
        rgb[i] /= grey[i];
}

void hnbrdf_film_fill(film_table *table, const film_stack *film)
{
    for (int k = 0; k <= FILM_STEPS; k++)
        film_colour(film, (double)k / FILM_STEPS, table->rgb[k]);
}

void hnbrdf_film_reflectance(const film_table *table, double c, double rgb[3])
{
    double x = c * FILM_STEPS;
    int k = (int)x < FILM_STEPS - 1 ? (int)x : FILM_STEPS - 1;
    double t = x - k;
    for (int i = 0; i < 3; i++)
        rgb[i] = table->rgb[k][i] + t * (table->rgb[k + 1][i] - table->rgb[k][i]);
}
