#!/bin/sh
# holdout.sh: how well a network describes measured materials that it has not seen, by what it was trained on. A third of
# the materials is left out at a time; the network is trained on the rest and on what is named, and the materials left out
# are fitted on it with --freeze. Markdown on stdout.
#
#   sh examples/holdout.sh DIRECTORY [MORE...] > holdout.md
#
# DIRECTORY: .bsdf or .binary files. MORE: directories of more to train on (networks of Neural-BRDF, say); files in them
# that are called like a material that is left out are not used. COUNTS (default "0 100 300"): so many procedural
# materials beside, a row each; STEPS (default 40000), NET (64x2), LATENT (16), ROTATIONS (3), PAIRS (50000) and SIZE (64,
# pixels of the spheres). WORK: a directory that keeps the models, so that a second call goes on where the first one ended.
set -eu
hnbrdf=${HNBRDF:-$(dirname "$0")/../build/hnbrdf}
steps=${STEPS:-40000} net=${NET:-64x2} latent=${LATENT:-16} rotations=${ROTATIONS:-3}
pairs=${PAIRS:-50000} size=${SIZE:-64} counts=${COUNTS:-0 100 300}
[ $# -gt 0 ] && [ -d "$1" ] || {
    echo "usage: sh $0 DIRECTORY [MORE...]" >&2
    exit 2
}
from=$1
shift
work=${WORK:-}
[ -n "$work" ] || {
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
}
mkdir -p "$work"

# The share of the way from GGX to the own fit; 0 where there is no way.
closed='function closed(ggx, frozen, own) { return own == ggx ? 0 : (ggx - frozen) / (ggx - own) } '

# absolute DIRECTORY
absolute() {
    (cd "$1" && pwd)
}

# split ROTATION DIRECTORY...: links of what is left out and of what is seen.
split() {
    part=$1 number=0
    shift
    mkdir -p "$work/$part/out" "$work/$part/seen" "$work/$part/more"
    for file in "$(absolute "$from")"/*.bsdf "$(absolute "$from")"/*.binary; do
        [ -e "$file" ] || continue
        place=seen
        [ $((number % 3)) != "$part" ] || place=out
        ln -sf "$file" "$work/$part/$place/"
        number=$((number + 1))
    done
    for directory in "$@"; do
        for file in "$(absolute "$directory")"/*; do
            is_left_out "$part" "$(basename "$file")" || ln -sf "$file" "$work/$part/more/"
        done
    done
}

# is_left_out ROTATION NAME
is_left_out() {
    for left in "$work/$1/out"/*; do
        stem=$(basename "${left%.*}")
        case $2 in *"${stem%_rgb}"*) return 0 ;; esac
    done
    return 1
}

# unless_there FILE COMMAND...: the command writes it.
unless_there() {
    there=$1
    shift
    [ -e "$there" ] || "$@" >> "$work/log"
}

# psnr SHEET_LOG: "material ggx model" of each.
psnr() {
    awk '/PSNR/ { reading = 1; next } reading && NF == 5 && $NF + 0 > 0 { print $1, $3, $5 }' "$1" | sort
}

# measure MODEL DATA NAME: SMAPE and PSNR of the materials of DATA.
measure() {
    unless_there "$3.csv" "$hnbrdf" compare "$1" "$2" --sampler uniform --pairs "$pairs" --skip-missing --csv "$3.csv"
    [ -e "$3.sheet" ] || "$hnbrdf" sheet "$1" "$2" --size "$size" -o "$3.png" > "$3.sheet"
}

# rows NAME: "material ggx smape ggx_psnr psnr", sorted.
rows() {
    awk -F, 'NR > 1 && $1 != "mean" { print $1, $3, $2 }' "$1.csv" | sort > "$work/smape"
    psnr "$1.sheet" | join "$work/smape" -
}

unless_there "$work/own.safetensors" "$hnbrdf" fit "$from" --steps "$steps" -o "$work/own.safetensors"
measure "$work/own.safetensors" "$from" "$work/own"
rows "$work/own" | awk '{ print $1, $3, $5 }' > "$work/own.rows"
for count in $counts; do
    : > "$work/$count.rows"
    rotation=0
    while [ $rotation -lt "$rotations" ]; do
        split $rotation "$@"
        here=$work/$rotation model=$work/$rotation/$count.safetensors frozen=$work/$rotation/$count.frozen.safetensors
        data=$here/seen
        [ -z "$(ls "$here/more")" ] || data="$data $here/more"
        [ "$count" = 0 ] || data="$data procedural:$count"
        # shellcheck disable=SC2086 # data is several words
        unless_there "$model" "$hnbrdf" fit $data --net "$net" --latent "$latent" --steps "$steps" --pool 32768 -o "$model"
        unless_there "$frozen" "$hnbrdf" fit "$here/out" --freeze "$model" -o "$frozen"
        measure "$frozen" "$here/out" "$here/$count"
        rows "$here/$count" >> "$work/$count.rows"
        rotation=$((rotation + 1))
    done
    sort "$work/$count.rows" | join - "$work/own.rows" > "$work/$count.all"
done

cat << END
Network $net, l = $latent, $steps steps; a third of the materials left out at a time, $rotations times; SMAPE uniform over $pairs
pairs, PSNR of spheres of $size pixels. Own: 32x2, l = 4, trained on all of them with as many steps. Gap closed: (GGX -
frozen) / (GGX - own). Written by \`sh examples/holdout.sh\`.

| procedural materials beside | SMAPE: GGX, frozen, own | gap closed | PSNR: GGX, frozen, own | gap closed |
|---|---|---|---|---|
END
for count in $counts; do
    awk -v c="$count" "$closed"'{ g += $2; s += $3; q += $4; p += $5; o += $6; w += $7 }
        END { printf "| %s | %.3f, %.3f, %.3f | %.2f | %.1f, %.1f, %.1f dB | %.2f |\n", c, g / NR, s / NR, o / NR,
            closed(g, s, o), q / NR, p / NR, w / NR, closed(q, p, w) }' "$work/$count.all"
done
printf '\nWith %s of them:\n\n| material | SMAPE: GGX, frozen, own | gap closed | PSNR: GGX, frozen, own | gap closed |\n' "$count"
printf '|---|---|---|---|---|\n'
awk "$closed"'{ printf "| %s | %.3f, %.3f, %.3f | %.2f | %.1f, %.1f, %.1f dB | %.2f |\n", $1, $2, $3, $6,
    closed($2, $3, $6), $4, $5, $7, closed($4, $5, $7) }' "$work/$count.all"
