#!/bin/sh
# test_edit_cli.sh HNBRDF FILES: what `edit` and `mix` write, print and refuse.
set -u
. "$(dirname "$0")/test_cli_support.sh"

"$FILES" . || exit 1
first=$("$HNBRDF" info builtin | awk 'NR == 2 { print $1 }')
second=$("$HNBRDF" info builtin | awk 'NR == 3 { print $1 }')
cp hybrid.safetensors original.safetensors

# line MODEL NAME: the row of the material's numbers, the first that `info` prints of it.
line() {
    "$HNBRDF" info "$1" | awk -v name="$2" '$1 == name { $1 = ""; print; exit }'
}
# values MODEL NAME: f for three pairs of directions.
values() {
    printf '0,0,1,0,0,1\n0.6,0,0.8,0,0.6,0.8\n0,-0.6,0.8,0,0.6,0.8\n' | "$HNBRDF" eval "$1" --material "$2"
}

for command in edit mix; do
    run "$HNBRDF" "$command" --help
    expect_ok "$command --help"
    grep -q "^usage: hnbrdf $command " out || fail "$command --help: no usage line"
    grep -q "^  hnbrdf $command " out || fail "$command --help: no example of itself"
    awk 'length($0) > 104 { exit 1 }' out || fail "$command --help: lines longer than 104"
    run "$HNBRDF" "$command"
    expect_usage "$command without arguments" "hnbrdf $command --help"
done

# ---- edit -------------------------------------------------------------------------------------------
run "$HNBRDF" edit hybrid.safetensors --material "$first" --set alpha=0.2,kd=0.1:0.2:0.3,eta=1.6,rotation=30deg \
    --as b -o out.safetensors
expect_ok "edit --as"
[ "$(line out.safetensors b)" = " 0.1000 0.2000 0.3000 1.6 1.6 1.6 0.2 0.2 0.5236" ] ||
    fail "edit --as: $(line out.safetensors b)"
[ "$(line out.safetensors "$first")" = "$(line hybrid.safetensors "$first")" ] || fail "edit --as changed its source"
cmp -s hybrid.safetensors original.safetensors || fail "edit -o changed MODEL"
values out.safetensors "$second" >after
values hybrid.safetensors "$second" >before
cmp -s before after || fail "edit changed another material"
run "$HNBRDF" edit out.safetensors -m b --set 'alpha*=2,eta+=0.4,rotation+=-30deg,kd*=0.5'
expect_ok "edit in place"
grep -q '^out.safetensors: b changed$' out || fail "edit does not say what it wrote"
grep -q '^  alpha *0.2 -> 0.4$' out || fail "edit does not say what changed"
[ "$(line out.safetensors b | cut -d' ' -f2-9)" = "0.0500 0.1000 0.1500 2 2 2 0.4 0.4" ] ||
    fail "relative edits: $(line out.safetensors b)"
run "$HNBRDF" edit out.safetensors -m b --set alpha=0.1:0.4
run "$HNBRDF" edit out.safetensors -m b --set alpha_y=0.3,kd=0.2 --as c
[ "$(line out.safetensors c | cut -d' ' -f2-9)" = "0.2000 0.2000 0.2000 2 2 2 0.1 0.3" ] ||
    fail "isotropic made anisotropic: $(line out.safetensors c)"

cp out.safetensors kept.safetensors
refuse() { # NAME SET TEXT
    run "$HNBRDF" edit out.safetensors -m b --set "$2"
    expect_usage "$1" "$3"
}
refuse "an unknown field" kf=1 "did you mean kd"
refuse "no value" kd= "not a number"
refuse "no assignment" kd "'kd' is not FIELD=VALUE"
refuse "two values of kd" kd=1:2 "found 2 values, expected 1 or 3"
refuse "three values of alpha" alpha=0.1:0.2:0.3 "found 3 values, expected 1 or 2"
refuse "an alpha in degrees" alpha=1deg "not a number"
refuse "infinity" eta=inf "not a number"
refuse "a trailing comma" kd=1, "is not FIELD=VALUE"
run "$HNBRDF" edit out.safetensors -m b --set alpha=7
expect_failure "alpha out of range" "alpha.* is 7, expected 0.0001 to 1"
run "$HNBRDF" edit out.safetensors -m b --set eta=1
expect_failure "eta of 1" "eta.* is 1, expected above 1, at most 1000"
run "$HNBRDF" edit out.safetensors -m b --set kd+=1
expect_failure "kd above 1" "kd.* expected 0 to 1"
run "$HNBRDF" edit out.safetensors -m nothing --set kd=0
expect_failure "an unknown material" "nothing"
run "$HNBRDF" edit out.safetensors --set kd=0
expect_failure "no material of several" "choose one"
run "$HNBRDF" edit out.safetensors -m b --set kd=0 --as c
expect_failure "a name that is taken" "a material c already"
run "$HNBRDF" edit lambert.binary --set kd=0
expect_failure "edit of measured data" "measured data"
run "$HNBRDF" edit out.safetensors -m b --set kd=0 -o nowhere/out.safetensors
expect_failure "a folder that is missing" "nowhere/out.safetensors"
cmp -s out.safetensors kept.safetensors || fail "a refused edit changed the file"
run "$HNBRDF" edit out.safetensors -m b --set kd=0 --as c --replace
expect_ok "--replace"

