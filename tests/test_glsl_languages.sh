#!/bin/sh
# test_glsl_languages.sh SCENES SHADERS [directx|metal]: exported text compiles as Vulkan GLSL 450, desktop
# GLSL 330 and GLSL ES 300, in both builds; with a third argument, through SPIRV-Cross to HLSL or MSL.
set -eu
scenes=$1 shaders=$2 target=${3-}
need() { command -v "$1" >/dev/null || { echo "skipped: no $1"; exit 77; }; }
need glslangValidator
[ -z "$target" ] || need spirv-cross
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$scenes" "$work" >"$work/names"

run() { "$@" >"$work/messages" 2>&1 || { echo "failed: $*"; cat "$work/messages"; exit 1; }; }

# Does the scene define this function?
has() { grep -q "^[a-z_0-9]* $2(" "$work/$1.glsl"; }

# A fragment shader with the standalone text pasted behind #version, as a user would.
fragment() { # version scene exact output
    {
        echo "#version $1"
        echo "#define HNBRDF_EXACT $3"
        cat "$work/$2.alone.glsl"
        if [ "$1" = 450 ]; then
            echo 'layout(location = 0) in vec3 wi; layout(location = 1) in vec3 wo; layout(location = 0) out vec4 colour;'
        else
            echo 'in vec3 wi; in vec3 wo; out vec4 colour;'
        fi
        echo 'void main() {'
        echo '    hnbrdf_material m = hnbrdf_scene_material(HNBRDF_MATERIAL_GOLD_PAINT);'
        echo '    colour = vec4(hnbrdf_eval(m, wi, wo), 1.0);'
        # What the scene has besides evaluation.
        has "$2" hnbrdf_eval_analytic && echo '    colour.rgb += hnbrdf_eval_analytic(m, wi, wo);'
        has "$2" hnbrdf_sample && echo '    colour.rgb += hnbrdf_sample(m, wo, wi.xy).weight * hnbrdf_pdf(m, wi, wo);'
        has "$2" hnbrdf_eval_GOLD_PAINT && echo '    colour.rgb += hnbrdf_eval_GOLD_PAINT(wi, wo);'
        if has "$2" hnbrdf_material_unpack; then
            texels=$(sed -n 's/^#define HNBRDF_TEXELS //p' "$work/$2.glsl") list=wi.xyzx
            while [ "$texels" -gt 1 ]; do
                list="$list, wo.zyxz" texels=$((texels - 1))
            done
            echo "    colour.rgb += hnbrdf_eval(hnbrdf_material_unpack($list), wi, wo);"
        fi
        echo '}'
    } >"$4"
}

while read -r scene; do
    for exact in 0 1; do
        if [ -z "$target" ]; then
            fragment 450 "$scene" $exact "$work/a.frag"
            run glslangValidator -V "$work/a.frag" -o "$work/a.spv"
            for version in 330 '300 es'; do
                fragment "$version" "$scene" $exact "$work/b.frag"
                run glslangValidator "$work/b.frag"
            done
        else
            cp "$work/$scene.alone.glsl" "$work/scene.glsl"
            stages=frag
            if has "$scene" hnbrdf_eval_analytic; then # which verify.comp calls
                stages='frag comp'
                run glslangValidator -V -DHNBRDF_EXACT=$exact -I"$shaders" -I"$work" "$shaders/verify.comp" -o "$work/c.spv"
            fi
            fragment 450 "$scene" $exact "$work/a.frag"
            run glslangValidator -V "$work/a.frag" -o "$work/a.spv"
            for stage in $stages; do
                [ $stage = frag ] && spv=$work/a.spv || spv=$work/c.spv
                if [ "$target" = directx ]; then # and what comes out is HLSL that compiles
                    run spirv-cross "$spv" --hlsl --shader-model 60 --output "$work/out.hlsl"
                    run glslangValidator -D -V -S $stage -e main "$work/out.hlsl" -o "$work/d.spv"
                else
                    run spirv-cross "$spv" --msl --msl-version 20100 --output "$work/out.metal"
                fi
            done
        fi
    done
    echo "ok: $scene"
done <"$work/names"
