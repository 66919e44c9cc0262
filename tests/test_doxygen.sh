#!/bin/sh
# test_doxygen.sh SOURCE: doxygen finds everything in the public headers documented, and warns of nothing; every
# function that they declare is in what it writes, with the sentences of its comment.
set -u
source=$1
command -v doxygen > /dev/null || { echo "skipped: no doxygen"; exit 77; }
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
failures=0
fail() {
    echo "test_doxygen: $*" >&2
    failures=$((failures + 1))
}

# documented SOURCE: runs doxygen on it as the target `docs` does, but for XML; what it says is in log.
documented() {
    sed -e "s|@PROJECT_SOURCE_DIR@|$1|g; s|@HNBRDF_DOCS_DIR@|$scratch|; s|@HNBRDF_DOCS_XML@|YES|; s|@PROJECT_VERSION@|0|" \
        -e '$aGENERATE_HTML = NO' "$1/src/Doxyfile.in" > "$scratch/Doxyfile"
    rm -rf "$scratch/xml"
    doxygen "$scratch/Doxyfile" > "$scratch/log" 2>&1
}
documented "$source" || fail "doxygen fails"
[ ! -s "$scratch/log" ] || fail "doxygen warns: $(head -n 5 "$scratch/log")"

cat "$source"/include/hnbrdf/*.h | tr '\n' ' ' | grep -oE 'HNBRDF_(API|EXPERIMENTAL) [^;(]*\(' |
    sed -n 's/.*[ *]\(hnbrdf_[a-z0-9_]*\)($/\1/p' | sort -u > "$scratch/declared"
cat "$scratch"/xml/*.xml | tr '\n' ' ' | sed 's/<memberdef /\n&/g' | grep 'kind="function"' |
    grep -E '<(brief|detailed)description> *<para>' | sed -n 's/.*<name>\(hnbrdf_[a-z0-9_]*\)<.*/\1/p' | sort -u |
    comm -23 "$scratch/declared" - > "$scratch/lost"
[ "$(wc -l < "$scratch/declared")" -gt 100 ] || fail "only $(wc -l < "$scratch/declared") functions are declared"
[ ! -s "$scratch/lost" ] || fail "without a text: $(tr '\n' ' ' < "$scratch/lost")"
cat "$scratch"/xml/*.xml | tr -s '\n ' ' ' | grep -q 'Every function that evaluates is pure: no allocation' ||
    fail "the comment of hnbrdf.h is lost"

# What is not documented is noticed.
mkdir -p "$scratch/copy/include" "$scratch/copy/src"
cp -r "$source/include/hnbrdf" "$scratch/copy/include"
cp "$source/src/Doxyfile.in" "$source/src/doxygen_filter.awk" "$scratch/copy/src"
sed -i '/^\/\* Free a model; NULL is allowed. \*\/$/d' "$scratch/copy/include/hnbrdf/hnbrdf.h"
! documented "$scratch/copy" && grep -q 'hnbrdf_model_free.* is not documented' "$scratch/log" ||
    fail "a function without a comment is not noticed: $(head -n 3 "$scratch/log")"
[ "$failures" -eq 0 ] || exit 1
echo "passed, $(wc -l < "$scratch/declared") functions"
