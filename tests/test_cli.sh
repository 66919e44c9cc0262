#!/bin/sh
# test_cli.sh HNBRDF FILES: usage, help, and what eval, compare, info and import print.
set -u
. "$(dirname "$0")/test_cli_support.sh"

"$FILES" . || exit 1
commands="fit eval compare export verify render scene sheet gallery import info"
first=$("$HNBRDF" info builtin | awk 'NR == 2 { print $1 }')
second=$("$HNBRDF" info builtin | awk 'NR == 3 { print $1 }')

# ---- help and usage ---------------------------------------------------------------------------------
for command in $commands; do
    run "$HNBRDF" "$command" --help
    expect_ok "$command --help"
    grep -q "^usage: hnbrdf $command " out || fail "$command --help: no usage line"
    grep -q "^examples:" out || fail "$command --help: no examples"
    grep -q "^  .*hnbrdf $command " out || fail "$command --help: no example of itself"
    awk 'length($0) > 104 { exit 1 }' out || fail "$command --help: lines longer than 104"
    cp out by_option
    run "$HNBRDF" help "$command"
    cmp -s out by_option || fail "help $command differs from $command --help"
    run "$HNBRDF" "$command" -h
    cmp -s out by_option || fail "$command -h differs from $command --help"
    run "$HNBRDF" "$command" --no-such-option
    expect_usage "$command --no-such-option" "unknown option --no-such-option"
done
for command in $commands; do
    run "$HNBRDF" "$command"
    expect_usage "$command without arguments" "hnbrdf $command --help"
done

run "$HNBRDF"
expect_usage "no command" "usage: hnbrdf COMMAND"
run "$HNBRDF" --help
expect_ok "--help"
for command in $commands; do
    grep -q "^  $command " out || fail "--help does not name $command"
done
run "$HNBRDF" --version
expect_ok "--version"
grep -q '^hnbrdf [0-9]*\.[0-9]*\.[0-9]*$' out || fail "--version"
run "$HNBRDF" fti
expect_usage "fti" "did you mean 'fit'"
run "$HNBRDF" help compere
expect_usage "help compere" "did you mean 'compare'"
run "$HNBRDF" frobnicate
expect_usage "frobnicate" "unknown command 'frobnicate'"
run "$HNBRDF" compare m d --piars 3
expect_usage "--piars" "did you mean --pairs"
run "$HNBRDF" compare m d --pairs
expect_usage "--pairs without a value" "needs a value"
run "$HNBRDF" compare m d --csv --json x
expect_usage "--csv without a value" "csv needs a value"
run "$HNBRDF" compare m d --pairs 1.5
expect_usage "--pairs 1.5" "'1.5' is not a whole number"
run "$HNBRDF" compare m d --pairs=0
expect_usage "--pairs 0" "out of range"
run "$HNBRDF" compare m d --pairs 12x
expect_usage "--pairs 12x" "'12x' is not a whole number"
run "$HNBRDF" compare m d --skip-missing=1
expect_usage "a flag with a value" "takes no value"
run "$HNBRDF" compare m d --sampler gird
expect_usage "--sampler gird" "did you mean grid"
run "$HNBRDF" fit builtin --net 32 -o x
expect_usage "--net 32" "'32' is not HxN"
run "$HNBRDF" import a.brdf
expect_usage "import without -o" "-o MODEL"
run "$HNBRDF" eval a b
expect_usage "eval a b" "more than one"

