#!/bin/sh
# run.sh [quick]: what must hold before a change is accepted. Stops at the first failure.
#   sh tests/run.sh         everything, as continuous integration runs it: installs what is missing,
#                           checks formatting, builds with gcc and clang without a warning, with parts
#                           left out, and with sanitizers, fuzzes the readers for a moment, and runs the
#                           tests, those of the release build last. Less than half an hour on two cores.
#   sh tests/run.sh quick   for daily work: builds the release in build/ and runs the tests that are
#                           labelled quick (tests/CMakeLists.txt lists the others). Less than three
#                           minutes where build/ is up to date.
# HNBRDF_FUZZ_SECONDS: how long each reader is fuzzed (5). tests/coverage.sh, tests/mutants.sh and
# tests/lint.sh are commands of their own.
set -eu
cd "$(dirname "$0")/.."
jobs=$(getconf _NPROCESSORS_ONLN 2> /dev/null || echo 2)
start=$(date +%s)
everything="-DHNBRDF_BUILD_FIT=ON -DHNBRDF_BUILD_CLI=ON -DHNBRDF_BUILD_TESTS=ON
    -DHNBRDF_BUILD_EXAMPLES=ON -DHNBRDF_WITH_OPENEXR=ON -DHNBRDF_WITH_VULKAN=ON
    -DHNBRDF_WITH_EGL=ON -DHNBRDF_WERROR=ON"
steps=7 step=0 quick=0 targets=""
case ${1:-} in
"") ;;
quick) quick=1 steps=2 ;;
-h | --help)
    sed -n '2,/^set /s/^# \{0,1\}//p' tests/run.sh
    exit 0
    ;;
*)
    echo "run.sh: unknown argument $1, expected quick or nothing (--help)" >&2
    exit 2
    ;;
esac

announce() {
    step=$((step + 1))
    echo "[$step/$steps] $1 ($(($(date +%s) - start)) s)"
}
fail() {
    echo "run.sh: FAILED in step $step/$steps: $1" >&2
    exit 1
}
# build COMPILER DIRECTORY cmake-arguments...: configures and builds, with Ninja where it is installed
# and the folder new (make starts two processes more for each of 300 targets); what was printed is
# shown on failure.
build() {
    compiler=$1 directory=$2
    shift 2
    mkdir -p "$directory"
    [ -e "$directory/CMakeCache.txt" ] || ! command -v ninja > /dev/null || set -- -G Ninja "$@"
    log=$directory/build.log
    # shellcheck disable=SC2086 # $everything is words; what comes later wins
    { CC=$compiler cmake -S . -B "$directory" $everything "$@" &&
        cmake --build "$directory" -j "$jobs" ${targets:+--target $targets}; } > "$log" 2>&1 || {
        grep -E -A 12 'error:|warning:|Error at|undefined' "$log" | head -n 60 >&2
        tail -n 10 "$log" >&2
        fail "building $directory, all of it in $log"
    }
}

if [ $quick = 1 ]; then
    announce "release build with gcc, warnings are errors"
    build gcc build -DCMAKE_BUILD_TYPE=Release
    announce "quick tests"
    exec ctest --test-dir build -L quick -j "$jobs" --output-on-failure
fi

echo "packages"
sh tests/packages.sh tests || fail "packages"

announce "formatting and static analysis"
sh tests/lint.sh || fail "formatting and static analysis"

announce "clang, warnings are errors"
# Built is what runs here; all files are compiled once for their warnings, which need no code, but for
# what is generated. (The commands are words of JSON.)
targets=$(ls tests/test_math*.c tests/test_core_*.c | sed 's,^tests/\(.*\)\.c$,hnbrdf_\1,')
build clang build/clang -DCMAKE_BUILD_TYPE=Release
targets=""
sed -n 's/^  "command": "\(.*\)",\{0,1\}$/\1/p' build/clang/compile_commands.json |
    sed '/-c [^ ]*\/generated\//d; s/\\"/"/g; s/\\\\/\\/g' > build/clang/commands
[ "$(wc -l < build/clang/commands)" -gt 400 ] || fail "no commands in build/clang/compile_commands.json"
tr '\n' '\0' < build/clang/commands |
    xargs -0 -n 1 -P "$jobs" sh -c 'eval "$1 -fsyntax-only"' sh > build/clang/warnings.log 2>&1 || {
    grep -E -A 12 'error:|warning:' build/clang/warnings.log | head -n 60 >&2
    fail "compiling with clang, all of it in build/clang/warnings.log"
}
ctest --test-dir build/clang -R '^test_(math|core_)' -j "$jobs" --output-on-failure \
    > build/clang/test.log 2>&1 || {
    cat build/clang/test.log
    fail "the core tests under clang"
}

announce "without Vulkan, OpenEXR and Embree"
build gcc build/plain -DCMAKE_BUILD_TYPE=Debug -DHNBRDF_WITH_OPENEXR=OFF -DHNBRDF_WITH_VULKAN=OFF \
    -DHNBRDF_WITH_EMBREE=OFF -DHNBRDF_BUILD_TESTS=OFF
build/plain/hnbrdf --help > /dev/null || fail "hnbrdf --help without Vulkan, OpenEXR and Embree"

announce "AddressSanitizer and UndefinedBehaviorSanitizer"
# libhdf5 and what it links keep memory at exit, which LeakSanitizer would count as ours.
build gcc build/sanitize -DCMAKE_BUILD_TYPE=RelWithDebInfo -DHNBRDF_SANITIZE=ON -DHNBRDF_WITH_HDF5=OFF
# Tests of what other programs make of our text or flags, of the tree itself, of a second driver, of
# how good long fits end (test_fit runs the same code), of statistics, and of long commands that
# call what other tests call too find nothing here that the release tests do not.
elsewhere='^test_(glsl_languages|web_.*|minimal|fit_divergence|fit_stiff|fit_horizon|mix_path|locale|.*_second_driver|rooms|habits)'
elsewhere="$elsewhere|^test_(sampling_density|glsl_sample|glsl_sampling_density|bench|bake_cli|gallery)\$"
elsewhere="$elsewhere|^test_(report|growth|gpu_script|report_sampling|report_editing|stability_cli|edit_properties|help_examples|help_pages|pages|path_tracer|doxygen|first_use)\$"
UBSAN_OPTIONS=print_stacktrace=1 ctest --test-dir build/sanitize -E "$elsewhere" -j "$jobs" \
    --output-on-failure || fail "tests under sanitizers"

seconds=${HNBRDF_FUZZ_SECONDS:-5}
announce "fuzzing every reader for $seconds s (HNBRDF_FUZZ_SECONDS)"
HNBRDF_FUZZ_JOBS=$jobs sh tests/fuzz/run.sh "$seconds" || fail "fuzzing"

announce "MemorySanitizer on what every reader but EXR makes of seeds and crashers"
HNBRDF_FUZZ_SANITIZERS=memory HNBRDF_FUZZ_JOBS=$jobs sh tests/fuzz/run.sh 1 ||
    fail "values that were never set"

announce "release build with gcc, warnings are errors"
build gcc build -DCMAKE_BUILD_TYPE=Release
ctest --test-dir build -j "$jobs" --output-on-failure || fail "tests"
sh tests/parity_summary.sh build/Testing/Temporary/LastTest.log
