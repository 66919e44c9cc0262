#!/bin/sh
# demo.sh: the whole road, from measured BRDFs to a shader proven equal to C, in under five minutes on two
# cores. Installs what is missing, builds into build/, writes everything into out/.
#
#   sh examples/demo.sh [DATA...]     DATA as for `hnbrdf fit`; the built-in procedural materials by default
#
# SECONDS_TO_FIT sets how long the network trains (default 60).
set -eu
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- builtin
seconds=${SECONDS_TO_FIT:-60}
jobs=$(getconf _NPROCESSORS_ONLN 2> /dev/null || echo 2)
out=out
start=$(date +%s)

say() {
    printf '\n== %s (%d s)\n' "$1" $(($(date +%s) - start))
}
fail() {
    echo "demo.sh: $1" >&2
    exit 1
}
exec 3>&1
run() {
    echo "\$ $*" >&3
    "$@"
}

say "Installing what is missing"
sh tests/packages.sh demo

say "Building into build/"
mkdir -p build "$out"
{
    CC=gcc cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DHNBRDF_BUILD_FIT=ON -DHNBRDF_BUILD_CLI=ON \
        -DHNBRDF_BUILD_EXAMPLES=ON -DHNBRDF_WITH_OPENEXR=ON -DHNBRDF_WITH_VULKAN=ON &&
        cmake --build build -j "$jobs" --target hnbrdf_cli hnbrdf_example_batch
} > build/demo.log 2>&1 || {
    tail -n 30 build/demo.log >&2
    fail "the build failed; all of it is in build/demo.log"
}
hnbrdf=build/hnbrdf

say "A first picture, of a material of the shipped model"
run $hnbrdf render examples/models/rgl_32x2.safetensors --material vch_silk_blue --size 256 --spp 32 -o $out/first.png

say "Fitting: GGX alone, then a hybrid with one 32x2 network for all materials"
run $hnbrdf fit "$@" --kind ggx -o $out/ggx.safetensors
run $hnbrdf fit "$@" --net 32x2 --latent 4 --seconds "$seconds" -o $out/hybrid.safetensors
run $hnbrdf info $out/hybrid.safetensors

say "Comparing both with the measurements"
run $hnbrdf compare $out/ggx.safetensors "$@" --csv $out/error_ggx.csv > /dev/null
run $hnbrdf compare $out/hybrid.safetensors "$@" --csv $out/error_hybrid.csv > $out/error_hybrid.txt

say "Exporting the scene as one GLSL include"
run $hnbrdf export $out/hybrid.safetensors -o $out/scene.glsl

say "Proving on every Vulkan device here that the shader equals the C library"
run $hnbrdf verify $out/hybrid.safetensors --json $out/verify.json

say "Rendering"
first=$(sed -n 2p $out/error_hybrid.csv | cut -d, -f1)
run $hnbrdf render $out/hybrid.safetensors --material "$first" --size 384 -o "$out/$first.exr"
run $hnbrdf sheet $out/hybrid.safetensors "$@" --ggx $out/ggx.safetensors -o $out/sheet.png > $out/sheet.txt
tail -n 1 $out/sheet.txt

say "Timing one thread of C"
run build/examples/batch $out/hybrid.safetensors > $out/time.csv

# The three files have the same materials in the same order; time.csv has no row for the mean.
{
    echo "material,smape_ggx,smape_hybrid,single_ns,batch_ns"
    cut -d, -f1,2 $out/error_ggx.csv | paste -d, - $out/error_hybrid.csv $out/time.csv |
        awk -F, 'NR > 1 { if ($8 == "") { $8 = single / n; $9 = batch / n }
                          single += $8; batch += $9; n++
                          printf "%s,%s,%s,%.0f,%.0f\n", $1, $2, $4, $8, $9 }'
} > $out/table.csv
say "Error (SMAPE, grid sampler: 0 is perfect, 2 the worst) and run time per material"
awk -F, 'NR == 1 { printf "%-28s %9s %9s %12s %12s\n", "", "", "", "C, one", "C, in batch"
                   printf "%-28s %9s %9s %12s %12s\n", "material", "GGX", "hybrid", "ns/eval", "ns/eval" }
         NR > 1 { printf "%-28s %9.4f %9.4f %12.0f %12.0f\n", $1, $2, $3, $4, $5 }' $out/table.csv
sed -n 's/.*"name": "\([^"]*\)".*/\1/p; s/.*"ns_per_evaluation": \([0-9.]*\).*/  the shader: \1 ns per evaluation/p' \
    $out/verify.json

cat << END

Done in $(($(date +%s) - start)) s. To look at, in $out/:
  first.png           a material of the shipped model
  sheet.png           every material: measurement, GGX alone, hybrid
  $first.png, .exr
  scene.glsl          the network and the materials, to include after shaders/hybrid_brdf.glsl
  verify.json         how far the shader is from C, stage by stage
  hybrid.safetensors  the model (ggx.safetensors: GGX alone)
  table.csv           the table above
END
