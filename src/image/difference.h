/* difference.h: where two pictures of the same size differ: which pixels count, and the
 * difference in false colours. The difference of a pixel is |a - b|, mean over the channels: its
 * mean is the MAE. */
#ifndef HNBRDF_IMAGE_DIFFERENCE_H
#define HNBRDF_IMAGE_DIFFERENCE_H

#include "image/image.h"

/* 1 if this pixel counts: a or b covers it at least in part. A picture without alpha covers
 * everything. */
int render_covered(const render_image *a, const render_image *b, size_t pixel);

/* Where the scale ends: the smallest of 1, 2 and 5 times a power of ten that at most one in a
 * hundred of the pixels that count exceeds: highlights may. 1 for equal pictures; 0 without
 * memory. */
double render_difference_top(const render_image *a, const render_image *b);

/* The colours of render_colour_map() from 0 to `top` where pixels count, with an alpha of 0
 * elsewhere. */
hnbrdf_result render_difference_map(const render_image *a, const render_image *b, double top,
                                    render_image *map, hnbrdf_error *error);

enum { RENDER_DIFFERENCE_LINES = 3 };
/* A page with the map, its scale beside it, and lines of text above, shortened where they are too
 * long; NULL: none. top as above, or 0: chosen. */
hnbrdf_result render_difference_page(const render_image *a, const render_image *b, double top,
                                     const char *const lines[RENDER_DIFFERENCE_LINES],
                                     render_image *page, hnbrdf_error *error);

#endif
