/* draw.c: rectangles, pictures, aligned text and a colour scale on images. */
#include "image/draw.h"

#include "image/label.h"

#include <math.h>
#include <string.h>

static int inside(const render_image *image, int x, int y)
{
    return x >= 0 && y >= 0 && x < image->width && y < image->height;
}

void render_fill(render_image *image, int x, int y, int width, int height, const float colour[3])
{
    for (int row = y; row < y + height; row++)
        for (int column = x; column < x + width; column++)
            if (inside(image, column, row))
                memcpy(image->rgb + 3 * ((size_t)row * (size_t)image->width + (size_t)column),
                       colour, 3 * sizeof *colour);
}

void render_paste(render_image *image, int x, int y, const render_image *part)
{
    for (int row = 0; row < part->height; row++)
        for (int column = 0; column < part->width; column++) {
            if (!inside(image, x + column, y + row))
                continue;
            size_t from = (size_t)row * (size_t)part->width + (size_t)column;
            size_t to = (size_t)(y + row) * (size_t)image->width + (size_t)(x + column);
            float through = part->alpha ? 1.0f - part->alpha[from] : 0.0f;
            for (size_t k = 0; k < 3; k++)
                image->rgb[3 * to + k] = part->rgb[3 * from + k] + through * image->rgb[3 * to + k];
        }
}

void render_text_at(render_image *image, double x, int y, double share, const char *text,
                    double x_height, const float colour[3])
{
    int left = (int)floor(x - share * render_text_width(text, x_height) + 0.5);
    render_text(image, left, y, text, x_height, colour);
}

/* Mean over [x, x + side) x [y, y + side) of channel k; alpha is channel 3. */
static double area_mean(const render_image *image, double x, double y, double side, int k)
{
    double sum = 0.0;
    for (int row = (int)y; row < image->height && row < y + side; row++)
        for (int column = (int)x; column < image->width && column < x + side; column++) {
            double wide = fmin(column + 1.0, x + side) - fmax(column, x);
            double high = fmin(row + 1.0, y + side) - fmax(row, y);
            size_t pixel = (size_t)row * (size_t)image->width + (size_t)column;
            double value =
                k < 3 ? (double)image->rgb[3 * pixel + (size_t)k] : (double)image->alpha[pixel];
            sum += wide * high * value;
        }
    return sum / (side * side);
}

hnbrdf_result render_resize(const render_image *image, int size, double gain, render_image *out,
                            hnbrdf_error *error)
{
    hnbrdf_result result = render_image_create(size, size, image->alpha != NULL, out, error);
    double side = (double)image->width / size;
    for (int i = 0; result == HNBRDF_OK && i < size * size; i++) {
        double x = i % size * side, y = i / size * side;
        for (int k = 0; k < 3; k++)
            out->rgb[3 * i + k] = (float)(gain * area_mean(image, x, y, side, k));
        if (out->alpha)
            out->alpha[i] = (float)area_mean(image, x, y, side, 3);
    }
    return result;
}

void render_colour_map(double t, float rgb[3])
{
    static const float stops[5][3] = {
        {68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    double at = t > 0.0 ? (t < 1.0 ? 4.0 * t : 4.0) : 0.0; /* NaN: 0 */
    int k = at < 3.0 ? (int)at : 3;
    for (int c = 0; c < 3; c++) {
        double srgb =
            ((double)stops[k][c] + (at - k) * (double)(stops[k + 1][c] - stops[k][c])) / 255.0;
        rgb[c] = (float)(srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4));
    }
}

void render_colour_bar(render_image *image, int x, int y, int width, int height)
{
    for (int row = 0; row < height; row++) {
        float rgb[3];
        render_colour_map(1.0 - (row + 0.5) / height, rgb);
        render_fill(image, x, y + row, width, 1, rgb);
    }
}
