/* draw.h: what pages are made of: rectangles, pictures, aligned text, a colour scale. All of it is
 * clipped to the image; colours are linear. */
#ifndef HNBRDF_IMAGE_DRAW_H
#define HNBRDF_IMAGE_DRAW_H

#include "image/image.h"

void render_fill(render_image *image, int x, int y, int width, int height, const float colour[3]);
/* Lays a premultiplied picture over what is there. */
void render_paste(render_image *image, int x, int y, const render_image *part);
/* Text beside x; share: 0 it starts there, 1/2 it is centred, 1 it ends. Baseline at pixel row y.
 * */
void render_text_at(render_image *image, double x, int y, double share, const char *text,
                    double x_height, const float colour[3]);

/* A square picture at size x size pixels, times gain: each pixel is the mean of the area it
 * covers. */
hnbrdf_result render_resize(const render_image *image, int size, double gain, render_image *out,
                            hnbrdf_error *error);

/* Dark to light with t from 0 to 1, clamped: five colours of viridis (van der Walt and Smith 2015),
 * even to the eye. */
void render_colour_map(double t, float rgb[3]);
/* The whole of it as a bar, 1 at its top. */
void render_colour_bar(render_image *image, int x, int y, int width, int height);

#endif
