#!/bin/sh
# lint.sh [FILE...]: formatting and static analysis of all files of the repository, or of those named.
# clang-format 14 must change nothing in *.c, *.cc and *.h; no line of C or CMake is over 100 columns;
# clang-tidy 14 finds nothing in src/ (.clang-tidy says what it looks for and why). Configures
# build/lint (or $HNBRDF_LINT_BUILD) with clang; nothing is compiled. Exit status 1: something was found.
set -eu
cd "$(dirname "$0")/.."
case ${1:-} in
-h | --help)
    sed -n '2,/^set /s/^# //p' tests/lint.sh
    exit 0
    ;;
esac
build=${HNBRDF_LINT_BUILD:-build/lint}
jobs=$(getconf _NPROCESSORS_ONLN 2> /dev/null || echo 2)
failed=0

# the_14th TOOL: its version 14, the one whose word counts (other versions format otherwise).
the_14th() {
    for name in "$1-14" "$1"; do
        if command -v "$name" > /dev/null && "$name" --version | grep -q 'version 14\.'; then
            echo "$name"
            return
        fi
    done
    echo "lint.sh: no $1 14 (package $1-14)" >&2
    return 1
}
format=$(the_14th clang-format)
tidy=$(the_14th clang-tidy)

if [ $# -gt 0 ]; then
    all=$(printf '%s\n' "$@")
else
    all=$(find CMakeLists.txt .ci examples include shaders src tests -type f | sort)
fi
these() { # suffixes, as one regular expression
    echo "$all" | grep -E "$1" || true
}

sources=$(these '\.(c|h|cc)$')
# shellcheck disable=SC2086 # file names of ours have no blanks
if [ -n "$sources" ] && ! $format --dry-run --Werror $sources 2> /dev/null; then
    for file in $sources; do
        $format "$file" | cmp -s - "$file" || echo "$file: $format changes it (run $format -i $file)"
    done
    failed=1
fi

for file in $(these '(\.(c|h|cc|cmake|in)|CMakeLists\.txt)$'); do
    # Columns, not bytes: what continues a UTF-8 character takes none.
    LC_ALL=C awk -v file="$file" '{
        gsub(/[\200-\277]/, "")
        if (length($0) > 100) { print file ":" NR ": " length($0) " columns, expected at most 100"; bad = 1 }
    } END { exit bad }' "$file" || failed=1
done

analysed=$(these '^src/.*\.c$' | grep -v '/kernel_neon' || true)
if [ -n "$analysed" ]; then
    mkdir -p "$build"
    CC=clang cmake -S . -B "$build" -DHNBRDF_BUILD_TESTS=OFF -DHNBRDF_BUILD_EXAMPLES=OFF > "$build/log" 2>&1 || {
        cat "$build/log"
        exit 1
    }
    echo "$analysed" | xargs -P "$jobs" -n 8 "$tidy" -p "$build" --quiet --warnings-as-errors='*' \
        > "$build/found" 2> "$build/errors" || failed=1
    grep -E -A 4 'warning:|error:' "$build/found" | sed "s|$PWD/||" || true
    ! grep -E '^Error|error:' "$build/errors" || failed=1
fi
[ $failed = 0 ] || exit 1
echo "$(echo "$all" | wc -l) files, nothing found"