# ---- sources ----------------------------------------------------------------------------------------
run "$HNBRDF" info nowhere.bsdf
expect_failure "a missing file" "nowhere.bsdf: No such file"
run "$HNBRDF" info nowhere.safetensors
expect_failure "a missing model" "nowhere.safetensors"
run "$HNBRDF" info "$first"
expect_failure "a built-in name" "builtin:$first"
run "$HNBRDF" info "builtin:x$first"
expect_failure "a misspelt built-in name" "did you mean $first?"
run "$HNBRDF" eval builtin
expect_failure "eval builtin" "choose one"
run "$HNBRDF" eval builtin:anisotropic
expect_failure "eval builtin:anisotropic" "builtin:anisotropic holds 12 materials, choose one as in builtin:plain-weave-linen"
run "$HNBRDF" info builtin:anisotropic
[ "$rc" -eq 0 ] && [ "$(grep -c ' builtin  no  ' out)" -eq 12 ] || fail "info builtin:anisotropic: $(cat out)"
run "$HNBRDF" info builtin:corduroy
[ "$rc" -eq 0 ] || fail "a material of the second set"
mkdir empty twice
run "$HNBRDF" info empty
expect_failure "an empty directory" "empty: the directory has no measured file: RGL .bsdf, MERL .binary, UTIA .bin or NBRDF .h5/.npy"
cp lambert_rgb.bsdf twice/lambert_rgb.bsdf
cp lambert_rgb.bsdf twice/lambert.bsdf
run "$HNBRDF" info twice
expect_failure "two of one name" "lambert: twice/lambert.bsdf and twice/lambert_rgb.bsdf"
run "$HNBRDF" eval twice
expect_failure "a directory as source" "twice: a directory"
run "$HNBRDF" compare lambert.binary builtin
expect_failure "data as model" "lambert.binary: measured data"
run "$HNBRDF" compare hybrid.safetensors ggx.safetensors
expect_failure "a model as data" "ggx.safetensors: a model file"
cp hybrid.safetensors misnamed.bsdf
run "$HNBRDF" info misnamed.bsdf
expect_ok "a model is known by its content"
grep -q 'kind *hybrid' out || fail "a model is known by its content"
mkdir sorted
cp lambert_rgb.bsdf sorted/b.bsdf
cp lambert_rgb.bsdf sorted/a_rgb.bsdf
cp lambert_rgb.bsdf sorted/C.bsdf
run "$HNBRDF" info sorted
[ "$(awk 'NR > 1 { printf "%s ", $1 }' out)" = "C a b " ] || fail "byte order of names"

# ---- info -------------------------------------------------------------------------------------------
run "$HNBRDF" info hybrid.safetensors --json
expect_ok "info --json"
for pair in '"kind": "hybrid"' '"net": "8x2"' '"encoding": "half-difference"' '"latent": 4' \
    '"weights": 214' '"mults": 192' '"floor": 0.00300000003' "\"materials\": \[\"$first\", \"$second\","; do
    grep -q "$pair" out || fail "info --json has no $pair"
done
run "$HNBRDF" info ggx.safetensors --json
grep -q '"net": "none"' out || fail "the net of ggx is not none"
grep -q '"weights": 0' out || fail "ggx has weights"
run "$HNBRDF" info lambert_rgb.bsdf --json
grep -q '"kind": "measured", "format": "RGL", "name": "lambert", "isotropic": true' out || fail "info of RGL"
run "$HNBRDF" info lambert.binary
grep -q 'format *MERL' out || fail "info of MERL"
if command -v python3 >/dev/null; then
    for source in hybrid.safetensors ggx.safetensors one.safetensors lambert_rgb.bsdf builtin sorted; do
        "$HNBRDF" info "$source" --json >out 2>err
        python3 -m json.tool out >/dev/null 2>err || fail "info $source --json is not JSON"
    done
fi

# ---- eval -------------------------------------------------------------------------------------------
run_in '0,0,1,0,0.866025404,0.5\n' "$HNBRDF" eval lambert_rgb.bsdf
expect_ok "eval RGL"
expect_out "f = (0.125, 0.25, 0.375)/0.5" 'f_r,f_g,f_b\n0.25,0.5,0.75\n'
run_in '0,0,1,0,0.6,0.8\n' "$HNBRDF" eval lambert.binary
expect_ok "eval MERL"
expect_out "f = (1, 1.15, 1.66)" 'f_r,f_g,f_b\n1,1.14999998,1.65999997\n'

