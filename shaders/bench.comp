#version 450
#extension GL_GOOGLE_include_directive : require
// bench.comp: what `hnbrdf bench` times: one kind of work for every pair of directions in a buffer.
#define WORK_VALUE 0   // the whole BRDF
#define WORK_NETWORK 1 // the network alone, above the horizon as in hnbrdf_eval(); the directions are its inputs
#define WORK_COPY 2    // neither: what reading and writing the buffers costs
#ifndef WORK
#define WORK WORK_VALUE
#endif
#define HNBRDF_WEIGHTS_BINDING 2
#include "scene.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Directions { float directions[]; }; // wi, wo
layout(std430, set = 0, binding = 1) writeonly buffer Values { float values[]; };
layout(push_constant) uniform Push { uint count; int material; };

void main()
{
    uint k = gl_GlobalInvocationID.x;
    if (k >= count)
        return;
    uint at = 6 * k;
    vec3 wi = vec3(directions[at], directions[at + 1], directions[at + 2]);
    vec3 wo = vec3(directions[at + 3], directions[at + 4], directions[at + 5]);
#if WORK == WORK_VALUE
    vec3 f = hnbrdf_eval(hnbrdf_scene_material(material), wi, wo);
#elif WORK == WORK_NETWORK
    vec3 f = vec3(0.0);
    if (wi.z > 0.0 && wo.z > 0.0) {
#ifdef HNBRDF_SCENE_HYBRID
        vec3 c, g;
        hnbrdf_network(hnbrdf_scene_material(material), wi, wo, c, g);
        f = c + g;
#else
        hnbrdf_network(hnbrdf_scene_material(material), wi, wo, f);
#endif
    }
#else
    vec3 f = wi + wo;
#endif
    values[3 * k] = f.x;
    values[3 * k + 1] = f.y;
    values[3 * k + 2] = f.z;
}
