/* same_picture.h: whether two pictures are the same to the bit, and what differs if not. */
#ifndef HNBRDF_REPORT_SAME_PICTURE_H
#define HNBRDF_REPORT_SAME_PICTURE_H

#include "image/image.h"

#include <stdio.h>

/* Numbers of two pictures. */
typedef struct report_same_picture {
    size_t count, differ, apart; /* all; not equal; not even neighbouring floats */
    double psnr;                 /* dB; infinite where none differs */
} report_same_picture;

/* Both of the same size, with alpha. */
hnbrdf_result report_same_picture_measure(const render_image *a, const render_image *b,
                                          report_same_picture *same, hnbrdf_error *error);
/* What a check of a device's picture against the CPU's says. Sums are kept in doubles by the CPU,
 * in pairs of floats by the device: neighbours may come out. `exact`: the device computes + - * /
 * sqrt as C does. */
void report_same_picture_print(const report_same_picture *same, int exact, FILE *file);

#endif
