#!/bin/sh
# test_bench.sh HNBRDF FILES: what `hnbrdf bench` writes is complete, consistent and well-formed. No time is
# held to anything: a test machine may be busy.
set -u
. "$(dirname "$0")/test_cli_support.sh"
ASAN_OPTIONS=detect_leaks=0 # the Vulkan driver is unloaded before leaks are looked for
export ASAN_OPTIONS

run "$HNBRDF" bench --help
expect_ok "bench --help"
grep -q "^usage: hnbrdf bench " out || fail "no usage line"
awk 'length($0) > 104 { exit 1 }' out || fail "bench --help: lines longer than 104"
run "$HNBRDF" bench --quick --nets 16 --device none
expect_usage "--nets 16" "not HxN"
run "$HNBRDF" bench builtin:retro-tape --quick
expect_failure "a measurement for a model" "expected a model"
run "$HNBRDF" bench missing.safetensors --quick
expect_failure "a missing model" "missing.safetensors"
run "$HNBRDF" bench --quick --csv no/such/place.csv
expect_failure "a place that cannot be written" "no/such/place.csv"
run "$HNBRDF" bench --quick --csv - --json -
expect_usage "two on standard output" "only one"

# ---- many processes, on paper
run "$HNBRDF" bench --scaling --nets 8x2
expect_ok "bench --scaling"
[ "$(grep -c '^8x2,' out)" = 8 ] || fail "bench --scaling: a row for each batch and number of processes"
awk -F, '/^8x2,/ { if ($4 > $3 || $5 * $4 < $2) exit 1; if ($3 > 1 && $8 <= 0) exit 1 }' out ||
    fail "bench --scaling: ranks that work, and pairs of them"

# ---- how costs grow
run "$HNBRDF" bench --growth --quick --device none --csv growth.csv
[ "$rc" -eq 0 ] || fail "bench --growth: exit $rc"
grep -q '^look-up by name, ns ' out || fail "bench --growth: the table"
head -n 1 growth.csv | grep -q '^cost,unit,against,size,value,arithmetic,exponent,arithmetic_exponent,last_' ||
    fail "bench --growth: the columns"
awk -F'"' 'NR > 1 { sub(/"[^"]*"/, "x") } { n = split($0, f, ","); if (n != 10) exit 1 }' growth.csv ||
    fail "bench --growth: fields"

# ---- a model of ours and one with the published encoding ---------------------------------------------
materials="builtin:glossy-plastic-green builtin:gold-two-lobe"
data=$(echo $materials | tr ' ' ,)
fit() {
    "$HNBRDF" fit $materials --steps 100 --pool 2048 "$@" >out 2>err || fail "fit $*"
}
fit --net 8x2 -o ours.safetensors
fit --net 4x1 --encoding directions --floor 0 -o paper.safetensors
run "$HNBRDF" bench ours.safetensors paper.safetensors --data "$data" --quick --sampler cosine --csv b.csv --json b.json \
    --plot b.svg
[ "$rc" -eq 0 ] || fail "bench: exit $rc"
cp out table
for text in 'SMAPE by the cosine sampler, 2000 pairs' 'peak of one thread' 'times its network'; do
    grep -q -e "$text" table || fail "the table has no '$text'"
done
header=model,net,encoding,latent,backend,variant,weights,precision,ns_per_eval,evals_per_s,peak_fraction
header=$header,ratio_to_ggx,compile_ms,bytes,mults,smape,psnr
head -n 1 b.csv | grep -q "^$header,io_ns,net_ns," || fail "the columns"
columns=$(head -n 1 b.csv | tr ',' '\n' | wc -l)
awk -F, -v n="$columns" 'NF != n { print "line " NR ": " NF " fields"; exit 1 }' b.csv >out || fail "fields"

# rows WHAT: prints the rows, by column name; fails the test if `bad` is printed.
rows() {
    awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
             function get(name) { return $(at[name]) } '"$2" b.csv >out
    [ ! -s out ] || fail "$1"
}
rows "a time, a rate or a size is not positive" \
    'get("evals_per_s") * get("ns_per_eval") != "" && !(get("ns_per_eval") != 0 && get("evals_per_s") != 0) { print }
     get("model") != "ggx" && !(get("bytes") > 0 && get("mults") > 0) { print }'
