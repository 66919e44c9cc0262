// unreal.hlsl: the text of a Custom node of an Unreal material (output type: CMOT Float 3).
// Not run in the engine: compiled by DXC, FXC and glslang, inside a function like the one that the engine makes.
//
//   hnbrdf export MODEL --materials NAME --only eval --language hlsl --standalone -o hnbrdf_scene.ush
//
// Put that file into the folder Shaders of a project or plugin that maps it (AddShaderSourceDirectoryMapping), and
// name it in the node: Include File Paths, "/Project/hnbrdf_scene.ush". Inputs of the node: Normal
// (PixelNormalWS), View (CameraVectorWS), ToLight (of length 1, towards the light) and Irradiance, all in world space.
// Connect the output to Emissive Color of an unlit material: the lights of the deferred renderer do not reach a node.
float3 n = normalize(Normal);
float3 t = normalize(cross(abs(n.y) < 0.9 ? float3(0, 1, 0) : float3(1, 0, 0), n));
float3 b = cross(n, t);
float3 wi = float3(dot(ToLight, t), dot(ToLight, b), dot(ToLight, n));
float3 wo = float3(dot(View, t), dot(View, b), dot(View, n));
hnbrdf_material m = hnbrdf_scene_material(0);
return hnbrdf_eval(m, wi, wo) * Irradiance * max(wi.z, 0.0);
