#!/bin/sh
# test_compilers.sh SOURCE SCRATCH VARIANTS: gcc and clang give the same bits at -O0, -O1, -O2 and -O3, which are
# those of VARIANTS, test_core_variants as it was built here. What evaluates is compiled anew each time, with the
# plain kernel alone; the other kernels have their flags from CMake and are compared with it in every build.
set -eu
source=$1 scratch=$2 variants=$3
name=test_compilers
# shellcheck source=library_support.sh
. "$source/tests/library_support.sh"

rm -rf "$scratch"
mkdir -p "$scratch"
expected=$("$variants" | sed -n 's/^plain //p')
[ -n "$expected" ] || fail "$variants prints no checksum of the plain variant"
compared=0
for compiler in gcc clang; do
    command -v $compiler > /dev/null || {
        echo "no $compiler: left out"
        continue
    }
    for level in 0 1 2 3; do
        program=$scratch/$compiler$level
        $compiler -std=c11 -O$level -ffp-contract=off -DHNBRDF_STATIC -I"$source/include" -I"$source/src" \
            -I"$source/tests" "$source"/src/core/[!k]*.c "$source/src/core/kernel_plain.c" \
            "$source"/src/model/*.c "$source/src/base/text.c" "$source/tests/test_core_variants.c" \
            "$source/tests/variants_sweep.c" -lm -o "$program" > "$scratch/log" 2>&1 || {
            cat "$scratch/log"
            fail "$compiler -O$level: does not compile"
        }
        "$program" > "$scratch/found" || fail "$compiler -O$level: differs from the definition"
        found=$(sed -n 's/^plain //p' "$scratch/found")
        echo "$compiler -O$level $found"
        [ "$found" = "$expected" ] || fail "$compiler -O$level: $found, expected $expected"
        compared=$((compared + 1))
    done
done
[ $compared -gt 0 ] || skip "no gcc and no clang"
rm -rf "$scratch"
