#!/bin/sh
# test_measured_cli.sh HNBRDF FILES: the options that say how measured files are read, in every command that
# reads them, and what `info` tells of them.
set -u
. "$(dirname "$0")/test_cli_support.sh"

"$FILES" . || exit 1
mkdir utia
# 248832 doubles of 0.5, by doubling.
printf '\000\000\000\000\000\000\340\077' >half
for step in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18; do
    cat half half >more
    mv more half
done
head -c 1990656 half >utia/cloth.bin
pair='0,0,1,0,0.6,0.8\n'

for command in fit eval compare info render sheet; do
    run "$HNBRDF" "$command" --help
    for option in merl merl-node utia utia-scale utia-no-extrapolate spectra; do
        grep -q -e "--$option" out || fail "$command --help: no --$option"
    done
    run "$HNBRDF" "$command" --merl cubic
    expect_usage "$command --merl cubic" "merl: found 'cubic', expected nearest|trilinear"
    run "$HNBRDF" "$command" --utia-scale 0
    expect_usage "$command --utia-scale 0" "utia-scale: 0 is out of range"
done
for command in eval compare info render sheet; do
    run "$HNBRDF" "$command" --help
    grep -q -e "--signed" out || fail "$command --help: no --signed"
done

# UTIA: 0.5 as it stands, 100/12.92/140 of it, and through the sRGB curve.
run_in "$pair" "$HNBRDF" eval utia/cloth.bin --utia raw
expect_out "utia raw" 'f_r,f_g,f_b\n0.5,0.5,0.5\n'
run_in "$pair" "$HNBRDF" eval utia/cloth.bin --utia=raw --utia-scale 3
expect_out "utia scale" 'f_r,f_g,f_b\n1.5,1.5,1.5\n'
run_in "$pair" "$HNBRDF" eval utia/cloth.bin
awk -F, 'NR == 2 { exit !($1 > 0.027642 && $1 < 0.027643) }' out || fail "utia djb: $(tail -1 out)"
run_in "$pair" "$HNBRDF" eval utia/cloth.bin --utia srgb
awk -F, 'NR == 2 { exit !($1 > 0.21404 && $1 < 0.21405) }' out || fail "utia srgb: $(tail -1 out)"
run "$HNBRDF" info utia/cloth.bin
expect_ok "info of UTIA"
grep -q "mode djb, directional albedo 0.087 at 0 and 0.087 at 45 degrees" out || fail "info of UTIA"
run "$HNBRDF" info utia --utia raw
grep -q "^cloth  *UTIA .*WARNING: more than arrives" out || fail "info of a directory with UTIA"
head -c 1990655 half >utia/cut.bin
run "$HNBRDF" info utia
expect_failure "a cut UTIA file" "cut.bin: 1990655 bytes, expected a UTIA .bin of exactly 1990656"

# Bytes 8 to 16 of a UTIA file may look like the beginning of a model; its first double never does.
{ printf '\000\000\000\000\000\000\340\077{'; tail -c +10 utia/cloth.bin; } >brace.bin
run "$HNBRDF" info brace.bin
expect_ok "UTIA with a brace"
grep -q "format  *UTIA" out || fail "UTIA with a brace is taken for something else"

# NBRDF: six files are one material, whichever is named. All weights 0, the last biases 1: e - 1.
put_npy() { # FILE SHAPE NUMBERS
    printf "%-117s\n" "{'descr': '<f4', 'fortran_order': False, 'shape': ($2), }" >header
    { printf '\223NUMPY\001\000\166\000'; cat header; head -c $((4 * $3)) /dev/zero; } >"$1"
}
mkdir nets
for name in gold gold_b; do
    put_npy nets/${name}_fc1.npy "6, 21" 126
    put_npy nets/${name}_b1.npy "21," 21
    put_npy nets/${name}_fc2.npy "21, 21" 441
    put_npy nets/${name}_b2.npy "21," 21
    put_npy nets/${name}_fc3.npy "21, 3" 63
    put_npy nets/${name}_b3.npy "3," 0
    for channel in 1 2 3; do printf '\000\000\200\077' >>nets/${name}_b3.npy; done
