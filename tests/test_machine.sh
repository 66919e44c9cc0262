#!/bin/sh
# test_machine.sh MACHINE SOURCE SCRATCH VARIANTS PORTABLE SEEDS: another machine gives the bits of this one.
# MACHINE is aarch64, i686 (32 bits) or s390x (the highest byte first). The libraries, test_core_variants and
# portable are cross-compiled and run, under qemu-user where this machine cannot; what they print must be what
# VARIANTS and PORTABLE print, the same programs built for this machine: checksums of every value and sample, of
# model files, shaders, texels, and of what the readers make of MERL, RGL, UTIA and .brdf files. SEEDS: files that
# fuzz_seeds wrote. Skipped (77) without cross compiler or emulator.
set -eu
machine=$1 source=$2 scratch=$3 variants=$4 portable=$5 seeds=$6
name="test_machine $machine"
# shellcheck source=library_support.sh
. "$source/tests/library_support.sh"

case $machine in
aarch64) emulators="qemu-aarch64-static qemu-aarch64" flags="" packages=arm64 kernel=neon ;;
# As src/arithmetic.cmake chooses for the library.
i686) emulators="qemu-i386-static qemu-i386" flags="-msse2 -mfpmath=sse" packages=i386 kernel=sse2 ;;
s390x) emulators="qemu-s390x-static qemu-s390x" flags="-fexcess-precision=fast" packages=s390x kernel=plain ;;
*) fail "expected aarch64, i686 or s390x" ;;
esac
compiler=$machine-linux-gnu-gcc
command -v "$compiler" > /dev/null || skip "no $compiler (package gcc-$machine-linux-gnu)"
mkdir -p "$scratch"
echo 'int main(void) { return 0; }' | $compiler -static -x c - -o "$scratch/probe" 2> /dev/null ||
    skip "$compiler cannot link (package libc6-dev-$packages-cross)"
emulator=none
if "$scratch/probe" 2> /dev/null; then
    emulator=""
else
    for command in $emulators; do
        [ "$emulator" != none ] || emulator=$(command -v "$command") || emulator=none
    done
fi
[ "$emulator" != none ] || skip "no ${emulators% *} (package qemu-user-static)"

library hnbrdf_measured_static -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR="$machine" \
    -DCMAKE_C_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release -DHNBRDF_BUILD_FIT=ON
for program in test_core_variants portable; do
    # shellcheck disable=SC2086 # $flags is words
    program $program "$compiler" -static -O2 $flags
done
model=$source/examples/models/rgl_32x2.safetensors
$emulator "$scratch/test_core_variants" > "$scratch/there" || fail "the variants differ among themselves"
"$variants" > "$scratch/here" || fail "the variants differ here"
cat "$scratch/there"
grep -q "^$kernel " "$scratch/there" || fail "no variant $kernel"
[ "$(sed 's/.* //' "$scratch/there" "$scratch/here" | sort -u | wc -l)" = 1 ] || fail "the checksums differ"
$emulator "$scratch/portable" "$seeds" "$model" "$scratch/work" > "$scratch/there" || fail "portable"
"$portable" "$seeds" "$model" "$scratch/work" > "$scratch/here" || fail "portable here"
[ "$(wc -l < "$scratch/here")" -gt 80 ] || fail "portable prints too little"
diff "$scratch/here" "$scratch/there" || fail "the same files give something else (<: here, >: there)"
echo "portable: $(wc -l < "$scratch/there") lines, all the same"
rm -rf "$scratch"
