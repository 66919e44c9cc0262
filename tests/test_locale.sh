#!/bin/sh
# test_locale.sh SCRATCH PORTABLE HNBRDF TEXT SEEDS MODEL: nothing read or written depends on the locale. German
# writes a comma for the point, Pashto a sign of two bytes; both are made here. PORTABLE takes the locale over and
# must print what it prints without: model files, .brdf, shaders, texels, measurements, messages. TEXT is test_text,
# whose own test needs such a locale. HNBRDF writes the same CSV, JSON, GLSL and models with the environment set to
# each. Skipped (77) where no locale can be made.
set -eu
scratch=$1 portable=$2 hnbrdf=$3 text=$4 seeds=$5 model=$6

fail() {
    echo "test_locale: $*" >&2
    exit 1
}
skip() {
    echo "SKIPPED, NOTHING TESTED: $*"
    exit 77
}
command -v localedef > /dev/null || skip "no localedef, which comes with glibc"
rm -rf "$scratch"
mkdir -p "$scratch/work"
for locale in de_DE ps_AF; do
    # It warns about what it does not know, and then ends with 1; what matters is what it leaves.
    localedef -i $locale -f UTF-8 "$scratch/$locale.UTF-8" > "$scratch/log" 2>&1 ||
        [ -f "$scratch/$locale.UTF-8/LC_NUMERIC" ] || skip "localedef -i $locale (package locales): $(head -n 1 "$scratch/log")"
done
export LOCPATH="$scratch"

# commands DIRECTORY: what the command line writes, under the locale that is set.
commands() {
    mkdir "$1"
    printf 'wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0.6,0,0.8,-.5,1e-1,0.86\n0,0,1,0.28,0,0.96\n' > "$1/pairs.csv"
    "$hnbrdf" edit "$model" --material vch_silk_blue --set alpha=0.25,kd=0.1:0.2:0.3 --as velvet-crimson \
        -o "$1/edited.safetensors" > "$1/edit" &&
        "$hnbrdf" eval "$1/edited.safetensors" -m velvet-crimson -i "$1/pairs.csv" > "$1/eval" &&
        "$hnbrdf" info "$1/edited.safetensors" --json > "$1/info" &&
        "$hnbrdf" compare "$1/edited.safetensors" builtin:velvet-crimson --pairs 100 --csv "$1/compare.csv" \
            --json "$1/compare.json" > "$1/compare" 2> "$1/progress" &&
        "$hnbrdf" import "$seeds/brdf/plain" -o "$1/imported.safetensors" > "$1/import" &&
        "$hnbrdf" export "$model" --pack half --texels "$1/texels" -o "$1/scene.glsl" > "$1/export" || return 1
    ! "$hnbrdf" edit "$model" --material vch_silk_blue --set alpha=1.5 -o "$1/none" 2> "$1/refusal" || return 1
    [ ! -e "$1/none" ] && rm "$1/progress"
}

LC_ALL=C
export LC_ALL
"$portable" "$seeds" "$model" "$scratch/work" > "$scratch/plain" || fail "portable in the C locale"
commands "$scratch/cli" || fail "the command line in the C locale"
for locale in de_DE ps_AF; do
    LC_ALL=$locale.UTF-8
    "$portable" "$seeds" "$model" "$scratch/work" locale > "$scratch/there" || fail "portable under $locale"
    diff "$scratch/plain" "$scratch/there" || fail "$locale changes what is read or written (<: C, >: $locale)"
    mv "$scratch/cli" "$scratch/c"
    commands "$scratch/cli" || fail "the command line under $locale"
    diff -r "$scratch/c" "$scratch/cli" || fail "$locale changes what the command line writes"
    rm -rf "$scratch/c"
    echo "$locale: $(wc -l < "$scratch/there") lines and $(find "$scratch/cli" -type f | wc -l) files, all the same"
done
"$text" > "$scratch/log" 2>&1 || fail "test_text: $(cat "$scratch/log")"
! grep -q SKIPPED "$scratch/log" || fail "test_text found no locale: $(grep SKIPPED "$scratch/log" | head -n 1)"
rm -rf "$scratch"
