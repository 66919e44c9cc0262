#!/bin/sh
# parity_summary.sh LOG: which languages ran by which APIs on which drivers, as a table from the log of a ctest run.
# Tests that execute or compile a shader print a line for each:
#   parity: LANGUAGE | API | DRIVER | executed     or compiled, or skipped: why
# A test of this kind that was skipped as a whole is listed with what it said.
set -eu
[ -r "$1" ] || { echo "parity_summary.sh: $1: cannot be read" >&2; exit 1; }
echo "Shaders in this run: language, API, driver"
awk '
    # A section of a test: "12/170 Testing: NAME", then what it printed, then how it ended.
    / Testing: / { test = $0; sub(/.* Testing: /, "", test); sub(/ .*/, "", test); lines = 0; said = "" }
    /^parity: / {
        line = $0
        sub(/^parity: /, "", line)
        split(line, part, / *\| */)
        row = sprintf("  %-6s %-26s %-34s %s", part[1], part[2], part[3], part[4])
        if (!(row in seen))
            rows[++count] = row
        seen[row] = 1
        lines++
    }
    /^skipped: / && said == "" { said = $0 }
    /^Test time/ {
        if (test ~ /^test_(gpu_verify|gl_verify|language|web|parity)/ && lines == 0 && said != "")
            left[++skipped] = sprintf("  %-40s %s", test, said)
        said = ""
    }
    END {
        for (i = 1; i <= count; i++)
            print rows[i]
        if (count == 0)
            print "  none"
        for (i = 1; i <= skipped; i++)
            print left[i]
    }
' "$1"
