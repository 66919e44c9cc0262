#!/bin/sh
# coverage.sh [--fuzz] [--csv FILE] [--lines] [--least PERCENT]: which lines of src/ the tests run. Builds with gcc
# into build/coverage (or $HNBRDF_COVERAGE_BUILD), runs ctest (about ten minutes), and prints the share of lines that
# ran by directory and by file, with the number of those that did not. Fails below 90 %, or PERCENT, overall.
#   --fuzz       instead: which lines of the readers in tests/fuzz/readers.txt the fuzz corpus runs, that is seeds,
#                regressions and generated files, without any other test (two minutes). Fails if one file is below
#                95 %, or PERCENT.
#   --csv FILE   also write the table as CSV: file,lines,covered,missed,percent; directories end in /, the last
#                row is src/
#   --lines      also print each line that did not run
# What ran is counted by gcov over all programs: a line of a header counts as run where any of them ran it.
# Tests that other libraries or limits on files would upset when instrumented are left out; they call the command
# and the libraries as others do.
set -eu
cd "$(dirname "$0")/.."
root=$PWD
build=${HNBRDF_COVERAGE_BUILD:-$root/build/coverage}
csv="" lines=0 least="" fuzz=0
usage() {
    sed -n '2,/^set /s/^# //p' "$root/tests/coverage.sh"
}
while [ $# -gt 0 ]; do
    case $1 in
    --csv | --least)
        [ $# -gt 1 ] || {
            echo "coverage.sh: $1 needs a value" >&2
            exit 2
        }
        [ "$1" = --csv ] && csv=$2 || least=$2
        shift
        ;;
    --lines) lines=1 ;;
    --fuzz) fuzz=1 ;;
    -h | --help)
        usage
        exit 0
        ;;
    *)
        echo "coverage.sh: unknown argument $1" >&2
        usage >&2
        exit 2
        ;;
    esac
    shift
done
jobs=$(getconf _NPROCESSORS_ONLN 2> /dev/null || echo 2)
target=all
tests="-E ^(test_(exports|install|minimal|full_disk|races|compilers|glsl_languages)|test_machine_.*)"
if [ $fuzz = 1 ]; then
    target=hnbrdf_replays
    tests="-R ^fuzz_"
fi
: "${least:=$((fuzz ? 95 : 90))}"
mkdir -p "$build"

# A compiler cache that makes paths relative would hide the sources from gcov.
unset CCACHE_BASEDIR
{
    CC=gcc cmake -S . -B "$build" -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS="-O1 --coverage -fprofile-abs-path" \
        -DHNBRDF_BUILD_FIT=ON -DHNBRDF_BUILD_CLI=ON -DHNBRDF_BUILD_TESTS=ON -DHNBRDF_BUILD_EXAMPLES=ON &&
        cmake --build "$build" --target "$target" -j "$jobs"
} > "$build/build.log" 2>&1 || {
    tail -n 20 "$build/build.log" >&2
    echo "coverage.sh: the build failed, all of it in $build/build.log" >&2
    exit 1
}
find "$build" -name '*.gcda' -exec rm -f {} +
failed=0
# shellcheck disable=SC2086 # two words
ctest --test-dir "$build" $tests -j "$jobs" --timeout 1500 --output-on-failure || failed=1

# Each line of src/ that was compiled, from all objects: FILE TAB NUMBER TAB RAN TAB TEXT.
mkdir -p "$build/gcov"
find "$build" -name '*.gcda' > "$build/gcov/objects"
(cd "$build/gcov" && xargs gcov --stdout < objects 2> gcov.log) | awk -v root="$root/" '
    { split($0, part, ":"); number = part[2] + 0; text = substr($0, length(part[1]) + length(part[2]) + 3) }
    number == 0 && text ~ /^Source:/ {
        file = substr(text, 8)
        file = index(file, root "src/") == 1 ? substr(file, length(root) + 1) : ""
    }
    number > 0 && file != "" {
        gsub(/ /, "", part[1])
        if (part[1] == "-") next
        key = file "\t" number
        line[key] = text
        ran[key] += part[1] !~ /^[#=]/
    }
    END { for (key in line) print key "\t" (ran[key] > 0) "\t" line[key] }' | sort -t "$(printf '\t')" -k1,1 -k2,2n \
    > "$build/gcov/lines"
if [ $fuzz = 1 ]; then # the readers' own files
    grep -v '^[#-]' tests/fuzz/readers.txt | tr ' ' '\n' | grep '^src/' | sort -u > "$build/gcov/readers"
    awk -F '\t' 'NR == FNR { reader[$1] = 1; next } $1 in reader { print; seen[$1] = 1 }
        END { for (file in reader) if (!(file in seen)) print file "\t0\t0\tnot compiled or no such file" }' \
        "$build/gcov/readers" "$build/gcov/lines" | sort -t "$(printf '\t')" -k1,1 -k2,2n > "$build/gcov/own"
    mv "$build/gcov/own" "$build/gcov/lines"
fi
[ -s "$build/gcov/lines" ] || {
    echo "coverage.sh: gcov found no line of src/, see $build/gcov/gcov.log" >&2
    exit 1
}

awk -F '\t' '
    { total[$1]++; covered[$1] += $3; part = $1; sub(/[^\/]*$/, "", part) }
    { total[part]++; covered[part] += $3; total["src/"]++; covered["src/"] += $3 }
    END {
        for (name in total)
            printf "%s,%d,%d,%d,%.1f\n", name, total[name], covered[name], total[name] - covered[name],
                100 * covered[name] / total[name]
    }' "$build/gcov/lines" | sort -t , -k1,1 > "$build/gcov/table"
{
    echo "file,lines,covered,missed,percent"
    grep -v '^src/,' "$build/gcov/table" | { [ $fuzz = 1 ] && grep '\.[ch],' || cat; }
    grep '^src/,' "$build/gcov/table"
} > "$build/gcov/csv"
awk -F , '{ printf "%-34s %8s %8s %8s %8s\n", $1, $2, $3, $4, $5 }' "$build/gcov/csv"
[ $lines = 0 ] || awk -F '\t' '!$3 { print $1 ":" $2 ": " $4 }' "$build/gcov/lines"
if [ -n "$csv" ]; then
    cp "$build/gcov/csv" "$csv.tmp" && mv "$csv.tmp" "$csv"
fi
[ $failed = 0 ] || {
    echo "coverage.sh: tests failed" >&2
    exit 1
}
awk -F , -v least="$least" -v fuzz=$fuzz '(fuzz ? $1 ~ /\.[ch]$/ : $1 == "src/") && 100 * $3 / $2 < least {
    print "coverage.sh: " $5 " % of the lines of " $1 " ran, expected at least " least " %" > "/dev/stderr"
    bad = 1
}
END { exit bad }' "$build/gcov/table"
