#!/bin/sh
# recipe.sh: how the trainer's choices act on SMAPE and on image PSNR: the default against each change of it.
#
#   sh examples/recipe.sh NAME=DATA... > table.md
#
# DATA as for `hnbrdf fit`; quote several: "rgl=measured/rgl". STEPS (default 16000) and SEEDS (default "1") set how long
# and how often each one is trained, NET (default 32x2) the network, CHANGES which of them, by name; PAIRS (default 200000)
# a material for SMAPE and SIZE (default 64) of the spheres for PSNR, how closely they are measured.
set -eu
hnbrdf=${HNBRDF:-$(dirname "$0")/../build/hnbrdf}
steps=${STEPS:-16000} seeds=${SEEDS:-1} net=${NET:-32x2}
pairs=${PAIRS:-200000} size=${SIZE:-64}
[ $# -gt 0 ] || set -- builtin=builtin
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# options NAME: what this change gives to `hnbrdf fit` beside the defaults. The same number of pairs for all.
options() {
    case $1 in
    default) echo "--steps $steps" ;;
    loss-smape) echo "--steps $steps --loss smape" ;;
    loss-log) echo "--steps $steps --loss log" ;;
    schedule-linear) echo "--steps $steps --schedule linear" ;;
    schedule-constant) echo "--steps $steps --schedule constant" ;;
    uniform-share-*) echo "--steps $steps --uniform-share ${1#uniform-share-}" ;;
    bright-share-*) echo "--steps $steps --bright-share ${1#bright-share-}" ;;
    lift-*) echo "--steps $steps --lift ${1#lift-}" ;;
    before) echo "--steps $steps --bright-share 0 --lift 0 --uniform-share 0.5" ;;
    neural) echo "--steps $steps --kind neural" ;;
    neural-before) echo "--steps $steps --kind neural --bright-share 0 --uniform-share 0.5" ;;
    latent-*) echo "--steps $steps --latent ${1#latent-}" ;;
    batch-8192) echo "--steps $((steps / 4)) --batch 8192" ;;
    batch-1024) echo "--steps $((steps * 2)) --batch 1024" ;;
    rate-*) echo "--steps $steps --rate ${1#rate-}" ;;
    floor-0) echo "--steps $steps --floor 0" ;;
    joint) echo "--steps $steps --analytic joint" ;;
    angles | angles-directed) echo "--steps $steps --encoding $1" ;;
    *) echo "recipe.sh: no change is called $1" >&2 && exit 2 ;;
    esac
}
changes=${CHANGES:-before bright-share-0 lift-0 loss-smape loss-log schedule-linear schedule-constant uniform-share-0 uniform-share-1 batch-1024
    batch-8192 rate-0.01 rate-0.03 rate-0.1 floor-0 joint angles angles-directed}

# mean_of FILE: the error in the last row of a CSV of `compare`, named mean.
mean_of() {
    tail -n 1 "$1" | cut -d, -f"${2:-2}"
}

# measure CHANGE DATA SEED: "grid uniform psnr analytic" of a model fitted with this change.
measure() {
    # shellcheck disable=SC2046,SC2086 # options and DATA are several words
    {
        $hnbrdf fit $2 --net "$net" --seed "$3" $(options "$1") -o "$work/m.safetensors"
        $hnbrdf compare "$work/m.safetensors" $2 --sampler grid --pairs "$pairs" --csv "$work/grid.csv"
        $hnbrdf compare "$work/m.safetensors" $2 --sampler uniform --pairs "$pairs" --csv "$work/uniform.csv"
        $hnbrdf sheet "$work/m.safetensors" $2 --size "$size" -o "$work/sheet.png"
    } > "$work/log"
    psnr=$(awk '/PSNR/ { reading = 1; next } reading && NF >= 3 && $NF + 0 > 0 { sum += $NF; n++ }
                END { print sum / n }' "$work/log")
    echo "$(mean_of "$work/grid.csv") $(mean_of "$work/uniform.csv") $psnr $(mean_of "$work/grid.csv" 3)"
}

cat << END
Networks of $net, l = 4, $steps steps of 2048 pairs or as many pairs, seeds $seeds (mean over them); SMAPE over $pairs
pairs a material (0 is perfect, 2 the worst), PSNR in dB of spheres under the built-in sky, $size pixels wide, 32 samples a
pixel; analytic: SMAPE (grid) of the model's GGX part alone. Written by \`STEPS=$steps SEEDS="$seeds"
PAIRS=$pairs SIZE=$size sh examples/recipe.sh\` with the data named below.
END
for set in "$@"; do
    printf '\n## %s\n\n| change | SMAPE grid | SMAPE uniform | PSNR | analytic |\n|---|---|---|---|---|\n' "${set%%=*}"
    for change in default $changes; do
        options "$change" > "$work/options"
        for seed in $seeds; do
            measure "$change" "${set#*=}" "$seed"
        done > "$work/rows"
        awk -v c="$change" '{ g += $1; u += $2; p += $3; a += $4 }
            END { printf "| %s | %.4f | %.4f | %.2f | %.4f |\n", c, g / NR, u / NR, p / NR, a / NR }' "$work/rows"
    done
done
