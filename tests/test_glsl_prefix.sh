#!/bin/sh
# test_glsl_prefix.sh HNBRDF SCENES SHADERS: exported texts with a prefix stand in one shader in every way: included,
# standalone, stripped; what cannot work is an error that says what to do.
set -eu
hnbrdf=$1 scenes=$2 shaders=$3
command -v glslangValidator >/dev/null || { echo "skipped: no glslangValidator"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$scenes" . >/dev/null
fail() { echo "failed: $*"; cat messages 2>/dev/null; exit 1; }
export_text() { text=$1; shift; "$hnbrdf" export "$@" -o "$text" >messages 2>&1 || fail "export $*"; }

shader() { # version, texts: one after the other, and a call of each
    echo "#version $1"; shift
    cat "$@"
    echo 'in vec3 wi; in vec3 wo; out vec4 colour; void main() { colour = vec4(0.0);'
    cat "$@" | sed -n 's/^vec3 \([A-Za-z]*\)_eval(.*/colour.rgb += \1_eval(\1_scene_material(0), wi, wo);/p' | sort -u
    echo '}'
}
works() {
    for version in 330 '300 es'; do
        shader "$version" "$@" >t.frag
        glslangValidator t.frag >messages 2>&1 || fail "$version: $*"
    done
}
refused() { # with these words: texts
    words=$1; shift
    shader 330 "$@" >t.frag
    ! glslangValidator t.frag >messages 2>&1 || fail "compiles: $*"
    grep -q "$words" messages || fail "does not say '$words': $*"
}

# Of different kinds, and none of them has all parts of hybrid_brdf.glsl.
export_text gold.glsl hybrid_8x4_rotated.safetensors --standalone --prefix gold
export_text silk.glsl neural_16x3_directions.safetensors --standalone --only eval --weights uniform --prefix silk
export_text mint.glsl edited_fixed.safetensors --standalone --fixed --strip-comments --prefix mint
export_text half.glsl half.safetensors --standalone --precision half --weights columns --prefix half
export_text hnbrdf.glsl ggx_rotated.safetensors --standalone --only eval --prefix hnbrdf
works gold.glsl silk.glsl mint.glsl half.glsl hnbrdf.glsl
works hnbrdf.glsl half.glsl mint.glsl silk.glsl gold.glsl
works silk.glsl silk.glsl
export_text whole.glsl --library
works whole.glsl mint.glsl silk.glsl

# Each function of the library once, whoever brings it.
shader 330 gold.glsl mint.glsl hnbrdf.glsl | grep -v '^#include' >t.frag
glslangValidator -E t.frag >preprocessed 2>&1 || fail "does not preprocess"
[ "$(grep -c 'hnbrdf_pair hnbrdf_pair_make(' preprocessed)" = 1 ] || fail "hnbrdf_pair_make is there twice"
[ "$(grep -c '^vec3 [a-z]*_eval(' preprocessed)" = 3 ] || fail "not three hnbrdf_eval"

# Errors that say what to do.
export_text plain.glsl hybrid_8x4_rotated.safetensors --standalone
export_text plain2.glsl hybrid_32x2.safetensors
refused 'without a prefix came before this one' plain.glsl gold.glsl
refused 'a standalone text came before' gold.glsl whole.glsl
refused 'two exported texts with the same names' plain.glsl plain2.glsl
refused 'include hybrid_brdf' plain2.glsl
export_text other.glsl hybrid_32x2.safetensors --standalone --prefix gold
refused 'two exported texts with the same names' gold.glsl other.glsl

# Bindings and blocks carry the name, in Vulkan too.
export_text a.glsl uniform.safetensors --weights uniform --prefix a
export_text b.glsl uniform.safetensors --weights uniform --prefix b
{
    printf '#version 450\n#define A_WEIGHTS_BINDING 3\n#define B_WEIGHTS_SET 1\n'
    cat "$shaders/hybrid_brdf.glsl" a.glsl b.glsl
    echo 'layout(location = 0) out vec4 colour; void main() { vec3 w = vec3(0.0, 0.0, 1.0);'
    echo 'colour = vec4(a_eval(a_scene_material(0), w, w) + b_eval(b_scene_material(0), w, w), 1.0); }'
} >t.frag
glslangValidator -V -H t.frag -o t.spv >messages 2>&1 || fail "two uniform blocks"
grep -q 'Binding 3' messages && grep -q 'DescriptorSet 1' messages || fail "bindings of two blocks"
grep -q 'a_weights_block' messages && grep -q 'b_weights_block' messages || fail "names of two blocks"
rc=0
"$hnbrdf" export ggx.safetensors --prefix gl_x -o x.glsl 2>messages || rc=$?
[ $rc = 1 ] && grep -q 'the prefix is "gl_x"' messages && [ ! -e x.glsl ] || fail "a prefix that is refused"
echo ok