pairs='0.6,0,0.8,0,0,1\n0,0.6,0.8,-0.6,0,0.8\n'
run_in "$pairs" "$HNBRDF" eval "builtin:$first"
expect_ok "eval builtin"
[ "$(wc -l <out)" -eq 3 ] || fail "one line for each pair"
cp out plain
same() {
    expect_ok "$1"
    cmp -s out plain || fail "$1: other values than without"
}
run_in "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n$pairs" "$HNBRDF" eval "builtin:$first"
same "a header"
run_in '0.6,0,0.8,0,0,1\r\n0,0.6,0.8,-0.6,0,0.8\r\n' "$HNBRDF" eval "builtin:$first"
same "CRLF"
# One line out for every line in, blank ones where blank ones were. The header out stands where that
# of the input stood, or first where there was none.
kinds() {
    awk '{ print (/[^ \t\r]/ ? "text" : "blank") }' "$1"
}
run_in '\n  \n0.6,0,0.8,0,0,1\n\t\n0,0.6,0.8,-0.6,0,0.8\n\n\n' tee blank.csv
run "$HNBRDF" eval "builtin:$first" -i blank.csv
grep . out | cmp -s - plain || fail "blank lines: other values than without"
{ echo text; kinds blank.csv; } >expected
kinds out | cmp -s - expected || fail "blank lines stand elsewhere"
run_in '\n\nwi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n\n0.6,0,0.8,0,0,1\r\n\r\n\r\n0,0.6,0.8,-0.6,0,0.8\n ' tee blank.csv
run "$HNBRDF" eval "builtin:$first" -i blank.csv
grep . out | cmp -s - plain || fail "blank lines and a header: other values than without"
kinds blank.csv >expected
kinds out | cmp -s - expected || fail "blank lines with a header stand elsewhere"
run_in '0.6,0,0.8,0,0,1\n0,0.6,0.8,-0.6,0,0.8' "$HNBRDF" eval "builtin:$first"
same "no newline at the end"
run_in "\\357\\273\\277$pairs" "$HNBRDF" eval "builtin:$first"
same "a byte order mark"
run_in ' 6e-1 ,+0,0.8,0,0, 1.0\n"0","0.6",0.8 ,-.6,0.,0.8\n' "$HNBRDF" eval "builtin:$first"
same "spaces, quotes and other spellings"
run_in 'note,wo_z,wo_y,wo_x,wi_z,wi_y,wi_x\nx,1,0,0,0.8,0,0.6\n"a, b",0.8,0,-0.6,0.8,0.6,0\n' \
    "$HNBRDF" eval "builtin:$first"
same "columns in another order"
printf "$pairs" >pairs.csv
run "$HNBRDF" eval "builtin:$first" -i pairs.csv -o values.csv
expect_ok "eval -i -o"
expect_out "eval -o prints nothing" ''
cmp -s values.csv plain || fail "eval -o: other values"

run_in '0.6,0,-0.8,0,0,1\n0,0,1,0.6,0,-0.8\n1,0,0,0,0,1\n' "$HNBRDF" eval "builtin:$first"
expect_ok "below the horizon"
expect_out "0 below the horizon" 'f_r,f_g,f_b\n0,0,0\n0,0,0\n0,0,0\n'
run_in 'wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n' "$HNBRDF" eval "builtin:$first"
expect_ok "a header alone"
expect_out "a header alone" 'f_r,f_g,f_b\n'
run_in '0,0,2,0,0,1\n' "$HNBRDF" eval "builtin:$first"
[ "$rc" -eq 0 ] && grep -q "warning: stdin: 1 lines, line 1 first" err || fail "not a unit vector: no warning"

run_in "$pairs" "$HNBRDF" eval hybrid.safetensors --material "$first"
expect_ok "eval of a model"
cp out plain
run_in "$pairs" "$HNBRDF" eval hybrid.safetensors --material "$first" --variant plain
same "plain C"
HNBRDF_VARIANT=nonsense run_in "$pairs" "$HNBRDF" eval hybrid.safetensors --material "$first"
same "a variable of the environment that was once read"
run_in "$pairs" "$HNBRDF" eval hybrid.safetensors --material "$first" --variant fastest
expect_usage "unknown variant" "expected auto, plain"
run_in "$pairs" "$HNBRDF" eval hybrid.safetensors
expect_failure "several materials" "choose one with --material"
run_in "$pairs" "$HNBRDF" eval hybrid.safetensors --material "$second"
expect_ok "eval of a model"
cp out of_second
run_in "material,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n$second,0.6,0,0.8,0,0,1\n$second,0,0.6,0.8,-0.6,0,0.8\n" \
    "$HNBRDF" eval hybrid.safetensors
