#!/bin/sh
# test_cli_hostile.sh HNBRDF FILES: files that are truncated, corrupted, empty, of another kind or of an
# absurd size give exactly one line on stderr and exit 1, for every kind of file that is read.
set -u
. "$(dirname "$0")/test_cli_support.sh"

"$FILES" . || exit 1
builtin=$("$HNBRDF" info builtin | awk 'NR == 2 { print $1 }')
"$HNBRDF" render "builtin:$builtin" --size 8 --spp 1 -o sky.exr >out 2>err ||
    echo "no OpenEXR: environments are tested as files that cannot be read"
pairs='0.6,0,0.8,0,0,1'
{
    echo wi_x,wi_y,wi_z,wo_x,wo_y,wo_z
    echo "$pairs"
} >pairs.csv

# ---- Spoiling files -----------------------------------------------------------------------------------
size_of() { wc -c <"$1" | tr -d ' '; }
truncate_to() { dd if="$1" of="$2" bs="$3" count=1 2>/dev/null; }
# put_bytes FILE OFFSET OCTAL: writes bytes over the file, printf's escapes.
put_bytes() { printf "$3" | dd of="$1" bs=1 seek="$2" conv=notrunc 2>/dev/null; }
# offset_of FILE HEX: the first place of these bytes among the first 64 KiB.
offset_of() {
    dd if="$1" bs=65536 count=1 2>/dev/null | od -An -v -tx1 | tr -d ' \n' |
        awk -v hex="$2" '{ k = index($0, hex); print k ? (k - 1) / 2 : -1 }'
}

# must_fail NAME FILE COMMAND...: exit 1 and one line that names the file (of a .brdf, the material).
must_fail() {
    name=$1 file=$2
    shift 2
    run "$@" "$file"
    expect_failure "$name" "${file%.brdf}"
}
# must_not_crash NAME FILE COMMAND...: either good, or exit 1 with one line.
must_not_crash() {
    name=$1 file=$2
    shift 2
    run "$@" "$file"
    [ "$rc" -eq 0 ] || expect_failure "$name" .
}

# spoil FILE COMMAND...: the whole programme for one kind; COMMAND takes the file as last argument.
spoil() {
    good=$1
    shift
    kind=${good##*.}
    bad=bad.$kind
    : >"$bad"
    must_fail "$kind: empty" "$bad" "$@"
    printf 'This is a letter, not a file of data.\n' >"$bad"
    must_fail "$kind: a letter" "$bad" "$@"
    dd if=/dev/zero of="$bad" bs=65536 count=1 2>/dev/null
    must_fail "$kind: zeros" "$bad" "$@"
    tr '\000' '\377' <"$bad" >ones
    mv ones "$bad"
    must_fail "$kind: ones" "$bad" "$@"
    truncate_to "$HNBRDF" "$bad" 20000
    must_fail "$kind: a program" "$bad" "$@"
    rm "$bad"
    mkdir "$bad"
    must_fail "$kind: a directory" "$bad" "$@"
    rmdir "$bad"
    must_fail "$kind: missing" "$bad" "$@"

    [ -f "$good" ] || return 0
    size=$(size_of "$good")
    for length in 1 7 8 9 11 12 13 18 20 100 $((size / 4)) $((size / 2)); do
        [ "$length" -lt "$size" ] || continue
        truncate_to "$good" "$bad" "$length"
        must_fail "$kind: truncated to $length bytes" "$bad" "$@"
    done
    truncate_to "$good" "$bad" $((size - 1))
    must_not_crash "$kind: one byte short" "$bad" "$@"
    cp "$good" "$bad"
    put_bytes "$bad" 0 'XXXX'
    # The first words of a .brdf and of an old Radiance picture, which says its format later, are not needed.
    case $kind in
    brdf | hdr) ;;
    *) must_fail "$kind: wrong magic" "$bad" "$@" ;;
    esac
    rm "$bad"
    [ "$size" -lt 1000000 ] || return 0
    # One byte of three a place, in turn; what every byte does to a reader is for fuzz_replay_*.
    step=$((size / 40 + 1)) at=1
    set -- '\377' '\000' '9' "$@"
    while [ "$at" -lt "$size" ]; do
        byte=$1 second=$2 third=$3
        shift 3
        cp "$good" "$bad"
        put_bytes "$bad" "$at" "$byte"
        must_not_crash "$kind: byte $at is $byte" "$bad" "$@"
        set -- "$second" "$third" "$byte" "$@"
        at=$((at + step))
    done
    rm "$bad"
}

