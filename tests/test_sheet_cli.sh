#!/bin/sh
# test_sheet_cli.sh HNBRDF FILES: the contact sheet: its columns, what it prints, that neither threads nor a second
# run change a byte, and that a refusal leaves no picture.
set -u
. "$(dirname "$0")/test_cli_support.sh"
"$FILES" . || exit 1
two="--materials gold-two-lobe,velvet-crimson --size 32 --spp 2"

# size PNG: width and height, from its header.
size() {
    od -An -tu1 -j16 -N8 "$1" | awk '{ print $3 * 256 + $4, $7 * 256 + $8 }'
}
# expect_columns NAME HEADER ROWS: the table's first line and how many follow, each a name and as many numbers as
# the header asks for; then the file's name, which is taken off.
expect_columns() {
    [ "$rc" -eq 0 ] || fail "$1: exit $rc" # on a busy machine stderr shows the progress
    tail -n 1 out | grep -q '^[a-z]*\.png$' || fail "$1: the file is not named"
    sed -i '$d' out
    [ "$(head -n 1 out | tr -s ' ')" = "$2" ] || fail "$1: expected the columns $2"
    awk -v rows="$3" -v fields="$(head -n 1 out | grep -o PSNR | wc -l)" '
        NR > 1 && (NF != 1 + 2 * fields || !($2 > 0)) { exit 1 }
        END { exit NR != rows + 1 }' out || fail "$1: expected $3 rows of numbers"
}

run "$HNBRDF" sheet hybrid.safetensors builtin $two -o plain.png
expect_columns "hybrid" "material MAE GGX PSNR MAE model PSNR" 2
cp out hybrid.out
run "$HNBRDF" sheet hybrid.safetensors builtin $two --threads 1 -o again.png
expect_columns "one thread" "material MAE GGX PSNR MAE model PSNR" 2
cmp -s plain.png again.png && cmp -s out hybrid.out || fail "one thread gives another page"
run "$HNBRDF" sheet hybrid.safetensors builtin $two --seed 2 -o again.png
expect_columns "seed" "material MAE GGX PSNR MAE model PSNR" 2
! cmp -s plain.png again.png || fail "another seed gives the same page"

# Differences are two columns more and print the same; one block of materials is higher than two.
run "$HNBRDF" sheet hybrid.safetensors builtin $two --difference -o wide.png
expect_columns "difference" "material MAE GGX PSNR MAE model PSNR" 2
cmp -s out hybrid.out || fail "--difference changes the errors"
[ "$(size wide.png | cut -d' ' -f1)" -gt "$(size plain.png | cut -d' ' -f1)" ] || fail "--difference: not wider"
run "$HNBRDF" sheet hybrid.safetensors builtin $two --columns 1 -o one.png
run "$HNBRDF" sheet hybrid.safetensors builtin $two --columns 2 -o two.png
[ "$(size one.png | cut -d' ' -f2)" -gt "$(size two.png | cut -d' ' -f2)" ] || fail "--columns 1: not higher"

# A ggx model has no other column; --ggx takes the GGX column from another model: a rougher gold is further off.
run "$HNBRDF" sheet ggx.safetensors builtin $two -o ggx.png
expect_columns "ggx" "material MAE GGX PSNR" 2
run "$HNBRDF" edit ggx.safetensors --material gold-two-lobe --set alpha=0.9 -o rough.safetensors
run "$HNBRDF" sheet hybrid.safetensors builtin $two --ggx rough.safetensors -o other.png
expect_columns "--ggx" "material MAE GGX PSNR MAE model PSNR" 2
awk 'NR == FNR { mae[$1] = $2; next }
    $1 ~ /gold/ && !($2 > 1.04 * mae[$1]) { exit 1 }
    $1 ~ /velvet/ && $2 != mae[$1] { exit 1 }' hybrid.out out ||
    fail "--ggx: not the errors of that model"
run "$HNBRDF" sheet hybrid.safetensors builtin:velvet-crimson --env sky.hdr --size 32 --spp 2 --exposure 1 -o env.png
expect_columns "all there are data of" "material MAE GGX PSNR MAE model PSNR" 1

# What cannot be shown.
run "$HNBRDF" sheet hybrid.safetensors builtin --materials nobody -o none.png
expect_failure "unknown material" "no material 'nobody'"
run "$HNBRDF" sheet hybrid.safetensors builtin:retro-tape --materials velvet-crimson -o none.png
expect_failure "no data" "velvet-crimson: none of the data has this name"
run "$HNBRDF" sheet hybrid.safetensors lambert.binary -o none.png
expect_failure "nothing in common" "none of its materials is among the data"
run "$HNBRDF" sheet builtin:velvet-crimson builtin -o none.png
expect_failure "no model" "measured data, expected a model file"
run "$HNBRDF" sheet hybrid.safetensors builtin --ggx one.safetensors $two -o none.png
expect_failure "--ggx without the material" "one.safetensors: has no material gold-two-lobe"
run "$HNBRDF" sheet hybrid.safetensors builtin --ggx missing.safetensors -o none.png
expect_failure "--ggx missing" "missing.safetensors"
run "$HNBRDF" sheet hybrid.safetensors -o none.png
expect_usage "no data" "expected MODEL and DATA"
[ ! -e none.png ] || fail "a refused sheet leaves a picture"
run "$HNBRDF" sheet hybrid.safetensors builtin $two -o page.exr
if [ "$rc" -eq 0 ]; then
    [ -s page.exr ] && cmp -s page.png plain.png || fail "page.exr: expected plain.png beside it"
else
    expect_failure "without OpenEXR" "OpenEXR"
fi
finish