done
run "$HNBRDF" info nets
expect_ok "info of a directory of NBRDF"
[ "$(wc -l <out)" -eq 3 ] || fail "two materials in twelve files: $(cat out)"
grep -q "^gold  *NBRDF  *yes  *NBRDF network 6-21-21-3 from six .npy files" out || fail "info of NBRDF: $(cat out)"
for path in nets/gold nets/gold_fc1.npy nets/gold_b3.npy nets/gold_b_b2.npy; do
    run_in "$pair" "$HNBRDF" eval $path
    expect_out "eval $path" 'f_r,f_g,f_b\n1.71828187,1.71828187,1.71828187\n'
done
rm nets/gold_b2.npy
run "$HNBRDF" info nets
expect_failure "a part is missing" "nets/gold_b2.npy: cannot be opened for reading"
run "$HNBRDF" info nets/gol
expect_failure "no such material" "nets/gol: No such file or directory"

# MERL: the lookup is told, the checksum compared.
run "$HNBRDF" info lambert.binary --merl trilinear --merl-node edge
grep -q "trilinear between lower edges" out || fail "info of MERL does not tell the lookup"
grep -q "not one of the 100 published files" out || fail "info of MERL does not tell the checksum"
run "$HNBRDF" info lambert.binary --json
grep -q '"published": null' out || fail "info --json of MERL: no published"
run_in "$pair" "$HNBRDF" eval lambert.binary --merl trilinear
awk -F, 'NR == 2 { exit !($1 > 0.999999 && $1 < 1.000001 && $3 > 1.659999 && $3 < 1.660001) }' out ||
    fail "merl trilinear: $(tail -1 out)"

# Procedural materials: so many, or one by its number.
run "$HNBRDF" info procedural:3
expect_ok "info of procedural materials"
[ "$(grep -c '^procedural-[012] ' out)" -eq 3 ] || fail "three procedural materials: $(cat out)"
run "$HNBRDF" info builtin:procedural-17
grep -q "random terms" out || fail "info of one procedural material: $(cat out)"
for wrong in 0 x -1 1000000 3x ''; do
    run "$HNBRDF" info "procedural:$wrong"
    expect_failure "procedural:$wrong" "procedural:$wrong: expected a number of materials, 1 to 999999"
done
run "$HNBRDF" info builtin:procedural-x
expect_failure "procedural-x" "no material 'procedural-x' in builtin"

# What is not the default is told beside every error and fit.
run "$HNBRDF" fit lambert.binary --kind ggx --merl trilinear --merl-node edge --utia raw -o lambert.safetensors
expect_ok "fit with reading options"
grep -q "read with --merl trilinear --merl-node edge --utia raw$" out || fail "fit does not tell how data are read"
run "$HNBRDF" compare lambert.safetensors lambert.binary --pairs 1000 --merl trilinear
grep -q "read with --merl trilinear --merl-node centre$" out || fail "compare does not tell how data are read"
run "$HNBRDF" compare lambert.safetensors lambert.binary --pairs 1000
grep -q "read with" out && fail "compare tells of defaults"

# What a network knows of materials that it has not seen, in small.
mkdir held
cp lambert_rgb.bsdf held/one.bsdf
cp lambert_rgb.bsdf held/two.bsdf
cp lambert.binary held/three.binary
ROTATIONS=1 STEPS=20 COUNTS="0 2" NET=16x2 LATENT=2 PAIRS=500 SIZE=32 HNBRDF=$HNBRDF WORK=work \
    sh "$(dirname "$0")/../examples/holdout.sh" held > out 2> err || fail "holdout.sh: $(cat err)"
for row in '| 0 | ' '| 2 | ' '| one | '; do
    grep -q "^$row" out || fail "holdout.sh: no row $row: $(cat out)"
done
[ -e work/0/seen/two.bsdf ] && [ ! -e work/0/seen/one.bsdf ] || fail "holdout.sh trains on what it leaves out"
finish
