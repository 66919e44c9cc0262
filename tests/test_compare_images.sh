#!/bin/sh
# test_compare_images.sh HNBRDF FILES: `compare --images`: known errors, alpha, what cannot be compared, differences.
set -u
. "$(dirname "$0")/test_cli_support.sh"

# Radiance pictures of 2 x 1 pixels; 200 201 is the mantissa 128 and the exponent of 1, and so on.
hdr() {
    printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n'"$2" >"$1"
}
one='\200\200\200\201' two='\200\200\200\202' four='\200\200\200\203' black='\0\0\0\0'
hdr image.hdr "$one$two"
hdr reference.hdr "$one$four"
hdr black.hdr "$black$black"
printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n'"$one" >small.hdr

# ---- figures: |1 - 1|, |2 - 4|: MAE 1, MSE 2, PSNR 10 log10(16/2) -------------------------------------
run "$HNBRDF" compare --images image.hdr reference.hdr --csv -
expect_ok "compare --images"
[ "$(sed -n 1p out)" = image,reference,mae,mse,psnr,pixels,flip ] || fail "columns"
sed 1d out | awk -F, '$1 == "image.hdr" && $2 == "reference.hdr" && $3 == 1 && $4 == 2 && $6 == 2 &&
    $5 > 9.0308 && $5 < 9.0310 { good = 1 } END { exit !good || NR != 1 }' || fail "figures"
run "$HNBRDF" compare --images reference.hdr image.hdr reference.hdr --json -
expect_ok "compare --images, JSON"
if command -v python3 >/dev/null; then
    python3 - out 2>err <<'END' || fail "JSON"
import json, sys
t = json.load(open(sys.argv[1]))
same, other = t["images"]
assert t["reference"] == "reference.hdr" and same["name"] == "reference.hdr" and other["name"] == "image.hdr"
assert same["mae"] == 0 and same["psnr"] is None and other["mse"] == 2 and other["pixels"] == 2
END
fi
# Both white where it is displayed with exposure 0, so that nobody sees a difference; black against white: 0.9674.
run "$HNBRDF" compare --images image.hdr reference.hdr --exposure 0 --csv -
awk -F, 'NR == 2 && $7 == 0 { good = 1 } END { exit !good }' out || fail "FLIP of white pictures: $(cat out)"
run "$HNBRDF" compare --images black.hdr reference.hdr --exposure 0 --ppd 40 --csv -
awk -F, 'NR == 2 && $7 > 0.9673 && $7 < 0.9675 { good = 1 } END { exit !good }' out || fail "black, white: $(cat out)"
run "$HNBRDF" compare --images image.hdr reference.hdr --csv -
awk -F, 'NR == 2 && $7 > 0.05 && $7 < 0.5 { good = 1 } END { exit !good }' out || fail "HDR-FLIP: $(cat out)"
run "$HNBRDF" compare image.hdr reference.hdr --exposure 1
expect_usage "--exposure without --images" "belong to --images"
run "$HNBRDF" compare --images reference.hdr black.hdr
expect_ok "a black reference"
grep -q -- '-inf' out || fail "a black reference has a PSNR"
run "$HNBRDF" compare --images reference.hdr reference.hdr
grep -q ' equal ' out || fail "equal pictures are not said to be equal"

# ---- differences ------------------------------------------------------------------------------------
run "$HNBRDF" compare --images image.hdr reference.hdr --difference where.png
expect_ok "--difference"
grep -qx where.png out && [ -s where.png ] || fail "no difference picture"
run "$HNBRDF" compare --images image.hdr reference.hdr --difference where.png --csv -
[ "$(wc -l <out)" -eq 2 ] || fail "the CSV on standard output is mixed with something else"
cp where.png chosen.png
run "$HNBRDF" compare --images image.hdr reference.hdr --difference where.png --scale 2
cmp -s where.png chosen.png || fail "the scale chosen for a difference of 2 is not 2"
run "$HNBRDF" compare --images image.hdr reference.hdr --difference where.png --scale 100
cmp -s where.png chosen.png && fail "--scale changes nothing"

