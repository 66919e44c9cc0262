#version 450
// verify.comp: shaders/parity.glsl over a buffer of rows, an invocation for every slot of every row.
#extension GL_GOOGLE_include_directive : require
#define HNBRDF_WEIGHTS_BINDING 2
#include "scene.glsl"
#include "parity.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Rows { vec4 rows[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Outputs { vec4 outputs[]; };
layout(push_constant) uniform Push { uint count; };

void main()
{
    uint k = gl_GlobalInvocationID.x, slot = gl_GlobalInvocationID.y;
    if (k >= count)
        return;
    outputs[8 * k + slot] =
        hnbrdf_parity(rows[4 * k], rows[4 * k + 1], rows[4 * k + 2], rows[4 * k + 3], int(slot));
}
