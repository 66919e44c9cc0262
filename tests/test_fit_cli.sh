#!/bin/sh
# test_fit_cli.sh HNBRDF: the files that `hnbrdf fit` writes, an interrupt and --resume, a frozen network.
set -eu
hnbrdf=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() {
    echo "FAILED: $1" >&2
    exit 1
}
fit() {
    "$hnbrdf" fit "$@" 2> err > out || { cat err; fail "fit $*"; }
}
small="builtin:retro-tape builtin:rough-clay --net 16x2 --pool 4096 --batch 1024"

# shellcheck disable=SC2086 # words
fit $small --steps 500 --log log.csv --plot loss.svg --json speed.json -o whole.safetensors
head -n 1 log.csv | grep -qx 'step,share,loss,pairs_per_s' || fail "the log's header"
[ "$(wc -l < log.csv)" = 6 ] || fail "the log has not a row every 100 steps"
tail -n 1 log.csv | grep -q '^500,1.000000,' || fail "the log's last row"
grep -q '<polyline' loss.svg && tail -n 1 loss.svg | grep -qx '</svg>' || fail "the plot"
grep -q '^speed: .* M pairs/s everything included' out && grep -q 'of the FMA peak' out &&
    grep -q '^time: .* forward and backward' out || fail "the speed is not printed"
tr -d ' \n' < speed.json | grep -q '"pairs":512000,' || fail "500 steps of 1024 pairs in the JSON"
[ ! -e whole.safetensors.checkpoint ] || fail "a finished fit leaves its checkpoint"

# An interrupted fit saves its model and goes on to the same bits.
# shellcheck disable=SC2086
"$hnbrdf" fit $small --steps 20000 --log cut.csv -o cut.safetensors > out 2> err &
process=$!
# The log under way tells when the network is being trained; after that there is something to interrupt.
until grep -qs '^100,' cut.csv.hnbrdf-part || ! kill -0 $process 2> /dev/null; do sleep 0.05; done
kill -INT $process 2> /dev/null || true
wait $process || fail "an interrupted fit does not end well: $(cat err)"
if ! grep -q 'interrupted' out; then
    echo "SKIPPED: the fit had ended before the interrupt reached it"
    exit 77
fi
"$hnbrdf" info cut.safetensors > /dev/null || fail "the model of an interrupted fit"
[ -s cut.safetensors.checkpoint ] || fail "no checkpoint after an interrupt"
# shellcheck disable=SC2086
fit $small --steps 20000 --resume --log cut.csv -o cut.safetensors
[ ! -e cut.safetensors.checkpoint ] || fail "a resumed fit leaves its checkpoint"
# shellcheck disable=SC2086
fit $small --steps 20000 --threads 1 --log straight.csv -o straight.safetensors
cut -d, -f1,3 cut.csv > cut.loss # what does not depend on the machine
cut -d, -f1,3 straight.csv | cmp - cut.loss || fail "the log of a resumed fit is not that of the whole one"
cmp cut.safetensors straight.safetensors || fail "resumed and uninterrupted fits differ"

# shellcheck disable=SC2086
if "$hnbrdf" fit $small --resume -o never.safetensors > out 2> err; then
    fail "--resume without a checkpoint"
fi
# shellcheck disable=SC2086
if "$hnbrdf" fit $small --steps 20000 --resume --log loss.svg -o never.safetensors > out 2> err; then
    fail "--resume goes on with a file that is no log"
fi
grep -q '^hnbrdf: loss.svg:1: ' err || fail "the message about a file that is no log: $(cat err)"
# shellcheck disable=SC2086
"$hnbrdf" fit $small --resume -o never.safetensors > out 2> err || true
grep -q 'never.safetensors.checkpoint' err || fail "the message of --resume names no file"
[ ! -e never.safetensors ] || fail "a failed fit writes a model"

fit builtin:gold-two-lobe --freeze whole.safetensors --steps 200 --pool 4096 -o more.safetensors
"$hnbrdf" info more.safetensors --json | tr -d ' \n' |
    grep -q '"materials":\["gold-two-lobe","retro-tape","rough-clay"\]' || fail "materials on a frozen network"
# The network in the command itself; the model written has the new material alone.
fit builtin:gold-two-lobe --freeze universal --steps 4 --pool 4096 -o new.safetensors
"$hnbrdf" info new.safetensors --json | tr -d ' \n' | grep -q '"materials":\["gold-two-lobe"\]' ||
    fail "materials on the universal network"
"$hnbrdf" info universal --without-physics > out || fail "info of the universal network"
if "$hnbrdf" fit builtin:gold-two-lobe --freeze builtin:retro-tape -o none.safetensors > out 2> err; then
    fail "--freeze takes a measurement"
fi
echo "all held"
