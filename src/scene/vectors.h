/* vectors.h: arithmetic in double precision for what makes shapes. */
#ifndef HNBRDF_SCENE_VECTORS_H
#define HNBRDF_SCENE_VECTORS_H

#include <math.h>

static inline double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* Returns the length of a x b. */
static inline double cross(const double a[3], const double b[3], double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
    return sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
}

#endif
