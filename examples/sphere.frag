// sphere.frag: a sphere of one exported material under one light, in a single fragment shader.
//
//   build/hnbrdf export examples/models/rgl_32x2.safetensors --materials vch_silk_blue -o scene.glsl
//   glslangValidator -V -Ishaders -I. examples/sphere.frag -o sphere.spv
//
// Draw one triangle that covers the screen; uv runs over the picture from -1 to 1, y up.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "hybrid_brdf.glsl"
#include "scene.glsl"

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 colour;

const vec3 to_light = vec3(0.4364358, 0.5345225, 0.7237469);
const vec3 light = vec3(3.0); // irradiance on a surface that faces the light, W/m^2
const vec3 to_viewer = vec3(0.0, 0.0, 1.0);

void main()
{
    float r2 = dot(uv, uv);
    if (r2 >= 1.0)
        discard;
    vec3 n = vec3(uv, sqrt(1.0 - r2));
    vec3 tangent = vec3(n.z, 0.0, -n.x); // along the circles of latitude, of any length
    hnbrdf_material material = hnbrdf_scene_material(0);
    vec3 f = hnbrdf_eval_world(material, n, tangent, to_light, to_viewer);
    vec3 radiance = f * light * max(dot(n, to_light), 0.0); // f comes without the cosine
    colour = vec4(pow(clamp(radiance, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
}
