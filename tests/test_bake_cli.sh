#!/bin/sh
# test_bake_cli.sh HNBRDF FILES: what `bake` learns from, picks, writes and refuses, and an interrupt.
set -u
. "$(dirname "$0")/test_cli_support.sh"

names=gold-two-lobe,retro-tape,rough-clay
data="builtin:retro-tape builtin:rough-clay builtin:gold-two-lobe"
# shellcheck disable=SC2086 # words
"$HNBRDF" fit $data builtin:clear-coat-red --net 16x2 --latent 2 --steps 300 --pool 4096 -o big.safetensors >out 2>err ||
    fail "the model to bake from"

# bake NAME RC ARGUMENTS...: exit code and no word but progress on stderr when it is 0.
bake() {
    name=$1
    expected=$2
    shift 2
    run "$HNBRDF" bake "$@" --pool 2048 --pairs 1000
    [ "$rc" -eq "$expected" ] || fail "$name: exit $rc, expected $expected"
    [ "$rc" -ne 0 ] || ! grep -q '^hnbrdf' err || fail "$name: a message though all is well"
}
# value FILE KEY: of a JSON file's first line that has it.
value() {
    sed -n "s/.*\"$2\": \"*\([^,\"}]*\).*/\1/p" "$1" | head -n 1
}
# line MODEL NAME: the material's row of numbers.
line() {
    "$HNBRDF" info "$1" --json | grep "\"name\": \"$2\"" | sed 's/, "latent.*//'
}

run "$HNBRDF" bake --help
expect_ok "bake --help"
grep -q '^  hnbrdf bake ' out || fail "bake --help: no example of itself"
awk 'length($0) > 104 { exit 1 }' out || fail "bake --help: lines longer than 104"

# ---- the model is the teacher: a named network, GGX kept to the last bit -----------------------------
"$HNBRDF" edit big.safetensors --material retro-tape --set alpha=0.31 -o edited.safetensors >out 2>err
bake "a network by name" 0 edited.safetensors -m $names --net 6x1 --steps 300 --restarts 2 --csv net.csv -o net.safetensors
for name in gold-two-lobe retro-tape rough-clay; do
    [ "$(line net.safetensors $name)" = "$(line edited.safetensors $name)" ] || fail "$name: the GGX part moved"
done
"$HNBRDF" info net.safetensors --json | tr -d '\n' | grep -q '"net": "6x1".*"latent": 2,.*"gold-two-lobe", "retro-tape", "rough-clay"\]' ||
    fail "net, latent code or materials"
bake "the same with one thread" 0 edited.safetensors -m $names --net 6x1 --steps 300 --restarts 2 --threads 1 \
    --csv one.csv -o one.safetensors
cmp -s net.safetensors one.safetensors || fail "threads change the result"
head -n 1 net.csv | grep -qx 'net,latent,encoding,backend,mults,weights,ns_per_eval,ratio_to_ggx,fit,steps,seed,seconds,sampler,reference,smape,smape_worst,smape_analytic,picked' ||
    fail "the heading of the CSV"
sed -n 3p net.csv | grep -q '^6x1,2,[a-z-]*,c-batch,84,96,[0-9.]*,[0-9.]*,full,300,' || fail "the row of the CSV"
# It has learned: nearer to its teacher than GGX alone is.
awk -F, 'NR == 2 { ggx = $15 } NR == 3 { exit !($15 < 0.9 * ggx && $18 == 1) }' net.csv || fail "nothing was learned"
bake "one material needs no latent code" 0 big.safetensors -m retro-tape --net 4x1 --steps 100 --restarts 1 -o lone.safetensors
"$HNBRDF" info lone.safetensors | grep -q '^  latent *0$' || fail "a lone material has a latent code"

# ---- measurements ------------------------------------------------------------------------------------
# shellcheck disable=SC2086
bake "within an error" 0 big.safetensors -m $names --max-error 0.35 --steps 800 --restarts 2 --json error.json \
    --csv error.csv --plot error.svg -o error.safetensors --data $data
[ "$(value error.json met)" = true ] && [ "$(value error.json reference)" = data ] || fail "the error is not met"
# The picked row is the smallest of those within the error, and sizes are tried in their order.
awk -F, 'NR > 1 && $15 <= 0.35 && (!least || $5 < least) { least = $5 }
    NR > 1 && $18 { picked = $5; error = $15 }
    NR > 1 { if ($9 == "short" && $5 < before) bad = 1; before = $5 }
    END { exit !(picked == least && error <= 0.35 && !bad) }' error.csv || fail "another one should be picked"
