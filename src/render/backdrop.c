/* backdrop.c: what is seen beside the sphere. */
#include "render/render.h"

#include <math.h>
#include <stdlib.h>

/* Premultiplied "over" with an opaque colour; alpha is dropped by the caller at the end. */
static void over(render_image *image, size_t pixel, const double behind[3])
{
    double through = image->alpha ? 1.0 - (double)image->alpha[pixel] : 0.0;
    for (size_t k = 0; k < 3; k++)
        image->rgb[3 * pixel + k] += (float)(through * behind[k]);
}

static void drop_alpha(render_image *image)
{
    free(image->alpha);
    image->alpha = NULL;
}

void render_over_backdrop(render_image *image, double level)
{
    for (int row = 0; row < image->height; row++)
        for (int column = 0; column < image->width; column++) {
            double x = (column + 0.5) / image->width - 0.5, y = (row + 0.5) / image->height - 0.42;
            double value = level * (0.35 + 0.65 * exp(-4.0 * (x * x + y * y)));
            double behind[3] = {value * 0.97, value, value * 1.05};
            over(image, (size_t)row * (size_t)image->width + (size_t)column, behind);
        }
    drop_alpha(image);
}

void render_over_environment(render_image *image, const render_environment *environment,
                             double gain)
{
    enum { GRID = 3 }; /* texels are larger than pixels: a few looks soften their borders */
    double half = tan(3.14159265358979323846 / 6.0);
    for (int row = 0; row < image->height; row++)
        for (int column = 0; column < image->width; column++) {
            double behind[3] = {0.0, 0.0, 0.0};
            for (int i = 0; i < GRID * GRID; i++) {
                double x = half * (2.0 * (column + (i % GRID + 0.5) / GRID) / image->width - 1.0);
                double y = half * (1.0 - 2.0 * (row + (i / GRID + 0.5) / GRID) / image->height);
                double length = sqrt(x * x + y * y + 1.0);
                float direction[3] = {(float)(x / length), (float)(y / length),
                                      (float)(-1.0 / length)};
                float radiance[3];
                render_environment_lookup(environment, direction, radiance);
                for (int k = 0; k < 3; k++)
                    behind[k] += gain * (double)radiance[k] / (GRID * GRID);
            }
            over(image, (size_t)row * (size_t)image->width + (size_t)column, behind);
        }
    drop_alpha(image);
}
