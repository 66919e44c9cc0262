#!/bin/sh
# test_report.sh HNBRDF FILES: `report accuracy` trains, measures, writes, and goes on where it was ended.
set -u
. "$(dirname "$0")/test_cli_support.sh"

run "$HNBRDF" report --help
expect_ok "report --help"
grep -q "^usage: hnbrdf report accuracy " out || fail "no usage line"
awk 'length($0) > 104 { exit 1 }' out || fail "report --help: lines longer than 104"
run "$HNBRDF" report
expect_usage "no report named" "expected accuracy"
run "$HNBRDF" report precision builtin -o r
expect_usage "another report" "no report is called 'precision'"
run "$HNBRDF" report accuracy -o r
expect_usage "no data" "no DATA"
run "$HNBRDF" report accuracy builtin
expect_usage "no folder" "-o DIR"
for nets in 16 16x 65x1 16x5 16x2, 16x2,16x2 ''; do
    run "$HNBRDF" report accuracy builtin -o r --nets "$nets"
    expect_usage "--nets '$nets'" "--nets"
done
for latents in 0 9 4,4 4, x; do
    run "$HNBRDF" report accuracy builtin -o r --latents "$latents"
    expect_usage "--latents '$latents'" "--latents"
done
run "$HNBRDF" report accuracy builtin -o r --models hybird
expect_usage "--models hybird" "expected hybrid, paper or neural"
run "$HNBRDF" report accuracy builtin -o r --steps 5 --seconds 5
expect_usage "steps and seconds" "exclude"
[ ! -e r ] || fail "a refused report made its folder"
: >file
run "$HNBRDF" report accuracy builtin -o file
expect_failure "a file in the way" "file: is a file, expected a folder"

# ---- a small grid -----------------------------------------------------------------------------------
materials="builtin:glossy-plastic-green builtin:gold-two-lobe builtin:velvet-crimson"
small="--quick --steps 200 --pool 2048"
pairs=1000
side=32
report() {
    run "$HNBRDF" report accuracy $materials $small --pairs $pairs --images $side -o r "$@"
    [ "$rc" -eq 0 ] || fail "report $*: exit $rc"
}
# column NAME: that column of accuracy.csv, after the model's name.
column() {
    awk -F, -v want="$1" 'NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k } NR > 1 { print $at["name"], $at[want] }' \
        r/accuracy.csv
}
header=kind,net,encoding,latent,steps,seconds,pairs_per_s,weights,mults,smape_grid,smape_uniform,smape_analytic

report --nets 8x2
for name in accuracy.csv materials.csv ggx.csv ggx.svg report.md errors-8x2.svg models/hybrid-8x2-l4.safetensors \
    models/paper-8x2-l4.safetensors models/neural-8x2-l12.safetensors models/ggx.safetensors; do
    [ -s "r/$name" ] || fail "no $name"
done
head -n 1 r/accuracy.csv | grep -q "^$header" || fail "columns of accuracy.csv"
[ "$(cut -d, -f1-4 r/accuracy.csv | sed 1d | tr '\n' ' ')" = \
    "ggx,none,none,0 hybrid,8x2,angles,4 hybrid,8x2,directions,4 neural,8x2,angles,12 " ] || fail "rows of accuracy.csv"
[ "$(wc -l <r/materials.csv)" -eq 13 ] || fail "materials.csv has not a row for 3 materials of 4 models"
column floor | grep -qx "paper-8x2-l4 0" || fail "the paper's form has a floor"
column weights | grep -qx "hybrid-8x2-l4 214" || fail "weights"
[ "$(column steps | grep -c ' 200$')" -eq 3 ] || fail "steps"
# The analytic part of a faithful hybrid is the fit of GGX alone.
[ "$(column smape_analytic | awk '/^ggx/ { print $2 }')" = "$(column smape_analytic | awk '/^hybrid/ { print $2 }')" ] ||
    fail "analytic part and GGX alone differ"
column smape_analytic | grep -qx "neural-8x2-l12 " || fail "a neural model has an analytic part"
column smape_grid | awk '!($2 > 0 && $2 < 2) { exit 1 }' || fail "errors out of their range"
column psnr | awk '!($2 > 5 && $2 < 120) { exit 1 }' || fail "PSNR out of its range"
# The fits of GGX alone: all materials by rising error, and never worse than the second best start.
sed 1d r/ggx.csv | awk -F, '$2 < last || $11 != 8 || $12 > $13 { exit 1 } { last = $2 } END { exit NR != 3 }' ||
    fail "ggx.csv: $(cat r/ggx.csv)"
[ "$(grep -c "class='mark'" r/ggx.svg)" -eq 12 ] || fail "ggx.svg has not 4 panels of 3 materials"
# The same figures as `compare`.
"$HNBRDF" compare r/models/hybrid-8x2-l4.safetensors $materials --sampler grid --pairs 1000 --csv - >compared
alone=$(awk -F, '$1 == "mean" { printf "%.5f", $2 }' compared)
table=$(column smape_grid | awk '/^hybrid/ { printf "%.5f", $2 }')
[ "$alone" = "$table" ] || fail "compare says $alone, the report $table"
for text in 'grid sampler' 'uniform sampler' '1000 valid pairs' 'seed 1' 'sampler unknown' '| 16x2 | 0.2815 |' \
    'hnbrdf report accuracy builtin:glossy' 'Mean PSNR' 'at equal numbers' '| 8x2 | 12 |' 'materials the second best ends' \
    '| hybrid-8x2-l4 | 1.000 |' '| net | hybrid l=4 | paper.s form l=4 | neural l=12 |' ' of 3 |'; do
    grep -q -e "$text" r/report.md || fail "report.md has no '$text'"