rows "CPU rows: something is missing" \
    'get("backend") ~ /^c-/ && !(get("ns_per_eval") > 0 && get("evals_per_s") > 0 && get("ratio_to_ggx") > 0 &&
                                 get("threads") == 1 && get("weights") == "model" && get("io_ns") == "") { print }'
rows "rates and times disagree" \
    '{ r = get("evals_per_s") * get("ns_per_eval") / 1e9; if (r < 0.999 || r > 1.001) print }'
rows "GGX is not once itself" 'get("model") == "ggx" && get("ratio_to_ggx") != 1 { print }'
rows "GGX has a network" \
    'get("model") == "ggx" && (get("net") != "none" || get("mults") != 0 || get("net_ns") != "") { print }'
rows "sizes" 'get("model") == "ours" && get("backend") == "c-batch" && (get("bytes") != 856 || get("mults") != 192) { print }'
rows "errors out of range" \
    '!(get("smape") > 0 && get("smape") < 2) && get("weights") != "published-style" { print }
     !(get("psnr") > 0) && get("weights") != "published-style" && get("precision") != "half" { print }'
# 0.002 is what half precision may cost.
rows "half precision" \
    'get("precision") == "float" && get("weights") == "constants" { first[get("model")] = get("smape") }
     get("precision") == "half" { d = get("smape") - first[get("model")]; if (d > 0.002 || d < -0.002) print }'

# One c-batch row for every variant of this machine, the other backends once, for every model.
for model in ggx ours paper; do
    for backend in c-single c-single-prepared c-many; do
        [ "$(grep -c "^$model,.*,$backend," b.csv)" -eq 1 ] || fail "$model: rows of $backend"
    done
    [ "$(grep -c "^$model,.*,c-batch," b.csv)" -eq "$(grep -o '"variant": "[a-z0-9-]*", "fma"' b.json | wc -l)" ] ||
        fail "$model: rows of c-batch"
done
# The error is that of `compare`.
"$HNBRDF" compare ours.safetensors $materials --sampler cosine --pairs 2000 --csv - >compared
alone=$(awk -F, '$1 == "mean" { printf "%.5f", $2 }' compared)
[ "$(awk -F, '$1 == "ours" && $7 != "published-style" && $8 == "float" { printf "%.5f\n", $16 }' b.csv | sort -u)" = "$alone" ] ||
    fail "compare says another error than $alone"

# ---- Vulkan, where there is any ----------------------------------------------------------------------
if grep -q ',vulkan:' b.csv; then
    for model in ours paper; do
        for weights in constants columns uniform published-style; do
            [ "$(grep -c "^$model,.*,vulkan:[^,]*,shader,$weights,float," b.csv)" -ge 1 ] || fail "$model: no $weights"
        done
    done
    rows "shaders: something is missing" \
        'get("backend") ~ /^vulkan/ && !(get("io_ns") > 0 && get("compile_ms") > 0 && get("first_dispatch_ms") > 0 &&
                                         get("bytes") > 1000 && get("ns_per_eval") != "") { print }'
    # Three decimals of the weights change the error little, and only of `directions` is it known.
    rows "the peer's error" \
        'get("weights") == "published-style" && get("model") == "ours" && get("smape") != "" { print }
         get("model") == "paper" && get("precision") == "float" { d = get("smape") - first; if (!first) first = get("smape")
                                   else if (d > 0.02 || d < -0.02) print }'
else
    echo "no Vulkan rows here"
fi

# ---- JSON and the plot ------------------------------------------------------------------------------
[ "$(grep -c '"model": ' b.json)" -eq "$(($(wc -l <b.csv) - 1))" ] || fail "JSON and CSV differ in rows"
if command -v python3 >/dev/null; then
    python3 -c 'import json, sys; json.load(open(sys.argv[1]))' b.json 2>err || fail "JSON"
    python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' b.svg 2>err || fail "the plot is not XML"
