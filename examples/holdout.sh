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
    for analytic in faithful joint; do
        $hnbrdf fit "$work/held" --freeze "$work/half.safetensors" --analytic $analytic \
            -o "$work/$analytic.safetensors" > "$work/$analytic.log"
    done
    $hnbrdf fit "$1" $options -o "$work/full.safetensors"
    for kind in faithful joint full; do
        $hnbrdf compare "$work/$kind.safetensors" "$work/held" --sampler "$sampler" --csv "$work/$kind.csv"
    done
} > "$work/log"
cat << END
# Held-out materials on a frozen network

Network $net, l = $latent, $steps steps, $sampler sampler, 200,000 pairs a material. Trained on every second material of
the data; for the others only kd, eta, alpha and the latent code were fitted
($(sed -n 's/.*frozen network, \([0-9.]* s each\).*/\1/p' "$work/faithful.log")): faithful keeps kd, eta and alpha as GGX alone is fitted, joint moves them along
with the code. Closer: to training on all than to GGX alone. Written by \`sh examples/holdout.sh DIRECTORY\`.

| held-out material | GGX alone | frozen, faithful | frozen, joint | trained on all | closer, faithful | closer, joint |
|---|---|---|---|---|---|---|
END
paste -d, "$work/faithful.csv" "$work/joint.csv" "$work/full.csv" | awk -F, '
    function closer(error) { return $3 - error > error - $10 }
    NR > 1 {
        faithful = closer($2); joint = closer($6)
        if ($1 != "mean") { n++; faithfuls += faithful; joints += joint }
        printf "| %s | %.4f | %.4f | %.4f | %.4f | %s | %s |\n", $1, $3, $2, $6, $10,
            $1 == "mean" ? "" : (faithful ? "yes" : "no"), $1 == "mean" ? "" : (joint ? "yes" : "no") }
    END { printf "\nCloser to training on all than to GGX alone: %d of %d (%.0f %%) faithful, %d (%.0f %%) joint.\n",
        faithfuls, n, 100 * faithfuls / n, joints, 100 * joints / n }'
