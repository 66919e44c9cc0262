#!/bin/sh
# test_gpu_cli.sh HNBRDF SCENES: `hnbrdf export`, `hnbrdf verify` and `hnbrdf render --device` as a user runs them.
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

# Export: the text that the library gives, one line on stdout, nothing left aside.
status 0 "$hnbrdf" export "$model" -o "$work/x.glsl"
cmp "$work/x.glsl" "$work/hybrid_8x4_rotated.glsl" || fail "export differs from the library's text"
[ "$(wc -l <"$work/out")" = 1 ] || fail "export prints one line"
status 0 "$hnbrdf" export "$model" --standalone -o "$work/x.glsl"
cmp "$work/x.glsl" "$work/hybrid_8x4_rotated.alone.glsl" || fail "standalone differs"
status 0 "$hnbrdf" export "$model" --materials 'blue fabric' -o -
grep -q 'HNBRDF_MATERIAL_COUNT 1$' "$work/out" || fail "--materials"
grep -q GOLD "$work/out" && fail "a material that was not asked for"
status 1 "$hnbrdf" export "$model" --materials nothing -o "$work/y.glsl"
status 1 "$hnbrdf" export "$work/x.glsl" -o "$work/y.glsl"
status 1 "$hnbrdf" export "$model" -o "$work/no/such/place.glsl"
status 2 "$hnbrdf" export "$model"
status 2 "$hnbrdf" export
[ -e "$work/y.glsl" ] && fail "a failed export leaves a file"

# Styles: what the library gives, the bytes of the block beside it, told at the top.
uneven=$work/half_uniform.safetensors
status 0 "$hnbrdf" export "$uneven" --weights uniform --precision half --weights-out "$work/w.bin" -o "$work/x.glsl"
cmp "$work/x.glsl" "$work/half_uniform.glsl" || fail "--weights uniform --precision half differs"
vectors=$(sed -n 's/.*hnbrdf_weights\[\([0-9]*\)\]; };$/\1/p' "$work/x.glsl")
[ "$(wc -c <"$work/w.bin")" = $((16 * vectors)) ] || fail "the block has another size than the shader's"
grep -q '^//   weights .* in a uniform block$' "$work/x.glsl" || fail "the style is not told at the top"
grep -q '^//   precision  half' "$work/x.glsl" || fail "the precision is not told at the top"
status 0 "$hnbrdf" export "$uneven" --weights columns -o - 
grep -q 'as constants in columns' "$work/out" || fail "--weights columns"
status 2 "$hnbrdf" export "$uneven" --weights-out "$work/y.bin" -o "$work/y.glsl"
status 2 "$hnbrdf" export "$uneven" --weights none -o "$work/y.glsl"
status 1 "$hnbrdf" export "$work/ggx.safetensors" --weights uniform --weights-out "$work/y.bin" -o "$work/y.glsl"
[ -e "$work/y.bin" ] || [ -e "$work/y.glsl" ] && fail "a failed export leaves a file"

# Verify.
status 2 "$hnbrdf" verify
status 2 "$hnbrdf" verify "$model" --pairs 1
status 1 "$hnbrdf" verify "$work/missing.safetensors"
"$hnbrdf" verify --list --api vulkan >"$work/devices" 2>"$work/err" || { grep -q 'without Vulkan' "$work/err" && exit 0; fail "--list"; }
[ -s "$work/devices" ] || { echo "the rest skipped: no Vulkan device"; exit 77; }
PATH=/nonexistent status 1 "$hnbrdf" verify "$model" --device 0
grep -q glslang-tools "$work/out" || fail "a missing compiler is named with its package"
command -v glslangValidator >/dev/null || { echo "the rest skipped: no glslangValidator"; exit 77; }
status 0 "$hnbrdf" verify "$model" --device 0 --pairs 1024 --csv "$work/v.csv" --json "$work/v.json"
grep -q 'ns per evaluation\|not measured' "$work/out" || fail "no run time"
grep -q '"passed": true' "$work/v.json" || fail "json"
# 1 device, 3 materials, 2 builds, 7 stages
[ "$(wc -l <"$work/v.csv")" = 43 ] || fail "csv rows"
[ "$(head -1 "$work/v.csv" | tr ',' '\n' | wc -l)" = "$(tail -1 "$work/v.csv" | sed 's/"[^"]*"/quoted/g' | tr ',' '\n' | wc -l)" ] || fail "csv columns"
status 0 "$hnbrdf" verify "$uneven" --device 0 --pairs 256 --weights uniform --precision half --without-timing --json "$work/v.json"
grep -q '"weights": "uniform", "precision": "half"' "$work/v.json" || fail "json does not name the style"
status 0 "$hnbrdf" verify "$model" --device 0 --pairs 64 --stage fragment --materials 'blue fabric'
grep -q '^vulkan fragment device 0: ' "$work/out" || fail "--stage fragment"
status 1 "$hnbrdf" verify "$model" --device 99
status 2 "$hnbrdf" verify "$model" --device first

# Render: device and CPU, times of both, the comparison; the picture beside it.
render() { expected=$1; shift; status "$expected" "$hnbrdf" render "$@" --size 24 --spp 80 -o "$work/r.png"; }
render 0 "$model" --material gold-paint --device 0 --check
[ "$(grep -c 'ns a sample$' "$work/out")" = 2 ] || fail "no two times"
grep -q '^check: ' "$work/out" || fail "no comparison"
[ -s "$work/r.png" ] || fail "no picture"
rm "$work/r.png"
render 1 "$model" --material gold-paint --device 99
render 1 builtin:clear-coat-red --device 0
render 2 "$model" --material gold-paint --device first
render 2 "$model" --material gold-paint --device 0 --analytic
render 2 "$model" --material gold-paint --check
[ -e "$work/r.png" ] && fail "a failed rendering leaves a picture"
echo ok