spoil hybrid.safetensors "$HNBRDF" info
spoil lambert_rgb.bsdf "$HNBRDF" info
spoil lambert.binary "$HNBRDF" info
spoil a.brdf "$HNBRDF" import -o imported.safetensors
spoil sky.exr "$HNBRDF" render "builtin:$builtin" --size 8 --spp 1 -o picture.exr --env
spoil sky.hdr "$HNBRDF" render "builtin:$builtin" --size 8 --spp 1 -o picture.png --env
spoil pairs.csv "$HNBRDF" eval "builtin:$builtin" -i

# ---- Absurd sizes -------------------------------------------------------------------------------------
for length in '\377\377\377\377\377\377\377\377' '\000\000\000\000\000\001\000\000' '\377\377\377\177\000\000\000\000'; do
    cp hybrid.safetensors bad.safetensors
    put_bytes bad.safetensors 0 "$length"
    must_fail "safetensors: header of $length bytes" bad.safetensors "$HNBRDF" info
done
# header TEXT: a safetensors file of this header and 64 bytes of zeros.
header() {
    printf '%b' "$(printf '\\0%03o\\0%03o\\0000\\0000\\0000\\0000\\0000\\0000' $((${#1} % 256)) $((${#1} / 256)))" >bad.safetensors
    printf '%s' "$1" >>bad.safetensors
    dd if=/dev/zero bs=64 count=1 2>/dev/null >>bad.safetensors
}
meta='"__metadata__":{"format":"hnbrdf/1","kind":"ggx","materials":"[\"m\"]"}'
for shape in 4294967296,4294967296 18446744073709551615 99999999999999999999999 -1,3 1e9,3 0,3; do
    header "{$meta,\"material.kd\":{\"dtype\":\"F32\",\"shape\":[$shape],\"data_offsets\":[0,12]}}"
    must_fail "safetensors: shape $shape" bad.safetensors "$HNBRDF" info
done
for offsets in 0,18446744073709551615 4611686018427387904,12 12,0 60,72; do
    header "{$meta,\"material.kd\":{\"dtype\":\"F32\",\"shape\":[1,3],\"data_offsets\":[$offsets]}}"
    must_fail "safetensors: offsets $offsets" bad.safetensors "$HNBRDF" info
done
header "$(awk 'BEGIN { printf "{\"a\":"; for (k = 0; k < 60000; k++) printf "[" }')"
must_fail "safetensors: nested 60000 deep" bad.safetensors "$HNBRDF" info

for shape in '\377\377\377\377\377\377\377\377' '\000\000\000\000\000\000\000\100' '\000\000\000\000\000\000\000\000'; do
    cp lambert_rgb.bsdf bad.bsdf
    put_bytes bad.bsdf $(($(offset_of bad.bsdf 72676205000a) + 14)) "$shape" # rgb, 5 axes, f32, offset
    must_fail "bsdf: shape $shape" bad.bsdf "$HNBRDF" info
done
cp lambert_rgb.bsdf bad.bsdf
put_bytes bad.bsdf 14 '\377\377\377\377'
must_fail "bsdf: 4294967295 fields" bad.bsdf "$HNBRDF" info
cp lambert_rgb.bsdf bad.bsdf
put_bytes bad.bsdf $(($(offset_of bad.bsdf 72676205000a) + 3)) '\377\377'
must_fail "bsdf: 65535 axes" bad.bsdf "$HNBRDF" info

dd if=lambert.binary of=small.binary bs=4096 count=1 2>/dev/null
for sizes in '\377\377\377\177\377\377\377\177\377\377\377\177' '\132\000\000\000\264\000\000\000\132\000\000\000' \
    '\246\377\377\377\246\377\377\377\264\000\000\000' '\000\000\001\000\000\000\001\000\000\000\001\000'; do
    cp small.binary bad.binary
    put_bytes bad.binary 0 "$sizes"
    must_fail "MERL: sizes $sizes" bad.binary "$HNBRDF" info
done

