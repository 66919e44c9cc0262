#!/bin/sh
# test_physics_cli.sh HNBRDF MODEL SHADERS: energy as `info` tells it, `edit` and `export` --conserve correct it and a
# furnace shows it. MODEL holds chm_mint, near 1 at the horizon and far below it else, and cm_military_green.
set -eu
hnbrdf=$1 model=$2 shaders=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "failed: $*"; exit 1; }
"$hnbrdf" edit "$model" --material chm_mint --set kd+=0.25 --as bright -o "$work/bright.safetensors" >/dev/null
model=$work/bright.safetensors # bright is above 1, but near the horizon alone
"$hnbrdf" info "$model" >"$work/info"
grep -q '^bright .*ABOVE 1' "$work/info" || fail "energy above 1 is not told"
grep -q '^cm_military_green .*kept' "$work/info" || fail "energy below 1 is not told"
"$hnbrdf" info "$model" --json | grep -q '"conserves_energy": false' || fail "json"
# Without: the same but for what is measured.
"$hnbrdf" info "$model" --without-physics >"$work/short"
lines=$(wc -l <"$work/short")
head -n "$lines" "$work/info" | cmp -s - "$work/short" || fail "--without-physics tells something else"
grep -q albedo "$work/short" && fail "--without-physics measures"
"$hnbrdf" info "$model" --without-physics --json | grep -q albedo && fail "--without-physics --json measures"

# The factor in the shader alone, and in a model.
"$hnbrdf" export "$model" --conserve --materials bright,cm_military_green -o "$work/scene.glsl" >"$work/out"
grep -q '^bright: albedo [1-9].* becomes 0.9[0-9]*, ' "$work/out" || fail "the material with a factor is not told"
grep -q '^cm_military_green: albedo' "$work/out" && fail "a material that needs no factor is told"
[ "$(grep -c 'hnbrdf_energy_factor(material_in' "$work/scene.glsl")" = 1 ] || fail "the value is not multiplied, once"
"$hnbrdf" export "$model" --materials bright -o "$work/plain.glsl" >/dev/null
grep -q energy "$work/plain.glsl" && fail "a factor that nobody asked for"
"$hnbrdf" edit "$model" --conserve -o "$work/kept.safetensors" >"$work/out"
awk '/^[a-z].*: albedo/ { n++; if ($6 < 0.99 || $6 > 1 || $5 + 0 > 1) exit 1 } END { exit n < 1 }' "$work/out" ||
    { cat "$work/out"; fail "normal incidence is not within 1 %"; }
"$hnbrdf" info "$work/kept.safetensors" >"$work/info"
grep -q 'ABOVE 1' "$work/info" && fail "edit --conserve leaves an albedo above 1"
"$hnbrdf" info "$work/kept.safetensors" --json | grep -q '"conserves_energy": false' && fail "json of it"
"$hnbrdf" export "$work/kept.safetensors" --materials bright,cm_military_green -o "$work/same.glsl" >/dev/null
cmp -s "$work/scene.glsl" "$work/same.glsl" || fail "the shaders differ"
# An edit finds the factor of a material that has one again, a mixture too.
"$hnbrdf" edit "$work/kept.safetensors" --material bright --set alpha*=0.5 >"$work/out"
grep -q '^  energy ' "$work/out" || fail "the factor of an edited material stays"
"$hnbrdf" mix "$work/kept.safetensors" bright cm_military_green --t 0.25 --as mixed >"$work/out"
"$hnbrdf" info "$work/kept.safetensors" | grep -q 'ABOVE 1' && fail "an edit or a mixture is above 1"
"$hnbrdf" export "$work/kept.safetensors" --pack half -o "$work/x.glsl" | grep -q 'energy (.* has it)' ||
    fail "--pack leaves the factor out"
if command -v glslangValidator >/dev/null; then
    printf '%s\n' '#version 450' '#extension GL_GOOGLE_include_directive : require' '#include "hybrid_brdf.glsl"' \
        '#include "scene.glsl"' 'layout(location = 0) out vec4 c;' \
        'void main() { c = vec4(hnbrdf_eval(hnbrdf_scene_material(0), vec3(0, 0, 1), vec3(0.6, 0, 0.8)), 1); }' \
        >"$work/x.frag"
    glslangValidator -V -I"$shaders" -I"$work" "$work/x.frag" -o "$work/x.spv" >"$work/log" || { cat "$work/log"; fail "does not compile"; }
fi
"$hnbrdf" render "$model" --material bright --env furnace --background env --size 32 --spp 4 -o "$work/f.png" >/dev/null
[ -s "$work/f.png" ] || fail "no furnace"
echo ok
