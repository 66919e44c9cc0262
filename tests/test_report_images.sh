#!/bin/sh
# test_report_images.sh HNBRDF FILES: `report images` measures spheres, says how good its figures are, and goes on.
set -u
. "$(dirname "$0")/test_cli_support.sh"

run "$HNBRDF" report images --help
expect_ok "report images --help"
grep -q "^usage: hnbrdf report images " out || fail "no usage line"
awk 'length($0) > 104 { exit 1 }' out || fail "report images --help: lines longer than 104"
run "$HNBRDF" report images -o r
expect_usage "no data" "no DATA"
run "$HNBRDF" report images builtin
expect_usage "no folder" "-o DIR"
run "$HNBRDF" report images builtin -o r --nets 16x9
expect_usage "--nets 16x9" "--nets"
run "$HNBRDF" report images builtin -o r --model m --nets 16x2
expect_usage "--model and --nets" "the whole grid"
run "$HNBRDF" report images builtin -o r --model missing.safetensors
expect_failure "a missing model" "missing.safetensors"
[ ! -e r ] || fail "a refused report made its folder"
run "$HNBRDF" report images builtin:rough-clay -o r --from nowhere --quick
expect_failure "--from nowhere" "nowhere/models/ggx.safetensors"
rm -rf r

materials="builtin:gold-two-lobe builtin:velvet-crimson"
small="--quick --nets 8x1 --steps 100 --pool 2048 --size 24"
samples=8
report() {
    run "$HNBRDF" report images $materials $small --spp $samples "$@"
    [ "$rc" -eq 0 ] || fail "report images $*: exit $rc"
}
report -o r
for name in images.csv images.md images.txt psnr-8x1.svg models/hybrid-8x1-l4.safetensors; do
    [ -s "r/$name" ] || fail "no $name"
done
[ "$(sed -n 1p r/images.csv)" = \
    material,kind,net,encoding,latent,mae,mse,psnr,psnr_error,psnr_bias,peak_error,flip,name ] || fail "columns"
[ "$(sed 1d r/images.csv | cut -d, -f1-5 | tr '\n' ' ')" = "gold-two-lobe,ggx,none,none,0 \
gold-two-lobe,hybrid,8x1,angles,4 gold-two-lobe,hybrid,8x1,directions,4 gold-two-lobe,neural,8x1,angles,12 \
velvet-crimson,ggx,none,none,0 velvet-crimson,hybrid,8x1,angles,4 velvet-crimson,hybrid,8x1,directions,4 \
velvet-crimson,neural,8x1,angles,12 " ] || fail "rows of images.csv"
sed 1d r/images.csv | awk -F, '!($6 > 0 && $7 > 0 && $8 > 5 && $8 < 120 && $9 > 0 && $9 < 5 && $11 >= 0 && $12 > 0 && $12 < 1) { exit 1 }' ||
    fail "figures out of their range"
for text in '24 x 24 pixels, 8 samples' 'built-in sky' '| 8x1 | .* +- ' '| net | hybrid l=4 | paper.s form l=4 | neural l=12 |' \
    '2 of 2 materials done' '## Mean FLIP' 'at 67.02 pixels a degree' 'GGX alone: .* +- ' 'psnr-8x1.svg'; do
    grep -q -e "$text" r/images.md || fail "images.md has no '$text'"
done
[ "$(grep -c '<circle' r/psnr-8x1.svg)" -eq 8 ] || fail "the plot has not 4 curves of 2 materials"

# ---- the stated error covers what another seed changes -------------------------------------------------
report -o s --from r --seed 2
sed 1d s/images.csv | paste -d, - r/images.csv >/dev/null
sed 1d r/images.csv >first && sed 1d s/images.csv >second
# Two figures differ by less than 5 of their joint standard errors, that of the peak included.
paste -d, first second | awk -F, '{ apart = $8 - $21; error = sqrt($9 * $9 + $11 * $11 + $22 * $22 + $24 * $24)
    if ($8 == $21 || apart * apart > 25 * error * error) exit 1 } END { exit NR != 8 }' ||
    fail "seeds differ by more than the stated error: $(paste -d, first second | cut -d, -f1,8,9,11,21,22,24 | tr '\n' ' ')"

