#!/bin/sh
# test_fit_mpi.sh HNBRDF 0|1: `mpirun hnbrdf fit`: the bits of one process, one voice, a rank that is killed.
set -eu
hnbrdf=$1
if [ "$2" != 1 ] || ! command -v mpirun > /dev/null; then
    echo "SKIPPED: hnbrdf is built without MPI, or there is no mpirun"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() {
    echo "FAILED: $1" >&2
    exit 1
}
options=""
# More ranks than processors, as root in a container, on a machine that is busy with other tests.
mpirun --version | grep -q 'Open MPI' &&
    options="--oversubscribe --allow-run-as-root --mca odls_base_sigkill_timeout 5"
ranks() {
    count=$1
    shift
    # shellcheck disable=SC2086 # words
    mpirun $options -n "$count" "$hnbrdf" "$@"
}
small="builtin:retro-tape builtin:rough-clay builtin:gold-two-lobe --net 8x2 --batch 2048 --pool 640"

# The bits of one process; what is printed is printed once.
# shellcheck disable=SC2086
"$hnbrdf" fit $small --steps 250 --threads 1 -o one.safetensors > one.out 2> err || fail "one process: $(cat err)"
# shellcheck disable=SC2086
ranks 3 fit $small --steps 250 --threads 2 --log log.csv --json speed.json -o three.safetensors > out 2> err ||
    fail "three ranks: $(cat err)"
cmp one.safetensors three.safetensors || fail "three ranks make another model than one process"
[ "$(grep -c '^three.safetensors: hybrid' out)" = 1 ] || fail "three ranks speak with more than one voice"
grep -q '2 threads in each of 3 processes' out || fail "the speed does not tell of processes"
[ "$(wc -l < log.csv)" = 3 ] && grep -q '"exchange"' speed.json || fail "files beside the model"
[ ! -e three.safetensors.checkpoint ] || fail "a finished fit leaves its checkpoint"

# Independent fits are shared out: the same models, and the figures of all.
report() {
    "$@" report accuracy builtin:retro-tape builtin:rough-clay --nets 4x1 --latents 1 --steps 5 --pool 64 --pairs 200 \
        --images 0 --threads 1 -o "$folder" > out 2> err || fail "report: $(cat err)"
}
folder=alone report "$hnbrdf"
folder=shared report ranks 3
for file in models/hybrid-4x1-l1.safetensors models/neural-4x1-l9.safetensors materials.csv; do
    cmp "alone/$file" "shared/$file" || fail "a report by three ranks: $file"
done
[ "$(grep -c '^hybrid-4x1-l1 ' out)" = 1 ] || fail "three ranks tell of a model more than once"

# What is wrong with the data of one rank is said once, and ends all.
if ranks 2 fit builtin:retro-tape none.bsdf -o none.safetensors > out 2> err; then
    fail "a file that is not there"
fi
[ "$(grep -c '^hnbrdf: none.bsdf: ' err)" = 1 ] || fail "the message about a file: $(cat err)"
[ ! -e none.safetensors ] || fail "a failed fit writes a model"
if ranks 2 info one.safetensors > out 2> err; then
    fail "two processes do what is for one"
fi
[ "$(grep -c 'hnbrdf: info is done by one process' err)" = 1 ] || fail "the refusal: $(cat err)"

# A rank that is killed: the others say so and leave a checkpoint, good for another number of ranks.
# shellcheck disable=SC2086
mpirun $options -n 3 "$hnbrdf" fit $small --steps 4000 --threads 1 --log cut.csv -o cut.safetensors > out 2> err &
launcher=$!
until grep -qs '^100,' cut.csv.hnbrdf-part || ! kill -0 $launcher 2> /dev/null; do sleep 0.02; done
victim=""
for process in $(cat /proc/$launcher/task/$launcher/children 2> /dev/null); do
    if tr '\0' '\n' < "/proc/$process/environ" 2> /dev/null | grep -qE '^(OMPI_COMM_WORLD_RANK|PMI_RANK)=2$'; then
        victim=$process
    fi
done
[ -z "$victim" ] || kill -KILL "$victim" 2> /dev/null || true
if wait $launcher; then
    echo "SKIPPED: the fit had ended before a rank was killed, or no rank was found"
    exit 77
fi
grep -q 'hnbrdf: .*of 3 ranks has ended or cannot be reached; cut.safetensors.checkpoint holds the' err ||
    fail "the message about a killed rank: $(cat err)"
[ ! -e cut.safetensors ] || fail "a broken fit writes a model"
# shellcheck disable=SC2086
ranks 2 fit $small --steps 4000 --threads 1 --resume -o cut.safetensors > out 2> err || fail "resuming: $(cat err)"
# shellcheck disable=SC2086
"$hnbrdf" fit $small --steps 4000 --threads 2 -o straight.safetensors > out 2> err || fail "straight: $(cat err)"
cmp cut.safetensors straight.safetensors || fail "a resumed fit is not the whole one"
echo "all held"
