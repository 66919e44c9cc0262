/* cie.c: colour of a reflected spectrum: X = sum f S x / sum S y with the CIE 1931 2-degree
 * observer and illuminant D65 (CIE 15:2004, tables T.4 and T.1), then linear sRGB (IEC
 * 61966-2-1). */
#include "measured/cie.h"

enum { FIRST_NM = 380, LAST_NM = 780, OBSERVER_STEP = 5, D65_STEP = 10 };

/* x, y, z from 380 nm on, every 5 nm. */
static const double OBSERVER[][3] = {
    {0.001368, 0.000039, 0.00645}, {0.002236, 0.000064, 0.01055}, {0.004243, 0.00012, 0.02005},
    {0.00765, 0.000217, 0.03621},  {0.01431, 0.000396, 0.06785},  {0.02319, 0.00064, 0.1102},
    {0.04351, 0.00121, 0.2074},    {0.07763, 0.00218, 0.3713},    {0.13438, 0.004, 0.6456},
    {0.21477, 0.0073, 1.03905},    {0.2839, 0.0116, 1.3856},      {0.3285, 0.01684, 1.62296},
    {0.34828, 0.023, 1.74706},     {0.34806, 0.0298, 1.7826},     {0.3362, 0.038, 1.77211},
    {0.3187, 0.048, 1.7441},       {0.2908, 0.06, 1.6692},        {0.2511, 0.0739, 1.5281},
    {0.19536, 0.09098, 1.28764},   {0.1421, 0.1126, 1.0419},      {0.09564, 0.13902, 0.81295},
    {0.05795, 0.1693, 0.6162},     {0.03201, 0.20802, 0.46518},   {0.0147, 0.2586, 0.3533},
    {0.0049, 0.323, 0.272},        {0.0024, 0.4073, 0.2123},      {0.0093, 0.503, 0.1582},
    {0.0291, 0.6082, 0.1117},      {0.06327, 0.71, 0.07825},      {0.1096, 0.7932, 0.05725},
    {0.1655, 0.862, 0.04216},      {0.22575, 0.91485, 0.02984},   {0.2904, 0.954, 0.0203},
    {0.3597, 0.9803, 0.0134},      {0.43345, 0.99495, 0.00875},   {0.51205, 1.0, 0.00575},
    {0.5945, 0.995, 0.0039},       {0.6784, 0.9786, 0.00275},     {0.7621, 0.952, 0.0021},
    {0.8425, 0.9154, 0.0018},      {0.9163, 0.87, 0.00165},       {0.9786, 0.8163, 0.0014},
    {1.0263, 0.757, 0.0011},       {1.0567, 0.6949, 0.001},       {1.0622, 0.631, 0.0008},
    {1.0456, 0.5668, 0.0006},      {1.0026, 0.503, 0.00034},      {0.9384, 0.4412, 0.00024},
    {0.85445, 0.381, 0.00019},     {0.7514, 0.321, 0.0001},       {0.6424, 0.265, 0.00005},
    {0.5419, 0.217, 0.00003},      {0.4479, 0.175, 0.00002},      {0.3608, 0.1382, 0.00001},
    {0.2835, 0.107, 0.0},          {0.2187, 0.0816, 0.0},         {0.1649, 0.061, 0.0},
    {0.1212, 0.04458, 0.0},        {0.0874, 0.032, 0.0},          {0.0636, 0.0232, 0.0},
    {0.04677, 0.017, 0.0},         {0.0329, 0.01192, 0.0},        {0.0227, 0.00821, 0.0},
    {0.01584, 0.005723, 0.0},      {0.011359, 0.004102, 0.0},     {0.008111, 0.002929, 0.0},
    {0.00579, 0.002091, 0.0},      {0.004109, 0.001484, 0.0},     {0.002899, 0.001047, 0.0},
    {0.002049, 0.00074, 0.0},      {0.00144, 0.00052, 0.0},       {0.001, 0.000361, 0.0},
    {0.00069, 0.000249, 0.0},      {0.000476, 0.000172, 0.0},     {0.000332, 0.00012, 0.0},
    {0.000235, 0.000085, 0.0},     {0.000166, 0.00006, 0.0},      {0.000117, 0.000042, 0.0},
    {0.000083, 0.00003, 0.0},      {0.000059, 0.000021, 0.0},     {0.000042, 0.000015, 0.0},
};

