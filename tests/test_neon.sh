#!/bin/sh
# test_neon.sh SOURCE SCRATCH NATIVE: the variants of 64-bit Arm give the bits of this machine's. The library
# and test_core_variants are cross-compiled and run under qemu-user; the checksums must equal those that
# NATIVE, the same test built for this machine, prints. Skipped (77) without cross compiler or emulator.
set -eu
source=$1 scratch=$2 native=$3
compiler=aarch64-linux-gnu-gcc

fail() {
    echo "test_neon: $*" >&2
    exit 1
}
emulator=
for name in qemu-aarch64-static qemu-aarch64; do
    [ -n "$emulator" ] || emulator=$(command -v $name) || true
done
command -v $compiler > /dev/null || { echo "skipped: no $compiler (package gcc-aarch64-linux-gnu)"; exit 77; }
[ -n "$emulator" ] || { echo "skipped: no qemu-aarch64 (package qemu-user-static)"; exit 77; }
echo 'int main(void) { return 0; }' | $compiler -static -x c - -o "$scratch.probe" 2> /dev/null || {
    echo "skipped: $compiler cannot link (package libc6-dev-arm64-cross)"
    exit 77
}
rm -rf "$scratch" "$scratch.probe"

{
    cmake -S "$source" -B "$scratch" -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
        -DCMAKE_C_COMPILER=$compiler -DCMAKE_BUILD_TYPE=Release -DHNBRDF_WERROR=ON -DHNBRDF_BUILD_FIT=OFF \
        -DHNBRDF_BUILD_CLI=OFF -DHNBRDF_BUILD_TESTS=OFF -DHNBRDF_BUILD_EXAMPLES=OFF \
        -DHNBRDF_WITH_OPENEXR=OFF -DHNBRDF_WITH_VULKAN=OFF &&
        cmake --build "$scratch" --target hnbrdf_static &&
        $compiler -static -std=c11 -O2 -ffp-contract=off -DHNBRDF_STATIC -I"$source/include" \
            -I"$source/src" -I"$source/tests" "$source/tests/test_core_variants.c" \
            "$source/tests/variants_sweep.c" "$scratch/libhnbrdf.a" -lm -o "$scratch/variants"
} > "$scratch.log" 2>&1 || { cat "$scratch.log"; fail "build"; }
"$emulator" "$scratch/variants" > "$scratch/arm" || fail "the variants differ on aarch64"
"$native" > "$scratch/here" || fail "the variants differ here"
cat "$scratch/arm" "$scratch/here"
grep -q '^neon ' "$scratch/arm" || fail "the aarch64 build has no neon variant"
[ "$(sed 's/.* //' "$scratch/arm" "$scratch/here" | sort -u | wc -l)" = 1 ] || fail "the checksums differ"
rm -rf "$scratch" "$scratch.log"
