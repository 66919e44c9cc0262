#version 450
#extension GL_GOOGLE_include_directive : require
// verify.comp: runs one stage of an exported scene over a buffer of direction pairs, for comparison with C.
#define HNBRDF_WEIGHTS_BINDING 3
#include "hybrid_brdf.glsl"
#include "scene.glsl"

const int STAGE_ENCODING = 0; // 6 numbers a pair
const int STAGE_NETWORK = 1;  // 6 numbers a pair, from inputs that C encoded
const int STAGE_ANALYTIC = 2; // 3 numbers a pair
const int STAGE_VALUE = 3;    // 3 numbers a pair
const int STAGE_COPY = 4;     // reads and writes as STAGE_VALUE does and nothing else: what buffers cost

layout(constant_id = 0) const int STAGE = STAGE_VALUE;
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Directions { float directions[]; }; // wi, wo
layout(std430, set = 0, binding = 1) readonly buffer Encoded { float encoded[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Values { float values[]; };
layout(push_constant) uniform Push { uint count; int material; };

void store3(uint at, vec3 v)
{
    values[at] = v.x;
    values[at + 1] = v.y;
    values[at + 2] = v.z;
}

void main()
{
    uint k = gl_GlobalInvocationID.x;
    if (k >= count)
        return;
    uint at = 6 * k;
    vec3 wi = vec3(directions[at], directions[at + 1], directions[at + 2]);
    vec3 wo = vec3(directions[at + 3], directions[at + 4], directions[at + 5]);
    hnbrdf_material m = hnbrdf_scene_material(material);
    if (STAGE == STAGE_VALUE)
        store3(3 * k, hnbrdf_eval(m, wi, wo));
    else if (STAGE == STAGE_COPY)
        store3(3 * k, wi + wo);
    else if (STAGE == STAGE_ANALYTIC)
        store3(3 * k, hnbrdf_eval_analytic(m, wi, wo));
#ifndef HNBRDF_SCENE_GGX
    else if (STAGE == STAGE_ENCODING) {
        vec3 x0, x1;
        hnbrdf_pair p = hnbrdf_scene_pair(m, wi, wo);
#ifdef HNBRDF_SCENE_EDITED
        hnbrdf_edit edit = hnbrdf_scene_edit(m);
        p = hnbrdf_scene_seen(edit, p, hnbrdf_scene_specular(m, p));
#endif
        HNBRDF_SCENE_ENCODE(p, x0, x1);
        store3(at, x0);
        store3(at + 3, x1);
    } else {
        vec3 x0 = vec3(encoded[at], encoded[at + 1], encoded[at + 2]);
        vec3 x1 = vec3(encoded[at + 3], encoded[at + 4], encoded[at + 5]);
        vec3 c, g = vec3(0.0);
#ifdef HNBRDF_SCENE_HYBRID
        hnbrdf_network(m, x0, x1, c, g);
#else
        hnbrdf_network(m, x0, x1, c);
#endif
        store3(at, c);
        store3(at + 3, g);
    }
#endif
}
