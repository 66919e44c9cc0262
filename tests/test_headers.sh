#!/bin/sh
# test_headers.sh SOURCE: every public header, alone and twice, as C99, C11 and C++11 without a warning, under
# every compiler that is there.
set -eu
include=$1/include
warnings="-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wundef -Werror -fsyntax-only"
tried=0
for compiler in gcc clang cc; do
    command -v $compiler > /dev/null || continue
    tried=1
    for header in "$include"/hnbrdf/*.h; do
        name=hnbrdf/$(basename "$header")
        for language in c:c99 c:c11 c++:c++11 c++:c++17; do
            # shellcheck disable=SC2086 # warnings are words
            printf '#include "%s"\n#include "%s"\nint one_declaration;\n' "$name" "$name" |
                $compiler -x "${language%:*}" -std="${language#*:}" $warnings -I"$include" - ||
                { echo "test_headers: $name, $compiler, ${language#*:}" >&2; exit 1; }
        done
    done
done
[ $tried = 1 ] || exit 77
