/* flip_displayed.h: FLIP of pictures as displays make them. */
#ifndef HNBRDF_METRICS_FLIP_DISPLAYED_H
#define HNBRDF_METRICS_FLIP_DISPLAYED_H

#include "hnbrdf/hnbrdf.h"
#include "metrics/flip_colour.h"

/* The largest FLIP of each pixel over `count` displays; as hnbrdf_flip() otherwise. */
hnbrdf_result hnbrdf_flip_displayed(const float *image, const float *reference, int width,
                                    int height, double pixels_per_degree,
                                    const flip_display *displays, int count, float *map,
                                    hnbrdf_error *error);

#endif