picked=$(awk -F, '$18 == 1 { printf "%.5f", $15 }' error.csv)
analytic=$(awk -F, '$18 == 1 { printf "%.5f", $17 }' error.csv)
# shellcheck disable=SC2086
"$HNBRDF" compare error.safetensors $data --pairs 1000 --csv - >compared
[ "$(awk -F, '$1 == "mean" { printf "%.5f", $2 }' compared)" = "$picked" ] || fail "compare and bake differ: $picked"
# The analytic part is that of a fit of GGX alone to the same data.
ggx=$(awk -F, 'NR == 2 { printf "%.5f", $17 }' error.csv)
[ "$ggx" = "$analytic" ] || fail "the analytic part is not faithful: $ggx, $analytic"
grep -q 'accepted: 0.35' error.svg && grep -q 'picked' error.svg && tail -n 1 error.svg | grep -qx '</svg>' || fail "the plot"
# Rounding weights to 11 bits moves the value by some 2^-11 of each unit: far below a hundredth of SMAPE.
half=$(value error.json smape_half)
awk -v half="$half" -v whole="$picked" 'BEGIN { d = half - whole; exit !(half > 0 && d < 0.01 && d > -0.01) }' ||
    fail "in half precision $half, in single $picked"
# shellcheck disable=SC2086
bake "the worst counts" 0 big.safetensors -m $names --max-error 0.45 --worst --steps 800 --restarts 2 --csv worst.csv \
    -o worst.safetensors --data $data
awk -F, '$18 == 1 { held = $16 <= 0.45 } END { exit !held }' worst.csv || fail "--worst: the worst is beyond the limit"
awk -F, '$18 == 0 && $5 > 0 && $15 <= 0.45 && $16 > 0.45 { seen = 1 } END { exit !seen }' worst.csv ||
    fail "--worst: no row that the mean would have let pass, so nothing is tested"
# shellcheck disable=SC2086
bake "a measurement that is missing" 1 big.safetensors --net 4x1 -o never.safetensors --data $data
grep -q 'no measurement of clear-coat-red among the 3' err || fail "the message of a missing measurement"

# ---- GGX alone is enough -----------------------------------------------------------------------------
bake "GGX within the error" 0 big.safetensors -m $names --max-error 1.9 --json ggx.json -o ggx.safetensors
grep -q 'the network is dropped (kind ggx)' out || fail "a dropped network is not told"
"$HNBRDF" info ggx.safetensors | grep -q '^  kind *ggx$' || fail "the network is not dropped"
[ "$(line ggx.safetensors retro-tape)" = "$(line big.safetensors retro-tape)" ] || fail "dropping the network moved GGX"

# ---- limits that cannot be met, and that can ---------------------------------------------------------
bake "an error out of reach" 1 big.safetensors -m $names --max-error 1e-6 --steps 80 --restarts 1 -o best.safetensors
grep -q 'best.safetensors has the most accurate one' err || fail "an error out of reach: the message"
"$HNBRDF" info best.safetensors >out 2>&1 || fail "nothing is saved when the error is out of reach"
bake "a time out of reach" 1 big.safetensors -m $names --max-ns 0.001 -o none.safetensors
grep -q 'nothing takes at most 0.001 ns' err || fail "a time out of reach: the message"
bake "time enough" 0 big.safetensors -m $names --max-ns 1e9 --steps 160 --restarts 1 --json ns.json -o ns.safetensors
"$HNBRDF" info ns.safetensors | grep -q '^  kind *hybrid$' || fail "time enough, and yet no network"
bake "size enough" 0 big.safetensors -m $names --max-mults 100 --steps 160 --restarts 1 --csv mults.csv -o mults.safetensors
awk -F, 'NR > 1 && $5 > 100 { bad = 1 } $18 == 1 { picked = $5 } END { exit !(picked > 0 && !bad) }' mults.csv ||
    fail "--max-mults: a network beyond it, or none"
bake "the knee" 0 big.safetensors -m retro-tape,rough-clay --net auto --steps 160 --restarts 1 --plot auto.svg -o auto.safetensors
"$HNBRDF" info auto.safetensors | grep -q '^  kind *hybrid$' || fail "--net auto gives no network"

# ---- encodings, times of GGX, several numbers of materials -------------------------------------------
# shellcheck disable=SC2086
bake "every encoding" 0 big.safetensors -m $names --net 4x1 --encoding all --steps 160 --restarts 1 --csv all.csv \
    -o all.safetensors --data $data
[ "$(awk -F, 'NR > 2 { print $3 }' all.csv | sort | tr '\n' ' ')" = "angles angles-directed directions half-difference " ] ||
    fail "--encoding all: not each of them once"
awk -F, 'NR > 2 && (!n++ || $15 < least) { least = $15; best = $3 } NR > 2 && $18 { picked = $3 } END { exit picked != best }' all.csv ||
    fail "--encoding all: not the best one is picked"
