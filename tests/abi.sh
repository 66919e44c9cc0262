#!/bin/sh
# abi.sh INCLUDE [--record]: what programs that were compiled with the headers of the folder INCLUDE rely on, as
# text: each function, each constant, the size and the value of each enum, and the size of each struct with the
# place, size and declaration of its members. --record writes it to tests/data/abi.txt, which is done once for a
# release, when its version is final.
set -eu
include=$1
record=$(dirname "$0")/data/abi.txt
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Statements, one a line: comments, directives and what is for C++ left out; constants as "define NAME VALUE".
for header in "$include"/hnbrdf/*.h; do
    awk '
        { sub(/\r$/, "") }
        /^#ifdef __cplusplus/ { skip = 1 }
        skip { if (/^#endif/) skip = 0; next }
        { text = text $0 "\n" }
        END {
            gsub(/\\\n/, " ", text)
            while ((from = index(text, "/*")) > 0) {
                rest = substr(text, from + 2)
                text = substr(text, 1, from - 1) " " substr(rest, index(rest, "*/") + 2)
            }
            n = split(text, line, "\n")
            for (k = 1; k <= n; k++) {
                gsub(/[ \t]+/, " ", line[k])
                if (line[k] ~ /^#define HNBRDF_[A-Z0-9_]+ [^ ]/ &&
                    line[k] !~ /^#define HNBRDF_(API|EXPERIMENTAL|VERSION_[A-Z]+) /)
                    print substr(line[k], 2)
                if (line[k] !~ /^#/)
                    code = code " " line[k]
            }
            gsub(/[ \t]+/, " ", code)
            for (k = 1; k <= length(code); k++) {
                c = substr(code, k, 1)
                depth += (c == "{") - (c == "}")
                if (c == ";" && depth == 0) {
                    sub(/^ +/, "", statement)
                    print statement
                    statement = ""
                } else
                    statement = statement c
            }
        }' "$header"
done > "$scratch/statements"

# A program that prints the layouts.
{
    for header in "$include"/hnbrdf/*.h; do
        echo "#include \"hnbrdf/$(basename "$header")\""
    done
    echo '#include <stdio.h>'
    echo 'int main(void) {'
    awk '
        function name_of(text, part) { # of a declarator
            if (match(text, /\( *\* *[a-z_0-9]+/)) {
                text = substr(text, RSTART, RLENGTH)
                gsub(/[( *]/, "", text)
                return text
            }
            sub(/ *\[.*/, "", text)
            sub(/^.*[ *]/, "", text)
            return text
        }
        function member(type, text, declaration) {
            name = name_of(text)
            printf "printf(\"member %s.%s at %%zu of %%zu: %s\\n\", offsetof(%s, %s), sizeof ((%s *)0)->%s);\n",
                type, name, declaration, type, name, type, name
        }
        /^typedef (struct|union) [a-z_0-9]+ \{/ {
            type = $3
            body = $0
            sub(/^[^{]*\{/, "", body)
            sub(/\}[^}]*$/, "", body)
            printf "printf(\"struct %s of %%zu\\n\", sizeof(%s));\n", type, type
            depth = 0
            part = ""
            for (k = 1; k <= length(body); k++) {
                c = substr(body, k, 1)
                depth += (c == "{" || c == "(") - (c == "}" || c == ")")
                if (depth == 0 && (c == ";" || c == ",")) {
                    sub(/^ +/, "", part)
                    first = base == "" ? part : base " " part
                    member(type, part, first)
                    if (c == ";")
                        base = ""
                    else if (base == "") {
                        base = part
                        sub(/[ *]*[a-z_0-9]+( *\[[^]]*\])* *$/, "", base)
                    }
                    part = ""
                } else
                    part = part c
            }
        }
        /^typedef enum [a-z_0-9]+ \{/ {
            printf "printf(\"enum %s of %%zu\\n\", sizeof(%s));\n", $3, $3
            body = $0
            sub(/^[^{]*\{/, "", body)
            sub(/\}[^}]*$/, "", body)
            n = split(body, value, ",")
            for (k = 1; k <= n; k++)
                if (match(value[k], /[A-Z][A-Z_0-9]+/)) {
                    name = substr(value[k], RSTART, RLENGTH)
                    printf "printf(\"enum %s %s %%d\\n\", (int)%s);\n", $3, name, name
                }
        }' "$scratch/statements"
    echo 'return 0; }'
} > "$scratch/layout.c"
${CC:-cc} -std=c11 -I"$include" "$scratch/layout.c" -o "$scratch/layout" 2> "$scratch/log" || {
    cat "$scratch/log" >&2
    echo "abi.sh: the layouts do not compile" >&2
    exit 1
}
print_all() {
    echo "version $(sed -n 's/^#define HNBRDF_VERSION_STRING "\(.*\)"/\1/p' "$include/hnbrdf/hnbrdf.h")"
    {
        grep -E '^define |HNBRDF_(API|EXPERIMENTAL)|^typedef' "$scratch/statements" |
            grep -vE '^typedef (struct|union|enum) [a-z_0-9]+ \{'
        "$scratch/layout"
    } | LC_ALL=C sort
}
if [ "${2:-}" = --record ]; then
    print_all > "$record"
else
    print_all
fi
