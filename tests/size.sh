#!/bin/sh
# size.sh BUILD MINIMAL COMPILER SCRATCH: the table of code sizes, in Markdown, from two finished builds: BUILD
# with what is to be listed, MINIMAL with every option off. Fails if evaluation and sampling take 128 KiB:
# 96 before a batch worked on two blocks at a time, 80 before edits carried the network along, 64 before there were
# batches of samples and densities.
set -eu
build=$1 minimal=$2 compiler=$3 scratch=$4
limit=131072

# stripped FILE: its size in bytes without symbols.
stripped() {
    strip -s -o "$scratch" "$1"
    wc -c < "$scratch" | tr -d ' '
    rm -f "$scratch"
}
row() {
    printf '| %s | %s | %s |\n' "$1" "$2" "$3"
}
# Code and constants of one object file, without the file around them.
code() {
    size "$1" | awk 'NR == 2 { print $1 + $2 }'
}

$compiler -shared -o "$scratch.so" "$minimal"/CMakeFiles/hnbrdf_objects.dir/src/core/*.o -lm
core=$(stripped "$scratch.so")
rm -f "$scratch.so"

row option what bytes
row --- --- ---
row "\`HNBRDF_WITH_VARIANTS=OFF\`" "evaluation and sampling alone (\`src/core\` as a shared library, stripped)" "$core"
row "\`HNBRDF_WITH_VARIANTS=OFF\`" "\`libhnbrdf.so\`: with model files, import and GLSL export (stripped)" \
    "$(stripped "$minimal/libhnbrdf.so")"
for object in "$build"/CMakeFiles/hnbrdf_objects.dir/src/core/kernel_*.o; do
    name=$(basename "$object" .c.o)
    [ "$name" = kernel_plain ] || row "\`HNBRDF_WITH_VARIANTS=ON\`" "adds ${name#kernel_}" "$(code "$object")"
done
row "\`HNBRDF_WITH_VARIANTS=ON\`" "\`libhnbrdf.so\` (stripped)" "$(stripped "$build/libhnbrdf.so")"
for part in measured metrics fit; do
    [ ! -e "$build/libhnbrdf_$part.so" ] ||
        row "\`HNBRDF_BUILD_FIT=ON\`" "adds \`libhnbrdf_$part.so\` (stripped)" \
            "$(stripped "$build/libhnbrdf_$part.so")"
done
[ ! -e "$build/hnbrdf" ] || row "\`HNBRDF_BUILD_CLI=ON\`" "adds the command (stripped, all of the above in it)" \
    "$(stripped "$build/hnbrdf")"

[ "$core" -lt $limit ] || {
    echo "size.sh: evaluation and sampling take $core bytes, expected less than $limit" >&2
    exit 1
}
