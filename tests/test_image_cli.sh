#!/bin/sh
# test_image_cli.sh HNBRDF FILES SAMPLES: OpenEXR files of the kinds that people have, in the commands that read
# pictures: what is read, what is said, what is refused. SAMPLES writes the files.
set -u
. "$(dirname "$0")/test_cli_support.sh"
SAMPLES=$3
"$SAMPLES" . || fail "samples"

# expect_read NAME: the last command ended well; it may have warned.
expect_read() {
    [ "$rc" -eq 0 ] && ! grep -qv '^hnbrdf: warning: ' err || fail "$1: exit $rc, expected 0 and at most warnings"
}
# equal A B [options]: the two pictures are the same.
equal() {
    run "$HNBRDF" compare --images "$@" --csv -
    expect_read "compare --images $*"
    awk -F, 'NR == 2 && $3 <= 1e-6 { good = 1 } END { exit !good }' out || fail "$* differ: $(sed -n 2p out)"
}

# ---- what is read -------------------------------------------------------------------------------------
for file in chroma_half xyz plain layer b44_float b44_row dwaa cube square; do
    equal $file.exr $file.exr
done
equal chroma_half.exr chroma_float.exr
equal layer.exr plain.exr
equal b44_float.exr plain.exr
equal b44_row.exr row.exr
run "$HNBRDF" compare --images crop_left.exr crop_right.exr --csv -
expect_read "two crops"
awk -F, 'NR == 2 && $3 > 0.1 && $6 == 128 { good = 1 } END { exit !good }' out || fail "two places are one: $(cat out)"

# ---- layers -------------------------------------------------------------------------------------------
run "$HNBRDF" compare --images layers.exr layers.exr
expect_failure "several layers" "layers.exr: several layers, 'a', 'b': choose one: --layer NAME, or layer NAME in a scene"
equal layers.exr layers.exr --layer b
run "$HNBRDF" compare --images layers.exr layers.exr --layer c
expect_failure "a layer that is not there" "no layer 'c': there are 'a', 'b'"
run "$HNBRDF" compare model.safetensors builtin --layer b
expect_usage "--layer without --images" "belong to --images"

# ---- what is said, and refused ------------------------------------------------------------------------
said() { # FILE TEXT [options]
    file=$1 text=$2
    shift 2
    run "$HNBRDF" compare --images "$file" "$file" "$@"
    expect_read "$file"
    grep -qF "hnbrdf: warning: $file: $text" err || fail "$file: '$text' is not said: $(cat err)"
}
said xyz.exr "converted to Rec. 709 from CIE XYZ"
said crop_left.exr "data window of 4 x 2 at (1, 2), black outside it in 16 x 8"
said holes.exr "2 pixels were not finite, replaced by the mean of their neighbours" --repair
run "$HNBRDF" compare --images holes.exr holes.exr
expect_failure "not finite" "holes.exr: 2 pixels are not finite, the first at column 2, row 1"
run "$HNBRDF" compare --images deep.exr plain.exr
expect_failure "deep data" "deep.exr: deep data"
run "$HNBRDF" compare --images integers.exr plain.exr
expect_failure "integers" "integers.exr: channel R is of integers"

# ---- environments -------------------------------------------------------------------------------------
light() { # FILE [options]: renders a white sphere under it
    run "$HNBRDF" render builtin:rough-clay --size 8 --spp 1 --background env --env "$@" -o lit.exr
}
for file in chroma_half.exr xyz.exr crop_left.exr layer.exr dwaa.exr cube.exr; do
    light $file
    expect_read "render --env $file"
done
light layers.exr --layer a
expect_read "render --layer"
light layers.exr
expect_failure "render with several layers" "several layers, 'a', 'b'"
light holes.exr
expect_failure "render with holes" "holes.exr: 2 pixels are not finite, the first at column 2, row 1"
light holes.exr --repair
expect_read "render --repair"
grep -q "2 pixels were not finite" err || fail "render --repair says nothing: $(cat err)"
light square.exr
expect_read "render with a square map"
grep -q "square.exr: 8 x 8, the shape of an angular map or a light probe" err || fail "square: $(cat err)"
light plain.exr
[ ! -s err ] || fail "a plain map is warned of: $(cat err)"
printf 'camera from 0 0 4 to 0 0 0 fov 40\nsize 8 8\nenvironment layers.exr layer b repair\nshape sphere\n' >a.scene
if "$HNBRDF" scene a.scene --spp 1 -o scene.exr >out 2>err; then
    sed 's/ layer b//' a.scene >b.scene
    run "$HNBRDF" scene b.scene --spp 1 -o scene.exr
    expect_failure "a scene with several layers" "choose one: --layer NAME, or layer NAME in a scene"
else
    grep -q "without Embree" err || fail "a scene with a layer: $(cat err)"
fi

finish
