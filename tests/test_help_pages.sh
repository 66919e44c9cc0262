#!/bin/sh
# test_help_pages.sh HNBRDF FOLDER: the manual pages and the completion of bash that the build made in FOLDER from
# --help have every command and option, are sound, and complete what one types.
set -u
hnbrdf=$1 folder=$2
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
failures=0
fail() {
    echo "test_help_pages: $*" >&2
    failures=$((failures + 1))
}
LC_ALL=C
export LC_ALL

# ---- Every command, option and word ----
count=0
for command in $("$hnbrdf" --help | sed -n '/^commands:/,/^$/s/^  \([a-z]*\) .*/\1/p') report-images report-sampling report-editing; do
    page=$folder/man1/hnbrdf-$command.1
    [ -s "$page" ] || { fail "no page of $command" && continue; }
    words=$(echo "$command" | tr - ' ')
    [ "$command" != report ] || words="report accuracy"
    # shellcheck disable=SC2086 # two words
    "$hnbrdf" $words --help > "$scratch/help"
    sed 's/\\-/-/g; s/\\f.//g; s/\\(ha/^/g; s/\\(ti/~/g; s/\\(aq/'"'"'/g; s/\\(ga/`/g; s/\\e/\\/g; s/\\&//g' "$page" > "$scratch/page"
    grep -e "^    \"$words\") " "$folder/completions/hnbrdf" | tr -s '" ' '\n' > "$scratch/completed"
    for option in $(sed -n '/^options:/,/^$/s/^  \(-., \|    \)\(--[a-z-]*\).*/\2/p' "$scratch/help"); do
        count=$((count + 1))
        grep -q -e "^\(-., \)\{0,1\}$option\( \|\$\)" "$scratch/page" || fail "$command: $option is not in its page"
        grep -qx -e "$option" "$scratch/completed" || fail "$command: $option is not completed"
    done
    # But for the headings and quotation marks.
    sed '/^[a-z]*:$/d; s/^usage: //; s/`//g' "$scratch/help" | tr -s ' ' '\n' | sort -u > "$scratch/words"
    tr -s ' ' '\n' < "$scratch/page" | sort -u | comm -23 "$scratch/words" - > "$scratch/lost"
    [ -s "$scratch/words" ] && ! grep -q . "$scratch/lost" || fail "$command: the page lacks $(tr '\n' ' ' < "$scratch/lost")"
done
[ "$count" -gt 200 ] || fail "only $count options were found"
grep -q '^.BR hnbrdf\\-fit (1),' "$folder/man1/hnbrdf.1" || fail "hnbrdf.1 does not name hnbrdf-fit"

# ---- Sound ----
if command -v mandoc > /dev/null; then
    mandoc -T lint "$folder"/man1/*.1 > "$scratch/log" 2>&1 || fail "mandoc: $(head -n 5 "$scratch/log")"
    [ ! -s "$scratch/log" ] || fail "mandoc: $(head -n 5 "$scratch/log")"
else
    echo "pages not checked by mandoc: it is not here"
fi
if command -v groff > /dev/null; then
    groff -man -Tutf8 -ww -z "$folder"/man1/*.1 > "$scratch/log" 2>&1 || fail "groff: $(head -n 5 "$scratch/log")"
    [ ! -s "$scratch/log" ] || fail "groff: $(head -n 5 "$scratch/log")"
else
    echo "pages not checked by groff: it is not here"
fi

# ---- Completion ----
command -v bash > /dev/null || { echo "completion not tried: no bash"; exit $((failures > 0)); }
cd "$scratch" || exit 1
mkdir here && cd here || exit 1
mkdir rgl
for file in model.safetensors UPPER.BSDF notes.txt light.hdr room.scene; do : > $file; done
cat > ../try.bash << 'END'
# try.bash COMPLETION: reads lines "WORD WORD... -> OFFERED...": what is offered for the last word, sorted. Words are
# split as bash does it, and a last word of _ stands for nothing typed yet.
. "$1"
bad=0
while IFS= read -r line; do
    typed=${line% ->*} expected=${line#* ->}
    typed=${typed//=/ = }
    read -r -a COMP_WORDS <<< "${typed//:/ : }"
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    [ "${COMP_WORDS[COMP_CWORD]}" != _ ] || COMP_WORDS[COMP_CWORD]=
    COMPREPLY=()
    _hnbrdf
    found=$(printf ' %s\n' "${COMPREPLY[@]}" | sort | tr -d '\n')
    [ "${found:- }" = "${expected:- }" ] || { echo "$line: offered$found" && bad=1; }
done
exit $bad
END
bash ../try.bash "$folder/completions/hnbrdf" > ../out 2>&1 << 'END' || fail "completion: $(cat ../out)"
hnbrdf s -> scene sheet stability
hnbrdf --v -> --version
hnbrdf report e -> editing
hnbrdf fit --ki -> --kind
hnbrdf fit --kind _ -> ggx hybrid neural
hnbrdf fit --kind=hy -> hybrid
hnbrdf fit --kind= -> ggx hybrid neural
hnbrdf fit --encoding angles- -> angles-anisotropic angles-azimuths angles-directed
hnbrdf fit _ -> UPPER.BSDF builtin rgl
hnbrdf fit builtin:rough -> rough-clay
hnbrdf fit builtin:cor -> corduroy
hnbrdf fit builtin:an -> anisotropic anodised-titanium
hnbrdf fit builtin:rough-clay --freeze _ -> model.safetensors rgl
hnbrdf fit rgl -o _ -> model.safetensors rgl
hnbrdf fit --steps _ ->
hnbrdf compare _ -> model.safetensors rgl
hnbrdf compare model.safetensors _ -> UPPER.BSDF builtin rgl
hnbrdf compare --pairs 10 model.safetensors r -> rgl
hnbrdf compare --sampler=grid model.safetensors U -> UPPER.BSDF
hnbrdf compare n -> notes.txt
hnbrdf info m -> model.safetensors
hnbrdf export model.safetensors --weights c -> columns constants
hnbrdf export model.safetensors -w u -> uniform
hnbrdf scene _ -> rgl room.scene
hnbrdf scene room.scene --measured _ -> rgl
hnbrdf render model.safetensors --env _ -> furnace light.hdr rgl sky
hnbrdf render model.safetensors --background b -> backdrop
hnbrdf mix model.safetensors _ ->
hnbrdf report accuracy --sampler co -> cosine
hnbrdf report images _ -> UPPER.BSDF builtin rgl
END
[ ! -s ../out ] || fail "completion: $(cat ../out)"
[ "$failures" -eq 0 ] || exit 1
echo "passed, $count options"
