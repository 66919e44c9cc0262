#!/bin/sh
# test_readers.sh: no reader without a fuzz target. A file of src/ that opens files for reading, and one that holds
# a row of the table of measured formats, stands in tests/fuzz/readers.txt; each target there exists and has a
# generator; each target that exists stands there.
set -eu
cd "$(dirname "$0")/.."
table=tests/fuzz/readers.txt failed=0
complain() {
    echo "test_readers.sh: $1" >&2
    failed=1
}
for file in $(grep -lE 'fopen\([^)]*"r|hnbrdf_open_to_read\(|[^_]fread\(|_wfopen\(' -r src --include='*.c'); do
    grep -qF " $file" "$table" || complain "$file reads files and is not in $table"
done
# A measured format that opens bytes has a row with .recognise.
for file in $(grep -lE '^ *\.recognise =' -r src/measured --include='*.c'); do
    grep -v '^-' "$table" | grep -qF " $file" || complain "$file is a measured format without a fuzz target in $table"
done
for target in $(grep -v '^[#-]' "$table" | cut -d ' ' -f 1); do
    [ -f "tests/fuzz/fuzz_$target.c" ] || complain "no tests/fuzz/fuzz_$target.c"
    [ -f "tests/fuzz/generate_$target.c" ] || complain "no tests/fuzz/generate_$target.c"
done
for file in tests/fuzz/fuzz_*.c tests/fuzz/generate_*.c; do
    target=$(basename "$file" .c) target=${target#*_}
    grep -qE "^$target( |\$)" "$table" || complain "$file is not in $table"
done
for file in $(grep -v '^#' "$table" | tr ' ' '\n' | grep '^src/'); do
    [ -f "$file" ] || complain "$file of $table does not exist"
done
exit $failed