expect_ok "a column material"
cmp -s out of_second || fail "a column material: other values than --material"
run_in "material,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\nnone,0.6,0,0.8,0,0,1\n" "$HNBRDF" eval hybrid.safetensors
expect_failure "an unknown material in a line" "stdin:2: the model has no material 'none'"
run_in "$pairs" "$HNBRDF" eval hybrid.safetensors --material "${second}x"
expect_failure "an unknown material" "did you mean $second?"
run_in "$pairs" "$HNBRDF" eval one.safetensors
expect_ok "the only material needs no name"

bad_line() {
    run_in "$2" "$HNBRDF" eval "builtin:$first"
    expect_failure "$1" "$3"
}
bad_line "an empty input" '' 'stdin: empty'
bad_line "a missing field" '0,0,1,0,0,1\n0,0,1,0,0\n' 'stdin:2: found 5 fields, expected 6'
bad_line "a field too many" '0,0,1,0,0,1,\n' 'stdin:1: found 7 fields, expected 6'
bad_line "a word" '0,0,1,0,up,1\n' "stdin:1: wo_y: found 'up', expected a finite decimal number"
bad_line "an empty field" '0,0,1,0,,1\n' "stdin:1: wo_y: found '', expected"
bad_line "nan" '0,0,1,0,0,1\n0,0,nan,0,0,1\n' "stdin:2: wi_z: found 'nan'"
bad_line "inf" '0,0,1,0,0,inf\n' "found 'inf'"
bad_line "an overflow" '0,0,1,0,0,1e39\n' "found '1e39'"
bad_line "semicolons" '0;0;1;0;0;1\n' "expected numbers or a header.*commas separate fields here, not ';'"
bad_line "decimal commas" '0,6;0;0,8;0;0;1\n' "stdin:1: found 3 fields, expected 6; commas separate"
bad_line "as many decimal commas as expected" '0,6;0,1;0,8;0,1;0,1;1\n' "found '6;0', expected.*; commas"
bad_line "a header with semicolons" 'wi_x;wi_y;wi_z;wo_x;wo_y;wo_z\n' "wi_x is missing.; commas"
bad_line "tabs" '0\t0\t1\t0\t0\t1\n' "commas separate fields here, not tabs"
bad_line "a CR alone" '0,0,1,0,0,1\r0,0,1,0,0,1\r' 'stdin:1: found a CR inside a line'
bad_line "two CRs" '0,0,1,0,0,1\r\r\n' 'stdin:1: found a CR inside a line'
bad_line "UTF-16" '\377\376\060\000,\000' 'stdin:1: found UTF-16, expected UTF-8'
bad_line "UTF-16, the other order" '\376\377\000\060\000,' 'stdin:1: found UTF-16, expected UTF-8'
bad_line "blank fields" '0,0,1,0,0,1\n,,,,,\n' "stdin:2: wi_x: found ''"
bad_line "two columns of a name" 'wi_x,wi_y,wi_z,wo_x,note,wo_y,wo_z,wi_y\n0,0,1,0,0,0,1,0\n' \
    'stdin:1: fields 2 and 8 are both named wi_y, expected one'
bad_line "two columns of a name after a mark" '\357\273\277"wi_x",wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n' \
    'stdin:1: fields 1 and 2 are both named wi_x'
bad_line "two materials" 'material,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,material\na,0,0,1,0,0,1,b\n' \
    'fields 1 and 8 are both named material'
