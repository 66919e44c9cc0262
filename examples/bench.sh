#!/bin/sh
# bench.sh: run time against error of several networks fitted to the same data: the table and plot of the README.
#
#   sh examples/bench.sh DATA OUT
#
# DATA as for `hnbrdf fit`, one argument; OUT is a folder, which gets the models, bench.txt, bench.csv, bench.json and
# bench.svg. Models that OUT has already are not fitted again. STEPS (default 40000) sets how long each one is trained,
# SAMPLER (default uniform) names that of the SMAPE, ROUNDS (default 30) how often each row is timed. NBRDF: a folder with
# NBRDF networks of the same materials (.h5, .npy), to stand beside them; https://github.com/asztr/Neural-BRDF has some.
set -eu
hnbrdf=${HNBRDF:-$(dirname "$0")/../build/hnbrdf}
data=$1 out=$2 steps=${STEPS:-40000} sampler=${SAMPLER:-uniform} rounds=${ROUNDS:-30}
mkdir -p "$out"

# fit NAME OPTIONS...: a model of that name, unless it is there.
models=
fit() {
    model=$out/$1.safetensors
    models="$models $model"
    shift
    [ -s "$model" ] || "$hnbrdf" fit "$data" --steps "$steps" -o "$model" "$@"
}
fit hybrid_8x2 --net 8x2
fit hybrid_16x2 --net 16x2
fit hybrid_32x2 --net 32x2
fit hybrid_64x3 --net 64x3
fit neural_32x2 --net 32x2 --kind neural
fit paper_32x2 --net 32x2 --encoding directions --floor 0 --analytic joint # the paper's form
# shellcheck disable=SC2086 # several names
"$hnbrdf" bench $models --data "$data" --baselines ${NBRDF:+--nbrdf "$NBRDF"} --sampler "$sampler" --rounds "$rounds" --csv "$out/bench.csv" \
    --json "$out/bench.json" --plot "$out/bench.svg" | tee "$out/bench.txt"