fi
# Two panels for c-batch, c-single-prepared, each device, and bytes; in each of them a mark for each model, and one for the
# peer, whose error and time are known; and the legend's. What is left of GGX's time on a device without that of its
# reading and writing may be noise, and negative: that has no mark.
devices=$(cut -d, -f5 b.csv | grep vulkan | sort -u | wc -l)
backends=$((2 + devices))
awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) at[$k] = k; next }
         $5 != "c-single" && $5 != "c-many" && $(at["ns_per_eval"]) > 0 {
             peer = $(at["weights"]) == "published-style"
             kind = peer ? "peer" : $(at["model"]) == "ggx" ? "ggx" : "hybrid"
             if ($(at["smape"]) != "") { seen[$5, $1, peer, "smape"] = 1; kinds[kind] = 1 }
             if ($(at["psnr"]) != "") { seen[$5, $1, peer, "psnr"] = 1; kinds[kind] = 1 }
         }
         NR > 1 { bytes[$1, 1] = bytes[$1, 2] = 1 } # the panels against bytes
         END { for (k in seen) n++; for (k in bytes) n++; for (k in kinds) n++; print n }' b.csv >marks
[ "$(cat marks)" -ge 20 ] || fail "marks of the processor" # three models in six panels, two kinds
[ "$(grep -c "class='mark'" b.svg)" -eq "$(cat marks)" ] || fail "marks in the plot, expected $(cat marks)"
[ "$(grep -c '<polyline' b.svg)" -eq "$((2 * backends + 2))" ] || fail "Pareto fronts in the plot"

# ---- what one would pick instead ------------------------------------------------------------------
run "$HNBRDF" bench ours.safetensors --quick --baselines
expect_usage "--baselines without data" "needs --data"
run "$HNBRDF" bench ours.safetensors --quick --nbrdf x --data "$data"
expect_usage "--nbrdf alone" "needs --baselines"
one=builtin:gold-two-lobe
run "$HNBRDF" bench ours.safetensors --data $one --quick --baselines --device none --csv b.csv --plot b.svg
[ "$rc" -eq 0 ] || fail "bench --baselines: exit $rc"
for model in measurement table-90x90x180 ggx-two-lobes; do
    [ "$(grep -c "^$model,none,none,0,c-single-prepared," b.csv)" -eq 1 ] || fail "no row of $model"
done
rows "baselines: a value, a direction, a density take time" \
    'get("backend") == "c-single-prepared" && !(get("ns_per_eval") > 0 && get("sample_ns") > 0 && get("density_ns") > 0 &&
                                               get("ratio_to_ggx") > 0) { print }'
# The measurement has no error, the table little, and two lobes follow a material of two lobes.
rows "baselines: errors" \
    'get("model") == "ggx" { ggx = get("smape") }
     get("model") == "measurement" && get("smape") != 0 { print }
     get("model") == "table-90x90x180" && !(get("smape") > 0 && get("smape") < 0.05) { print }
     get("model") == "ggx-two-lobes" && !(get("smape") < 0.6 * ggx) { print }'
rows "baselines: bytes" \
    'get("model") == "ggx-two-lobes" && get("scene_bytes") != 44 { print }
     get("model") == "table-90x90x180" && get("scene_bytes") != 17496000 { print }
     get("model") == "ours" && get("scene_bytes") != get("bytes") + 4 * (9 + get("latent")) { print }
     get("model") == "ggx" && get("scene_bytes") != 36 { print }'
grep -q 'measurement (exact)' b.svg || fail "the plot has no measurement"

# ---- without a model --------------------------------------------------------------------------------
run "$HNBRDF" bench --quick --nets 4x1,8x1 --data "$data" --device none --csv -
[ "$rc" -eq 0 ] && [ "$(cut -d, -f1 out | sort -u | tr '\n' ' ')" = "ggx hybrid-4x1 hybrid-8x1 model " ] ||
    fail "networks that bench fits itself"
grep -q vulkan out && fail "--device none"

finish
