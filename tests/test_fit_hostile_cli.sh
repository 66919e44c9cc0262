#!/bin/sh
# test_fit_hostile_cli.sh HNBRDF: what `hnbrdf fit` says of data that are hardly any, and of a rate that is too large.
set -eu
hnbrdf=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() {
    echo "FAILED: $1" >&2
    exit 1
}
short="--net 8x1 --steps 60 --pool 1024"

# UTIA files have no header: 1990656 bytes of doubles.
head -c 1990656 /dev/zero > black.bin
head -c 1990656 /dev/zero | tr '\0' '\177' > huge.bin # 1.4e306 each, beyond a float
# shellcheck disable=SC2086 # words
"$hnbrdf" fit black.bin $short -o black.safetensors > out 2> err || fail "black data: $(cat err)"
grep -q '^note: black: every value is 0' out || fail "no word about black data"
# shellcheck disable=SC2086
if "$hnbrdf" fit huge.bin $short -o huge.safetensors > out 2> err; then
    fail "values beyond a float are taken"
fi
grep -q '^hnbrdf: huge.bin: ' err || fail "the message about values beyond a float: $(cat err)"
[ ! -e huge.safetensors ] || fail "a refused file leaves a model"

"$hnbrdf" fit builtin:retro-tape --net 16x2 --rate 10 --steps 150 --pool 2048 --json fit.json -o r.safetensors \
    > out 2> err || fail "a rate that is too large: $(cat err)"
grep -q '^note: training diverged [0-9]* times\? and went on from its best state' out ||
    fail "no word about divergence: $(cat out)"
tr -d ' \n' < fit.json | grep -q '"set_backs":[1-9]' || fail "the JSON does not count divergence"
"$hnbrdf" fit builtin:retro-tape --net 16x2 --steps 150 --pool 2048 --json fit.json -o r.safetensors \
    > out 2> err || fail "a plain fit: $(cat err)"
if grep -q '^note:' out; then fail "a note about a plain fit: $(cat out)"; fi
tr -d ' \n' < fit.json | grep -q '"set_backs":0,.*"best_step":150,"ggx_alone":false' || fail "the JSON of a plain fit"
echo "all held"
