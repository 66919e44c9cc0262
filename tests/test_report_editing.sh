#!/bin/sh
# test_report_editing.sh HNBRDF FILES: `report editing` fits, edits, measures and writes; a model that it wrote gives
# the same figures again.
set -u
. "$(dirname "$0")/test_cli_support.sh"

run "$HNBRDF" report editing --help
expect_ok "report editing --help"
grep -q "two-lobe, beckmann" out || fail "report editing --help does not name the families"
awk 'length($0) > 120 { exit 1 }' out || fail "report editing --help: lines longer than 120"
run "$HNBRDF" report editing
expect_usage "no folder" "-o DIR"
run "$HNBRDF" report editing builtin -o r
expect_usage "data" "'builtin': takes no DATA"
run "$HNBRDF" report editing --families plastik -o r
expect_usage "a family that is none" "'plastik' is none of two-lobe"
run "$HNBRDF" report editing --model nothing.safetensors -o r
expect_failure "a model that is missing" "nothing.safetensors"
run "$HNBRDF" report editing --model nothing.safetensors --steps 5 -o r
expect_usage "steps of a given model" "exclude each other"
[ ! -e r ] || fail "a refused report made its folder"

quick="report editing --quick --pool 64 --pairs 500"
run "$HNBRDF" $quick --families plastic --images 12 -o r
[ "$rc" = 0 ] || fail "report editing: exit $rc"
for file in report.md editing.csv mixtures.csv editing.svg editing-alpha.png editing-others.png isotropic.safetensors; do
    [ -s "r/$file" ] || fail "no r/$file"
done
head -n 1 r/editing.csv | grep -qx 'member,family,alpha,edit,factor,model,smape,psnr,stopped,network' ||
    fail "the columns of editing.csv"
# alpha: 8 factors; eta 2, kd 2, colour, anisotropy 2. 0.3 times 4 is beyond 1, as alpha and as alpha_x.
[ "$(sed 1d r/editing.csv | cut -d, -f1 | sort | uniq -c | awk '{ printf "%s %s ", $2, $1 / 4 }')" = \
    "plastic-0.08 15 plastic-0.16 15 plastic-0.3 13 " ] || fail "rows: $(sed 1d r/editing.csv | cut -d, -f1 | sort | uniq -c)"
awk -F, 'NR > 1 && !($7 > 0 && $7 < 2 && $8 > 5 && $8 < 120) { exit 1 }' r/editing.csv || fail "figures out of range"
# Without an edit nothing differs but the fit; GGX alone follows an edit of alpha, the unedited material does not.
awk -F, '$4 == "alpha" && $5 == 1 { s[$1, $6] = $7 } END { for (m in s) if (m ~ /unedited/) { split(m, k, SUBSEP)
    if (s[m] != s[k[1], "edited"]) exit 1 } }' r/editing.csv || fail "unedited and edited differ without an edit"
awk -F, '$1 == "plastic-0.08" && $5 == 4 { s[$6] = $7 } END { exit !(s["unedited"] > 2 * s["ggx"]) }' r/editing.csv ||
    fail "GGX alone does not follow an edit"
[ "$(grep -c '^| alpha x' r/report.md)" = 8 ] || fail "report.md has not 8 factors of alpha"
grep -q '^| isotropic | 9 | .* | 3 | ' r/report.md || fail "report.md: mixtures"
[ "$(wc -l <r/mixtures.csv)" = 10 ] || fail "mixtures.csv has not 9 mixtures"

# The same figures from the model that was written, whatever the threads.
run "$HNBRDF" $quick --model r/isotropic.safetensors --images 0 --threads 1 -o again
[ "$rc" = 0 ] || fail "report editing --model: exit $rc"
cut -d, -f1-7 r/editing.csv >a
cut -d, -f1-7 again/editing.csv | cmp -s - a || fail "a model that is given has other figures"
[ ! -e again/editing-alpha.png ] || fail "pictures without --images"
# GGX alone is no model that can be wrong after an edit; one without members has mixtures alone.
run "$HNBRDF" fit builtin:glossy-plastic-green builtin:velvet-crimson --steps 1 --pool 64 -o two.safetensors
run "$HNBRDF" report editing --model two.safetensors -o mixtures
[ "$rc" = 0 ] && grep -q 'has no member of the families' err || fail "a model without members: exit $rc"
grep -q 'of 3 mixtures, .* of 1 pairs' out || fail "mixtures of a model without members"
finish
