#version 450
#extension GL_GOOGLE_include_directive : require
// evaluate.comp: an exported scene's functions for any material and pair of directions, one of each an invocation.
#define HNBRDF_WEIGHTS_BINDING 2
#include "hybrid_brdf.glsl"
#include "scene.glsl"

layout(constant_id = 0) const int WHAT = 1; // 0: the analytic part, 1: the value, 2: the density, 3: a sample
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

// hnbrdf_material read_material(uint at): wi, wo, kd, eta, alpha, cosine and sine, latent, lobes, then u, then what it
// was fitted with, then its energy: 56 numbers.
#include "material.glsl"

void main()
{
    uint k = gl_GlobalInvocationID.x;
    if (k >= count)
        return;
    uint at = 56 * k, to = 8 * k;
    hnbrdf_material m = read_material(at);
    vec3 wi = read3(at), wo = read3(at + 3), f = vec3(0.0);
    if (WHAT == 0)
        f = hnbrdf_eval_analytic(m, wi, wo);
    else if (WHAT == 1)
        f = hnbrdf_eval(m, wi, wo);
    else if (WHAT == 2)
        f.x = hnbrdf_pdf(m, wi, wo);
    else {
        hnbrdf_sample_result s = hnbrdf_sample(m, wo, vec2(inputs[at + 42], inputs[at + 43]));
        f = s.wi;
        values[to + 3] = s.weight.x;
        values[to + 4] = s.weight.y;
        values[to + 5] = s.weight.z;
        values[to + 6] = s.pdf;
        values[to + 7] = hnbrdf_pdf(m, s.wi, wo);
    }
    values[to] = f.x;
    values[to + 1] = f.y;
    values[to + 2] = f.z;
}
