#!/bin/sh
# test_shipped_model.sh MODEL: the shipped model has the bytes that every figure in the documents is about.
# Change the number here only together with them.
set -eu
expected="397805408 8784"
found=$(cksum < "$1")
[ "$found" = "$expected" ] || {
    echo "test_shipped_model: $1 has cksum $found, expected $expected" >&2
    exit 1
}
