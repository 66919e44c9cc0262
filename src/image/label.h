/* label.h: clean anti-aliased lettering on images, from a stroke font drawn for this program. */
#ifndef HNBRDF_IMAGE_LABEL_H
#define HNBRDF_IMAGE_LABEL_H

#include "image/image.h"

/* One glyph: strokes on a grid with the baseline at y = 0, small letters 10 high, capitals 14,
 * descenders to -4. A path is a list of M x y (move), L x y (line), Q cx cy x y (quadratic curve);
 * `width` is that of the drawing, without the space to the next glyph. */
typedef struct render_glyph {
    int width;
    const char *path;
} render_glyph;

/* Of a Unicode code point: ASCII, the middle dot, the multiplication sign and the ellipsis; an
 * empty box for any other. */
const render_glyph *render_glyph_find(unsigned code);

/* Text is UTF-8; x_height is the height of small letters in pixels (whole numbers are crispest). */
double render_text_width(const char *text, double x_height);
/* Left end at x, baseline at the middle of pixel row y; colour is linear. Clipped to the image. */
void render_text(render_image *image, int x, int y, const char *text, double x_height,
                 const float colour[3]);
/* Copies text, ending it with an ellipsis if it is wider than width pixels or does not fit size
 * bytes. */
void render_text_shorten(const char *text, double x_height, double width, char *out, size_t size);

#endif
