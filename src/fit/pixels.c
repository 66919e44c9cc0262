/* pixels.c: the small picture of a fitted material. */
#include "fit/pixels.h"

#include <math.h>
#include <string.h>

static const double SUN_RADIUS = 0.0524, /* 3 degrees; a sharper light shows single pixels */
    SUN_RADIANCE = 200.0, PI = 3.14159265358979323846;
/* Towards them: from above, from the left, and nearly from the camera, which is at +z. */
static const double suns[FIT_SUNS][3] = {
    {-0.42, 0.62, 0.6627}, {0.8, 0.1, 0.5916}, {0.1, -0.3, 0.9487}};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

int hnbrdf_fit_pixel_at(int k, int side, fit_pixel *p)
{
    const double x = (2 * (k % side) + 1) / (double)side - 1.0;
    const double y = (2 * (k / side) + 1) / (double)side - 1.0;
    if (x * x + y * y > 0.999)
        return 0;
    const double z = sqrt(1.0 - x * x - y * y), across = sqrt(x * x + z * z);
    const double frame[3][3] = {
        {z / across, 0.0, -x / across}, {-x * y / across, across, -y * z / across}, {x, y, z}};
    memcpy(p->frame, frame, sizeof frame);
    for (int c = 0; c < 3; c++)
        p->wo[c] = (float)frame[c][2];
    return 1;
}

int hnbrdf_fit_pixel_is_near(const fit_pixel *p, int sun, double alpha)
{
    const double *n = p->frame[2], h[3] = {suns[sun][0], suns[sun][1], suns[sun][2] + 1.0};
    const double cosine = dot(n, h) / sqrt(dot(h, h)), reach = SUN_RADIUS + 4.0 * alpha;
    return cosine > cos(fmin(reach, 1.5));
}

double hnbrdf_fit_pixel_sun(const fit_pixel *p, int sun, int k, int points, float wi[3])
{
    const double *to = suns[sun], flat = sqrt(to[0] * to[0] + to[1] * to[1]);
    const double x[3] = {to[1] / flat, -to[0] / flat, 0.0};
    const double y[3] = {to[1] * x[2] - to[2] * x[1], to[2] * x[0] - to[0] * x[2],
                         to[0] * x[1] - to[1] * x[0]};
    const double r = SUN_RADIUS * sqrt((k + 0.5) / points), turn = 2.399963 * k;
    double w[3];
    for (int c = 0; c < 3; c++)
        w[c] = sqrt(1.0 - r * r) * to[c] + r * (cos(turn) * x[c] + sin(turn) * y[c]);
    for (int c = 0; c < 3; c++)
        wi[c] = (float)dot(p->frame[c], w);
    return SUN_RADIANCE * PI * SUN_RADIUS * SUN_RADIUS * (double)wi[2] / points;
}

double hnbrdf_fit_pixel_even(const fit_pixel *p, const hnbrdf_prepared *ggx, int k, int points,
                             hnbrdf_rng *rng, float wi[3])
{
    float u[2];
    u[0] = ((float)k + hnbrdf_rng_float(rng)) / (float)points;
    u[1] = hnbrdf_rng_float(rng);
    const float pdf = hnbrdf_prepared_draw(ggx, p->wo, u, wi);
    return pdf > 0.0f ? (double)wi[2] / ((double)pdf * points) : 0.0;
}
