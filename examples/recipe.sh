#!/bin/sh
# recipe.sh: how the trainer's choices act on SMAPE and on image PSNR: the default against each change of it.
#
#   sh examples/recipe.sh NAME=DATA... > table.md
#
# DATA as for `hnbrdf fit`; quote several: "rgl=measured/rgl". STEPS (default 16000) and SEEDS (default "1") set how long
# and how often each one is trained, NET (default 32x2) the network, CHANGES which of them, by name; PAIRS (default 200000)
# a material for SMAPE and SIZE (default 64) of the spheres for PSNR, how closely they are measured. Where `neural` is among
# CHANGES, a row more compares it with the default. The table of three seeds, hybrid and neural at equal steps:
#
#   TRIAL=1 sh examples/recipe.sh rgl=measured/rgl standins=standins
set -eu
hnbrdf=${HNBRDF:-$(dirname "$0")/../build/hnbrdf}
if [ -n "${TRIAL:-}" ]; then
    steps=${STEPS:-40000} seeds=${SEEDS:-1 2 3} pairs=${PAIRS:-30000} CHANGES=${CHANGES:-neural}
fi
steps=${steps:-${STEPS:-16000}} seeds=${seeds:-${SEEDS:-1}} net=${NET:-32x2}
pairs=${pairs:-${PAIRS:-200000}} size=${SIZE:-64}
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

# measure CHANGE DATA SEED: "uniform cosine grid psnr analytic alone" of a model fitted with this change; alone: how many
# materials are left to GGX.
measure() {
    # shellcheck disable=SC2046,SC2086 # options and DATA are several words
    {
        $hnbrdf fit $2 --net "$net" --seed "$3" $(options "$1") -o "$work/m.safetensors"
        for sampler in uniform cosine grid; do
            $hnbrdf compare "$work/m.safetensors" $2 --sampler $sampler --pairs "$pairs" --csv "$work/$sampler.csv"
        done
        $hnbrdf sheet "$work/m.safetensors" $2 --size "$size" -o "$work/sheet.png"
    } > "$work/log" 2> "$work/notes" || { cat "$work/notes" >&2 && exit 1; }
    psnr=$(awk '/PSNR/ { reading = 1; next } reading && NF >= 3 && $NF + 0 > 0 { sum += $NF; n++ }
                END { print sum / n }' "$work/log")
    alone=$(grep -c "worse than GGX alone" "$work/notes" || true)
    echo "$(mean_of "$work/uniform.csv") $(mean_of "$work/cosine.csv") $(mean_of "$work/grid.csv") $psnr" \
        "$(mean_of "$work/grid.csv" 3) $alone"
}

cat << END
Networks of $net, l = 4, $steps steps of 2048 pairs or as many pairs, seeds $seeds (mean over them); SMAPE over $pairs
pairs a material (0 is perfect, 2 the worst), PSNR in dB of spheres under the built-in sky, $size pixels wide, 32 samples a
pixel; analytic: SMAPE (grid) of the model's GGX part alone; left: materials that are left to GGX, of all seeds. Written by \`STEPS=$steps SEEDS="$seeds"
PAIRS=$pairs SIZE=$size sh examples/recipe.sh\` with the data named below.
END
for set in "$@"; do
    printf '\n## %s\n\n| change | SMAPE uniform | cosine | grid | PSNR | analytic | left |\n|---|---|---|---|---|---|---|\n' "${set%%=*}"
    : > "$work/means"
    for change in default $changes; do
        options "$change" > "$work/options"
        for seed in $seeds; do
            measure "$change" "${set#*=}" "$seed"
        done > "$work/rows"
        awk -v c="$change" '{ u += $1; o += $2; g += $3; p += $4; a += $5; l += $6 }
            END { print c, u / NR, o / NR, g / NR, p / NR, a / NR, l }' "$work/rows" | tee -a "$work/means" |
            awk '{ printf "| %s | %.4f | %.4f | %.4f | %.2f | %.4f | %d |\n", $1, $2, $3, $4, $5, $6, $7 }'
    done
    awk '{ for (k = 2; k <= 5; k++) of[$1, k] = $k; has[$1] = 1 }
        END { if (has["neural"]) printf "| default beside neural | %.3f | %.3f | %.3f | %+.2f | | |\n",
                  of["default", 2] / of["neural", 2], of["default", 3] / of["neural", 3],
                  of["default", 4] / of["neural", 4], of["default", 5] - of["neural", 5] }' "$work/means"
done
