#!/bin/sh
# test_physics_cli.sh HNBRDF MODEL SHADERS: energy as `info` tells it, `export --conserve` corrects it and a furnace
# shows it. MODEL holds paper_white, above 1, and vch_silk_blue, below.
set -eu
hnbrdf=$1 model=$2 shaders=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "failed: $*"; exit 1; }
"$hnbrdf" info "$model" >"$work/info"
grep -q '^paper_white .*ABOVE 1' "$work/info" || fail "energy above 1 is not told"
grep -q '^vch_silk_blue .*kept' "$work/info" || fail "energy below 1 is not told"
"$hnbrdf" info "$model" --json | grep -q '"conserves_energy": false' || fail "json"
# Without: the same but for what is measured.
"$hnbrdf" info "$model" --without-physics >"$work/short"
lines=$(wc -l <"$work/short")
head -n "$lines" "$work/info" | cmp -s - "$work/short" || fail "--without-physics tells something else"
grep -q albedo "$work/short" && fail "--without-physics measures"
"$hnbrdf" info "$model" --without-physics --json | grep -q albedo && fail "--without-physics --json measures"

"$hnbrdf" export "$model" --conserve --materials paper_white,vch_silk_blue -o "$work/scene.glsl" >"$work/out"
grep -q '^paper_white: albedo 1' "$work/out" || fail "the scaled material is not told"
grep -q '^vch_silk_blue' "$work/out" && fail "a material that needs no factor is told"
factor=$(sed -n 's/^paper_white:.*times \([0-9.]*\)$/\1/p' "$work/out")
grep -q "return hnbrdf_material(.*, $(echo "$factor" | cut -c 1-5)[0-9]*);" "$work/scene.glsl" || fail "the factor $factor"
[ "$(grep -c 'energy_factor \*' "$work/scene.glsl")" = 2 ] || fail "value and analytic part are scaled"
"$hnbrdf" export "$model" --materials paper_white -o "$work/plain.glsl" >/dev/null
grep -q energy "$work/plain.glsl" && fail "a factor that nobody asked for"
"$hnbrdf" export "$model" --conserve --pack half -o "$work/x.glsl" >/dev/null 2>&1 && fail "--pack with --conserve"
if command -v glslangValidator >/dev/null; then
    printf '%s\n' '#version 450' '#extension GL_GOOGLE_include_directive : require' '#include "hybrid_brdf.glsl"' \
        '#include "scene.glsl"' 'layout(location = 0) out vec4 c;' \
        'void main() { c = vec4(hnbrdf_eval(hnbrdf_scene_material(0), vec3(0, 0, 1), vec3(0.6, 0, 0.8)), 1); }' \
        >"$work/x.frag"
    glslangValidator -V -I"$shaders" -I"$work" "$work/x.frag" -o "$work/x.spv" >"$work/log" || { cat "$work/log"; fail "does not compile"; }
fi
"$hnbrdf" render "$model" --material paper_white --env furnace --background env --size 32 --spp 4 -o "$work/f.png" >/dev/null
[ -s "$work/f.png" ] || fail "no furnace"
echo ok
