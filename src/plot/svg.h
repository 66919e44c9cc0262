/* svg.h: what plots are made of, written as SVG without dependencies: panels with axes, marks,
 * text. */
#ifndef HNBRDF_PLOT_SVG_H
#define HNBRDF_PLOT_SVG_H

#include <stdio.h>

typedef struct svg_axis {
    double low, high; /* low < high; above 0 if logarithmic */
    int logarithmic;
    const char *title; /* NULL: none */
} svg_axis;

/* A rectangle of the picture, in pixels from the top left corner, and what its sides mean: x
 * grows to the right and y upwards. Left of it and below there must be room for the numbers and
 * titles: 60 and 48. */
typedef struct svg_panel {
    double left, top, width, height;
    svg_axis x, y;
} svg_panel;

/* Shapes of a mark; SVG_SHAPES is their number. */
typedef enum svg_shape {
    SVG_CIRCLE = 0,
    SVG_SQUARE,
    SVG_DIAMOND,
    SVG_TRIANGLE,
    SVG_SHAPES
} svg_shape;

/* Colours that most colour-blind people tell apart (Okabe and Ito 2008), black first. */
enum { SVG_COLORS = 7 };
extern const char *const svg_colors[SVG_COLORS];

/* The whole picture with a white ground; svg_end() closes it. */
void svg_begin(FILE *file, double width, double height);
void svg_end(FILE *file);

/* Text at a point, which is its "start", "middle" or "end"; any characters. color NULL: black; else
 * with a white rim, readable on lines too. */
void svg_text(FILE *file, double x, double y, const char *anchor, const char *color,
              const char *text);
/* Larger and bold. */
void svg_heading(FILE *file, double x, double y, const char *text);
/* Read from below to above, centred. */
void svg_text_upwards(FILE *file, double x, double y, const char *text);

void svg_line(FILE *file, double x0, double y0, double x1, double y1, const char *color,
              double width, int dashed);
/* A path through points given in pixels: begin, any number of points, end. */
void svg_path_begin(FILE *file, const char *color, double width, int dashed);
void svg_path_point(FILE *file, double x, double y);
void svg_path_end(FILE *file);
/* hollow: only the outline. */
void svg_mark(FILE *file, svg_shape shape, double x, double y, double radius, const char *color,
              int hollow);

/* Values to pixels. */
double svg_x(const svg_panel *panel, double value);
double svg_y(const svg_panel *panel, double value);

/* Widens an axis so that `value` lies on it; low > high stands for an axis without any value yet.
 * Values that the axis cannot show are passed over. */
void svg_axis_include(svg_axis *axis, double value);
/* Room on both sides by a share of the length, and never an empty axis. */
void svg_axis_pad(svg_axis *axis, double share);

/* Grid, numbers and titles. */
void svg_panel_draw(FILE *file, const svg_panel *panel);

#endif
