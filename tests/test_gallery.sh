#!/bin/sh
# test_gallery.sh HNBRDF FILES MODEL: pages of edited and mixed materials.
set -u
model=$3
. "$(dirname "$0")/test_cli_support.sh"

"$FILES" . || exit 1
run "$HNBRDF" gallery "$model"
expect_usage "no folder" "-o DIR"
run "$HNBRDF" gallery missing.safetensors -o g
expect_failure "a missing model" "missing.safetensors"
run "$HNBRDF" gallery "$model" -o g --materials vch_silk_blu
expect_failure "an unknown material" "did you mean vch_silk_blue?"
run "$HNBRDF" gallery "$model" -o g --pairs vch_silk_blue
expect_failure "half a pair" "'vch_silk_blue' is not A:B"
: >file
run "$HNBRDF" gallery "$model" -o file
expect_failure "a file in the way" "file: is a file, expected a folder"
rm -rf g

small="--size 32 --spp 1"
run "$HNBRDF" gallery "$model" --materials vch_silk_blue --pairs vch_silk_blue:paper_white $small -o g
[ "$rc" -eq 0 ] || fail "gallery: exit $rc"
for page in edits-vch_silk_blue anisotropy mixes; do
    [ -s "g/$page.png" ] && grep -q "($page.png)" g/gallery.md || fail "no page $page"
done
grep -q 'hnbrdf mix .* vch_silk_blue paper_white --t 0:1:0.1667' g/gallery.md || fail "gallery.md does not tell the mix"
# What gallery.md tells can be done.
grep '^    hnbrdf' g/gallery.md >commands
[ "$(wc -l <commands)" -eq 5 ] || fail "not a command a strip"
while read -r _ rest; do
    # shellcheck disable=SC2086 # several words
    run "$HNBRDF" $rest
    expect_ok "hnbrdf $rest"
done <commands
# Without names: two materials and up to six pairs, of a model fitted to what is given.
run "$HNBRDF" gallery builtin:gold-two-lobe builtin:velvet-crimson builtin:rough-clay --seconds 0.2 $small -o d
[ "$rc" -eq 0 ] || fail "gallery of data: exit $rc"
[ -s d/model.safetensors ] && [ "$(ls d | grep -c '^edits-.*png')" -eq 2 ] || fail "gallery of data: $(ls d)"
[ "$(grep -c 'hnbrdf mix' d/gallery.md)" -eq 1 ] || fail "three materials are not one pair"
# A neural model has no GGX part to edit.
"$HNBRDF" fit builtin:gold-two-lobe builtin:velvet-crimson --kind neural --net 8x1 --steps 20 --pool 2048 \
    -o neural.safetensors >out 2>err || fail "fit"
run "$HNBRDF" gallery neural.safetensors $small -o n
[ "$rc" -eq 0 ] && [ -s n/mixes.png ] && [ ! -e n/anisotropy.png ] || fail "a neural model: exit $rc, $(ls n)"

finish
