// unity.shader: one material in Unity's Universal Render Pipeline, lit by the main light and additional lights.
// Not run in the engine: compiled by DXC, FXC and glslang, with a stand-in for URP's headers.
//
//   hnbrdf export MODEL --materials NAME --only eval --language hlsl --standalone -o hnbrdf_scene.hlsl
//
// Put both files into one folder of Assets.
Shader "hnbrdf/Measured"
{
    SubShader
    {
        Tags { "RenderType" = "Opaque" "RenderPipeline" = "UniversalPipeline" }
        Pass
        {
            Tags { "LightMode" = "UniversalForward" }
            HLSLPROGRAM
            #pragma target 4.5
            #pragma vertex vertex
            #pragma fragment fragment
            #pragma multi_compile _ _ADDITIONAL_LIGHTS
            #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Core.hlsl"
            #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Lighting.hlsl"
            #include "hnbrdf_scene.hlsl"

            struct Corner
            {
                float4 positionOS : POSITION;
                float3 normalOS : NORMAL;
            };

            struct Varying
            {
                float4 positionCS : SV_POSITION;
                float3 positionWS : TEXCOORD0;
                float3 normalWS : TEXCOORD1;
            };

            Varying vertex(Corner corner)
            {
                Varying result;
                result.positionWS = TransformObjectToWorld(corner.positionOS.xyz);
                result.normalWS = TransformObjectToWorldNormal(corner.normalOS);
                result.positionCS = TransformWorldToHClip(result.positionWS);
                return result;
            }

            // Lights of URP are scaled so that a white surface which faces a light of intensity 1 has the value 1: the
            // irradiance is pi times their colour.
            // No tangent: any does for a material that is isotropic.
            float3 reflected(hnbrdf_material m, float3 n, float3 toViewer, Light light)
            {
                float3 irradiance = PI * light.color * (light.distanceAttenuation * light.shadowAttenuation);
                float3 f = hnbrdf_eval_world(m, n, float3(0, 0, 0), light.direction, toViewer);
                return f * irradiance * max(dot(n, light.direction), 0.0);
            }

            float4 fragment(Varying varying) : SV_Target
            {
                float3 n = normalize(varying.normalWS);
                float3 toViewer = GetWorldSpaceNormalizeViewDir(varying.positionWS);
                hnbrdf_material m = hnbrdf_scene_material(0);
                float3 radiance = reflected(m, n, toViewer, GetMainLight());
                #ifdef _ADDITIONAL_LIGHTS
                for (uint i = 0u; i < uint(GetAdditionalLightsCount()); i++)
                    radiance += reflected(m, n, toViewer, GetAdditionalLight(i, varying.positionWS));
                #endif
                return float4(radiance, 1.0);
            }
            ENDHLSL
        }
    }
}
