#!/bin/sh
# engine_texts.sh SOURCE SCENE.hlsl SCENE.glsl FOLDER: what the compilers here take of the examples for engines, into
# FOLDER: unity.hlsl and unreal.hlsl with entry point main, godot.frag. In front stands, as far as they use it, what the
# engines declare: the test is of our texts and not of theirs.
set -eu
source=$1 hlsl=$2 glsl=$3 folder=$4

{
    cat << 'H'
#define PI 3.14159265
cbuffer engine { float4x4 object, camera_clip; float4 camera; };
struct Light { float3 direction, color; float distanceAttenuation, shadowAttenuation; };
cbuffer engine_lights { float4 lights[8][3]; int light_count; };
float3 TransformObjectToWorld(float3 p) { return mul(object, float4(p, 1)).xyz; }
float3 TransformObjectToWorldNormal(float3 n) { return normalize(mul((float3x3)object, n)); }
float4 TransformWorldToHClip(float3 p) { return mul(camera_clip, float4(p, 1)); }
float3 GetWorldSpaceNormalizeViewDir(float3 p) { return normalize(camera.xyz - p); }
Light light_of(uint i)
{
    Light l;
    l.direction = lights[i][0].xyz;
    l.color = lights[i][1].xyz;
    l.distanceAttenuation = lights[i][2].x;
    l.shadowAttenuation = lights[i][2].y;
    return l;
}
Light GetMainLight() { return light_of(0); }
int GetAdditionalLightsCount() { return light_count; }
Light GetAdditionalLight(uint i, float3 p) { return light_of(i + 1); }
#define _ADDITIONAL_LIGHTS
H
    # Between the two words, the include of the scene and the name of the stage that is compiled.
    sed -n '/^ *HLSLPROGRAM/,/^ *ENDHLSL/p' "$source/examples/engines/unity.shader" |
        sed "/HLSLPROGRAM\|ENDHLSL\|#pragma\|com\.unity/d; s/\bfragment(/main(/" |
        sed "/#include \"hnbrdf_scene.hlsl\"/{r $hlsl
d
}"
} > "$folder/unity.hlsl"

{
    cat "$hlsl"
    echo 'float3 CustomExpression0(float3 Normal, float3 View, float3 ToLight, float3 Irradiance)'
    echo '{'
    cat "$source/examples/engines/unreal.hlsl"
    echo '}'
    echo 'float4 main(float3 n : TEXCOORD0, float3 v : TEXCOORD1, float3 l : TEXCOORD2) : SV_Target'
    echo '{'
    echo '    return float4(CustomExpression0(n, v, l, float3(3, 3, 3)), 1);'
    echo '}'
} > "$folder/unreal.hlsl"

{
    echo '#version 450'
    place=0
    for name in 'vec3 NORMAL' 'vec3 LIGHT' 'vec3 VIEW' 'vec3 LIGHT_COLOR' 'float ATTENUATION'; do
        echo "layout(location = $place) in $name;"
        place=$((place + 1))
    done
    echo 'layout(location = 0) out vec3 SPECULAR_LIGHT;'
    sed '/^shader_type\|^render_mode/d' "$source/examples/engines/godot.gdshader" |
        sed "/#include \"hnbrdf_scene.gdshaderinc\"/{r $glsl
d
}"
    echo 'void main() { SPECULAR_LIGHT = vec3(0.0); light(); }'
} > "$folder/godot.frag"
