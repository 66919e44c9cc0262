#!/bin/sh
# test_path_tracer.sh SOURCE HNBRDF EXAMPLES NOISE SCRATCH: the path tracer of examples/path-tracer.md renders what
# `hnbrdf scene` (Embree) renders of the same scene, within the noise of both; NOISE is picture_noise.
set -u
source=$1 hnbrdf=$2 examples=$3 noise=$4 scratch=$5
model=$source/examples/models/rgl_32x2.safetensors
fail() {
    echo "test_path_tracer: $*" >&2
    exit 1
}
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch" || exit 1
# scene NAME SEED: of path_tracer.scene, or of what sed makes of it.
scene() {
    sed "${3:-}" "$source/examples/path_tracer.scene" |
        sed "s|models/|$source/examples/models/|" > "$1.scene"
    "$hnbrdf" scene "$1.scene" --width 96 --spp 96 --seed "$2" -o "$1.exr" > log 2>&1 || {
        grep -qE 'built without|OpenEXR' log && echo "skipped: $(tail -n 1 log)" && exit 77
        fail "$(tail -n 1 log)"
    }
}
scene b1 1
scene b2 2
"$examples/path_tracer" "$model" 96 96 1 > a1.hdr || fail "the path tracer"
"$examples/path_tracer" "$model" 96 96 2 > a2.hdr || fail "the path tracer"
"$noise" a1.hdr a2.hdr b1.exr b2.exr > found || fail "other pictures: $(cat found)"
cat found
# It would see a difference of a few per cent,
awk '/at most/ { seen = $(NF - 1) < 8 } END { exit !seen }' found || fail "too much noise to see anything"
# a reflection less, and a lamp a tenth brighter.
scene c1 1 's/^bounces 6/bounces 1/'
scene c2 2 's/^bounces 6/bounces 1/'
! "$noise" a1.hdr a2.hdr c1.exr c2.exr > found || fail "one reflection alone is not noticed: $(cat found)"
scene d1 1 's/emit 4 4 4/emit 4.4 4.4 4.4/'
scene d2 2 's/emit 4 4 4/emit 4.4 4.4 4.4/'
! "$noise" a1.hdr a2.hdr d1.exr d2.exr > found || fail "a brighter lamp is not noticed: $(cat found)"
! "$examples/path_tracer" missing.safetensors 2> log > x.hdr || fail "a missing model is no error"
grep -q 'missing.safetensors: cannot be opened' log || fail "a missing model: $(cat log)"
rm -rf "$scratch"
echo passed
