/* turn.h: the angle of a vector of + - * / alone: the same bits wherever IEEE floats are, which
 * libm's atan2 does not promise. shaders/sphere.comp holds the same function in the same order.
 * The way back is hnbrdf_sincos_turn(). The polynomial is fitted at Chebyshev nodes;
 * tests/test_render_light.c holds it to its error. */
#ifndef HNBRDF_RENDER_TURN_H
#define HNBRDF_RENDER_TURN_H

#include <math.h>

/* atan2(y, x) / (2 pi) in [0, 1], counter-clockwise from +x; 0 where both are 0. Absolute error
 * at most 8e-8, relative error of angles below an eighth at most 3e-7. */
static inline float render_turn(float y, float x)
{
    float ax = fabsf(x), ay = fabsf(y);
    float low = ax < ay ? ax : ay, high = ax < ay ? ay : ax;
    int wide = low > 0.414213562f * high; /* more than a sixteenth: taken from the diagonal */
    float r = wide ? (low - high) / (low + high) : high > 0.0f ? low / high : 0.0f;
    float r2 = r * r;
    float p = 0.0126946624f;
    p = p * r2 - 0.0220405571f;
    p = p * r2 + 0.0317897387f;
    p = p * r2 - 0.0530507751f;
    p = p * r2 + 0.159154937f;
    float t = (wide ? 0.125f : 0.0f) + r * p;
    t = ax < ay ? 0.25f - t : t;
    t = x < 0.0f ? 0.5f - t : t;
    return y < 0.0f ? 1.0f - t : t;
}

#endif
