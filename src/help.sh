#!/bin/sh
# help.sh HNBRDF FOLDER VERSION DATE: writes FOLDER/man1/*.1, a manual page for each command, and
# FOLDER/completions/hnbrdf for bash, from what `hnbrdf COMMAND --help` prints; run by the build.
set -eu
hnbrdf=$1 folder=$2 version=$3 date=$4
here=$(dirname "$0")
LC_ALL=C
export LC_ALL

commands=$("$hnbrdf" --help | sed -n '/^commands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
# What a message offers: "expected a, b or c", "expected a|b|c".
offered() {
    sed -n '1s/.*, expected \([a-z0-9+|, -]*\)$/\1/p' | sed 's/ or /, /; s/|/, /g; s/,//g' |
        grep -E '^[a-z0-9+-]+( [a-z0-9+-]+)+$' || true
}
reports=$("$hnbrdf" report 2>&1 | offered)

rm -rf "$folder/man1" "$folder/completions"
mkdir -p "$folder/man1" "$folder/completions"

# ---- Manual pages ----
# page NAME ABOUT: of the command that NAME names, words joined by hyphens; its help is in $folder/help.
page() {
    awk -v name="$1" -v about="$2" -v version="$version" -v date="$date" -v see="$3" \
        -f "$here/help_manual.awk" "$folder/help" > "$folder/man1/$1.1"
}
"$hnbrdf" --help > "$folder/help"
page hnbrdf "fit, check and use hybrid neural-microfacet BRDFs" "$(for c in $commands; do echo "hnbrdf-$c"; done)"
for command in $commands; do
    about=$("$hnbrdf" --help | sed -n "s/^  $command  *\(.*\)/\1/p")
    "$hnbrdf" "$command" --help > "$folder/help"
    page "hnbrdf-$command" "$about" hnbrdf
done
for report in $reports; do
    "$hnbrdf" report "$report" --help > "$folder/help"
    # What it does: the first sentence, up to a colon.
    about=$(sed '1,/^$/d; /^$/q' "$folder/help" | tr '\n' ' ' | sed 's/[.:;] .*//')
    page "hnbrdf-report-$report" "$(echo "$about" | cut -c1 | tr '[:upper:]' '[:lower:]')${about#?}" "hnbrdf hnbrdf-report"
done

# ---- Completion ----
# table NAME WORDS...: the options and places of a command, and what a value that is asked for offers:
# a value that no option takes is refused with the words, before any work as --? is no option.
# shellcheck disable=SC2086 # a name may be two words
table() {
    name=$1
    "$hnbrdf" $name --help > "$folder/help"
    sed -n '/^options:/,/^$/s/^  \(-., \|    \)\(--[^ ]*\) \(KIND\|NAME\|HOW\)  .*/\2/p' \
        "$folder/help" | while read -r option; do
        words=$("$hnbrdf" $name "$option" '?' '--?' 2>&1 | offered)
        [ -z "$words" ] || echo "$option $words"
    done > "$folder/words"
    awk -v name="$name" -v words="$folder/words" -f "$here/help_completion.awk" "$folder/help"
}
endings=$("$hnbrdf" --help | sed -n '/^RGL /p' | grep -o '\.[a-z0-9]*[a-z0-9]' | tr '\n' ' ')
{
    echo "# bash completion for hnbrdf $version, made from what \`hnbrdf COMMAND --help\` prints."
    echo "_hnbrdf_commands='$(echo "$commands" | tr '\n' ' ') --help --version'"
    echo "_hnbrdf_reports='$reports'"
    echo "_hnbrdf_data='$endings'"
    echo "_hnbrdf_builtin='anisotropic $({ "$hnbrdf" info builtin && "$hnbrdf" info builtin:anisotropic; } |
        sed -n 's/^\([a-z-]*\)  *builtin .*/\1/p' | tr '\n' ' ')'"
    echo "# _hnbrdf_value COMMAND OPTION: sets kind, what the option takes, to words, files, data, folder or any."
    echo "# _hnbrdf_table COMMAND: sets options, and what its places take; the last may be repeated."
    for command in $commands; do
        [ "$command" = report ] || table "$command"
    done > "$folder/cases"
    for report in $reports; do
        table "report $report"
    done >> "$folder/cases"
    printf '_hnbrdf_table() {\n    case $1 in\n'
    sed -n 's/^table //p' "$folder/cases"
    printf '    *) options="" places="" ;;\n    esac\n}\n_hnbrdf_value() {\n    case "$1 $2" in\n'
    sed -n 's/^value //p' "$folder/cases"
    printf '    *) return 1 ;;\n    esac\n}\n\n'
    sed 1,4d "$here/help_completion.bash"
} > "$folder/completions/hnbrdf"
rm "$folder/help" "$folder/words" "$folder/cases"
