#!/bin/sh
# encodings.sh: compares the encodings on measured data, everything else equal, and writes a Markdown table.
#
#   sh examples/encodings.sh NAME=DATA... > examples/encodings.md
#
# DATA as for `hnbrdf fit`; quote several: "rgl=measured/rgl". STEPS (default 32000) and SEEDS (default "1 2")
# set how long and how often each one is trained, NET (default 32x2) the network.
set -eu
hnbrdf=${HNBRDF:-$(dirname "$0")/../build/hnbrdf}
steps=${STEPS:-32000} seeds=${SEEDS:-1 2} net=${NET:-32x2}
[ $# -gt 0 ] || set -- builtin=builtin
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# mean_of COLUMN FILE: that column of the last row of a CSV, named mean.
mean_of() {
    tail -n 1 "$2" | cut -d, -f"$1"
}

cat << END
# Encodings compared

Networks of $net, l = 4, the analytic part faithful, $steps steps of 2048 pairs, seeds $seeds (mean over them);
SMAPE over 200,000 pairs a material (0 is perfect, 2 the worst), PSNR in dB of spheres under the built-in sky, 64
pixels wide, 32 samples a pixel. "floor" is b of the model; the paper's form is \`directions\` without a floor. Cost:
beside the network, which is the same for all. Written by \`sh examples/encodings.sh $*\`.

END
for set in "$@"; do
    name=${set%%=*} data=${set#*=}
    printf '## %s\n\n| encoding | floor | SMAPE grid | SMAPE uniform | PSNR | reciprocal | cost |\n|---|---|---|---|---|---|---|\n' "$name"
    for entry in "directions 0 no none" "directions 0.003 no none" \
        "half-difference 0.003 yes log,_3_sqrt,_3_divisions" "angles-directed 0.003 no 2_log,_1_sqrt,_3_divisions" \
        "angles 0.003 yes 2_log,_1_sqrt,_3_divisions" "angles-anisotropic 0.003 yes 2_log,_2_sqrt,_5_divisions" \
        "angles-azimuths 0.003 yes 2_log,_1_sqrt,_3_divisions"; do
        # shellcheck disable=SC2086 # the entry is four words
        set -- $entry
        : > "$work/rows"
        for seed in $seeds; do
            # shellcheck disable=SC2086 # DATA may be several words
            {
                $hnbrdf fit $data --net "$net" --latent 4 --encoding "$1" --floor "$2" --steps "$steps" \
                    --seed "$seed" -o "$work/m.safetensors"
                $hnbrdf compare "$work/m.safetensors" $data --sampler grid --csv "$work/grid.csv"
                $hnbrdf compare "$work/m.safetensors" $data --sampler uniform --csv "$work/uniform.csv"
                $hnbrdf sheet "$work/m.safetensors" $data --size 64 -o "$work/sheet.png"
            } > "$work/log"
            psnr=$(awk '/PSNR/ { reading = 1; next } reading && NF >= 5 && $NF + 0 > 0 { sum += $NF; n++ }
                        END { print sum / n }' "$work/log")
            echo "$(mean_of 2 "$work/grid.csv") $(mean_of 2 "$work/uniform.csv") $psnr" >> "$work/rows"
        done
        awk -v e="$1" -v b="$2" -v r="$3" -v c="$(echo "$4" | tr _ ' ')" \
            '{ g += $1; u += $2; p += $3 } END { printf "| `%s` | %s | %.4f | %.4f | %.2f | %s | %s |\n", e, b, g / NR,
                                                  u / NR, p / NR, r, c }' "$work/rows"
    done
    echo
done