bake "times of GGX" 0 big.safetensors -m $names --max-ggx 1000 --steps 160 --restarts 1 -o ratio.safetensors
"$HNBRDF" info ratio.safetensors | grep -q '^  kind *hybrid$' || fail "--max-ggx 1000, and yet no network"
bake "times of GGX that nothing meets" 0 big.safetensors -m $names --max-ggx 1 -o one.safetensors
"$HNBRDF" info one.safetensors | grep -q '^  kind *ggx$' || fail "--max-ggx 1: not GGX alone"
# shellcheck disable=SC2086
bake "a front" 0 big.safetensors -m $names --front 1,3 --steps 640 --restarts 1 --csv front.csv --plot front.svg --data $data
head -n 1 front.csv | grep -q '^materials,net,latent,encoding,' || fail "--front: the columns"
[ "$(awk -F, 'NR > 1 { print $1 }' front.csv | sort -u | tr '\n' ' ')" = "1 3 " ] || fail "--front: numbers of materials"
# All sizes have a short fit, and no full one is of a size that another short fit beats in both.
awk -F, 'NR > 1 && $10 == "short" { short[$1]++; for (k = 1; k <= n; k++) if (m[k] == $1 && e[k] < $16 && t[k] < $8) worse[$1, $2] = 1
             n++; m[n] = $1; e[n] = $16; t[n] = $8 }
         NR > 1 && $10 == "full" && $2 != "ggx" { full[$1]++ }
         END { exit !(short[1] > 9 && short[1] == short[3] && full[1] > 0 && full[3] > 0) }' front.csv || fail "--front: fits"
grep -q '3 materials' front.svg && tail -n 1 front.svg | grep -qx '</svg>' || fail "--front: the plot"

# However little time there is, the exit code tells whether a network was fitted.
run "$HNBRDF" bake big.safetensors -m $names --net 4x1 --seconds 1 --pool 2048 --pairs 1000 -o hasty.safetensors
if [ "$rc" -eq 0 ]; then
    "$HNBRDF" info hasty.safetensors | grep -q '^  net *4x1$' || fail "--seconds: not the network asked for"
else
    grep -q 'the time was over before a network was fitted\|s are over' err || fail "--seconds: exit $rc without its reason"
fi

# ---- wrong usage -------------------------------------------------------------------------------------
refuse() { # NAME TEXT ARGUMENTS...
    name=$1
    text=$2
    shift 2
    run "$HNBRDF" bake "$@"
    expect_usage "$name" "$text"
}
refuse "no model" "no MODEL given" --net auto -o x.safetensors
refuse "no wish" "exactly one of" big.safetensors -o x.safetensors
refuse "two wishes" "exactly one of" big.safetensors --net auto --max-error 0.1 -o x.safetensors
refuse "no output" "expected -o" big.safetensors --net auto
refuse "a net that is none" "expected auto or HxN" big.safetensors --net 8by2 -o x.safetensors
refuse "a net too large" "expected auto or HxN" big.safetensors --net 65x2 -o x.safetensors
refuse "an error of 0" "max-error" big.safetensors --max-error 0 -o x.safetensors
refuse "an unknown encoding" "'polar', expected directions" big.safetensors --net auto --encoding polar -o x.safetensors
refuse "data without --data" "measurements go after --data" big.safetensors builtin --net auto -o x.safetensors
run "$HNBRDF" bake big.safetensors -m retro-tap --net auto -o x.safetensors
expect_failure "an unknown material" "did you mean retro-tape"
run "$HNBRDF" bake builtin:retro-tape --net auto -o x.safetensors
expect_failure "a measurement to bake" "expected a model file"
run "$HNBRDF" bake big.safetensors --net auto -o nowhere/x.safetensors
expect_failure "an output that cannot be written" "nowhere/x.safetensors"
[ ! -e x.safetensors ] && [ ! -e never.safetensors ] || fail "a refused command writes a file"

# ---- an interrupt ------------------------------------------------------------------------------------
# Whatever it meets: exit 1, one line, and OUT is what it was or a whole model that was tried.
cp net.safetensors old.safetensors
"$HNBRDF" bake big.safetensors -m $names --net 64x4 --steps 100000000 --pool 2048 --pairs 1000 -o net.safetensors \
    </dev/null >out 2>err &
process=$!
tries=0
while ! grep -q '^ggx ' out && [ "$tries" -lt 600 ]; do
    sleep 0.1
    tries=$((tries + 1))
done
kill -INT "$process"
wait "$process"
rc=$?
[ "$rc" -eq 1 ] || fail "interrupt: exit $rc"
if grep -q 'interrupted before a network was fitted; net.safetensors is as it was' err; then
    cmp -s net.safetensors old.safetensors || fail "an early interrupt changed the output"
else
    grep -q 'interrupted; net.safetensors has the best' err || fail "interrupt: the message"
    "$HNBRDF" info net.safetensors | grep -q '64x4' || fail "the model after an interrupt"
fi
ls ./*part >/dev/null 2>&1 && fail "an interrupt leaves part of a file"

finish
