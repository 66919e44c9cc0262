#!/bin/sh
# run.sh [SECONDS] [TARGET...]: fuzzes every reader, or those named, for so long each (default 60), or for
# $HNBRDF_FUZZ_EXECUTIONS if those are sooner done, in build/fuzz (or $HNBRDF_FUZZ_BUILD), one process a target and
# $HNBRDF_FUZZ_JOBS at a time (default 1). The corpora grow in build/fuzz/corpus/TARGET from run to run. What crashes,
# hangs for a minute, leaks or asks for a block above 1 GiB is kept in build/fuzz/crashers/TARGET; once it is
# understood it belongs in tests/fuzz/regressions/TARGET, which the tests replay. Exit status 1 if there is any. With
# HNBRDF_FUZZ_SANITIZERS=memory, in a build of its own (build/fuzz_memory), MemorySanitizer watches for values that
# were never set, in all targets but exr (and hdf5): the OpenEXR that is installed is not instrumented, so that all it writes
# would count as never set.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
sanitizers=${HNBRDF_FUZZ_SANITIZERS:-}
build=${HNBRDF_FUZZ_BUILD:-$root/build/fuzz${sanitizers:+_$sanitizers}}
jobs=${HNBRDF_FUZZ_JOBS:-1}
executions=${HNBRDF_FUZZ_EXECUTIONS:--1} # -1: no limit
seconds=60
case ${1:-} in
-h | --help)
    sed -n '2,/^set /s/^# //p' "$0"
    exit 0
    ;;
[0-9]*)
    seconds=$1
    shift
    ;;
esac
all=$(cd "$here" && ls fuzz_*.c | sed 's/^fuzz_\(.*\)\.c$/\1/' | tr '\n' ' ')
options="-DHNBRDF_WITH_HDF5=OFF" # libhdf5 is not instrumented; the tests replay what hdf5 generates
all=$(echo " $all " | sed 's/ hdf5 / /')
if [ "$sanitizers" = memory ]; then
    all=$(echo " $all " | sed 's/ exr / /')
    options="$options -DHNBRDF_WITH_OPENEXR=OFF"
fi
[ -z "$sanitizers" ] || options="$options -DHNBRDF_FUZZ_SANITIZERS=$sanitizers"
targets=${*:-$all}
for target in $targets; do
    case " $all " in
    *" $target "*) ;;
    *)
        echo "run.sh: no target $target; there are: $all" >&2
        exit 2
        ;;
    esac
done

mkdir -p "$build"
[ -e "$build/CMakeCache.txt" ] || ! command -v ninja > /dev/null || options="$options -G Ninja"
{
    # shellcheck disable=SC2086 # $options is words
    CC=clang CXX=clang++ cmake -S "$root" -B "$build" $options -DHNBRDF_BUILD_FUZZERS=ON -DHNBRDF_BUILD_FIT=ON -DHNBRDF_BUILD_CLI=ON \
        -DHNBRDF_BUILD_TESTS=OFF -DHNBRDF_BUILD_EXAMPLES=OFF -DHNBRDF_WITH_VULKAN=OFF -DHNBRDF_WITH_VARIANTS=OFF \
        -DCMAKE_BUILD_TYPE=None &&
        cmake --build "$build" --target hnbrdf_fuzzers -j "$(getconf _NPROCESSORS_ONLN 2> /dev/null || echo 2)"
} > "$build/build.log" 2>&1 || {
    grep -E -A 8 'error:|Error at' "$build/build.log" | head -n 40 >&2
    echo "run.sh: building the fuzzers failed, all of it in $build/build.log" >&2
    exit 1
}
"$build/fuzz_seeds" "$build/seeds"

# Values of libFuzzer's last status line: executions, coverage in edges, inputs in the corpus.
last() {
    sed -n "s/^#[0-9]*[^a-z]*[A-Za-z]* *cov: \([0-9]*\) ft: [0-9]* corp: \([0-9]*\).*/\1 \2/p" "$1" | tail -n 1
}

# fuzz TARGET: runs it and leaves DIRECTORY/TARGET.log and .status.
fuzz() {
    corpus=$build/corpus/$1 crashers=$build/crashers/$1 log=$build/$1.log
    mkdir -p "$corpus" "$crashers"
    regressions=$here/regressions/$1
    [ -d "$regressions" ] || regressions=
    quiet=0 status=0
    [ "$1" != csv ] || quiet=2 # the command prints why it refuses each input
    # shellcheck disable=SC2086 # no regressions: no argument
    UBSAN_OPTIONS=print_stacktrace=1 "$build/fuzz_$1" -max_total_time="$seconds" -runs="$executions" -timeout=60 \
        -report_slow_units=60 -malloc_limit_mb=1024 -rss_limit_mb=2560 -dict="$here/dictionaries/$1.txt" \
        -artifact_prefix="$crashers/" -close_fd_mask=$quiet -print_final_stats=1 \
        "$corpus" "$build/seeds/$1" $regressions > "$log" 2>&1 || status=$?
    echo "$status" > "$build/$1.status"
}

report() {
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$1.log")
    took=$(sed -n 's/^Done [0-9]* runs in \([0-9]*\) second.*/\1/p' "$build/$1.log")
    found=$(find "$build/crashers/$1" -type f | wc -l)
    # shellcheck disable=SC2046 # two words
    set -- "$1" $(last "$build/$1.log")
    printf '%-12s %12s executions %6s s %6s edges %6s inputs %4d crashers\n' "$1" "${runs:--}" "${took:--}" \
        "${2:--}" "${3:--}" "$found"
    if [ "$(cat "$build/$1.status")" != 0 ] || [ "$found" != 0 ]; then
        failed=1
        grep -E -A 12 'ERROR|runtime error|broken promise|SUMMARY' "$build/$1.log" | head -n 30
        echo "  kept in $build/crashers/$1, all of it in $build/$1.log"
    fi
}

failed=0 started=0 running="" start=$(date +%s)
count=$(echo "$targets" | wc -w)
collect() {
    wait # the targets of one batch take the same time
    for target in $running; do
        report "$target"
    done
    running=""
}
for target in $targets; do
    started=$((started + 1))
    left=$(((count - started + jobs) / jobs * seconds))
    [ "$seconds" -lt 5 ] || echo "[$started/$count] $target, at most $left s left ($(($(date +%s) - start)) s gone)" >&2
    rm -f "$build/$target.status"
    fuzz "$target" &
    running="$running $target"
    [ $((started % jobs)) != 0 ] || collect
done
collect
exit $failed
