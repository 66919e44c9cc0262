#!/bin/sh
# test_amalgamation.sh AMALGAMATION SCRATCH SEEDS MODEL LIBRARY PORTABLE VARIANTS: hnbrdf.c and hnbrdf.h of the
# folder AMALGAMATION compile as C99, C17 and C++17 by gcc and clang without a warning and without a flag of
# ours, and do what the library does to the bit: values of every variant, samples, densities, batches, files,
# imports, shaders, messages. PORTABLE and VARIANTS are the objects of portable and test_core_variants, in
# quotes; LIBRARY is libhnbrdf.a, and beside it what these need too. Exit 77: no gcc and no clang.
set -eu
amalgamation=$1 scratch=$2 seeds=$3 model=$4 library=$5 portable=$6 variants=$7
measured=$(dirname "$library")/libhnbrdf_measured.a
unset CFLAGS CXXFLAGS || true

fail() {
    echo "test_amalgamation: $*" >&2
    exit 1
}
rm -rf "$scratch"
mkdir -p "$scratch/expected"
strict="-Wall -Wextra -Wpedantic -Wshadow -Werror -I$amalgamation"
fused=""
! grep -qs -w fma /proc/cpuinfo || fused=-mfma # what contraction would use; other machines have it anyway

# link_and_run FOLDER OBJECT: what the two programs print, linked with OBJECT.
link_and_run() {
    # shellcheck disable=SC2086 # lists of objects
    {
        cc $portable "$2" "$measured" -lm -o "$1/portable" &&
            cc $variants "$2" "$measured" -lm -o "$1/variants" &&
            "$1/portable" "$seeds" "$model" "$1" && "$1/variants"
    } > "$1/output" 2> "$1/log" || {
        cat "$1/log" >&2
        echo "test_amalgamation: $1 does not link or run" >&2
        return 1
    }
    rm -f "$1/portable" "$1/variants"
}
# try NAME command...: compiled and compared with the library.
try() {
    mkdir -p "$scratch/$1"
    folder=$scratch/$1
    shift
    # shellcheck disable=SC2086 # $strict is words
    "$@" $strict -c "$amalgamation/hnbrdf.c" -o "$folder/hnbrdf.o" > "$folder/log" 2>&1 || {
        head -n 20 "$folder/log" >&2
        echo "test_amalgamation: $* fails" >&2
        return 1
    }
    link_and_run "$folder" "$folder/hnbrdf.o" || return 1
    cmp "$scratch/expected/output" "$folder/output" >&2 || {
        echo "test_amalgamation: $*: not the bits of the library" >&2
        return 1
    }
    echo "$*: $(wc -l < "$folder/output") lines, the same bits"
    rm -rf "$folder"
}
# by C-COMPILER C++-COMPILER LEVEL: every standard; as C17 with instructions that fuse products and sums.
by() {
    command -v "$1" > /dev/null || { echo "no $1: left out"; return 0; }
    # shellcheck disable=SC2086 # $fused is one word or none
    try "$1-c99" "$1" -std=c99 -O0 && try "$1-c17" "$1" -std=gnu17 $3 $fused || return 1
    command -v "$2" > /dev/null || { echo "no $2: left out"; return 0; }
    try "$1-c++17" "$2" -std=c++17 -O1 -x c++
}

command -v gcc > /dev/null || command -v clang > /dev/null || { echo "skipped: no gcc and no clang"; exit 77; }
link_and_run "$scratch/expected" "$library" || fail "the library itself"
by gcc g++ -O2 &
lane=$!
by clang clang++ -O1 || { wait $lane || true; exit 1; }
wait $lane || exit 1

# Arithmetic that is not ours is refused.
! cc -ffast-math -I"$amalgamation" -fsyntax-only "$amalgamation/hnbrdf.c" 2> "$scratch/log" ||
    fail "-ffast-math is taken"
grep -q 'add -fno-fast-math' "$scratch/log" || fail "-ffast-math: $(cat "$scratch/log")"

# Other machines: no warning, and nothing fused where the machine could.
if command -v x86_64-w64-mingw32-gcc > /dev/null; then
    # shellcheck disable=SC2086
    x86_64-w64-mingw32-gcc -std=c17 $strict -fsyntax-only "$amalgamation/hnbrdf.c" || fail "for Windows"
fi
if command -v aarch64-linux-gnu-gcc > /dev/null; then
    # shellcheck disable=SC2086
    aarch64-linux-gnu-gcc -std=gnu17 -O1 $strict -c "$amalgamation/hnbrdf.c" -o "$scratch/arm.o" ||
        fail "for 64-bit Arm"
    ! aarch64-linux-gnu-objdump -d "$scratch/arm.o" | grep -E '\sf(n?m(add|sub)|ml[as])\s' ||
        fail "for 64-bit Arm: products and sums are fused"
fi
rm -rf "$scratch"
