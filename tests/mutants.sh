#!/bin/sh
# mutants.sh: do the tests notice small changes of the sources? Run with --help for how.
set -u
LC_ALL=C
export LC_ALL

usage() {
    cat <<'END'
usage: sh tests/mutants.sh [options] FILE...

Makes small changes ("mutants") to the given C files, one at a time: a comparison, an operator, a
sign or a constant changed, a statement left out. For each it builds what changed and runs the tests
that cover the file, quickest first, until one fails. A mutant that no test notices shows what the
tests do not hold. Works in copies of the tree in a scratch folder; your tree is not touched.

  --count N     only N of all mutants of the files, chosen by the seed (default: all)
  --seed S      which ones (default: 1)
  --list        print the mutants and stop
  --jobs N      N copies at a time (default: 1)
  --results F   write one line a mutant to F as it goes; lines already there are not run again
  --build CMD   build with CMD in the copy instead of CMake, and
  --test CMD    notice by CMD failing, instead of by the tests in tests/mutants_tests.txt

Mutants that do not compile are not counted, nor are those that tests/mutants_accepted.txt explains:
changes that leave every result the same. Exit status: 0 when every mutant is noticed or explained,
1 when some survive, 2 on an error.

  sh tests/mutants.sh src/core/half.h                   # every mutant of one file
  sh tests/mutants.sh --count 60 --seed 3 src/fit/*.c   # a sample of a room
  sh tests/mutants.sh --list src/core/pack.c
  sh tests/mutants.sh --build 'cc -Isrc -Iinclude tests/mine.c -lm -o t' --test ./t src/core/math.h
END
}

fail() {
    echo "mutants.sh: $*" >&2
    exit 2
}

# ---- Options -------------------------------------------------------------------------------------

root=$(cd "$(dirname "$0")/.." && pwd)
count=0 seed=1 list=0 jobs=1 results='' build_command='' test_command='' files=''
while [ $# -gt 0 ]; do
    case $1 in
    --help | -h) usage; exit 0 ;;
    --list) list=1 ;;
    --count | --seed | --jobs | --results | --build | --test)
        [ $# -gt 1 ] || fail "$1 needs a value"
        case $1 in
        --count) count=$2 ;;
        --seed) seed=$2 ;;
        --jobs) jobs=$2 ;;
        --results) results=$2 ;;
        --build) build_command=$2 ;;
        --test) test_command=$2 ;;
        esac
        case $1 in
        --count | --seed | --jobs)
            case $2 in '' | *[!0-9]*) fail "$1 is '$2', expected a whole number" ;; esac ;;
        esac
        shift ;;
    -*) fail "unknown option '$1'; see --help" ;;
    *)
        path=$(cd "$(dirname "$1")" 2>/dev/null && pwd)/${1##*/}
        [ -f "$path" ] || fail "$1: no such file"
        case $path in
        "$root"/*) files="$files ${path#"$root"/}" ;;
        *) fail "$1: not in $root" ;;
        esac ;;
    esac
    shift
done
[ -n "$files" ] || { usage >&2; exit 2; }
[ "$jobs" -ge 1 ] || fail "--jobs is '$jobs', expected at least 1"
[ -z "$build_command$test_command" ] || { [ -n "$build_command" ] && [ -n "$test_command" ]; } ||
    fail "--build and --test go together"

scratch=$(mktemp -d "${TMPDIR:-/tmp}/hnbrdf-mutants.XXXXXX") || fail "no scratch folder"
workers=''
stop() {
    # shellcheck disable=SC2086
    [ -z "$workers" ] || kill $workers 2> /dev/null
    wait
    rm -rf "$scratch"
}
trap stop EXIT
trap 'exit 2' INT TERM HUP
${CC:-cc} -std=c11 -O1 "$root/tests/mutate.c" -o "$scratch/mutate" || fail "mutate.c does not compile"

# ---- The mutants ---------------------------------------------------------------------------------

# file, number, line, change, text; the second of equal changes in a line is marked #2 and so on.
tab=$(printf '\t')
for file in $files; do
    (cd "$root" && "$scratch/mutate" list "$seed" "$file") | awk -F'\t' -v OFS='\t' -v file="$file" '{
        change = $4 " -> " $5
        n = ++seen[$3, change]
        print $2, file, $1, $3, change (n > 1 ? " #" n : ""), $6 }'
done > "$scratch/all"
if [ "$count" -gt 0 ]; then
    sort "$scratch/all" | head -n "$count"
else
    cat "$scratch/all"
fi | cut -f2- | sort -t "$tab" -k1,1 -k2,2n > "$scratch/chosen"
if [ "$list" = 1 ]; then
    awk -F'\t' '{ printf "%s:%s: %s: %s\n", $1, $3, $4, $5 }' "$scratch/chosen"
    exit 0
fi

# Explained ones leave. The lines of mutants_accepted.txt: file, change, text, reason, by tabs.
accepted=$root/tests/mutants_accepted.txt
[ -f "$accepted" ] || accepted=/dev/null
awk -F'\t' -v accepted="$accepted" '
    BEGIN { while ((getline line < accepted) > 0)
                if (line !~ /^#/ && split(line, f, "\t") >= 4) known[f[1], f[2], f[3]] = 1 }
    ($1, $4, $5) in known { explained++; next }
    { print }
    END { print explained + 0 > "/dev/stderr" }' "$scratch/chosen" \
    > "$scratch/open" 2> "$scratch/explained"

[ -n "$results" ] || results=$scratch/results
touch "$results" || fail "$results: cannot be written"
awk -F'\t' -v results="$results" '
    BEGIN { while ((getline line < results) > 0) { split(line, f, "\t"); done[f[2], f[4], f[5], f[6]] = 1 } }
    !(($1, $3, $4, $5) in done)' "$scratch/open" > "$scratch/left"

# ---- Building and testing ------------------------------------------------------------------------

# One copy. What is built: no optional part, little optimisation, traps on what is out of bounds; the
# AVX2 kernel beside the plain one only for the text of the kernels, which is one text; and only the
# library behind a room, for it is linked again for every mutant.
link="hnbrdf_fit_static hnbrdf_metrics_static" variants=OFF narrow=1
kernels='-DHNBRDF_COMPILES_SSE2=OFF -DHNBRDF_COMPILES_AVX512=OFF'
for file in $files; do
    case $file in
    src/core/kernel*) variants=ON ;;
    src/core/variant*) variants=ON kernels='' ;;
    esac
    case $file in
    src/base/* | src/core/* | src/lobes/* | src/file/* | src/model/*) ;;
    *) narrow=0 ;;
    esac
done
[ $narrow = 0 ] || link=hnbrdf_static

prepare() {
    mkdir -p "$1"
    (cd "$root" && tar cf - CMakeLists.txt README.md LICENSE .clang-format include src shaders tests \
        examples) | (cd "$1" && tar xf -)
    [ -z "$build_command" ] || return 0
    sed "s/hnbrdf_fit_static hnbrdf_metrics_static/$link/; s/CONFIGURE_DEPENDS//" \
        "$root/tests/CMakeLists.txt" > "$1/tests/CMakeLists.txt" || return 1
    traps=-fsanitize=bounds,shift,integer-divide-by-zero
    # shellcheck disable=SC2086
    cmake -S "$1" -B "$1/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug \
        -DCMAKE_C_FLAGS_DEBUG="-O1 -w $traps -fsanitize-undefined-trap-on-error -include $1/tests/mutant.h" \
        -DHNBRDF_WITH_VULKAN=OFF -DHNBRDF_WITH_EMBREE=OFF -DHNBRDF_WITH_OPENEXR=OFF \
        -DHNBRDF_BUILD_EXAMPLES=OFF -DHNBRDF_BUILD_TESTS=ON -DHNBRDF_WERROR=OFF \
        -DHNBRDF_WITH_VARIANTS=$variants $kernels > "$1.log" 2>&1
}

tests_of() {
    awk -v file="$1" '!/^#/ && index(file, $1) == 1 { for (i = 2; i <= NF; i++) print $i; exit }' \
        "$root/tests/mutants_tests.txt"
}

# The target behind a test: a program of its own, or the command.
target_of() {
    for name in "$2" "hnbrdf_$2"; do
        if ninja -C "$1/build" -t query "$name" > /dev/null 2>&1; then
            echo "$name"
            return
        fi
    done
    echo hnbrdf_cli
}

build_one() { # copy test
    if [ -n "$build_command" ]; then
        (cd "$1" && sh -c "$build_command") > "$1.log" 2>&1
    else
        ninja -C "$1/build" -j1 "$(cat "$1.target.$2")" > "$1.log" 2>&1
    fi
}

test_one() { # copy test limit
    if [ -n "$test_command" ]; then
        (cd "$1" && timeout "$3" sh -c "$test_command") > "$1.log" 2>&1
    else
        ctest --test-dir "$1/build" -R "^$2\$" --timeout "$3" --no-tests=error > "$1.log" 2>&1
    fi
}

# The tests of a file that exist in this build.
known_tests() { # copy file
    if [ -n "$build_command" ]; then
        echo command
        return
    fi
    for test in $(tests_of "$2"); do
        grep -q "^add_test(\[*=*\[*\"*$test\]*=*\]*\"* " "$1"/build/tests/CTestTestfile.cmake && echo "$test"
    done
}

# Which tests cover the files, and what to build for them.
find_tests() { # copy
    for file in $(cut -f1 "$scratch/left" | sort -u); do
        tests=$(known_tests "$1" "$file")
        [ -n "$tests" ] || { echo "$file: no test covers it: see tests/mutants_tests.txt" >&2; return 1; }
        echo "$tests" > "$1.tests.$(echo "$file" | tr / .)"
        for test in $tests; do
            [ -n "$build_command" ] || target_of "$1" "$test" > "$1.target.$test"
        done
    done
}

# All tests pass before anything is changed; how long each takes sets its limit.
rehearse() { # copy
    for test in $(cat "$1".tests.* | sort -u); do
        build_one "$1" "$test" || { cat "$1.log" >&2; return 1; }
        began=$(date +%s)
        test_one "$1" "$test" 600 || { tail -n 40 "$1.log" >&2; return 1; }
        echo $((10 + 5 * ($(date +%s) - began))) > "$1.limit.$test"
    done
}

judge() { # copy file: noticed by ..., survived or uncompiled
    [ -d "$1/src" ] || exit 2
    for test in $(cat "$1.tests.$(echo "$2" | tr / .)"); do
        build_one "$1" "$test" || { echo uncompiled; return; }
        test_one "$1" "$test" "$(cat "$1.limit.$test")" || { echo "noticed by $test"; return; }
    done
    echo survived
}

# ---- Many changes in one build -------------------------------------------------------------------

# The variable that chooses, read from the environment of the copies alone.
add_variable() { # copy
    cat >> "$1/src/core/strerror.c" <<'END'
#include <stdlib.h>
int hnbrdf_mutant = -1;
__attribute__((constructor)) static void choose_mutant(void)
{
    const char *text = getenv("HNBRDF_MUTANT");
    if (text)
        hnbrdf_mutant = atoi(text);
}
END
}

leave_apart() { # list: what is in list.apart goes from list.in
    awk -F'\t' -v apart="$1.apart" '
        BEGIN { while ((getline line < apart) > 0) { split(line, f, "\t"); gone[f[6]] = 1 } }
        !($6 in gone)' "$1.in" > "$1.left"
    mv "$1.left" "$1.in"
}

# Sources with all changes of list.in in them; what cannot be switched goes to list.apart.
write_switches() { # copy list
    for file in $(cut -f1 "$2" | sort -u); do
        awk -F'\t' -v file="$file" '$1 == file { print $2, $6 }' "$2.in" |
            "$scratch/mutate" switch 0 "$root/$file" > "$1/$file" 2> "$2.not"
        awk -F'\t' -v file="$file" -v not="$2.not" '
            BEGIN { while ((getline line < not) > 0) apart[line] = 1 }
            $1 == file && $2 in apart' "$2.in" >> "$2.apart"
    done
    leave_apart "$2"
}

# Lines that do not compile with their switches, and after some rounds those around them, are left to
# builds of their own.
build_switches() { # copy list
    targets=$(cat "$1".target.* | sort -u)
    round=0
    while :; do
        write_switches "$1" "$2"
        # shellcheck disable=SC2086
        ninja -C "$1/build" -j1 -k0 $targets > "$1.log" 2>&1 && return 0
        sed -n -e 's|^.*\(src/[^:]*\):\([0-9]*\):[0-9]*: error.*|\1\t\2|p' \
            -e 's|^.*\(src/[^:]*\):\([0-9]*\):[0-9]*: note: in expansion.*|\1\t\2|p' "$1.log" |
            sort -u > "$2.lines"
        [ -s "$2.lines" ] && [ "$round" -lt 12 ] || return 1
        awk -F'\t' -v lines="$2.lines" -v reach="$((round / 4))" '
            BEGIN { while ((getline line < lines) > 0) {
                        split(line, f, "\t")
                        for (d = -reach; d <= reach; d++) bad[f[1], f[2] + d] = 1 } }
            ($1, $3) in bad' "$2.in" >> "$2.apart"
        leave_apart "$2"
        round=$((round + 1))
    done
}

note() { # verdict file number line change text
    printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$@" >> "$results"
}

judge_switched() { # copy id file
    for test in $(cat "$1.tests.$(echo "$3" | tr / .)"); do
        HNBRDF_MUTANT=$2 test_one "$1" "$test" "$(cat "$1.limit.$test")" ||
            { echo "noticed by $test"; return; }
    done
    echo survived
}

# Those that can be switched; the others stay in list.apart.
work_switched() { # copy list
    awk -F'\t' -v OFS='\t' '{ print $1, $2, $3, $4, $5, NR }' "$2" > "$2.in"
    : > "$2.apart"
    if build_switches "$1" "$2"; then
        rehearse "$1" || return 1
        touch "$1.rehearsed"
        while IFS="$tab" read -r file number line change text id; do
            note "$(judge_switched "$1" "$id" "$file")" "$file" "$number" "$line" "$change" "$text"
        done < "$2.in"
    else
        awk -F'\t' -v OFS='\t' '{ print $1, $2, $3, $4, $5, NR }' "$2" > "$2.apart"
    fi
    for file in $(cut -f1 "$2" | sort -u); do
        cp "$root/$file" "$1/$file"
    done
    [ -f "$1.rehearsed" ] || rehearse "$1"
}

work() { # copy list
    prepare "$1" || { cat "$1.log" >&2; return 1; }
    [ -n "$build_command" ] || add_variable "$1"
    find_tests "$1" || return 1
    cp "$2" "$2.apart"
    if [ -n "$build_command" ]; then
        rehearse "$1" || return 1
    else
        work_switched "$1" "$2" || return 1
    fi
    while IFS="$tab" read -r file number line change text id; do
        "$scratch/mutate" apply "$number" "$root/$file" > "$1/$file"
        verdict=$(judge "$1" "$file")
        cp "$root/$file" "$1/$file"
        note "$verdict" "$file" "$number" "$line" "$change" "$text"
    done < "$2.apart"
}

if [ -s "$scratch/left" ]; then
    job=0
    while [ "$job" -lt "$jobs" ]; do
        awk -v n="$jobs" -v k="$job" 'NR % n == k' "$scratch/left" > "$scratch/left.$job"
        work "$scratch/tree.$job" "$scratch/left.$job" &
        workers="$workers $!"
        job=$((job + 1))
    done
    for worker in $workers; do
        wait "$worker" || fail "the unchanged tree does not build or pass its tests"
    done
    workers=''
fi

# ---- Report --------------------------------------------------------------------------------------

awk -F'\t' -v results="$results" -v explained="$(cat "$scratch/explained")" '
    BEGIN { while ((getline line < results) > 0) { split(line, f, "\t"); verdict[f[2], f[4], f[5], f[6]] = f[1] } }
    { v = verdict[$1, $3, $4, $5]
      if (v == "" || v == "uncompiled") { uncompiled++; next }
      if (!($1 in all)) order[++files] = $1
      all[$1]++; total++
      if (v ~ /^noticed/) { noticed[$1]++; good++ }
      else survivors[++bad] = sprintf("%s:%s: %s: %s", $1, $3, $4, $5) }
    END { printf "%-32s %8s %8s %7s\n", "file", "mutants", "noticed", "share"
          for (i = 1; i <= files; i++) {
              name = order[i]
              printf "%-32s %8d %8d %6.1f%%\n", name, all[name], noticed[name],
                  100 * noticed[name] / all[name] }
          printf "%-32s %8d %8d %6.1f%%\n", "all", total, good, total ? 100 * good / total : 100
          printf "%d do not compile, %d are explained in tests/mutants_accepted.txt\n", uncompiled, explained
          if (bad) print "survivors:"
          for (i = 1; i <= bad; i++) print survivors[i]
          exit bad > 0 }' "$scratch/open"
