/* sky.c: the built-in environment, a sky with studio lights in which gloss, colour and grazing
 * angles can be judged at once. */
#include "render/environment.h"

#include <math.h>

enum { WIDTH = 1024, HEIGHT = 512, SUN_GRID = 8 };

static const double pi = 3.14159265358979323846;
/* Unit vectors to the middle of each light. */
static const double sun_direction[3] = {-0.42, 0.62, 0.66272};
static const double sun_cosine = 0.99862953; /* of 3 degrees */
static const double sun_radiance[3] = {232.0, 214.0, 186.0};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double smooth_step(double low, double high, double x)
{
    double t = fmin(1.0, fmax(0.0, (x - low) / (high - low)));
    return t * t * (3.0 - 2.0 * t);
}

static void direction_at(double x, double y, double d[3])
{
    double theta = pi * y / HEIGHT, phi = 2.0 * pi * (x / WIDTH - 0.5);
    d[0] = sin(theta) * sin(phi);
    d[1] = cos(theta);
    d[2] = -sin(theta) * cos(phi);
}

static void add(double rgb[3], double weight, double r, double g, double b)
{
    rgb[0] += weight * r;
    rgb[1] += weight * g;
    rgb[2] += weight * b;
}

/* Horizon to zenith, and the ground below, brighter where it lies far away. */
static void gradient(const double d[3], double rgb[3])
{
    double up = d[1], sky = smooth_step(-0.02, 0.02, up);
    double height = pow(fmax(0.0, up), 0.6), depth = pow(fmax(0.0, -up), 0.5);
    add(rgb, sky * (1.0 - height), 0.62, 0.66, 0.70);
    add(rgb, sky * height, 0.11, 0.20, 0.40);
    add(rgb, (1.0 - sky) * (1.0 - depth), 0.30, 0.27, 0.24);
    add(rgb, (1.0 - sky) * depth, 0.085, 0.075, 0.065);
}

/* A rectangle with soft edges, seen along the tangent plane of its middle: turned by azimuth
 * about y, raised by elevation; half width and height as tangents. */
static double panel(const double d[3], double azimuth, double elevation, double width,
                    double height)
{
    double ca = cos(azimuth), sa = sin(azimuth), ce = cos(elevation), se = sin(elevation);
    double front[3] = {ce * sa, se, ce * ca}, right[3] = {ca, 0.0, -sa},
           up[3] = {-se * sa, ce, -se * ca};
    double z = dot(d, front);
    if (z <= 0.0)
        return 0.0;
    double x = fabs(dot(d, right) / z), y = fabs(dot(d, up) / z), edge = 0.03;
    return (1.0 - smooth_step(width - edge, width + edge, x)) *
           (1.0 - smooth_step(height - edge, height + edge, y));
}

/* Azimuths are measured from +z, behind the camera, towards +x, its right. */
static void lights(const double d[3], double rgb[3])
{
    add(rgb, panel(d, 1.05, 0.30, 0.22, 0.50), 3.4, 3.3, 3.2);
    add(rgb, panel(d, -2.15, 0.40, 0.10, 0.55), 3.4, 3.8, 4.4);
}

/* Share of a texel that the sun's disc covers. */
static double sun_share(int x, int y)
{
    double d[3];
    direction_at(x + 0.5, y + 0.5, d);
    if (dot(d, sun_direction) < sun_cosine - 0.002)
        return 0.0;
    int inside = 0;
    for (int i = 0; i < SUN_GRID * SUN_GRID; i++) {
        direction_at(x + (i % SUN_GRID + 0.5) / SUN_GRID, y + (i / SUN_GRID + 0.5) / SUN_GRID, d);
        inside += dot(d, sun_direction) > sun_cosine;
    }
    return (double)inside / (SUN_GRID * SUN_GRID);
}

hnbrdf_result render_sky(render_image *image, hnbrdf_error *error)
{
    hnbrdf_result result = render_image_create(WIDTH, HEIGHT, 0, image, error);
    if (result != HNBRDF_OK)
        return result;
    float *out = image->rgb;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++, out += 3) {
            double d[3], rgb[3] = {0.0, 0.0, 0.0};
            direction_at(x + 0.5, y + 0.5, d);
            gradient(d, rgb);
            lights(d, rgb);
            add(rgb, sun_share(x, y), sun_radiance[0], sun_radiance[1], sun_radiance[2]);
            for (int k = 0; k < 3; k++)
                out[k] = (float)rgb[k];
        }
    return HNBRDF_OK;
}
