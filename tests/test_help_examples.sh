#!/bin/sh
# test_help_examples.sh HNBRDF FILES SOURCES: the examples of every --help, word for word, in a folder with the files
# that they name; each command begins with the same ones. What would take long gets a few words more that make it short,
# or is left out: example_support.sh says which, and why.
set -u
. "$(dirname "$0")/test_cli_support.sh"
SOURCES=$3
. "$SOURCES/tests/example_support.sh"

seen=0 left=0
for help in "" $(grep -v '^#' "$SOURCES/tests/command_lines.txt" | cut -d'|' -f1 | tr ' ' + | sort -u); do
    command=$(echo "$help" | tr + ' ')
    rm -rf here
    cp -r start here
    hnbrdf $command --help | sed -n '/^examples:/,$p' | sed -e 1d -e 's/^ *//' -e ':a' -e '/\\$/N; s/\\\n *//; ta' >lines
    [ -s lines ] || fail "hnbrdf $command --help has no examples"
    while IFS= read -r line <&3; do try_example "$line"; done 3<lines
done
echo "$seen examples, $left of them only looked at"
[ "$seen" -gt 60 ] || fail "only $seen examples were found"

finish
