#!/bin/sh
# test_export_cli.sh HNBRDF SCENES MODEL: what `hnbrdf export` leaves out and packs, as a user runs it. MODEL is the
# shipped one.
set -eu
hnbrdf=$1 scenes=$2 shipped=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$scenes" "$work" >/dev/null
model=$work/hybrid_8x4_rotated.safetensors
fail() { echo "failed: $*"; exit 1; }
status() { expected=$1; shift; got=0; "$@" >"$work/out" 2>"$work/err" || got=$?
    [ $got = "$expected" ] || { cat "$work/out" "$work/err"; fail "exit $got, expected $expected: $*"; }; }

# --only and --fixed: the text states what it holds, and holds no more.
status 0 "$hnbrdf" export "$model" --only eval --fixed --standalone -o "$work/x.glsl"
grep -q '^//   contains   hnbrdf_eval, hnbrdf_eval_NAME, the same with _world$' "$work/x.glsl" || fail "contains"
grep -q '^//   left out   materials that change' "$work/x.glsl" || fail "left out"
grep -q 'hnbrdf_sample' "$work/x.glsl" && fail "sampling is there"
grep -q 'vec3 hnbrdf_eval_GOLD_PAINT(vec3 wi, vec3 wo)' "$work/x.glsl" || fail "no function of one material"
status 0 "$hnbrdf" export "$model" --only eval+sample -o "$work/y.glsl"
grep -q '^hnbrdf_sample_result hnbrdf_sample(' "$work/y.glsl" || fail "no sampling"
status 2 "$hnbrdf" export "$model" --only sample -o "$work/z.glsl"

# --pack: texels of the stated size, and an error that the README can quote.
status 0 "$hnbrdf" export "$shipped" --pack half --texels "$work/half.bin" -o "$work/p.glsl"
[ "$(wc -c <"$work/half.bin")" = $((12 * 3 * 8)) ] || fail "half texels"
grep -q '^//   texels     3 of RGBA16F a material, 24 bytes$' "$work/p.glsl" || fail "texels in the heading"
mean() { sed -n 's/.*mean \([0-9.]*\), worst.*/\1/p' "$work/out"; }
[ "$(mean | awk '{ print ($1 > 0 && $1 < 0.0015) }')" = 1 ] || fail "half: SMAPE $(mean), expected under 0.0015"
status 0 "$hnbrdf" export "$shipped" --pack byte --texels "$work/byte.bin" -o "$work/p.glsl"
[ "$(wc -c <"$work/byte.bin")" = $((12 * 3 * 4)) ] || fail "byte texels"
[ "$(mean | awk '{ print ($1 > 0 && $1 < 0.02) }')" = 1 ] || fail "byte: SMAPE $(mean), expected under 0.02"
grep -q '^fields: kd, eta, alpha, 4 latent$' "$work/out" || fail "fields of the packing"
status 0 "$hnbrdf" export "$model" --pack half --texels "$work/rows.bin" -o "$work/p.glsl"
grep -q '^fields: kd, eta, alpha, a second alpha (gold-paint has it), rotation (gold-paint has it), 6 latent$' "$work/out" ||
    fail "who asks for a field"

# The same layout whatever the materials are; planes hold what rows hold.
for materials in vch_silk_blue vch_silk_blue,chm_mint; do
    status 0 "$hnbrdf" export "$shipped" -m $materials --pack byte --texel-fields all --texels "$work/all.bin" -o "$work/p.glsl"
    grep -q '^#define HNBRDF_TEXELS 6$' "$work/p.glsl" || fail "texels of all fields"
done
[ "$(wc -c <"$work/all.bin")" = $((2 * 6 * 4)) ] || fail "bytes of all fields"
status 0 "$hnbrdf" export "$shipped" -m vch_silk_blue,chm_mint --pack byte --texel-fields all --texel-layout planes \
    --texels "$work/planes.bin" -o "$work/p.glsl"
bytes() { od -An -v -tx4 -w4 "$1"; }
bytes "$work/all.bin" | awk '{ row[NR - 1] = $1 } END { for (t = 0; t < 6; t++) for (k = 0; k < 2; k++) print row[6 * k + t] }' >"$work/a"
bytes "$work/planes.bin" | awk '{ print $1 }' | cmp -s - "$work/a" || fail "planes are not the rows turned"
status 2 "$hnbrdf" export "$shipped" --texel-fields all -o "$work/z.glsl"
status 2 "$hnbrdf" export "$shipped" --pack half --texel-layout planes -o "$work/z.glsl"