bad_line "a header without wo_z" 'wi_x,wi_y,wi_z,wo_x,wo_y\n' 'wo_z is missing'
bad_line "a NUL byte" '0,0,1,0,0,\0001\n' 'stdin:1: found a NUL byte'
bad_line "an open quote" '"0,0,1,0,0,1\n' 'stdin:1: a quoted field is not closed'
awk 'BEGIN { for (k = 0; k < 5000; k++) printf "0.12345,"; print "" }' >long.csv
run "$HNBRDF" eval "builtin:$first" -i long.csv
expect_failure "a long line" "long.csv:1: the line is longer than"
awk 'BEGIN { for (k = 0; k < 300; k++) printf "0,"; print "" }' >wide.csv
run "$HNBRDF" eval "builtin:$first" -i wide.csv
expect_failure "a wide line" "wide.csv:1: found more than 256 fields"
run "$HNBRDF" eval "builtin:$first" -i .
expect_failure "a directory as input" "cannot read"
printf '0,0,1,0,0,1\nbad\n' >bad.csv
printf 'old\n' >kept.csv
run "$HNBRDF" eval "builtin:$first" -i bad.csv -o kept.csv
expect_failure "a bad line, -o" "bad.csv:2"
[ "$(cat kept.csv)" = old ] && [ "$(ls | grep -c part)" -eq 0 ] || fail "a failure spoils the old file"
if [ -c /dev/full ]; then
    "$HNBRDF" eval "builtin:$first" -i pairs.csv >/dev/full 2>err
    [ $? -eq 1 ] && [ "$(wc -l <err)" -eq 1 ] || fail "a full disk goes unnoticed"
fi

# ---- compare ----------------------------------------------------------------------------------------
run "$HNBRDF" compare hybrid.safetensors "builtin:$second" "builtin:$first" --pairs 1e3 --csv - --threads 1
expect_ok "compare --csv -"
cp out table.csv
[ "$(sed -n 1p out)" = "material,smape,smape_analytic,pairs" ] || fail "compare: columns"
[ "$(sed 's/,.*//' out | tr '\n' ' ')" = "material $second $first mean " ] || fail "compare: rows in order"
awk -F, 'NR > 1 && ($2 < 0 || $2 > 2 || $3 < 0 || $3 > 2) { exit 1 }' out || fail "compare: SMAPE of 0 to 2"
awk -F, 'NR == 2 || NR == 3 { s += $2 / 2; a += $3 / 2; n += $4 }
    NR == 4 { if (($2 - s) ^ 2 > 1e-12 || ($3 - a) ^ 2 > 1e-12 || $4 != n) exit 1 }' out ||
    fail "compare: the mean"
run "$HNBRDF" compare hybrid.safetensors "builtin:$second" "builtin:$first" --pairs 1000 --csv - --seed 2
cmp -s out table.csv && fail "compare: the seed changes nothing"
"$HNBRDF" compare hybrid.safetensors builtin --pairs 20000 --csv - --threads 1 >one_thread.csv 2>err
run "$HNBRDF" compare hybrid.safetensors builtin --pairs 20000 --csv - --threads 3
cmp -s out one_thread.csv || fail "compare: other digits with more threads"
run "$HNBRDF" compare ggx.safetensors builtin --pairs 500 --csv ggx.csv --json ggx.json
expect_ok "compare"
grep -q "grid sampler, 500 pairs a material, seed 1" out || fail "compare: says how it measured"
awk -F, 'NR > 1 && $2 != $3 { exit 1 }' ggx.csv || fail "compare: ggx is its analytic part"
if command -v python3 >/dev/null; then
    python3 -m json.tool ggx.json >/dev/null 2>err || fail "compare --json is not JSON"
fi
run "$HNBRDF" compare hybrid.safetensors builtin --pairs 500 --against ggx.safetensors
expect_ok "compare --against"
grep -q "lower SMAPE: hybrid.safetensors for [0-9]* of [0-9]* materials, ggx" out || fail "compare --against: no count"
run "$HNBRDF" compare one.safetensors "builtin:$first" --pairs 500
expect_failure "compare: a missing material" "the model has no material $first"
run "$HNBRDF" compare hybrid.safetensors "builtin:$first" lambert_rgb.bsdf --pairs 500 --skip-missing --csv -
expect_ok "compare --skip-missing"
[ "$(wc -l <out)" -eq 3 ] || fail "compare --skip-missing: rows"
run "$HNBRDF" compare hybrid.safetensors lambert_rgb.bsdf --skip-missing
expect_failure "compare: nothing left" "none of the materials"
run "$HNBRDF" compare hybrid.safetensors "builtin:$first" --pairs 10 --csv nowhere/x.csv
[ "$rc" -eq 1 ] && grep -q "nowhere/x.csv: cannot write" err || fail "compare: a CSV that cannot be written"

finish
