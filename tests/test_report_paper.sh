#!/bin/sh
# test_report_paper.sh HNBRDF FILES: `report accuracy --paper` tells whose data it has, and puts the paper's figures,
# the published networks and those of Neural-BRDF beside ours.
set -u
. "$(dirname "$0")/test_cli_support.sh"

"$FILES" . || fail "test files"
report() {
    run "$HNBRDF" report accuracy "$@" --paper --quick --steps 5 --pairs 200 --pool 256 --images 8
    [ "$rc" -eq 0 ] || fail "report accuracy $*: exit $rc"
}
has() {
    for text; do
        grep -q -e "$text" out || fail "no '$text'"
    done
}

# ---- RGL and UTIA are known by their names ------------------------------------------------------------
mkdir rgl utia mixed published
for name in paper_white vch_silk_blue; do cp lambert_rgb.bsdf rgl/${name}_rgb.bsdf; done
cp a.brdf published/Ours_ld4_16x2_paper_white_rgb.brdf
report rgl --nets 16x2 --published published -o r
has 'Data: 2 of the 62 materials of RGL, by their names; what the files hold is not checked' '^| GGX alone | 8 | 0.64 | ' \
    "^| 16x2 paper's form, l = 4 | 12 | 0.6184 | " '^| 16x2 hybrid, l = 4 | 12 | | ' '^| 16x2 neural, l = 12 | 12 | 0.7552 | ' \
    'a network has 2 materials here and 62 there' 'the published networks, 8x2, l = 4, 1 of 2 | 12 | | ' \
    '^| GGX alone, of those 1 | 8 | | ' 'does not say how it draws directions' '^| GGX alone | 8 | 33.51 | '
has 'r/report.md'
sed -n '/^## Beside/,/^r.report/p' out | grep '^| ' >printed
sed -n '/^## Beside/,/^## Mean/p' r/report.md | grep '^| ' | cmp -s - printed || fail "report.md says something else"
# The row of the published network is what compare says.
"$HNBRDF" import published/*.brdf -o p.safetensors >/dev/null 2>&1 || fail import
value=$("$HNBRDF" compare p.safetensors rgl --skip-missing --sampler uniform --pairs 200 --csv - |
    awk -F, '$1 == "mean" { printf "%.4f", $2 }')
grep 'the published networks' out >/dev/null
sed -n 's/^| the published networks[^|]*| 12 | | [^|]* | \([^ ]*\) |.*/\1/p' printed | grep -qx "$value" ||
    fail "the published networks: $(grep published printed), compare says $value"
report rgl --nets 16x2 --published p.safetensors --resume -o r
sed -n '/^## Beside/,/^r.report/p' out | grep '^| ' | cmp -s - printed || fail "a model in the place of shaders differs"

head -c 1990656 /dev/zero >utia/m003_carpet01.bin # 288 x 288 x 3 doubles
report utia --models hybrid --nets 16x2 -o u
has 'Data: 1 of the 150 materials of UTIA' '^| GGX alone | 8 | 0.19 | '
# ---- anything else has nothing printed beside it ------------------------------------------------------
cp lambert_rgb.bsdf mixed/satin_white_rgb.bsdf
report mixed builtin:rough-clay --models hybrid -o m
has 'Data: 1 of the 62 materials of RGL, by their names; .*; 1 material of no database of the paper' \
    'nothing printed stands beside ours' '^| GGX alone | 8 | | '
cp lambert.binary paper_white.binary # not the published file of any name
report paper_white.binary --models hybrid -o n
has 'Data: 1 material of no database of the paper'

# ---- NBRDF: a network against itself ------------------------------------------------------------------
if command -v python3 >/dev/null; then
    mkdir nb
    python3 - <<'END'
import struct
for name, shape in (("fc1", (6, 21)), ("b1", (21,)), ("fc2", (21, 21)), ("b2", (21,)), ("fc3", (21, 3)), ("b3", (3,))):
    count = shape[0] * (shape[1] if len(shape) > 1 else 1)
    header = "{'descr': '<f4', 'fortran_order': False, 'shape': %s, }" % (shape,)
    header = header.encode().ljust(117) + b"\n"
    with open("nb/net_%s.npy" % name, "wb") as f:
        f.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header)
        f.write(struct.pack("<%df" % count, *[0.1 * ((7 * k) % 5) for k in range(count)]))
END
    report nb --models hybrid --nbrdf nb -o b
    has '^| NBRDF, a network a material, 1 of 1 | 675 | | 0.0000 | 0.0000 | 0.0000 |'
fi

# ---- what is refused ----------------------------------------------------------------------------------
run "$HNBRDF" report accuracy builtin -o x --published published
expect_usage "--published without --paper" "belong to --paper"
run "$HNBRDF" report accuracy builtin --paper -o x --published rgl
expect_failure "--published without shaders" "no published shader"
run "$HNBRDF" report accuracy builtin --paper -o x --nbrdf rgl
expect_failure "--nbrdf of other data" "expected networks of Neural-BRDF"
[ ! -e x ] || fail "a refused report made its folder"

finish
