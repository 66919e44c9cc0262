#!/bin/sh
# test_fast_math.sh PLAIN FAST MODEL: a renderer built with -ffast-math gets the numbers of one built without.
# Both are fast_math.c. Linked like that, FAST also runs with subnormals flushed where GCC does so: a direction
# whose z is subnormal is then below the horizon, so no such one is tried.
set -eu
plain=$1 fast=$2 model=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$plain" "$model" >"$work/plain"
"$fast" "$model" >"$work/fast"
[ "$(wc -l <"$work/plain")" -gt 1000 ] || { echo "failed: too few numbers"; exit 1; }
cmp "$work/plain" "$work/fast" || { diff "$work/plain" "$work/fast" | head -n 4; exit 1; }
echo "$(wc -l <"$work/plain") lines, all the same bits"
