#!/bin/sh
# holdout.sh: how well a network that never saw a material describes it: trains on every second file, fits the
# others on the frozen network, and compares with training on all and with GGX alone. Markdown on stdout.
#
#   sh examples/holdout.sh DIRECTORY > holdout.md
#
# STEPS (default 32000), NET (32x2), LATENT (8), ENCODING and SAMPLER (grid) as for `hnbrdf fit` and `compare`.
set -eu
hnbrdf=${HNBRDF:-$(dirname "$0")/../build/hnbrdf}
steps=${STEPS:-32000} net=${NET:-32x2} latent=${LATENT:-8} sampler=${SAMPLER:-grid}
[ $# = 1 ] && [ -d "$1" ] || {
    echo "usage: sh $0 DIRECTORY" >&2
    exit 2
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/seen" "$work/held"
from=$(cd "$1" && pwd)
odd=1
for file in "$from"/*.bsdf "$from"/*.binary; do
    [ -e "$file" ] || continue
    if [ $odd = 1 ]; then ln -s "$file" "$work/seen/"; else ln -s "$file" "$work/held/"; fi
    odd=$((1 - odd))
done
options="--net $net --latent $latent --steps $steps"
[ -z "${ENCODING:-}" ] || options="$options --encoding $ENCODING"
# shellcheck disable=SC2086 # words
{
    $hnbrdf fit "$work/seen" $options -o "$work/half.safetensors"
    $hnbrdf fit "$work/held" --freeze "$work/half.safetensors" -o "$work/frozen.safetensors" > "$work/frozen.log"
    $hnbrdf fit "$1" $options -o "$work/full.safetensors"
    for kind in frozen full; do
        $hnbrdf compare "$work/$kind.safetensors" "$work/held" --sampler "$sampler" --csv "$work/$kind.csv"
    done
} > "$work/log"
cat << END
# Held-out materials on a frozen network

Network $net, l = $latent, $steps steps, $sampler sampler, 200,000 pairs a material. Trained on every second material of
the data; for the others only kd, eta, alpha and the latent code were fitted
($(sed -n 's/.*frozen network, \([0-9.]* s each\).*/\1/p' "$work/frozen.log")). Written by \`sh examples/holdout.sh $1\`.

| held-out material | GGX alone | frozen network | trained on all | closer to |
|---|---|---|---|---|
END
paste -d, "$work/frozen.csv" "$work/full.csv" | awk -F, 'NR > 1 {
    near = $3 - $2 > $2 - $6 ? "full" : "GGX"
    if ($1 != "mean") { n++; full += near == "full" }
    printf "| %s | %.4f | %.4f | %.4f | %s |\n", $1, $3, $2, $6, $1 == "mean" ? "" : near }
    END { printf "\n%d of %d (%.0f %%) are closer to training on all than to GGX alone.\n", full, n, 100 * full / n }'
