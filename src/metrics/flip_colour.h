/* flip_colour.h: what a display shows, the colours of FLIP, and how far two of them are apart. */
#ifndef HNBRDF_METRICS_FLIP_COLOUR_H
#define HNBRDF_METRICS_FLIP_COLOUR_H

/* What the conversions need, made once. Linear RGB is Rec. 709; X, Y and Z are over those of
 * white. */
typedef struct flip_colours {
    double to_xyz[3][3], to_rgb[3][3];
    double largest; /* the distance of green and blue: the largest of two colours of a display */
} flip_colours;

/* How a display shows a picture. */
typedef struct flip_display {
    double gain;
    int filmic; /* 1: through the curve of a film; 0: clamped alone */
} flip_display;

/* What is shown of linear RGB, in [0, 1]. */
void hnbrdf_flip_show(const flip_display *display, const float rgb[3], double shown[3]);
/* What the curve of the film takes to `shown`, below 1. */
double hnbrdf_flip_film_inverse(double shown);

void hnbrdf_flip_colours(flip_colours *c);
/* Linear RGB to opponent colours that are linear in it: lightness, red-green, blue-yellow. */
void hnbrdf_flip_opponent(const flip_colours *c, const double rgb[3], double opponent[3]);
/* Opponent colours to CIE L*a*b*, through what a display shows of them; a* and b* by Hunt's
 * effect: less colourful where it is dark. */
void hnbrdf_flip_lab(const flip_colours *c, const double opponent[3], double lab[3]);
/* HyAB distance of two such colours, |dL| + |(da, db)|, to the power of 0.7. */
double hnbrdf_flip_distance(const double a[3], const double b[3]);
/* A distance mapped to [0, 1]: 40 % of the largest to 0.95, two straight lines. */
double hnbrdf_flip_spread(const flip_colours *c, double distance);

#endif
