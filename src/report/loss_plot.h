/* loss_plot.h: the course of a training as a picture. */
#ifndef HNBRDF_REPORT_LOSS_PLOT_H
#define HNBRDF_REPORT_LOSS_PLOT_H

#include "hnbrdf/hnbrdf.h"

typedef struct loss_point {
    long step;
    double loss;
} loss_point;

typedef struct loss_curve {
    loss_point *points; /* malloc'ed; steps increase */
    int count, room;
} loss_curve;

/* Adds a point; one that cannot be held is left out of the picture. */
void loss_curve_add(loss_curve *curve, long step, double loss);
void loss_curve_free(loss_curve *curve);

/* Writes an SVG: loss against step. */
hnbrdf_result loss_curve_plot(const loss_curve *curve, const char *title, const char *path,
                              hnbrdf_error *error);

#endif
