#!/bin/sh
# test_examples.sh SOURCE HNBRDF EXAMPLES SCRATCH: the programs and the shader in examples/ do what they say.
set -eu
source=$1 hnbrdf=$2 examples=$3 scratch=$4

fail() {
    echo "test_examples: $*" >&2
    exit 1
}
rm -rf "$scratch"
mkdir -p "$scratch"
model=$scratch/model.safetensors
"$hnbrdf" fit builtin:gold-two-lobe builtin:velvet-crimson --net 8x1 --steps 50 --pool 4096 -o "$model" > /dev/null

[ "$("$examples/eval" "$model" velvet-crimson | wc -l)" = 4 ] || fail "eval does not print four lines"
! "$examples/eval" "$model" nobody 2> "$scratch/message" || fail "eval knows a material that is not there"
grep -q gold-two-lobe "$scratch/message" || fail "eval does not say which materials there are"
! "$examples/eval" "$scratch/missing" 2> "$scratch/message" || fail "eval reads a missing file"
grep -q missing "$scratch/message" || fail "eval does not name the missing file"

"$examples/batch" "$model" > "$scratch/time.csv"
awk -F, 'NR == 1 && $0 != "material,single_ns,batch_ns" { exit 1 }
         NR > 1 && !(NF == 3 && $2 > 0 && $3 > 0) { exit 1 } END { exit NR != 3 }' "$scratch/time.csv" ||
    fail "batch prints $(cat "$scratch/time.csv")"

# Albedos lie in (0, 1.2): the model is a crude fit, but of things that reflect.
"$examples/sample" "$model" gold-two-lobe > "$scratch/albedo"
awk 'NR > 2 { n++; for (c = 2; c <= 4; c++) if (!($c > 0 && $c < 1.2)) exit 1 } END { exit n != 7 }' \
    "$scratch/albedo" || fail "sample prints $(cat "$scratch/albedo")"

"$examples/edit" "$model" gold-two-lobe velvet-crimson "$scratch/edited.safetensors" > "$scratch/names"
printf 'gold-two-lobe\nhalfway\ngold-two-lobe-rough\n' | cmp -s - "$scratch/names" || fail "edit prints $(cat "$scratch/names")"
"$hnbrdf" mix "$model" gold-two-lobe velvet-crimson --t 0.5 --as p -o "$scratch/mixed.safetensors" > /dev/null
for file in edited:halfway mixed:p-0.5; do # edit makes what `hnbrdf mix` makes
    echo 0,0.6,0.8,0,0,1 | "$hnbrdf" eval "$scratch/${file%:*}.safetensors" --material "${file#*:}" > "$scratch/${file%:*}.csv"
done
cmp "$scratch/edited.csv" "$scratch/mixed.csv" || fail "edit mixes otherwise than the command"
! "$examples/edit" "$model" gold-two-lobe nobody "$scratch/x" 2> "$scratch/message" || fail "edit knows nobody"

# bake prints a row a model, GGX first, and keeps to the size it asks for.
"$examples/bake" "$scratch/baked.safetensors" 100 > "$scratch/rows"
awk 'NR == 1 && $1 != "ggx" { exit 1 } / multiplications / && $3 > 120 { exit 1 }
     /^picked/ { seen = 1 } END { exit !(seen && NR > 3) }' "$scratch/rows" || fail "bake prints $(cat "$scratch/rows")"
"$hnbrdf" info "$scratch/baked.safetensors" | grep -q '^  kind *hybrid$' || fail "bake saves no hybrid"

for file in "$source"/examples/*.c "$source"/examples/*.frag; do
    [ "$(wc -l < "$file")" -le 100 ] || fail "$file is longer than 100 lines"
done
sh -n "$source/examples/demo.sh"
sh -n "$source/tests/run.sh"

command -v glslangValidator > /dev/null || { echo "shader skipped: no glslangValidator"; exit 0; }
"$hnbrdf" export "$model" --materials gold-two-lobe -o "$scratch/scene.glsl" > /dev/null
glslangValidator -V -I"$source/shaders" -I"$scratch" "$source/examples/sphere.frag" -o "$scratch/sphere.spv" \
    > "$scratch/message" || fail "sphere.frag: $(cat "$scratch/message")"
rm -rf "$scratch"
