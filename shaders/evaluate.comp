#version 450
#extension GL_GOOGLE_include_directive : require
// evaluate.comp: an exported scene's functions for any material and pair of directions, one of each an invocation.
#define HNBRDF_WEIGHTS_BINDING 2
#include "hybrid_brdf.glsl"
#include "scene.glsl"

layout(constant_id = 0) const int STAGE = 3; // 2: the analytic part, else the value, as in verify.comp
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Inputs { float inputs[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Values { float values[]; };
layout(push_constant) uniform Push { uint count; };

vec3 read3(uint at)
{
    return vec3(inputs[at], inputs[at + 1], inputs[at + 2]);
}

vec4 read4(uint at)
{
    return vec4(inputs[at], inputs[at + 1], inputs[at + 2], inputs[at + 3]);
}

// hnbrdf_material read_material(uint at): wi, wo, kd, eta, alpha, cosine and sine, latent are 32 numbers.
#include "material.glsl"

void main()
{
    uint k = gl_GlobalInvocationID.x;
    if (k >= count)
        return;
    uint at = 32 * k;
    hnbrdf_material m = read_material(at);
    vec3 wi = read3(at), wo = read3(at + 3);
    vec3 f = STAGE == 2 ? hnbrdf_eval_analytic(m, wi, wo) : hnbrdf_eval(m, wi, wo);
    values[3 * k] = f.x;
    values[3 * k + 1] = f.y;
    values[3 * k + 2] = f.z;
}
