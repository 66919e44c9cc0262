#!/bin/sh
# test_gl_cli.sh HNBRDF SCENES: `hnbrdf verify --api gl` and `gles` as a user runs them.
set -eu
hnbrdf=$1 scenes=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$scenes" "$work" >/dev/null
model=$work/hybrid_8x4_rotated.safetensors
ASAN_OPTIONS=detect_leaks=0 # the driver is unloaded before leaks are looked for
export ASAN_OPTIONS
fail() { echo "failed: $*"; exit 1; }
status() { expected=$1; shift; got=0; "$@" >"$work/out" 2>"$work/err" || got=$?
    [ $got = "$expected" ] || { cat "$work/out" "$work/err"; fail "exit $got, expected $expected: $*"; }; }

"$hnbrdf" verify --list --api gl >"$work/devices" 2>"$work/err" || {
    grep -q 'without OpenGL' "$work/err" || fail "--list: $(cat "$work/err")"
    echo "skipped: built without EGL"
    exit 77
}
[ -s "$work/devices" ] || { echo "skipped: no GL device"; exit 77; }
grep -q '^gl 0: .*, as gl 330, ' "$work/devices" || fail "--list names device and dialect"
status 0 "$hnbrdf" verify --list
grep -q '^gl 0: ' "$work/out" || fail "--list without --api lists all"

status 0 "$hnbrdf" verify "$model" --api gl --device 0 --pairs 64 --csv "$work/v.csv" --json "$work/v.json"
grep -q '^gl 330 device 0: ' "$work/out" || fail "the dialect is not told"
grep -q '^  compiling .* ms to the end of the first draw$' "$work/out" || fail "no time of the first draw"
grep -q '^  order  *of operations not kept' "$work/out" || fail "the missing precise is not told"
# 1 device, 3 materials, 2 builds, 7 stages
[ "$(wc -l <"$work/v.csv")" = 43 ] || fail "csv rows"
[ "$(grep -c ',gl 330$' "$work/v.csv")" = 42 ] || fail "csv api"
grep -q '"api": "gl 330"' "$work/v.json" || fail "json api"
grep -q '"ordered": false' "$work/v.json" || fail "json ordered"
if "$hnbrdf" verify --list --api gles | grep -q 'as gles 320'; then
    status 0 "$hnbrdf" verify "$model" --api gles --pairs 64 --without-timing --materials 'gold-paint'
    [ "$(grep -c ' within the bounds$' "$work/out")" = 2 ] || fail "two dialects of ES"
fi
status 1 "$hnbrdf" verify "$model" --api gl --device 99
grep -q 'GL has devices 0 to' "$work/err" || fail "which devices there are is not told"
status 2 "$hnbrdf" verify "$model" --api all --device 0
status 2 "$hnbrdf" verify "$model" --api directx
status 2 "$hnbrdf" verify "$model" --api gl --device -1
echo ok
