#!/bin/sh
# test_stability_cli.sh HNBRDF MODEL SCENES [DEVICE]: the short form of `hnbrdf stability`: the shipped model in C, a
# small one on a Vulkan device too, the first or DEVICE, or on all.
set -eu
hnbrdf=$1 model=$2 scenes=$3 device=${4:-0}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ASAN_OPTIONS=detect_leaks=0 # the Vulkan driver is unloaded before leaks are looked for
export ASAN_OPTIONS
fail() { echo "failed: $*"; exit 1; }
status() { expected=$1; shift; got=0; "$@" >"$work/out" 2>"$work/err" || got=$?
    [ $got = "$expected" ] || { cat "$work/out" "$work/err"; fail "exit $got, expected $expected: $*"; }; }

status 0 "$hnbrdf" stability "$model" --device none --blocks 3 --csv "$work/s.csv" --json "$work/s.json"
grep -q 'every bar kept' "$work/out" || fail "no verdict"
tail -n 40 "$work/out"
grep -q '"passed": true' "$work/s.json" || fail "json"
columns() { sed 's/"[^"]*"/quoted/g' | tr ',' '\n' | wc -l; }
[ "$(head -1 "$work/s.csv" | columns)" = "$(tail -1 "$work/s.csv" | columns)" ] || fail "csv columns"
# case, stage, backend are named in every row; the reference has all four stages of all cases.
[ "$(grep -c ',c plain,' "$work/s.csv")" -ge 80 ] || fail "csv rows"
status 0 "$hnbrdf" stability "$model" --device none --blocks 1 --csv -
head -1 "$work/out" | grep -q '^model,case' || fail "csv to stdout"
status 2 "$hnbrdf" stability
status 2 "$hnbrdf" stability "$model" --device none --blocks 0
status 0 "$hnbrdf" stability "$model" --device none --blocks 1 --plot "$work/s.png"
[ "$(wc -c <"$work/s.png")" -gt 10000 ] || fail "no plot"
status 2 "$hnbrdf" stability "$model" --plot "$work/s.svg"
status 1 "$hnbrdf" stability "$work/missing.safetensors"
status 1 "$hnbrdf" stability "$model" --device none --blocks 1 --csv "$work/no/such/place.csv"
status 2 "$hnbrdf" stability "$model" --device first

"$hnbrdf" verify --list >"$work/devices" 2>"$work/err" || { echo "ok, without Vulkan"; exit 0; }
command -v glslangValidator >/dev/null && [ -s "$work/devices" ] || { echo "ok, no device"; exit 0; }
"$scenes" "$work" >/dev/null
status 0 "$hnbrdf" stability "$work/hybrid_8x4_rotated.safetensors" --device "$device" --blocks 1
sed -n '/^the worst/,$p' "$work/out"
for build in exact fast half; do grep -q "glsl $build" "$work/out" || echo "no build $build here"; done
status 1 "$hnbrdf" stability "$model" --device 99
echo ok
