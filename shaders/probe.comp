#version 450
// probe.comp: shaders/probe.glsl over a buffer of operands, an invocation for each of the two slots.
#extension GL_GOOGLE_include_directive : require
#define HNBRDF_PRECISE precise
#include "probe.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Operands { vec4 operands[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Results { vec4 results[]; };
layout(push_constant) uniform Push { uint count; };

void main()
{
    uint k = gl_GlobalInvocationID.x, slot = gl_GlobalInvocationID.y;
    if (k >= count)
        return;
    results[2 * k + slot] = hnbrdf_probe(operands[k], int(slot));
}