# ---- going on -----------------------------------------------------------------------------------------
cp r/images.csv kept.csv
report -o r --resume
cmp -s kept.csv r/images.csv || fail "--resume changed a figure"
# A figure that is there is taken as it is, one that is not is measured again.
sed -e '/^velvet.*neural/d' -e '2s/^\(.*,0,\)[^,]*/\1123/' kept.csv >r/images.csv
report -o r --resume
grep -q '^gold-two-lobe,ggx,none,none,0,123,' r/images.csv || fail "--resume measured again what was there"
[ "$(sed 1,2d r/images.csv)" = "$(sed 1,2d kept.csv)" ] || fail "--resume did not measure what was missing"
samples=4
report -o r --resume
samples=8
grep -q ',123,' r/images.csv && fail "--resume reused figures of other settings"
[ "$(wc -l <r/images.csv)" -eq 9 ] || fail "not all figures are measured anew"

# ---- one model ----------------------------------------------------------------------------------------
"$HNBRDF" report images $materials --quick --pool 2048 --model r/models/hybrid-8x1-l4.safetensors --size 24 \
    --spp 8 -o m >out 2>err ||
    fail "--model"
[ "$(grep hybrid-8x1 m/images.csv | cut -d, -f1,6-)" = "$(grep hybrid-8x1 kept.csv | cut -d, -f1,6-)" ] ||
    fail "the figures of --model differ from those of the grid"
run "$HNBRDF" report images builtin:rough-clay --model r/models/hybrid-8x1-l4.safetensors --size 24 --spp 8 -o n
expect_failure "--model without the material" "has no material rough-clay"

# ---- pictures -----------------------------------------------------------------------------------------
[ -e s/pictures/velvet-crimson-reference.exr ] || finish # built without OpenEXR
[ -s s/images-1.png ] && [ -s s/images-1.exr ] || fail "no picture rows"
# What is kept is what was measured; the mean of two renderings is rounded to float, so 1e-6 of the MAE.
for name in ggx hybrid-8x1-l4; do
    "$HNBRDF" compare --images "s/pictures/velvet-crimson-$name.exr" s/pictures/velvet-crimson-reference.exr --csv - >out
    mae=$(awk -F, 'NR == 2 { print $3 }' out) flip=$(awk -F, 'NR == 2 { print $7 }' out)
    grep "^velvet-crimson.*,$name\$" s/images.csv | awk -F, -v mae="$mae" -v flip="$flip" \
        '{ d = $6 / mae - 1; e = $12 / flip - 1; exit d * d > 1e-10 || e * e > 1e-8 }' ||
        fail "$name: compare --images says $mae, FLIP $flip"
done
# A report that ends early has the figures of what is done, and compares nothing.
mkdir -p p/pictures/velvet-crimson-ggx.exr # no picture can be written there
run "$HNBRDF" report images $materials $small --spp $samples --from r -o p
[ "$rc" -eq 1 ] && grep -q '1 of 2 materials done' p/images.md && [ "$(wc -l <p/images.csv)" -eq 5 ] ||
    fail "a report that ended early: exit $rc"
grep -q '^| hybrid-8x1-l4 | .* +- .* |$' p/images.md && ! grep -q '[+-][0-9.]* +- [0-9.]*, [0-9]* of' p/images.md ||
    fail "an incomplete report names winners"
grep -q '[+-][0-9.]* +- [0-9.]*, [0-9]* of 2 |' s/images.md || fail "a complete one names none"
rm s/pictures/velvet-crimson-reference.exr
report -o s --from r --seed 2 --resume
[ -s s/pictures/velvet-crimson-reference.exr ] || fail "--resume did not make a lost picture again"
sed -i -e '2s/^\(.*,0,\)[^,]*/\1123/' s/images.csv
cp s/images-1.png s/images-2.png
report -o s --from r --seed 2 --rows 1 --resume
[ -s s/images-1.png ] && [ ! -e s/images-2.png ] || fail "--rows 1 --resume: a page of an earlier run is left"
[ "$(grep -c . s/images.csv)" -eq 9 ] || fail "--rows 1 left figures out"
grep -q '^gold-two-lobe,ggx,none,none,0,123,' s/images.csv || fail "--rows 1 --resume measured again what was there"

finish
