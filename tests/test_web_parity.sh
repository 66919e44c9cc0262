#!/bin/sh
# test_web_parity.sh webgl|webgpu|dawn SOURCE HNBRDF SCENES PACKAGES SCRATCH: the exported shader of every kind of model
# gives on that API what C gives, judged by the bounds of `hnbrdf verify`: GLSL ES 300 on WebGL2, WGSL on WebGPU, both in
# a browser, and WGSL on Dawn without one. SCENES: the program glsl_scenes. Skipped (77) without node, a browser (dawn:
# the npm packages of web/package.json).
set -eu
api=$1 source=$2 hnbrdf=$3 scenes=$4 scratch=$6
export HNBRDF_WEB_PACKAGES="$5"
command -v node > /dev/null || { echo "skipped: no node"; exit 77; }
rm -rf "$scratch"
mkdir -p "$scratch"
"$scenes" "$scratch" > /dev/null
cp "$source/examples/models/rgl_32x2.safetensors" "$scratch/shipped.safetensors"
language=
[ "$api" = webgl ] || language="--language wgsl"

hand_out() { # NAME PAIRS options...
    name=$1 pairs=$2
    shift 2
    # shellcheck disable=SC2086 # $language is words
    "$hnbrdf" verify "$scratch/$name.safetensors" --pairs "$pairs" $language "$@" --hand-out "$scratch/$name" > /dev/null
    cases="$cases $name"
}
cases=""
hand_out shipped 256 --materials irid_flake_paint1,vch_silk_blue
hand_out uniform 256 --weights uniform
hand_out neural_16x3_directions 256 --weights columns
hand_out ggx_rotated 256
hand_out edited 256 --weights columns

# shellcheck disable=SC2046,SC2086 # words
node "$source/tests/web/parity.mjs" "$api" $(for name in $cases; do echo "$scratch/$name"; done)
failed=0
for name in $cases; do
    if ! "$hnbrdf" verify "$scratch/$name.safetensors" --hand-in "$scratch/$name" > "$scratch/found" 2>&1; then
        echo "failed: $name"
        cat "$scratch/found"
        failed=1
    fi
    echo "$name: $(sed -n 's/^ *\(exact\|fast\) *value .* \([0-9.e+-]*\) *[0-9.e+-]*  ok$/\1 value \2/p' "$scratch/found" |
        tr '\n' ' ')"
done
[ $failed = 1 ] || rm -rf "$scratch"
exit $failed
