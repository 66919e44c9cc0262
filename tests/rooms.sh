#!/bin/sh
# rooms.sh SOURCE [OBJECTS]: the rooms of SOURCE/src are what the table in SOURCE/src/README.md says.
# OBJECTS is a folder with the objects that were compiled. Prints what is wrong, a line each; exit 1.
#
#   src/ROOM/FILE includes ... room ROOM may not use it  an arrow that the table does not have
#   circle of rooms / of files by includes / of files by what they define and use
#   ... is private to room ...                           a header that is no door
#   ... is not in src/rooms.cmake                        a file that nobody compiles
#   room ... has no row                                  and the other way round
set -u
LC_ALL=C
export LC_ALL
source=$1 objects=${2:+$(cd "$2" && pwd)}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$source" || exit 2
found=$scratch/found
: > "$found"

# The table: `room` | what for | may use | doors. "all" stands for every header of the room.
awk -F'|' '
    function trimmed(text) { gsub(/[`,]/, " ", text); gsub(/^ +| +$/, "", text); return text }
    $2 ~ /^ *`[a-z0-9_]+` *$/ && NF >= 5 {
        room = trimmed($2)
        print "room", room
        n = split(trimmed($4), used, / +/)
        for (i = 1; i <= n; i++) if (used[i] ~ /^[a-z0-9_]+$/) print "arrow", room, used[i]
        n = split(trimmed($5), doors, / +/)
        for (i = 1; i <= n; i++) if (doors[i] != "") print "door", room, doors[i]
    }' src/README.md > "$scratch/table"
[ -s "$scratch/table" ] || echo "src/README.md: no table of rooms was found" >> "$found"

# Rooms that are there and rows; arrows to rooms that are not.
for folder in src/*/; do
    room=$(basename "$folder")
    grep -qx "room $room" "$scratch/table" || echo "room $room has no row in src/README.md" >> "$found"
done
awk '$1 == "room" { print $2 } $1 == "arrow" { print $3 }' "$scratch/table" | sort -u | while read -r room; do
    [ -d "src/$room" ] || echo "room $room of src/README.md has no folder in src"
done >> "$found"
awk '$1 == "arrow" { print $2, $3 }' "$scratch/table" | tsort 2>&1 > /dev/null | sed 's/^tsort: //' |
    awk '/loop/ { if (line) print line; line = "circle of rooms:"; next } { line = line " " $0 } END { if (line) print line }' >> "$found"

# Includes: FILE HEADER, of src and of the public headers.
find src include -name '*.[ch]' -o -name '*.cc' | sort | while read -r file; do
    awk -v file="$file" 'match($0, /^[ \t]*#[ \t]*include[ \t]*"[^"]*"/) {
        split($0, part, "\""); print file, part[2] }' "$file"
done > "$scratch/includes"

# A public header belongs to the room of its name; hnbrdf.h is for everybody.
awk '
    function room_of(path, part) {
        split(path, part, "/")
        if (part[1] != "hnbrdf") return part[1]
        sub(/\.h$/, "", part[2])
        return part[2] == "hnbrdf" ? "" : part[2]
    }
    FILENAME ~ /table$/ {
        if ($1 == "arrow") arrow[$2, $3] = 1
        if ($1 == "door") door[$2, $3] = 1
        next
    }
    {
        file = $1; header = $2
        sub(/^src\//, "", file); sub(/^include\//, "", file)
        split(file, part, "/"); from = room_of(file); to = room_of(header)
        if (from == "" || to == "" || from == to || header !~ /\//) next
        if (!((from, to) in arrow)) print $1 " includes " header ", but room " from " may not use " to
        name = header; sub(/^[^\/]*\//, "", name)
        if (header !~ /^hnbrdf\// && !((to, name) in door) && !((to, "all") in door))
            print $1 " includes " header ", which is private to room " to
    }' "$scratch/table" "$scratch/includes" >> "$found"

circles() { # of the pairs on stdin, each line beginning with $1
    tsort 2>&1 > /dev/null | sed 's/^tsort: //' | awk -v before="$1" '
        /loop/ { if (line) print line; line = before; next }
        { line = line " " $0 }
        END { if (line) print line }'
}
sed 's/^src\///; s/^include\///' "$scratch/includes" | circles "circle of files by includes:" >> "$found"

# Files that are compiled: those of src/rooms.cmake, and kernels that src/kernels.cmake adds by name.
sed 's/#.*//' src/rooms.cmake | tr '\n()' '   ' | awk '{
    for (i = 1; i <= NF; i++) {
        if ($i == "hnbrdf_room") { room = $(++i); continue }
        if ($i == "set" || $i == "function") room = ""
        if (room != "" && $i ~ /\.cc?$/) print "src/" room "/" $i
    } }' | sort > "$scratch/listed"
for kernel in src/core/kernel_*.c; do
    [ ! -e "$kernel" ] || ! grep -q 'core/kernel_' src/kernels.cmake 2> /dev/null || echo "$kernel"
done | sort -u - "$scratch/listed" > "$scratch/compiled"
find src -mindepth 2 -name '*.c' -o -name '*.cc' | sort > "$scratch/there"
comm -13 "$scratch/compiled" "$scratch/there" | sed 's/$/ is not in src\/rooms.cmake/' >> "$found"
comm -23 "$scratch/listed" "$scratch/there" | sed 's/$/ of src\/rooms.cmake is not there/' >> "$found"

# Objects: who defines what somebody else uses. What generated files hold belongs to no room.
if [ -n "$objects" ]; then
    (cd "$objects" && find . -name '*.o') | grep '/src/[a-z0-9_]*/[^/]*\.o$' |
        grep -v -e '^./tests/' -e _dll_objects |
        awk '{ name = $0; sub(/.*\/src\//, "", name); print name, $0 }' | sort | awk '!seen[$1]++' |
        while read -r name path; do # what is left of older builds does not count
            [ ! -e "src/${name%.o}" ] || echo "$objects/$path"
        done > "$scratch/objects"
    [ -s "$scratch/objects" ] || echo "$objects: no objects of src were found" >> "$found"
    xargs nm -A -g < "$scratch/objects" 2> /dev/null | awk '
        {
            object = $0; sub(/\.o:.*/, "", object); sub(/.*\/src\//, "", object)
            kind = $(NF - 1); symbol = $NF
            if (kind == "U" || kind == "w") needs[object, symbol] = 1
            else defines[symbol] = object
        }
        END {
            for (pair in needs) {
                split(pair, part, SUBSEP)
                definer = defines[part[2]]
                if (definer != "" && definer != part[1]) print part[1], definer, part[2]
            }
        }' | sort > "$scratch/uses"
    awk '{ print $1, $2 }' "$scratch/uses" | sort -u | circles "circle of files by what they use:" >> "$found"
    awk '
        FILENAME ~ /table$/ { if ($1 == "arrow") arrow[$2, $3] = 1; next }
        {
            split($1, from, "/"); split($2, to, "/")
            if (from[1] != to[1] && !((from[1], to[1]) in arrow))
                print "src/" $1 " uses " $3 " of src/" $2 ", but room " from[1] " may not use " to[1]
        }' "$scratch/table" "$scratch/uses" >> "$found"
fi

cat "$found"
[ ! -s "$found" ]
