#version 450
// verify.frag: shaders/parity.glsl over a buffer of rows, a pixel for every row, one slot at a time; slots from 8 on
// are those of probe.glsl, whose rows are one vec4: a driver may round otherwise here than in compute shaders.
#extension GL_GOOGLE_include_directive : require
#define HNBRDF_WEIGHTS_BINDING 1
#include "scene.glsl"
#include "parity.glsl"
#include "probe.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Rows { vec4 rows[]; };
layout(push_constant) uniform Push { uint count, width, slot; };
layout(location = 0) out vec4 result;

void main()
{
    uint k = uint(gl_FragCoord.y) * width + uint(gl_FragCoord.x);
    if (k >= count)
        discard;
    if (slot >= 8)
        result = hnbrdf_probe(rows[k], int(slot) - 8);
    else
        result = hnbrdf_parity(rows[4 * k], rows[4 * k + 1], rows[4 * k + 2], rows[4 * k + 3],
                               int(slot));
}
