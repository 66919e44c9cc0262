#!/bin/sh
# test_glsl_languages.sh SCENES SHADERS SOURCES [directx|metal]: exported text compiles as Vulkan GLSL 450, desktop
# GLSL 330 and GLSL ES 300, its exact build also as 400 and ES 320, in a program whose macros have the names of plain
# words; with a fourth argument, through SPIRV-Cross to HLSL or MSL. Also what compilers refuse that are not here.
set -eu
scenes=$1 shaders=$2 sources=$3 target=${4-}
need() { command -v "$1" >/dev/null || { echo "skipped: no $1"; exit 77; }; }
need glslangValidator
[ -z "$target" ] || need spirv-cross
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$scenes" "$work" >"$work/names"

run() { "$@" >"$work/messages" 2>&1 || { echo "failed: $*"; cat "$work/messages"; exit 1; }; }
fail() { echo "failed: $*"; exit 1; }

# Does the scene define this function?
has() { grep -q "^[a-z_0-9]* $2(" "$work/$1.glsl"; }

# The program around the text: macros that break every line they stand in, one for each plain word of the C sources
# and of the texts' own comments (where the same things have plain names), for what engines are known to define, and
# for every letter that GLSL does not use itself as a component.
reserved='float int bool void vec[234] vec if else for return const struct in out inout uniform layout std140 set binding
location version extension require include ifdef ifndef endif define defined error precision precise highp mediump lowp
true false exp log min max clamp sqrt abs floor main colour GL VULKAN HNBRDF hnbrdf
kd eta alpha rotation wi wo pdf weight latent [0-9]* [xyzw]* [rgba]* [stpq]*'
{
    cat "$sources"/core/*.[ch] "$shaders"/*.glsl "$work"/*.alone.glsl | grep -oE '\b[A-Za-z][A-Za-z0-9]*\b'
    printf '%s\n' PI near far saturate lerp lerp3 sqr min3 material light share a0 b0 t0 s0 x0 u0
    printf '%s\n' c d e f h i j k l m n o u v A B C D E F G H I J K L M N O P Q R S T U V W X Y Z
} | sort -u | grep -vxE "$(echo "$reserved" | tr ' \n' '||')" >"$work/words"
grep -vxE 'latent[0-9]+|[a-z0-9]*vec[234]|intBitsToFloat|floatBitsToInt' "$work/words" |
    sed 's/.*/#define & ][/' >"$work/hostile"
for word in c low swap first rest share; do
    grep -qx "#define $word \]\[" "$work/hostile" || fail "$word is not among the hostile macros"
done

# A fragment shader with the standalone text pasted behind #version, as a user would.
fragment() { # version scene exact output
    {
        echo "#version $1"
        echo "#define HNBRDF_EXACT $3"
        cat "$work/hostile" "$work/$2.alone.glsl"
        sed 's/^#define \([^ ]*\).*/#undef \1/' "$work/hostile"
        if [ "$1" = 450 ]; then
            echo 'layout(location = 0) in vec3 wi; layout(location = 1) in vec3 wo; layout(location = 0) out vec4 colour;'
        else
            echo 'in vec3 wi; in vec3 wo; in hnbrdf_material varying_m; out vec4 colour;'
        fi
        echo 'void main() {'
        echo '    hnbrdf_material m = hnbrdf_scene_material(HNBRDF_MATERIAL_GOLD_PAINT);'
        echo '    colour = vec4(hnbrdf_eval(m, wi, wo), 1.0);'
        [ "$1" = 450 ] || echo '    colour.rgb += hnbrdf_eval(varying_m, wi, wo);'
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

# What compilers refuse that Debian does not have: engines that split lines at semicolons, also in comments, and take
# #if NAME for #ifdef NAME; that stop at quotes in #error; that print a number with fewer digits and find it too large;
# and a qualifier on the type that a function returns, which Mesa refuses.
refused() { # text
    ! grep -n '//.*;' "$1" || fail "$1: a semicolon in a comment"
    ! grep -nE '^ *#error.*["'\'']' "$1" || fail "$1: a quote in #error"
    ! grep -nE '^ *#(if|elif) !?[A-Za-z_0-9]+ *(&&|\|\||$)' "$1" || fail "$1: #if without a comparison"
    ! grep -nE '^(HNBRDF_PRECISE|precise) [A-Za-z_0-9]+ [A-Za-z_0-9]+\(' "$1" || fail "$1: a qualified function"
    sed 's,//.*,,' "$1" | grep -oE '[0-9.]+e\+?(3[89]|[4-9][0-9])' | while read -r number; do
        [ "$number" = 3.402823e38 ] || [ "$number" = 3.0e38 ] || fail "$1: $number may print as an infinity"
    done
}

# In the exact build every + - * / has to be what it says, outside of main().
contracted() { # spirv
    spirv-dis "$1" | awk '
        /OpDecorate .* NoContraction/ { exact[$2] = 1 }
        /OpName .* "main"/ { main = $2 }
        / = OpFunction / { inside = $1 != main }
        inside && / = Op(FAdd|FSub|FMul|FDiv|FNegate|Dot|VectorTimesScalar) / && !($1 in exact) { print; found = 1 }
        END { exit !found }'
}

while read -r scene; do
    refused "$work/$scene.glsl"
    refused "$work/$scene.alone.glsl"
    for exact in 0 1; do
        if [ -z "$target" ]; then
            fragment 450 "$scene" $exact "$work/a.frag"
            run glslangValidator -V "$work/a.frag" -o "$work/a.spv"
            if [ $exact = 1 ] && command -v spirv-dis >/dev/null; then
                ! contracted "$work/a.spv" || fail "$scene: operations that may be contracted"
            fi
            [ $exact = 1 ] && versions='330 400 320_es' || versions='330 300_es'
            for version in $versions; do
                fragment "$(echo $version | tr _ ' ')" "$scene" $exact "$work/b.frag"
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