# ---- what is refused --------------------------------------------------------------------------------
run "$HNBRDF" compare --images image.hdr
expect_usage "one picture" "found 1 picture, expected IMAGE... REFERENCE"
run "$HNBRDF" compare --images image.hdr black.hdr reference.hdr --difference where.png
expect_usage "three pictures, --difference" "expected IMAGE REFERENCE"
run "$HNBRDF" compare image.hdr reference.hdr --difference where.png
expect_usage "--difference without --images" "belong to --images"
run "$HNBRDF" compare --images image.hdr reference.hdr --against m
expect_usage "--images --against" "not for --images"
run "$HNBRDF" compare --images image.hdr reference.hdr --difference where.jpg
expect_usage "--difference where.jpg" "ending in"
run "$HNBRDF" compare --images image.hdr reference.hdr --difference no/where.png
expect_failure "--difference in no folder" "no/where.png"
run "$HNBRDF" compare --images small.hdr reference.hdr
expect_failure "sizes" "small.hdr is 1 x 1, the reference reference.hdr 2 x 1"
run "$HNBRDF" compare --images missing.hdr reference.hdr
expect_failure "a missing picture" "missing.hdr"
printf 'not a picture' >text.exr
run "$HNBRDF" compare --images text.exr reference.hdr
expect_failure "no picture" "text.exr: neither"

# ---- OpenEXR: alpha, values that are not finite -------------------------------------------------------
if ! "$HNBRDF" render builtin:rough-clay --size 24 --spp 4 --background none -o a.exr >out 2>err; then
    grep -q "without OpenEXR" err || fail "render a.exr"
    finish
fi
"$HNBRDF" render builtin:velvet-crimson --size 24 --spp 4 --background none -o b.exr >out 2>err || fail "render b.exr"
"$HNBRDF" render builtin:velvet-crimson --size 24 --spp 4 -o backdrop.exr >out 2>err || fail "render backdrop.exr"
pixels() {
    "$HNBRDF" compare --images "$1" "$2" --csv - | awk -F, 'NR == 2 { print $6 }'
}
# A disc of 24/1.06 pixels holds 403 whole ones; with its rim, up to twice its outline more.
n=$(pixels a.exr b.exr)
[ "$n" -gt 403 ] && [ "$n" -lt 545 ] || fail "$n of 576 pixels count where both pictures have alpha"
[ "$(pixels a.exr backdrop.exr)" -eq 576 ] || fail "an opaque picture does not count as a whole"
run "$HNBRDF" compare --images a.exr b.exr --difference where.exr
expect_ok "--difference where.exr"
[ -s where.exr ] && [ -s where.png ] || fail "no EXR, or no PNG beside it"

# exr FILE VALUE: one pixel, uncompressed, blue and green 1 and red VALUE (4 bytes, as printf writes them).
exr() {
    int1='\001\0\0\0' none='\0\0\0\0'
    {
        printf 'v/1\001\002\0\0\0'
        printf 'channels\0chlist\0\067\0\0\0'
        for channel in B G R; do printf "$channel"'\0\002\0\0\0\0\0\0\0'"$int1$int1"; done
        printf '\0compression\0compression\0\001\0\0\0\0'
        for window in dataWindow displayWindow; do printf "$window"'\0box2i\0\020\0\0\0'"$none$none$none$none"; done
        printf 'lineOrder\0lineOrder\0\001\0\0\0\0pixelAspectRatio\0float\0\004\0\0\0\0\0\200\077'
        printf 'screenWindowCenter\0v2f\0\010\0\0\0'"$none$none"
        printf 'screenWindowWidth\0float\0\004\0\0\0\0\0\200\077\0'
    } >"$1"
    at=$(($(wc -c <"$1") + 8))
    printf "\\$(printf %o $((at % 256)))\\$(printf %o $((at / 256)))"'\0\0\0\0\0\0' >>"$1"
    printf "$none"'\014\0\0\0\0\0\200\077\0\0\200\077'"$2" >>"$1"
}
exr finite.exr '\0\0\0\100'
exr nan.exr '\0\0\300\177'
run "$HNBRDF" compare --images finite.exr small.hdr --csv -
expect_ok "a picture of one pixel"
# Red is 2 instead of 1: a third of a value.
awk -F, 'NR == 2 && $3 > 0.3333 && $3 < 0.3334 { good = 1 } END { exit !good }' out || fail "one pixel: $(cat out)"
run "$HNBRDF" compare --images nan.exr small.hdr
expect_failure "NaN" "nan.exr: 1 pixel is not finite, the first at column 0, row 0: (nan, 1, 1)"

finish