sed '/diffuse_g/d' a.brdf >bad.brdf
must_fail "brdf: no diffuse_g" bad.brdf "$HNBRDF" import -o imported.safetensors
awk '{ print } /mat4\(/ && !done++ { printf "vec4 f9_9 = mat4("; for (k = 0; k < 100000; k++) printf "1,"; print "0);" }' a.brdf >bad.brdf
must_fail "brdf: a matrix of 100001 numbers" bad.brdf "$HNBRDF" import -o imported.safetensors
awk 'BEGIN { for (k = 0; k < 200000; k++) printf "float latent_%d 0 1 0\n", k }' >bad.brdf
must_fail "brdf: 200000 parameters" bad.brdf "$HNBRDF" import -o imported.safetensors
sed 's/float alpha .*/float alpha 0 1 -3/' a.brdf >bad.brdf
must_fail "brdf: negative alpha" bad.brdf "$HNBRDF" import -o imported.safetensors
sed 's/float alpha .*/float alpha 0 1 nan/' a.brdf >bad.brdf
must_fail "brdf: alpha is not a number" bad.brdf "$HNBRDF" import -o imported.safetensors
mkdir other
cp a.brdf other/a.brdf
run "$HNBRDF" import a.brdf other/a.brdf -o imported.safetensors
expect_failure "import: two of one name" "two materials have the name a: a.brdf and other/a.brdf"
run "$HNBRDF" import a.brdf b.brdf -o imported.safetensors
expect_ok "import"
run "$HNBRDF" info imported.safetensors --json
grep -q '"materials": \["a", "b"\]' out || fail "import: names"
cp a.brdf Ours_ld4_32x2_lambert_rgb.brdf
sed 's/float alpha .*/float alpha 0 1 1.005/' b.brdf >Ours_ld4_32x2_b.brdf
run "$HNBRDF" import a.brdf Ours_ld4_32x2_lambert_rgb.brdf Ours_ld4_32x2_b.brdf -o imported.safetensors
[ "$rc" -eq 0 ] && [ "$(grep -c warning: err)" -eq 1 ] &&
    grep -q "warning: Ours_ld4_32x2_b.brdf: line [0-9]*: alpha of b is 1.005" err ||
    fail "import: alpha above 1"
grep -q "^2 of 3 materials are named .* as lambert of Ours_ld4_32x2_lambert_rgb.brdf$" out ||
    fail "import: what was renamed"
run "$HNBRDF" compare imported.safetensors lambert_rgb.bsdf --pairs 16
[ "$rc" -eq 0 ] && grep -q '^lambert ' out || fail "import: the measurement of a published name is not found"
run "$HNBRDF" import b.brdf Ours_ld4_32x2_b.brdf -o imported.safetensors
expect_failure "import: two that become one name" "two materials have the name b: b.brdf and Ours_ld4_32x2_b.brdf"
run "$HNBRDF" import lambert_rgb.bsdf -o imported.safetensors
expect_failure "import: a measurement" "lambert_rgb.bsdf: measured data in a tensor file .RGL .bsdf., expected a published"
sed '/f1_0 = /s/0\.2/0.1/' b.brdf >other_net.brdf
run "$HNBRDF" import a.brdf other_net.brdf -o imported.safetensors
expect_failure "import: another network" "other_net"

for resolution in '-Y 2000000000 +X 2000000000' '-Y 18446744073709551617 +X 4' '-Y 0 +X 0' '-Y -2 +X 4' '-Y 2 +X 40000'; do
    sed "s/-Y 2 +X 4/$resolution/" sky.hdr >bad.hdr
    must_fail "Radiance: $resolution" bad.hdr "$HNBRDF" render "builtin:$builtin" --size 8 --spp 1 \
        -o picture.png --env
done
if [ -f sky.exr ]; then
    at=$(offset_of sky.exr 6461746157696e646f7700) # dataWindow, box2i, size
    for window in '\000\000\000\000\000\000\000\000\377\377\377\177\377\377\377\177' \
        '\000\000\000\200\000\000\000\200\377\377\377\177\377\377\377\177' \
        '\000\000\000\000\000\000\000\000\000\000\020\000\000\000\020\000' \
        '\011\000\000\000\011\000\000\000\000\000\000\000\000\000\000\000'; do
        cp sky.exr bad.exr
        put_bytes bad.exr $((at + 11 + 6 + 4)) "$window"
        must_fail "EXR: window $window" bad.exr "$HNBRDF" render "builtin:$builtin" --size 8 --spp 1 \
            -o picture.exr --env
    done
fi
[ ! -f picture.exr.*part ] || fail "a failed render leaves its file behind"

finish