done
if command -v xmllint >/dev/null; then
    xmllint --noout r/errors-8x2.svg 2>err || fail "the plot is not well-formed XML"
elif command -v python3 >/dev/null; then
    python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' r/errors-8x2.svg 2>err ||
        fail "the plot is not well-formed XML"
fi
[ "$(grep -c '<circle' r/errors-8x2.svg)" -eq 12 ] || fail "the plot has not 4 curves of 3 materials"

# ---- going on ---------------------------------------------------------------------------------------
cp r/models/hybrid-8x2-l4.safetensors first
cp r/ggx.csv first.csv
ls -i r/models/hybrid-8x2-l4.safetensors r/models/ggx.safetensors >before
report --nets 8x2,8x1 --resume
ls -i r/models/hybrid-8x2-l4.safetensors r/models/ggx.safetensors >after
cmp -s before after || fail "--resume made finished models again"
cmp -s first.csv r/ggx.csv || fail "--resume forgot how the fits of GGX went"
[ "$(wc -l <r/accuracy.csv)" -eq 8 ] || fail "--resume did not add the new ones"
[ "$(column smape_grid | awk '$1 == "hybrid-8x2-l4" { printf "%.5f", $2 }')" = "$alone" ] ||
    fail "--resume changed a figure"
# Finished models are not measured again: what is kept of them is taken as it is, unless the settings are others.
kept=r/models/hybrid-8x2-l4.figures
cp $kept kept
sed '2s/^[^ ]*/0.125/' kept >$kept # the first material, uniform
report --nets 8x2 --resume
grep -q '^glossy-plastic-green,hybrid,8x2,angles,4,[^,]*,0.125,' r/materials.csv || fail "--resume measured again"
cmp -s first.csv r/ggx.csv || fail "--resume without measuring forgot how the fits of GGX went"
pairs=1001
report --nets 8x2 --resume
pairs=1000
grep -q ',0.125,' r/materials.csv && fail "--resume took figures of other settings"
head -c 200 kept >$kept # as if a disk had been full
report --nets 8x2 --resume
cmp -s kept $kept || fail "figures measured again differ"
rm r/models/hybrid-8x2-l4.txt # as if the run had ended while it was at it
side=0
report --nets 8x2 --resume --threads 1
side=32
column psnr | grep -qx 'hybrid-8x2-l4 ' || fail "--images 0 makes pictures"
cmp -s first r/models/hybrid-8x2-l4.safetensors || fail "the model made again is another one"
report --nets 8x2 --resume --seed 2
cmp -s first r/models/hybrid-8x2-l4.safetensors && fail "--resume reused a model of another seed"

# ---- materials that are left to GGX alone: those that `fit` names ----------------------------------------
for steps in 40 60 90 120; do
    "$HNBRDF" fit $materials --net 16x2 --steps $steps --pool 2048 -o f.safetensors 2>&1 |
        sed -n 's/^note: \(.*\): with the network it is worse than GGX alone.*turns the network off$/\1/p' | sort >named
    [ ! -s named ] || break
done
[ -s named ] || fail "no material is left to GGX alone after so few steps: try others"
for again in '' --resume; do
    run "$HNBRDF" report accuracy $materials --quick --steps $steps --pairs 500 --pool 2048 --images 0 --models hybrid \
        -o a $again
    awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "alone") at = k } $at == 1 { print $1 }' a/materials.csv |
        sort | cmp -s - named || fail "alone: $(cat a/materials.csv); fit: $(cat named)"
    grep -q "^| hybrid-16x2-l4 | $(wc -l <named | tr -d ' '): .*$(head -n 1 named)" a/report.md ||
        fail "report.md does not name what is left to GGX alone"
done
grep -q ',ggx,none,none,0,.*,,ggx$' a/materials.csv || fail "GGX alone has a column alone"

# An interrupt ends the run with what is done.
"$HNBRDF" report accuracy $materials --nets 8x2,64x4 --steps 1000000 --pairs 1000 --pool 2048 -o i --models hybrid \
    --latents 4 </dev/null >out 2>err &
process=$!
tries=0
while [ ! -s i/accuracy.csv ] && [ "$tries" -lt 200 ]; do
    sleep 0.1
    tries=$((tries + 1))
done
kill -INT "$process"
wait "$process"
rc=$?
[ "$rc" -eq 1 ] && grep -q 'interrupted' err || fail "interrupt: exit $rc"
grep -q 'is told when all 3 are done' i/report.md && ! grep -q 'Against the baselines' i/report.md ||
    fail "an incomplete report names winners"
grep -q '^ggx,' i/accuracy.csv || fail "what was finished before the interrupt is lost"

finish
