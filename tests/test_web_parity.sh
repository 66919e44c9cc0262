#!/bin/sh
# test_web_parity.sh webgl|webgpu|dawn|slang SOURCE HNBRDF SCENES PACKAGES SCRATCH: the exported shader of every kind of
# model gives on that API what C gives, judged by the bounds of `hnbrdf verify`: GLSL ES 300 on WebGL2, WGSL on WebGPU,
# both in a browser; WGSL and, through Slang's compiler, Slang on Dawn without one. SCENES: the program glsl_scenes.
# Skipped (77) without node, a browser (dawn, slang: the npm packages of web/package.json).
set -eu
api=$1 source=$2 hnbrdf=$3 scenes=$4 scratch=$6
export HNBRDF_WEB_PACKAGES="$5"
command -v node > /dev/null || { echo "skipped: no node"; exit 77; }
rm -rf "$scratch"
mkdir -p "$scratch"
"$scenes" "$scratch" > /dev/null
cp "$source/examples/models/rgl_32x2.safetensors" "$scratch/shipped.safetensors"
case $api in
webgl) language= ;;
slang) language="--language slang" ;;
*) language="--language wgsl" ;;
esac

hand_out() { # NAME PAIRS options...
    name=$1 pairs=$2
    shift 2
    # shellcheck disable=SC2086 # $language is words
    "$hnbrdf" verify "$scratch/$name.safetensors" --pairs "$pairs" $language "$@" --hand-out "$scratch/$name" \
        > /dev/null
    cases="$cases $name"
}
cases=""
some=irid_flake_paint1,vch_silk_blue
case $api in
web*)
    hand_out shipped 256 --materials $some
    hand_out uniform 256 --weights uniform
    # Weights are loaded anew: another network of the same size, the same materials, the same shader.
    node "$source/tests/web/other_network.mjs" "$scratch/uniform.safetensors" "$scratch/reloaded.safetensors"
    hand_out reloaded 256 --weights uniform
    hand_out neural_16x3_directions 256 --weights columns
    hand_out ggx_rotated 256
    ;;
*) hand_out shipped 256 --materials $some --weights uniform ;; # which compiles soonest
esac
hand_out edited 256 --weights columns

# shellcheck disable=SC2046,SC2086 # words
node "$source/tests/web/parity.mjs" "$api" $(for name in $cases; do echo "$scratch/$name"; done) > "$scratch/ran" || {
    status=$? # 77: skipped
    cat "$scratch/ran"
    exit $status
}
cat "$scratch/ran"
sed -n 's/^shipped on \([^:]*\): \(.*\): [0-9]* shaders compiled.*/\1 | \2/p' "$scratch/ran" | # for parity_summary.sh
    sed "s/^/parity: $(case $api in webgl) echo glsl ;; slang) echo slang ;; *) echo wgsl ;; esac) | /; s/\$/ | executed/"
failed=0
if [ -d "$scratch/reloaded" ] && ! grep -q '^reloaded .*: 0 shaders compiled' "$scratch/ran"; then
    echo "failed: other weights needed another shader"
    failed=1
fi
for name in $cases; do
    if ! "$hnbrdf" verify "$scratch/$name.safetensors" --hand-in "$scratch/$name" > "$scratch/found" 2>&1; then
        echo "failed: $name"
        cat "$scratch/found"
        failed=1
    fi
    echo "$name, values, worst of the bound: $(awk '$2 == "value" { print $1, $(NF - 1) }' "$scratch/found" | xargs)"
done
if [ "$api" = slang ]; then # and to every other language that Slang writes
    {
        cat "$scratch/edited/scene.slang"
        cat << 'S'
[shader("fragment")]
float4 main(float3 wi : TEXCOORD0, float3 wo : TEXCOORD1, float2 u : TEXCOORD2) : SV_Target
{
    hnbrdf_material m = hnbrdf_scene_material(0);
    hnbrdf_sample_result drawn = hnbrdf_sample(m, wo, u);
    return float4(hnbrdf_eval(m, wi, wo) + hnbrdf_eval_analytic(m, wi, wo) + drawn.weight, hnbrdf_pdf(m, wi, wo));
}
S
    } > "$scratch/everything.slang"
    node "$source/tests/web/tool_slang.mjs" "$scratch/everything.slang" || failed=1
fi
[ $failed = 1 ] || rm -rf "$scratch"
exit $failed
