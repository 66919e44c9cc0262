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
float3 t = float3(0, 0, 0); // no tangent: any does for a material that is isotropic
float3 f = hnbrdf_eval_world(hnbrdf_scene_material(0), n, t, ToLight, View);
return f * Irradiance * max(dot(n, ToLight), 0.0);
