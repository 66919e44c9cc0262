#!/bin/sh
# test_scene_cli.sh HNBRDF FILES MODEL: `hnbrdf scene` and `hnbrdf render --mesh`: pictures, comparison, going on
# after an interruption, and what is said when something is wrong.
set -u
. "$(dirname "$0")/test_cli_support.sh"
MODEL=$3

cat > a.scene << EOF
camera from 0 1 5 to 0 0.3 0 fov 35
size 64 48
environment sky
material floor diffuse 0.5 0.5 0.5
material blue model $MODEL vch_silk_blue
shape quad scale 8 material floor
shape teapot detail 12 scale 0.4 material blue
EOF
printf 'v -1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > a.obj

run "$HNBRDF" scene a.scene --spp 2 -o a.png
if grep -q "without Embree" err; then
    # What is missing is said, and the sphere is still there.
    [ "$rc" -eq 1 ] || fail "without Embree: exit $rc"
    run "$HNBRDF" render --mesh a.obj "$MODEL" --material vch_silk_blue --spp 2 -o m.png
    run "$HNBRDF" render builtin:rough-clay --spp 2 --size 8 -o s.png
    expect_ok "the sphere without Embree"
    [ "$failures" -eq 0 ] && exit 77
    exit 1
fi
expect_ok "scene"
[ -s a.png ] && [ ! -e a.png.checkpoint ] || fail "scene: a picture and no checkpoint expected"

# The same picture whatever the threads; another one with another seed.
run "$HNBRDF" scene a.scene --spp 2 --threads 3 -o b.png
cmp -s a.png b.png || fail "scene: other threads, other picture"
run "$HNBRDF" scene a.scene --spp 2 --seed 2 -o b.png
cmp -s a.png b.png && fail "scene: another seed, the same picture"
run "$HNBRDF" scene a.scene --spp 2 --analytic -o b.png
expect_ok "scene --analytic"
cmp -s a.png b.png && fail "scene --analytic: the same picture"
run "$HNBRDF" scene a.scene --spp 2 --width 24 -o b.png
expect_ok "scene --width"
[ "$(od -An -tu1 -j16 -N8 b.png | tr -s ' ')" = " 0 0 0 24 0 0 0 18" ] || fail "scene --width 24: not 24 x 18"

# A time budget leaves a checkpoint, and going on ends with the bits of an uninterrupted rendering.
run "$HNBRDF" scene a.scene --spp 100 -o whole.png
run "$HNBRDF" scene a.scene --spp 100 --time 0.1 --threads 1 -o part.png
[ "$rc" -eq 0 ] || fail "scene --time: exit $rc"
grep -q "^stopped at .* of 100 samples a pixel" out && [ -s part.png.checkpoint ] ||
    fail "scene --time: no word of it, or no checkpoint"
run "$HNBRDF" scene a.scene --spp 100 --resume -o part.png
[ "$rc" -eq 0 ] || fail "scene --resume: exit $rc"
cmp -s whole.png part.png || fail "scene --resume: not the bits of one run"
[ ! -e part.png.checkpoint ] || fail "scene --resume: the checkpoint stayed"

# Meshes.
run "$HNBRDF" render --mesh a.obj "$MODEL" --material vch_silk_blue --spp 2 --size 16 -o m.png
expect_ok "render --mesh"
run "$HNBRDF" render --mesh none.obj "$MODEL" --material vch_silk_blue --spp 2 -o m.png
[ "$rc" -eq 1 ] && grep -q "none.obj: cannot be opened" err || fail "render --mesh none.obj: exit $rc"
run "$HNBRDF" render "$MODEL" --material vch_silk_blue --bounces 3 --spp 2 -o m.png
expect_usage "render --bounces without --mesh" "are for --mesh"

# Messages.
echo 'shape cone' >> a.scene
run "$HNBRDF" scene a.scene -o b.png
[ "$rc" -eq 1 ] && grep -q "a.scene:8: found 'cone', expected sphere" err || fail "wrong scene: exit $rc"
run "$HNBRDF" scene a.scene
expect_usage "scene without -o" "where to write"
run "$HNBRDF" scene a.scene --analytic --compare x -o b.png
expect_usage "two ways to show" "expected one of them"
run "$HNBRDF" scene a.scene --csv x -o b.png
expect_usage "--csv alone" "are for --compare"
sed -i '$d' a.scene
run "$HNBRDF" scene a.scene --compare nowhere -o b.png
[ "$rc" -eq 1 ] && grep -q "a.scene:5: nowhere: no measurement of 'vch_silk_blue'" err ||
    fail "--compare without measurements: exit $rc"
finish