/* Every 10 nm; the standard itself interpolates linearly between these. */
static const double D65[] = {
    49.9755, 54.6482, 82.7549, 91.486,  93.4318, 86.6823, 104.865, 117.008, 117.812,
    114.861, 115.923, 108.811, 109.354, 107.802, 104.79,  107.689, 104.405, 104.046,
    100.0,   96.3342, 95.788,  88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992,
    80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349,  61.604,  69.8856,
    75.087,  63.5927, 46.4182, 66.8054, 63.3828,
};

/* Of R, G, B. */
static const double CHROMATICITY[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};

/* Linear interpolation of both tables; nm lies within them. */
static void observer_under_d65(int nm, double xyz[3])
{
    int i = (nm - FIRST_NM) / OBSERVER_STEP, k = (nm - FIRST_NM) / D65_STEP;
    int beyond = (nm - FIRST_NM) % OBSERVER_STEP, beyond_d65 = (nm - FIRST_NM) % D65_STEP;
    double t = (double)beyond / OBSERVER_STEP, t_d65 = (double)beyond_d65 / D65_STEP;
    double power = beyond_d65 ? D65[k] + t_d65 * (D65[k + 1] - D65[k]) : D65[k];
    for (int c = 0; c < 3; c++) {
        double value = OBSERVER[i][c];
        xyz[c] = power * (beyond ? value + t * (OBSERVER[i + 1][c] - value) : value);
    }
}

/* Row c of the matrix from XYZ to linear sRGB, up to a factor: the plane through the two other
 * primaries. */
static void channel_row(int c, double row[3])
{
    double primary[2][3];
    for (int k = 0; k < 2; k++) {
        const double *xy = CHROMATICITY[(c + 1 + k) % 3];
        primary[k][0] = xy[0];
        primary[k][1] = xy[1];
        primary[k][2] = 1.0 - xy[0] - xy[1];
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        row[i] = primary[0][j] * primary[1][k] - primary[0][k] * primary[1][j];
    }
}

/* Gives rgb to the nodes that make up a spectrum at nm, each its share. `below` nodes lie below
 * nm. */
static void add_to_nodes(const float *nodes, size_t count, size_t below, int nm,
                         const double rgb[3], double (*weights)[3])
{
    size_t left = below > 0 ? below - 1 : 0, right = below < count ? below : left;
    double t = right > left
                   ? (nm - (double)nodes[left]) / ((double)nodes[right] - (double)nodes[left])
                   : 0.0;
    for (int c = 0; c < 3; c++) {
        weights[left][c] += (1.0 - t) * rgb[c];
        weights[right][c] += t * rgb[c];
    }
}

void hnbrdf_cie_weights(const float *nodes, size_t count, double (*weights)[3])
{
    double row[3][3], white[3] = {0};
    size_t below = 0;
    for (int c = 0; c < 3; c++)
        channel_row(c, row[c]);
    for (size_t i = 0; i < count; i++)
        weights[i][0] = weights[i][1] = weights[i][2] = 0.0;
    for (int nm = FIRST_NM; nm <= LAST_NM; nm++) {
        double xyz[3], rgb[3];
        observer_under_d65(nm, xyz);
        for (int c = 0; c < 3; c++) {
            rgb[c] = row[c][0] * xyz[0] + row[c][1] * xyz[1] + row[c][2] * xyz[2];
            white[c] += rgb[c];
        }
        while (below < count && (double)nodes[below] < nm)
            below++;
        add_to_nodes(nodes, count, below, nm, rgb, weights);
    }
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            weights[i][c] /= white[c];
}
