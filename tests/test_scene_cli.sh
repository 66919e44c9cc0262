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
# Meshes as people have them: pictures are those of the plain mesh. mesh NAME: the file on stdin.
mesh() {
    cat > "$1.obj"
    run "$HNBRDF" render --mesh "$1.obj" builtin:rough-clay --spp 2 --size 24 -o "$1.png"
    [ "$rc" -eq 0 ] || fail "render --mesh $1.obj: exit $rc"
}
same() {
    cmp -s "$1.png" "$2.png" || fail "$1.obj: not the picture of $2.obj"
}
printf 'v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n' | mesh plain
[ -s err ] && fail "a plain mesh: $(cat err)"
printf 'v 1e18 0 0\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 2 3 4\n' | mesh stray
same stray plain
printf '\357\273\277v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n' | mesh bom
same bom plain
for size in 1099511627776 1152921504606846976 9.094947017729282379150390625e-13; do # 2^40, 2^60, 2^-40
    printf 'v -%s -%s 0\nv %s -%s 0\nv 0 %s 0\nf 1 2 3\n' $size $size $size $size $size | mesh scaled
    same scaled plain
done
printf 'v 4194303 -4194305 8\nv 4194305 -4194305 8\nv 4194304 -4194303 8\nf 1 2 3\n' | mesh far
same far plain
printf 'v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1//1 2//2 3//3\n' | mesh lacking
same lacking plain
[ "$(grep -c warning err)" -eq 1 ] && grep -q "warning: lacking.obj:4: normal '1'" err ||
    fail "a mesh without its normals: $(cat err)"
printf 'v 0 -1 -1\nv 0 -1 1\nv 0 1 0\nf 1 2 3\n' | mesh edge
grep -q "warning: edge.obj: a flat mesh, seen edge-on" err || fail "a mesh seen edge-on: $(cat err)"
hole='v -3 -2 0\nv 3 -2 0\nv 0 3 0\nv -1 -1 0\nv 0 1 0\nv 1 -1 0\n'
printf "${hole}f 1 2 6\nf 1 6 4\nf 2 3 5\nf 2 5 6\nf 3 1 4\nf 3 4 5\n" | mesh pieces
printf "${hole}f 1 2 3 1 4 5 6 4\n" | mesh hole
same hole pieces
printf 'v 1 2 3\nf 1 1 1\n' > point.obj
run "$HNBRDF" render --mesh point.obj builtin:rough-clay --spp 2 -o m.png
[ "$rc" -eq 1 ] && grep -q "point.obj: its 1 face has no area" err || fail "a point: exit $rc, $(cat err)"

# In a scene such a mesh is where it says; what cannot be drawn there is told.
# look FILE PLACING: a scene with the mesh.
look() {
    printf 'camera from 0 0 5 to 0 0 0 fov 40\nsize 24 24\nenvironment sky\nmaterial a diffuse 0.5 0.5 0.5\n' > m.scene
    echo "shape obj $1 $2 material a" >> m.scene
    run "$HNBRDF" scene m.scene --spp 2 -o "$1.png"
}
look plain.obj ""
expect_ok "scene: a mesh"
look far.obj "move -1e6 1e6 -8 move -1e6 1e6 0 move -1e6 1e6 0 move -1e6 1e6 0 move -194304 194304 0"
expect_ok "scene: a mesh far away"
same far.obj plain.obj
look scaled.obj "scale 524288 scale 524288 scale 4"
expect_ok "scene: a small mesh made larger"
same scaled.obj plain.obj
look plain.obj "scale 1e6 scale 1e6"
[ "$rc" -eq 1 ] && grep -q "m.scene:5: a shape that reaches to 1e+12: expected coordinates up to 1e9" err ||
    fail "scene: a shape too large: exit $rc, $(cat err)"
look plain.obj "scale 1e-6 move 1 0 0"
[ "$rc" -eq 0 ] && grep -q "warning: m.scene:5: a shape of size 2.*e-06" err ||
    fail "scene: a shape too small: exit $rc, $(cat err)"

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
