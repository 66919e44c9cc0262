#!/bin/sh
# test_minimal.sh SOURCE BUILD COMPILER SCRATCH [cmake arguments...]: with every option off, libhnbrdf alone is
# built and installed, and is small; prints what the options of BUILD add to it.
set -eu
source=$1 build=$2 compiler=$3 scratch=$4
shift 4

fail() {
    echo "test_minimal: $*" >&2
    exit 1
}
rm -rf "$scratch"
{
    cmake -S "$source" -B "$scratch" -DHNBRDF_BUILD_FIT=OFF -DHNBRDF_BUILD_CLI=OFF -DHNBRDF_BUILD_TESTS=OFF -DHNBRDF_BUILD_EXAMPLES=OFF \
        -DHNBRDF_WITH_OPENEXR=OFF -DHNBRDF_WITH_VULKAN=OFF -DHNBRDF_WITH_VARIANTS=OFF -DHNBRDF_WERROR=ON \
        -DCMAKE_C_COMPILER="$compiler" "$@" &&
        cmake --build "$scratch" && cmake --install "$scratch" --prefix "$scratch/prefix"
} > "$scratch.log" 2>&1 || { cat "$scratch.log"; fail "build"; }
built=$(find "$scratch/prefix" -type f | sed "s|$scratch/prefix/||" | sort)
echo "$built" | grep -q 'libhnbrdf\.a$' || fail "no libhnbrdf.a"
! echo "$built" | grep -E 'fit|measured|metrics|bin/' || fail "installed more than the core"
sh "$source/tests/size.sh" "$build" "$scratch" "$compiler" "$scratch.measured" || fail "size"
rm -rf "$scratch" "$scratch.log"
