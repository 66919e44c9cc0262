#!/bin/sh
# test_language.sh SCENES LANGUAGE: what is exported in LANGUAGE compiles: every scene standalone, and each third of them
# also exact or as a text beside the shared part. SCENES writes the scenes (glsl_scenes.c). With glslang: hlsl.
# With a C++ compiler, which is not Apple's: msl. wgsl: its names alone; test_web_* has its compilers.
set -eu
scenes=$1 language=$2
need() { command -v "$1" > /dev/null || { echo "skipped: no $1"; exit 77; }; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
run() { "$@" > "$work/messages" 2>&1 || { echo "failed: $*"; cat "$work/messages"; exit 1; }; }
has() { grep -q " $2(" "$work/$1"; } # does this text define that function?

# FILE: the calls of all that a text has, as statements that add to `colour`.
calls() {
    has "$1" hnbrdf_eval_analytic && echo '    colour.rgb += hnbrdf_eval_analytic(m, wi, wo);'
    has "$1" hnbrdf_sample && echo '    colour.rgb += hnbrdf_sample(m, wo, wi.xy).weight * hnbrdf_pdf(m, wi, wo);'
    has "$1" hnbrdf_eval_GOLD_PAINT && echo '    colour.rgb += hnbrdf_eval_GOLD_PAINT(wi, wo);'
    if has "$1" hnbrdf_material_unpack; then
        texels=$(sed -n 's/^#define HNBRDF_TEXELS //p' "$work/$1") list=wi.xyzx
        while [ "$texels" -gt 1 ]; do
            list="$list, wo.zyxz" texels=$((texels - 1))
        done
        echo "    colour.rgb += hnbrdf_eval(hnbrdf_material_unpack($list), wi, wo);"
    fi
    return 0
}

hlsl() { # FILE...: a pixel shader of these texts, the last of which has the scene
    for last; do :; done
    for file; do cat "$work/$file"; done > "$work/main.hlsl"
    {
        echo 'float4 main(float3 wi : TEXCOORD0, float3 wo : TEXCOORD1) : SV_Target'
        echo '{'
        echo '    hnbrdf_material m = hnbrdf_scene_material(HNBRDF_MATERIAL_GOLD_PAINT);'
        echo '    float4 colour = float4(hnbrdf_eval(m, wi, wo), 1.0f);'
        calls "$last"
        echo '    return colour;'
        echo '}'
    } >> "$work/main.hlsl"
    run glslangValidator -D -V -S frag -e main "$work/main.hlsl" -o "$work/main.spv"
}

msl() { # FILE...: a function of these texts, as C++ beside msl/metal_stdlib
    for last; do :; done
    for file; do cat "$work/$file"; done > "$work/main.cc"
    {
        weights='' parameter=''
        if grep -q '^inline float3 hnbrdf_eval(.*hnbrdf_weights' "$work/$last"; then
            weights=', hnbrdf_weights' parameter=', constant float4 *hnbrdf_weights'
        fi
        echo '#define rgb xyz'
        echo "float3 shade(float3 wi, float3 wo$parameter)"
        echo '{'
        echo '    hnbrdf_material m = hnbrdf_scene_material(HNBRDF_MATERIAL_GOLD_PAINT);'
        echo "    float3 sum = hnbrdf_eval(m, wi, wo$weights);"
        calls "$last" | sed "s/colour\.rgb/sum/; s/\(hnbrdf_eval[A-Z_]*(.*wi, wo\))/\1$weights)/; s/wi\.xy)\.weight/wi.xy$weights).weight/"
        echo '    return sum;'
        echo '}'
    } >> "$work/main.cc"
    run "$compiler" -std=c++14 -fsyntax-only -Wall -Wno-unknown-pragmas -I"$here/msl" "$work/main.cc"
}

wgsl() { # FILE...: what is called is there once, whatever was exported together; nothing of GLSL is left
    for file; do cat "$work/$file"; done | sed 's,//.*,,' > "$work/main.wgsl"
    grep -oE '^(fn|struct|const) [A-Za-z_0-9]+' "$work/main.wgsl" | sed 's/^[a-z]* //' | sort > "$work/defined"
    [ -z "$(uniq -d "$work/defined")" ] || { echo "failed: twice in $*:" $(uniq -d "$work/defined"); exit 1; }
    grep -oE '(hnbrdf|HNBRDF)_[A-Za-z_0-9]+' "$work/main.wgsl" | sort -u > "$work/used"
    grep -oE '^@group.*var<uniform> [A-Za-z_0-9]+' "$work/main.wgsl" | sed 's/.* //' | sort -u - "$work/defined" > "$work/known"
    missing=$(comm -23 "$work/used" "$work/known")
    [ -z "$missing" ] || { echo "failed: not there in $*:" $missing; exit 1; }
    ! grep -nE '\?|#|precise|\<(in|out|inout|float|int|vec[234])\>' "$work/main.wgsl" || { echo "failed: GLSL in $*"; exit 1; }
}

here=$(cd "$(dirname "$0")" && pwd) compiler=''
case $language in
hlsl) need glslangValidator ;;
msl)
    for compiler in clang++ clang++-14 g++; do
        command -v $compiler > /dev/null && break
        compiler=''
    done
    [ "$compiler" ] || { echo 'skipped: no C++ compiler'; exit 77; }
    ;;
esac
"$scenes" "$work" "$language" > "$work/names"
number=0
while read -r scene; do
    "$language" "$scene.alone.$language"
    case $((number % 3)) in
    0) "$language" "$scene.exact.$language" ;;
    1) "$language" "hybrid_brdf.$language" "$scene.$language" ;;
    esac
    echo "ok: $scene"
    number=$((number + 1))
done < "$work/names"
