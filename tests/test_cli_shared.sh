#!/bin/sh
# test_cli_shared.sh HNBRDF FILES SHARED: `hnbrdf eval` reproduces the reference loader on real RGL
# files. Skipped (77) where the files are not.
set -u
shared=${HNBRDF_DATA_DIR:-$3}
[ -f "$shared/data/rgl_checkpoints.csv" ] || { echo "skipped: no $shared/data"; exit 77; }
shared=$(cd "$shared" && pwd)
. "$(dirname "$0")/test_cli_support.sh"

checkpoints=$shared/data/rgl_checkpoints.csv
rows=0
for material in $(awk -F, 'NR > 1 { print $1 }' "$checkpoints" | sort -u); do
    awk -F, -v m="$material" 'NR == 1 || $1 == m' "$checkpoints" >in.csv
    run "$HNBRDF" eval "$shared/data/rgl/${material}_rgb.bsdf" -i in.csv
    expect_ok "$material"
    # Of the largest channel, 1e-4: the reference is a float loader, rows agree to 2e-5 with doubles.
    paste -d, in.csv out | awk -F, -v m="$material" '
        function max(a, b) { return a > b ? a : b }
        NR > 1 {
            bound = 1e-4 * max($8, max($9, $10))
            for (c = 8; c <= 10; c++)
                if (($c - $(c + 3)) ^ 2 > bound ^ 2 && !bad++)
                    print m ", row " NR ": found " $(c + 3) ", expected " $c
        }
        END { exit bad > 0 }' || fail "$material: other values than the reference loader"
    rows=$((rows + $(wc -l <out) - 1))
done
[ "$rows" -eq 240 ] || fail "$rows rows, expected 240"
finish