# ---- mix --------------------------------------------------------------------------------------------
run "$HNBRDF" mix hybrid.safetensors "$first" "$second" --t 0:1:0.25 -o mixed.safetensors
expect_ok "mix"
for t in 0 0.25 0.5 0.75 1; do
    grep -qx "  $first-$second-$t" out || fail "mix: no material at $t"
done
values hybrid.safetensors "$first" >a
values mixed.safetensors "$first-$second-0" >a_mixed
values hybrid.safetensors "$second" >b
values mixed.safetensors "$first-$second-1" >b_mixed
cmp -s a a_mixed && cmp -s b b_mixed || fail "the ends of a mix are not the materials"
run "$HNBRDF" mix mixed.safetensors "$first" "$second" --t 0:1:0.5 --straight --as s
expect_ok "mix --straight"
for name in s-0.5 "$first-$second-0.5" s-0 s-1; do
    values mixed.safetensors "$name" >"$name.values"
done
cmp -s a s-0.values && cmp -s b s-1.values || fail "the ends of a straight mix are not the materials"
! cmp -s s-0.5.values "$first-$second-0.5.values" || fail "mix --straight mixes as without"
run "$HNBRDF" mix hybrid.safetensors "$first" "$second" --t 0:1:0.1 --as p -o mixed.safetensors
[ "$(grep -c '^  p-' out)" -eq 11 ] || fail "mix 0:1:0.1 has not 11 steps"
run "$HNBRDF" mix mixed.safetensors "$first" "$second" --t 0.5 --as p
expect_failure "mix over a name" "p-0.5 already"
run "$HNBRDF" mix mixed.safetensors "$first" "$second" --t 0.5 --as p --replace
expect_ok "mix --replace"
for t in 1.5 0:1 0:1:0 1:0:0.1 0:1:0.0001 x 0:1:0.5:1 ''; do
    run "$HNBRDF" mix mixed.safetensors "$first" "$second" --t "$t"
    expect_usage "mix --t '$t'" "--t"
done
run "$HNBRDF" mix mixed.safetensors "$first" --t 0.5
expect_usage "mix of one" "two materials"
run "$HNBRDF" mix mixed.safetensors "$first" nothing --t 0.5
expect_failure "mix with nothing" "nothing"

# ---- an edit and what was fitted ---------------------------------------------------------------------
run "$HNBRDF" edit hybrid.safetensors --material "$first" --set 'alpha*=1.5' -o rough.safetensors
expect_ok "edit alpha"
run "$HNBRDF" info rough.safetensors
[ "$(grep -c 'edited; fitted as' out)" = 1 ] || fail "info does not show what an edited material was fitted with"
"$HNBRDF" info rough.safetensors --json | grep -q '"fitted_alpha"' || fail "info --json of an edited material"
! "$HNBRDF" info hybrid.safetensors --json | grep -q fitted || fail "info shows unedited materials as edited"
"$HNBRDF" export rough.safetensors -o - | grep -q 'edited with their corrections' || fail "export of an edited material"
! "$HNBRDF" export hybrid.safetensors -o - | grep -q hnbrdf_edit || fail "export writes edits nobody asked for"
"$HNBRDF" export hybrid.safetensors --editable -o - | grep -q 'vec2 fitted_alpha;' || fail "export --editable"
run "$HNBRDF" export hybrid.safetensors --editable --fixed -o x.glsl
expect_usage "export --editable --fixed" "do not change"
run "$HNBRDF" edit rough.safetensors --material "$first" --set alpha=fitted
expect_ok "edit alpha=fitted"
values hybrid.safetensors "$first" >a
values rough.safetensors "$first" >b
cmp -s a b || fail "an edit taken back leaves other values"

# ---- lobes ------------------------------------------------------------------------------------------
run "$HNBRDF" lobes hybrid.safetensors -o lobes.safetensors
[ "$rc" -eq 0 ] || fail "lobes -o: exit $rc" # with progress, where it takes long
"$HNBRDF" lobes lobes.safetensors --show --csv - >fitted.csv 2>err || fail "lobes --show: $(cat err)"
head -n 1 fitted.csv | grep -qx 'material,alpha_x,alpha_y,roughness1,share1_0,.*,share2_3' || fail "the columns of lobes --csv"
! grep -q ',0,0,0,0,0,0,0,0,0,0$' fitted.csv || fail "lobes left a material without any"
values hybrid.safetensors "$first" >a
run "$HNBRDF" lobes lobes.safetensors --scheme guess -o guess.safetensors
expect_ok "lobes --scheme guess"
grep -q 'none: guessed' out || fail "lobes does not say that there are none"
run "$HNBRDF" lobes guess.safetensors --scheme paper
expect_ok "lobes --scheme paper"
"$HNBRDF" lobes guess.safetensors --show --csv - | tail -n 1 | grep -q ',-[0-9.]*,0.5,0.5,0.5,0.5,0,0,0,0,0$' ||
    fail "the paper's lobes"
values guess.safetensors "$first" >a_paper
cmp -s a a_paper || fail "lobes change values"
run "$HNBRDF" lobes guess.safetensors
[ "$rc" -eq 0 ] || fail "lobes: exit $rc" # with progress, where it takes long
cmp -s guess.safetensors lobes.safetensors || fail "lobes fitted again are others"
run "$HNBRDF" lobes hybrid.safetensors --show -o x.safetensors
expect_usage "lobes --show -o" "writes no model"
run "$HNBRDF" lobes lambert.binary
expect_failure "lobes of measured data" "lambert.binary"
run "$HNBRDF" lobes
expect_usage "lobes of nothing" "no MODEL"

finish
