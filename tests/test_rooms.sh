#!/bin/sh
# test_rooms.sh SOURCE BUILD COMPILER SCRATCH: src/ is as the table in src/README.md says (rooms.sh), and rooms.sh
# notices each kind of disorder, planted in a small tree.
set -u
source=$1 build=$2 compiler=$3 scratch=$4
bad=0

fail() {
    echo "test_rooms: $*" >&2
    bad=1
}
sh "$source/tests/rooms.sh" "$source" "$build" || fail "src/ is not as src/README.md says"

# ---- What src/README.md says about evaluation alone ----
words() { tr -s ' \n()`,.' '\n' | sed '/^$/d' | sort; }
readme=$source/src/README.md
sed -n 's/.*`libhnbrdf` is the rooms `\([a-z ]*\)`.*/\1/p' "$readme" | words > "$scratch.said"
sed -n '/^hnbrdf_part(hnbrdf ROOMS/,/)/p' "$source/CMakeLists.txt" | tr '\n' ' ' |
    sed 's/.*(hnbrdf ROOMS//; s/ [A-Z].*//' | words > "$scratch.is"
[ -s "$scratch.said" ] && cmp -s "$scratch.said" "$scratch.is" ||
    fail "src/README.md: the rooms of libhnbrdf are $(tr '\n' ' ' < "$scratch.is")"
sed -n 's/.*these files of base: `\([^`]*\)`.*/\1/p' "$readme" | tr ' ' '\n' | sort > "$scratch.said"
sed -n '/set(HNBRDF_BASE_HNBRDF/,/)/p' "$source/src/rooms.cmake" | tr ' )' '\n\n' | sed -n 's|^src/base/||p' |
    sort > "$scratch.is"
[ -s "$scratch.said" ] && cmp -s "$scratch.said" "$scratch.is" ||
    fail "src/README.md: libhnbrdf needs of base $(tr '\n' ' ' < "$scratch.is")"
plain=$(ls "$source"/src/core/*.c | grep -v kernel_ | tr '\n' ' ')
# shellcheck disable=SC2086 # a list of files
"$compiler" -std=c11 -O1 -fPIC -shared -I"$source/include" -I"$source/src" -ffp-contract=off -Wl,-z,defs -o "$scratch.so" \
    $plain "$source/src/core/kernel_plain.c" "$source"/src/model/*.c "$source/src/base/text.c" -lm > "$scratch.log" 2>&1 ||
    fail "core, model and text.c do not suffice for evaluation: $(cat "$scratch.log")"
rm -f "$scratch.said" "$scratch.is" "$scratch.so" "$scratch.log"

# ---- A small tree without a fault ----
plant() {
    rm -rf "$scratch"
    mkdir -p "$scratch/tree/src/low" "$scratch/tree/src/high" "$scratch/tree/include/hnbrdf" "$scratch/objects"
    cd "$scratch/tree" || exit 2
    cat > src/README.md << 'END'
| room | what it is for | may use | doors |
|---|---|---|---|
| `low` | the ground | | door.h |
| `high` | the roof | low | |
END
    printf 'hnbrdf_room(low\n  one.c two.c)\nhnbrdf_room(high three.c)\n' > src/rooms.cmake
    echo 'int one(void);' > src/low/door.h
    echo 'int two(void);' > src/low/private.h
    : > include/hnbrdf/high.h
    printf '#include "low/door.h"\nint one(void) { return 1; }\n' > src/low/one.c
    printf '#include "low/private.h"\n#include "low/door.h"\nint two(void) { return one(); }\n' > src/low/two.c
    printf '#include "low/door.h"\nint three(void);\nint three(void) { return one(); }\n' > src/high/three.c
}
# notices NAME TEXT: rooms.sh refuses the tree as it is now, with TEXT in a line.
notices() {
    for file in src/*/*.c; do
        mkdir -p "$scratch/objects/$(dirname "$file")"
        "$compiler" -Isrc -Iinclude -c "$file" -o "$scratch/objects/$file.o" || fail "$1: does not compile"
    done
    sh "$source/tests/rooms.sh" . "$scratch/objects" > "$scratch/said" && [ -n "$2" ] && fail "$1 is not noticed"
    grep -qF "$2" "$scratch/said" || [ -z "$2" ] || fail "$1: expected '$2', found: $(cat "$scratch/said")"
    [ -n "$2" ] || [ ! -s "$scratch/said" ] || fail "$1: found: $(cat "$scratch/said")"
}
plant
notices "a tree without a fault" ""
plant && echo '#include "high/roof.h"' >> src/low/one.c && : > src/high/roof.h
notices "an include up" "src/low/one.c includes high/roof.h, but room low may not use high"
plant && echo '#include "hnbrdf/high.h"' >> src/low/one.c
notices "a public header of a room above" "src/low/one.c includes hnbrdf/high.h, but room low may not use high"
plant && echo '#include "low/private.h"' >> src/high/three.c
notices "a private header" "src/high/three.c includes low/private.h, which is private to room low"
plant && printf '#include "low/private.h"\n' >> src/low/door.h && printf '#include "low/door.h"\n' >> src/low/private.h
sed -i '1i #pragma once' src/low/door.h src/low/private.h
notices "a circle of includes" "circle of files by includes:"
plant && printf 'int two(void);\nint back(void);\nint back(void) { return two(); }\n' >> src/low/one.c
notices "a circle of files by what they use" "circle of files by what they use: low/"
plant && printf 'int three(void);\nint up(void);\nint up(void) { return three(); }\n' >> src/low/one.c
notices "a use upwards without an include" "src/low/one.c uses three of src/high/three.c, but room low may not use high"
plant && sed -i 's/| the ground | |/| the ground | high |/' src/README.md
notices "a circle of rooms" "circle of rooms:"
plant && : > src/low/forgotten.c
notices "a file that is in no list" "src/low/forgotten.c is not in src/rooms.cmake"
plant && rm src/high/three.c
notices "a file that is listed and not there" "src/high/three.c of src/rooms.cmake is not there"
plant && mkdir src/cellar && : > src/cellar/door.h
notices "a room without a row" "room cellar has no row"
plant && echo '| `attic` | nothing | low | |' >> src/README.md
notices "a row without a room" "room attic of src/README.md has no folder"
cd / && rm -rf "$scratch"
exit $bad