# What one has to know who runs the text.
status 0 "$hnbrdf" export "$shipped" --weights uniform --prefix silk -o "$work/u.glsl"
grep -q 'uniform block silk_weights_block, [0-9]* bytes: --weights-out FILE writes them' "$work/out" || fail "weights to be loaded"
status 0 "$hnbrdf" export "$shipped" --weights uniform --weights-out "$work/w.bin" -o "$work/u.glsl"
! grep -q 'weights-out' "$work/out" || fail "weights that are written"
status 0 "$hnbrdf" export "$shipped" --precision half -o "$work/h.glsl"
grep -q 'ten times as long' "$work/out" || fail "half precision on a CPU driver"
status 2 "$hnbrdf" export "$model" --texels "$work/t.bin" -o "$work/z.glsl"
status 2 "$hnbrdf" export "$model" --fixed --pack half -o "$work/z.glsl"
status 1 "$hnbrdf" export "$model" --pack half --texels "$work/no/such/place" -o "$work/z.glsl"
[ -e "$work/z.glsl" ] && fail "a failed export leaves a file"

# --language, --library and --exact: the shared part alone, without a model; a scene asks for it.
for language in hlsl msl wgsl slang; do
    status 0 "$hnbrdf" export --library --language $language -o "$work/l.$language"
    head -1 "$work/l.$language" | grep -q "^// hybrid_brdf\.$language: " || fail "heading of the shared part, $language"
    status 0 "$hnbrdf" export "$model" -l $language -o "$work/s.$language"
    grep -q '(columns, float)' "$work/out" || fail "columns are the default in $language"
    grep -q 'hnbrdf_hard_gelu(' "$work/s.$language" && grep -q 'hnbrdf_hard_gelu(float x)' "$work/s.$language" && fail "$language: the shared part in a scene"
    [ $language = wgsl ] || grep -q "^#error.* hybrid_brdf\.$language" "$work/s.$language" || fail "$language: no check of the shared part"
    status 0 "$hnbrdf" export --library --exact -l $language -o "$work/e.$language"
    grep -q 'hnbrdf_log(tan_2)' "$work/e.$language" || fail "$language: exact"
    grep -q ' log(min(tan_2, ' "$work/l.$language" || fail "$language: not exact"
done
status 0 "$hnbrdf" export --library -o "$work/l.glsl"
status 0 "$hnbrdf" export "$model" --standalone --exact -o "$work/e.glsl"
grep -q '^#define HNBRDF_EXACT 1$' "$work/e.glsl" || fail "exact GLSL"
status 2 "$hnbrdf" export "$model" --exact -o "$work/z.glsl"
status 2 "$hnbrdf" export "$model" --library -o "$work/z.glsl"
status 2 "$hnbrdf" export "$model" --language cg -o "$work/z.glsl"
[ -e "$work/z.glsl" ] && fail "a refused export leaves a file"

# --language brdf: read back, the same values; and GLSL as programs for such files put it together, with every
# line gone that begins with '#'.
status 0 "$hnbrdf" export "$shipped" -m vch_silk_blue --language brdf -o "$work/vch_silk_blue.brdf"
status 0 "$hnbrdf" import "$work/vch_silk_blue.brdf" -o "$work/again.safetensors"
printf '%s\n' 0.3,0.1,0.9,-0.2,0.3,0.8 0,0,1,0.6,0,0.8 >"$work/pairs"
"$hnbrdf" eval "$shipped" -m vch_silk_blue -i "$work/pairs" -o "$work/f" >/dev/null
"$hnbrdf" eval "$work/again.safetensors" -i "$work/pairs" -o "$work/f_again" >/dev/null
cmp -s "$work/f" "$work/f_again" || fail "a written .brdf file has other values"
status 1 "$hnbrdf" export "$shipped" --language brdf -o "$work/z.glsl"
grep -q "expected one: a .brdf file holds one" "$work/err" || fail "several materials in a .brdf file"
if command -v glslangValidator >/dev/null; then
    for version in 410 '300 es'; do
        {
            printf '#version %s\nprecision highp float;\nin vec3 L;\nin vec3 V;\nout vec4 colour;\n' "$version"
            sed -n 's/^float \([a-z_0-9]*\) .*/uniform float \1;/p' "$work/vch_silk_blue.brdf"
            sed -n '/^::begin shader/,/^::end shader/p' "$work/vch_silk_blue.brdf" | grep -v -e '^ *#' -e '^::'
            echo 'void main() { colour = vec4(BRDF(L, V, vec3(0, 0, 1), vec3(1, 0, 0), vec3(0, 1, 0)), 1); }'
        } >"$work/x.frag"
        glslangValidator "$work/x.frag" >"$work/out" || { cat "$work/out"; fail "$version: a .brdf file does not compile"; }
    done
fi
echo ok
