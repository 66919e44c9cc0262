#!/bin/sh
# test_report_sampling.sh HNBRDF FILES: `report sampling` measures, writes tables, plot and pictures, and its numbers
# say what they must: the table is compared with itself, cosine alone is worse on a glossy material.
set -u
. "$(dirname "$0")/test_cli_support.sh"

run "$HNBRDF" report sampling --help
expect_ok "report sampling --help"
awk 'length($0) > 104 { exit 1 }' out || fail "report sampling --help: lines longer than 104"
run "$HNBRDF" report sampling -o r
expect_usage "no model" "no MODEL"
run "$HNBRDF" fit builtin:glossy-plastic-green builtin:gold-two-lobe --kind ggx -o ggx.safetensors
[ "$rc" = 0 ] || fail "fit"
run "$HNBRDF" report sampling ggx.safetensors
expect_usage "no folder" "-o DIR"
run "$HNBRDF" report sampling nothing.safetensors -o r
expect_failure "a model that is missing" "nothing.safetensors"
[ ! -e r ] || fail "a refused report made its folder"

run "$HNBRDF" report sampling ggx.safetensors --size 12 --samples 16 --spp 256 --strips 1 --env furnace -o r
[ "$rc" = 0 ] || fail "report sampling: exit $rc"
for file in sampling.csv sampling.md sampling.svg sampling-strips.png; do
    [ -s "r/$file" ] || fail "no r/$file"
done
head -n 1 r/sampling.csv | grep -qx 'material,model,alpha,sampler,spp,mse,mean,ns_per_sample,reference_spp,size' ||
    fail "the columns of sampling.csv"
# 2 materials, 5 samplers, 1, 4 and 16 samples
[ "$(wc -l <r/sampling.csv)" = 31 ] || fail "sampling.csv has $(wc -l <r/sampling.csv) lines, expected 31"
grep '^gold-two-lobe' out | awk '{ exit !($3 > 20 * $6 && $6 < 1.05 * $5 && $7 == 1) }' ||
    fail "cosine alone, fitted lobes and table on a glossy material: $(grep '^gold-two-lobe' out)"
# The error falls with the samples, and what one sample costs is known.
awk -F, 'NR > 1 && ($4 == "fitted" || $4 == "tabulated") { if ($5 == 1) one = $6; else if ($5 == 16 && !($6 < one)) bad = 1; if (!($8 > 0)) bad = 1 }
    END { exit bad }' r/sampling.csv || fail "sampling.csv: the error does not fall"
cp r/sampling.csv first.csv
run "$HNBRDF" report sampling ggx.safetensors --size 12 --samples 16 --spp 256 --strips 1 --env furnace --threads 1 -o r
cut -d, -f1-7 first.csv >a
cut -d, -f1-7 r/sampling.csv | cmp -s - a || fail "the errors depend on the threads"

finish
