/* frame.h: the material's tangent frame, the shading frame turned about n by material->rotation. */
#ifndef HNBRDF_CORE_FRAME_H
#define HNBRDF_CORE_FRAME_H

#include "hnbrdf/hnbrdf.h"

#include <math.h>

typedef struct hnbrdf_frame {
    float cosine, sine; /* of the rotation; 1 and 0 when there is none */
} hnbrdf_frame;

/* In double, rounded once: the exporter writes these same floats into the shader. */
static inline hnbrdf_frame hnbrdf_frame_of_angle(float rotation)
{
    hnbrdf_frame frame = {1.0f, 0.0f};
    if (rotation != 0.0f && isfinite(rotation)) {
        frame.cosine = (float)cos((double)rotation);
        frame.sine = (float)sin((double)rotation);
    }
    return frame;
}

static inline hnbrdf_frame hnbrdf_frame_of(const hnbrdf_material *material)
{
    return hnbrdf_frame_of_angle(material->rotation);
}

static inline void hnbrdf_to_tangent(hnbrdf_frame frame, const float w[3], float t[3])
{
    float x = w[0], y = w[1];
    t[0] = frame.cosine * x + frame.sine * y;
    t[1] = frame.cosine * y - frame.sine * x;
    t[2] = w[2];
}

static inline void hnbrdf_from_tangent(hnbrdf_frame frame, const float t[3], float w[3])
{
    float x = t[0], y = t[1];
    w[0] = frame.cosine * x - frame.sine * y;
    w[1] = frame.cosine * y + frame.sine * x;
    w[2] = t[2];
}

#endif
