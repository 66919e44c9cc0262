#!/bin/sh
# test_races.sh SOURCE SCRATCH COMPILER: no data race while eight threads do everything with one model, as
# ThreadSanitizer sees it (libhnbrdf alone). Skipped (77) where the compiler has none or it cannot run.
set -eu
source=$1 scratch=$2 compiler=$3
name=test_races
# shellcheck source=library_support.sh
. "$source/tests/library_support.sh"

mkdir -p "$scratch"
echo 'int main(void) { return 0; }' | $compiler -fsanitize=thread -x c - -o "$scratch/probe" 2> /dev/null ||
    skip "$compiler cannot link -fsanitize=thread"
# Older ones do not find their memory where the kernel places things too randomly.
run=""
"$scratch/probe" > "$scratch/log" 2>&1 || run="setarch $(uname -m) -R"
$run "$scratch/probe" > "$scratch/log" 2>&1 || skip "ThreadSanitizer does not run here: $(head -n 1 "$scratch/log")"

library hnbrdf_static -DCMAKE_C_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Debug -DHNBRDF_BUILD_FIT=OFF \
    -DCMAKE_C_FLAGS_DEBUG="-g1 -O1 -fsanitize=thread"
program test_threads "$compiler" -g1 -O1 -fsanitize=thread
TSAN_OPTIONS="halt_on_error=1 exitcode=66" $run "$scratch/test_threads" "$source/examples/models/rgl_32x2.safetensors" \
    "$scratch/work" || fail "a race, or values that differ"
rm -rf "$scratch"
