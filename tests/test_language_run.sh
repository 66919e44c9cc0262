#!/bin/sh
# test_language_run.sh HNBRDF SCENES MODEL: exported MSL gives the values of C: the parity body of `hnbrdf verify`, run as C++
# beside msl/metal_stdlib, which is not Apple's compiler. In the exact build every number has the bits of C.
set -eu
hnbrdf=$1 scenes=$2 model=$3
here=$(cd "$(dirname "$0")" && pwd)
for compiler in clang++ clang++-14 g++ ''; do
    [ -z "$compiler" ] || ! command -v "$compiler" > /dev/null || break
done
[ "$compiler" ] || { echo 'skipped: no C++ compiler'; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "test_language_run: $*" >&2; exit 1; }

# MODEL OPTIONS...: hands the case out, compiles and runs both builds, hands in.
try() {
    of=$1
    shift
    rm -rf "$work/case"
    "$hnbrdf" verify "$of" --language msl --pairs 256 --hand-out "$work/case" "$@" > /dev/null
    set -- -std=c++14 -ffp-contract=off -Wno-unknown-pragmas -I"$here/msl" -I"$work/case"
    [ ! -e "$work/case/weights.bin" ] || set -- "$@" -DCASE_WEIGHTS
    (
        cd "$work/case"
        for build in '' _exact; do
            "$compiler" "$@" -DCASE_SCENE="\"scene$build.msl\"" -DCASE_PARITY="\"parity$build.msl\"" \
                -DCASE_OUTPUTS="\"outputs$build.f32\"" ${build:+-DCASE_PROBE} "$here/msl/run.cc" -o run
            ./run
        done
        echo "C++ by $compiler" > device.txt
    )
    "$hnbrdf" verify "$of" --hand-in "$work/case" > "$work/said" || { cat "$work/said"; fail "$of is not within the bounds"; }
    [ "$(grep -c '^ *exact .* 100\.0000% .* ok$' "$work/said")" -ge 7 ] || { cat "$work/said"; fail "$of: not the bits of C"; }
    ! grep '^ *exact ' "$work/said" | grep -v ' 100\.0000% ' || fail "$of: not the bits of C"
}

"$scenes" "$work" msl > /dev/null
try "$model" --materials vch_silk_blue --weights columns
try "$work/hybrid_8x4_rotated.safetensors" --weights uniform
try "$work/edited.safetensors" --fixed
echo "parity: msl | C++, not Apple's compiler | $compiler | executed"
