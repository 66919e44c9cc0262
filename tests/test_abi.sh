#!/bin/sh
# test_abi.sh SOURCE BUILD SCRATCH: programs that were compiled with the last release (tests/data/abi.txt, written
# by abi.sh) go on working, or the version says that they do not: before 1.0 any difference needs another minor
# version; from 1.0 on what is added needs that too, and what is changed or gone, but for what is marked
# HNBRDF_EXPERIMENTAL, another major one. The number in the names of the shared libraries goes with it. Then the
# same judgement of headers that were changed on purpose.
set -eu
source=$1 build=$2 scratch=$3
name=test_abi

fail() {
    echo "$name: $*" >&2
    exit 1
}
rm -rf "$scratch"
mkdir -p "$scratch"

# judge RECORD NOW: 0 where the version of NOW allows its differences from RECORD; else 1, with the reason.
judge() {
    grep -v '^version' "$1" > "$scratch/before"
    grep -v '^version' "$2" > "$scratch/after"
    LC_ALL=C comm -23 "$scratch/before" "$scratch/after" > "$scratch/gone"
    LC_ALL=C comm -13 "$scratch/before" "$scratch/after" > "$scratch/new"
    # Members and values of types that only experimental functions take count as all others.
    grep -v '^HNBRDF_EXPERIMENTAL' "$scratch/gone" > "$scratch/broken" || true
    old=$(sed -n 's/^version //p' "$1") new=$(sed -n 's/^version //p' "$2")
    old_minor=${old#*.} new_minor=${new#*.}
    old_minor=${old_minor%%.*} new_minor=${new_minor%%.*}
    needs=none
    [ ! -s "$scratch/new" ] && [ ! -s "$scratch/gone" ] || needs=minor
    [ "${new%%.*}" = 0 ] || [ ! -s "$scratch/broken" ] || needs=major
    has=none
    [ "$old_minor" = "$new_minor" ] || has=minor
    [ "${old%%.*}" = "${new%%.*}" ] || has=major
    case $needs-$has in
    none-* | minor-minor | *-major) return 0 ;;
    esac
    {
        echo "version $old has become $new, but these differences need another $needs version (CMakeLists.txt and"
        echo "HNBRDF_VERSION_* in hnbrdf.h); < was, > is now:"
        sed 's/^/< /' "$scratch/gone"
        sed 's/^/> /' "$scratch/new"
    } | head -n 40
    return 1
}

sh "$source/tests/abi.sh" "$source/include" > "$scratch/now"
[ "$(grep -c '^HNBRDF_' "$scratch/now")" -gt 90 ] && [ "$(grep -c '^member' "$scratch/now")" -gt 200 ] ||
    fail "abi.sh finds few declarations"
judge "$source/tests/data/abi.txt" "$scratch/now" || fail "the interface is not that of its version"
echo "since $(sed -n 's/^version //p' "$source/tests/data/abi.txt"): $(wc -l < "$scratch/new") lines new," \
    "$(wc -l < "$scratch/gone") gone"

version=$(sed -n 's/^version //p' "$scratch/now")
case $version in 0.*) number=${version%.*} ;; *) number=${version%%.*} ;; esac
for library in "$build"/libhnbrdf*.so; do
    soname=$(objdump -p "$library" | sed -n 's/^ *SONAME *//p')
    [ "$soname" = "$(basename "$library").$number" ] || fail "$library is $soname, expected .so.$number"
done

# changed VERSION sed-expression: the judgement of headers with it, of another version.
changed() {
    rm -rf "$scratch/include"
    cp -r "$source/include" "$scratch/include"
    sed -i "s/^\(#define HNBRDF_VERSION_STRING\).*/\1 \"$1\"/; $2" "$scratch/include/hnbrdf/hnbrdf.h"
    sh "$source/tests/abi.sh" "$scratch/include" > "$scratch/changed"
    judge "$scratch/base" "$scratch/changed" > "$scratch/verdict"
}
of() { # VERSION: now, as if released under it
    sed "s/^version .*/version $1/" "$scratch/now" > "$scratch/base"
}
comment='s/^ \* One network/ * A network/'
function='s/^HNBRDF_API const char \*hnbrdf_version(void);/&\nHNBRDF_API int hnbrdf_added(int x);/'
layout='s/^    float scale\[HNBRDF_LOBES\];/    double scale[HNBRDF_LOBES];/'
value='s/^    HNBRDF_ERROR_ARGUMENT, /    HNBRDF_ERROR_NEW, HNBRDF_ERROR_ARGUMENT, /'
constant='s/^\(#define HNBRDF_MAX_LATENT\) 16/\1 17/'
takes() {
    changed "$@" || { cat "$scratch/verdict"; fail "refuses '$2' in $1"; }
}
refuses() {
    ! changed "$@" || fail "takes '$2' in $1"
    grep -q "$3" "$scratch/verdict" || { cat "$scratch/verdict"; fail "'$2' in $1: does not name $3"; }
}
of 0.2.0
takes 0.2.0 "$comment"
refuses 0.2.1 "$function" 'hnbrdf_added'
refuses 0.2.1 "$layout" 'member hnbrdf_lobes.share at 16 of'
takes 0.3.0 "$layout"
of 1.4.0
takes 1.5.0 "$function"
refuses 1.4.1 "$function" 'another minor version'
refuses 1.5.0 "$value" 'HNBRDF_ERROR_IO 3'
refuses 1.5.0 "$constant" 'another major version'
takes 2.0.0 "$value"
rm -rf "$scratch"
