#!/bin/sh
# test_windows.sh SOURCE SCRATCH VARIANTS: the libraries cross-compile with MinGW without
# a warning, static and as DLLs, and give under wine the bits of this machine, as VARIANTS
# (test_core_variants) has them. A model is saved over an old one and by a UTF-8 name. Skipped (77)
# without MinGW; what needs wine is left out without it.
set -eu
source=$1 scratch=$2 variants=$3
name=test_windows
# shellcheck source=library_support.sh
. "$source/tests/library_support.sh"
compiler=x86_64-w64-mingw32-gcc
command -v $compiler > /dev/null || skip "no $compiler (package gcc-mingw-w64-x86-64)"
root=/usr/x86_64-w64-mingw32
library all -DCMAKE_SYSTEM_NAME=Windows -DCMAKE_SYSTEM_PROCESSOR=x86_64 \
    -DCMAKE_C_COMPILER=$compiler -DCMAKE_FIND_ROOT_PATH=$root \
    -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY \
    -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=ONLY -DHNBRDF_BUILD_FIT=ON
for file in libhnbrdf.a libhnbrdf.dll libhnbrdf.dll.a libhnbrdf_measured.a; do
    [ -e "$scratch/build/$file" ] || fail "no $file"
done
x86_64-w64-mingw32-objdump -p "$scratch/build/libhnbrdf.dll" > "$scratch/exports"
grep -q 'hnbrdf_eval$' "$scratch/exports" || fail "libhnbrdf.dll does not export hnbrdf_eval"
! grep -q 'hnbrdf_put$' "$scratch/exports" || fail "libhnbrdf.dll exports what is internal"
command -v wine > /dev/null || {
    echo "no wine: compiled and not run"
    rm -rf "$scratch"
    exit 0
}
export WINEDEBUG=-all WINEPREFIX="$scratch/wine"
cat > "$scratch/save.c" << 'C'
#include <hnbrdf/hnbrdf.h>
#include <stdio.h>
int main(void)
{
    static const char *const names[] = {"out", "out", "\xc3\xa4\xe2\x82\xac"};
    hnbrdf_model *model;
    hnbrdf_error error;
    if (hnbrdf_model_load("in", NULL, &model, &error))
        return puts(error.text), 1;
    for (int k = 0; k < 3; k++)
        if (hnbrdf_model_save(model, names[k], &error))
            return puts(error.text), 1;
    return 0;
}
C
for kind in static dll; do
    case $kind in
    static) use="-DHNBRDF_STATIC $scratch/build/libhnbrdf.a" ;;
    dll) use=$scratch/build/libhnbrdf.dll.a ;;
    esac
    folder=$scratch/$kind
    mkdir -p "$folder"
    # shellcheck disable=SC2086 # $use is words
    $compiler -I"$source/include" "$scratch/save.c" $use -o "$folder/save.exe"
    cp "$scratch/build/libhnbrdf.dll" "$folder"
    cp "$source/examples/models/rgl_32x2.safetensors" "$folder/in"
    (cd "$folder" && timeout 240 wine save.exe 2> /dev/null) || fail "saving, $kind"
    for file in out ä€; do
        cmp "$folder/in" "$folder/$file" || fail "$kind: $file differs from the model"
    done
done
program test_core_variants $compiler -O2
timeout 240 wine "$scratch/test_core_variants.exe" 2> /dev/null | tr -d '\r' > "$scratch/there" ||
    fail "test_core_variants"
"$variants" > "$scratch/here"
expected=$(sed -n 's/^plain //p' "$scratch/here")
found=$(sed -n 's/^plain //p' "$scratch/there")
[ -n "$expected" ] && [ "$found" = "$expected" ] || fail "values: $found, expected $expected"
wineserver -k 2> /dev/null || true # it would go on writing there
timeout 20 wineserver -w 2> /dev/null || true
rm -rf "$scratch" || { sleep 5; rm -rf "$scratch"; }
