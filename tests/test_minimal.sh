#!/bin/sh
# test_minimal.sh SOURCE SCRATCH [cmake arguments...]: with every option off, libhnbrdf alone is built and
# installed.
set -eu
source=$1 scratch=$2
shift 2

fail() {
    echo "test_minimal: $*" >&2
    exit 1
}
rm -rf "$scratch"
{
    cmake -S "$source" -B "$scratch" -DHNBRDF_BUILD_FIT=OFF -DHNBRDF_BUILD_CLI=OFF -DHNBRDF_BUILD_TESTS=OFF -DHNBRDF_BUILD_EXAMPLES=OFF \
        -DHNBRDF_WITH_OPENEXR=OFF -DHNBRDF_WITH_VULKAN=OFF -DHNBRDF_WERROR=ON "$@" &&
        cmake --build "$scratch" && cmake --install "$scratch" --prefix "$scratch/prefix"
} > "$scratch.log" 2>&1 || { cat "$scratch.log"; fail "build"; }
built=$(find "$scratch/prefix" -type f | sed "s|$scratch/prefix/||" | sort)
echo "$built" | grep -q 'libhnbrdf\.a$' || fail "no libhnbrdf.a"
! echo "$built" | grep -E 'fit|measured|metrics|bin/' || fail "installed more than the core"
rm -rf "$scratch" "$scratch.log"
