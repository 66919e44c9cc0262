#!/bin/sh
# test_habits.sh HNBRDF FILES SOURCES: every command against the habits of people and shells: outputs that cannot be
# written, inputs of another kind, names that are wrong, streams that are closed or full. The answer is one line that
# begins with `hnbrdf` (and a hint to --help where the usage is wrong), a status that is not 0, and every file as it was.
set -u
. "$(dirname "$0")/test_cli_support.sh"
SOURCES=$3

grep -v '^#' "$SOURCES/tests/command_lines.txt" >table
sed -n 's/^ *ROW(\([a-z]*\), .*/\1/p' "$SOURCES/src/cli/commands.h" | sort -u >commands
sed 's/[ |].*//' table | sort -u >here
cmp -s commands here || fail "a command is not in the table of this test: $(diff commands here)"
for report in $(sed -n 's/.*strcmp(argv\[1\], "\([a-z]*\)").*/\1/p' "$SOURCES/src/cli/cmd_report.c"); do
    grep -q "^report $report|" table || fail "report $report is not in the table of this test"
done

"$FILES" . || exit 1
run "$HNBRDF" fit builtin:rough-clay builtin:velvet-crimson --steps 10 --pool 64 -o 'two materials.safetensors'
[ "$rc" -eq 0 ] || { fail "no model to try with"; finish; }
printf 'wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0.6,0,0.8,0,0,1\n' >pairs.csv
printf 'camera from 0 0 4 to 0 0 0 fov 40\nsize 16 12\nenvironment sky\nmaterial a builtin rough-clay\nshape sphere material a\n' >small.scene
printf 'This is a letter, not a file of data.\n' >letter

# ---- One command against everything ------------------------------------------------------------------------
# In a folder of its own, with these names set by row(): words, whole, arguments, and `output`, "" for none.
# try OUTPUT INPUT EXTRA...: runs the command with these in the places of @ and IN.
try() {
    at=$1 in=$2
    shift 2
    set -f
    IFS=' '
    for word in $arguments; do
        case $word in
        IN) set -- "$@" "$in" ;;
        @/) set -- "$@" "$at" ;;
        @.png) set -- "$@" "$at.png" ;;
        @) set -- "$@" "$at" ;;
        *) set -- "$@" "$word" ;;
        esac
    done
    set +f
    $as "$HNBRDF" $words "$@"
}
# refused NAME STATUS...: the status is one of these, stderr has one line that begins with hnbrdf, and stdout nothing
# but perhaps a heading.
refused() {
    name=$1
    shift
    for status; do
        [ "$rc" -eq "$status" ] || continue
        [ "$(grep -vc '^try: hnbrdf ' err)" -eq 1 ] && grep -q '^hnbrdf' err || break
        return
    done
    fail "$words: $name: exit $rc, expected $* and one line that begins with hnbrdf"
}
# kept NAME FILE: it is still the letter.
kept() { cmp -s "$2" letter || fail "$words: $1: $2 is not as it was"; }
# no_leftover NAME
no_leftover() { ! ls -d ./*.hnbrdf-part* >/dev/null 2>&1 || fail "$words: $1: a file aside is left behind"; }

outputs() {
    try no/folder/x "$model" >out 2>err </dev/null
    rc=$?
    refused "a folder that is missing" 1
    mkdir -p there there.png
    folder=there
    [ "$kind" = file ] || folder=letter
    try "$folder" "$model" >out 2>err </dev/null
    rc=$?
    refused "$folder in the place of the output" 1
    rmdir there there.png
    kept "$folder in the place of the output" letter
    try - "$model" >out 2>err </dev/null
    rc=$?
    rm -f -- -.png
    [ "$rc" -eq 0 ] || refused "standard output" 2
    [ ! -e ./- ] || fail "$words: -o - makes a file called -"
    # The files of other programs, and what is read.
    [ "$kind" = file ] || return 0
    case $arguments in
    *@.png) ;;
    *)
        try lambert_rgb.bsdf "$model" >out 2>err </dev/null
        rc=$?
        refused "a measurement in the place of the output" 1
        cmp -s lambert_rgb.bsdf ../lambert_rgb.bsdf || fail "$words: a measurement is overwritten"
        ;;
    esac
    if [ "$whole" = whole ]; then
        (ulimit -f 0 && try full "$model" </dev/null 2>&1 >/dev/null) | cat >err
        ls full* >/dev/null 2>&1 && fail "$words: no file may grow: a file is there"
        [ "$(wc -l <err)" -eq 1 ] && grep -q '^hnbrdf.*: File too large$' err || fail "$words: no file may grow"
        no_leftover "no file may grow"
    fi
    # A folder and a file that this user may not write to: one command for each kind of output.
    case $words in compare | fit | export | render) ;; *) return 0 ;; esac
    [ -n "$user" ] || return 0
    as=$user
    try closed/x "$model" >out 2>err </dev/null
    rc=$?
    refused "a folder that is closed" 1
    chmod 777 .
    cp letter readonly
    cp letter readonly.png
    chmod 444 readonly readonly.png
    try readonly "$model" >out 2>err </dev/null
    rc=$?
    refused "a read-only file" 1
    kept "a read-only file" readonly
    kept "a read-only file" readonly.png
    as=
}

inputs() {
    case $arguments in *IN*) ;; *) return 0 ;; esac
    for bad in letter empty lambert_rgb.bsdf /dev/zero; do
        case $words:$bad in
        info:lambert_rgb.bsdf | eval:lambert_rgb.bsdf | render:lambert_rgb.bsdf | gallery:lambert_rgb.bsdf) continue ;;
        esac
        try output "$bad" >out 2>err </dev/null
        rc=$?
        refused "'$bad' in the place of the model" 1
        ! ls -d output* >/dev/null 2>&1 || fail "$words: '$bad' in the place of the model: something is written"
        rm -rf output*
    done
    [ "$kind" = file ] || return 0
    case $words in edit | mix | lobes | bake) return 0 ;; esac # a model may take its own place
    cp "$model" own.png
    cp "$model" own
    try own own >out 2>err </dev/null
    rc=$?
    case $arguments in *@.png) rm own own.png && return 0 ;; esac
    refused "the output is the input" 1
    cmp -s own "$model" || fail "$words: the input is overwritten"
    rm own own.png
}

# The second of two values would count without a word; test_cli_commands.sh tries unknown options.
options() {
    $as "$HNBRDF" $words x --output=a --output=b >out 2>err </dev/null
    rc=$?
    refused "an option twice" 2
    [ ! -e output ] && [ ! -e output.png ] || fail "$words: wrong usage writes"
}

streams() {
    [ "$whole" = whole ] || return 0
    try output "$model" >&- 2>err <&-
    rc=$?
    case $words in
    eval) [ "$rc" -eq 0 ] || fail "eval says nothing, and closed streams: exit $rc" ;;
    *) refused "stdout and stdin closed" 1 ;;
    esac
    no_leftover "stdout closed"
    case $words in compare | info | export) full=1 ;; *) full=0 ;; esac # one function for all
    if [ -c /dev/full ] && [ "$full" -eq 1 ]; then
        try output "$model" >/dev/full 2>err </dev/null
        rc=$?
        : >out
        refused "stdout full" 1
        grep -q 'No space left on device' err || fail "$words: stdout full"
    fi
    # Nobody reads: the work is done all the same, without a word, and the status tells.
    (try output "$model" 2>err </dev/null; echo $? >status) | :
    rc=$(cat status)
    case $rc in 0 | 141) [ ! -s err ] || fail "$words: a pipe that ends early" ;; *) fail "$words: a pipe that ends early: $rc" ;; esac
    [ "$words" = info ] || ls output* >/dev/null 2>&1 || fail "$words: a pipe that ends early: nothing is written"
    no_leftover "a pipe that ends early"
    rm -rf output*
}

# row LINE: everything, in a folder with what is read; the model's name has a blank.
row() {
    words=${1%%|*} arguments=${1##*|} whole=${1#*|}
    whole=${whole%|*}
    model="two materials.safetensors"
    as=
    case $arguments in *@/) kind=folder ;; *@*) kind=file ;; *) kind= ;; esac
    mkdir "$words" && cd "$words" || return
    cp ../*.safetensors ../pairs.csv ../small.scene ../letter ../a.brdf ../lambert_rgb.bsdf .
    mkdir empty closed
    chmod 555 closed
    [ -z "$kind" ] || outputs
    inputs
    options
    streams
    cd ..
    echo "$failures" >"$words/failures"
}

# Who may not write everywhere: root asks another user to run the command.
user=
chmod 755 "$SCRATCH"
if [ "$(id -u)" -ne 0 ]; then
    user=env
elif setpriv --reuid=65534 --regid=65534 --clear-groups "$HNBRDF" --version >/dev/null 2>&1; then
    user="setpriv --reuid=65534 --regid=65534 --clear-groups"
fi
[ -n "$user" ] || echo "no user without rights: read-only places are not tried"

# Files that no argument names: in a folder, in a scene.
mkdir folder
cp lambert_rgb.bsdf folder/UPPER.BSDF
cp lambert_rgb.bsdf folder/lower.bsdf
run "$HNBRDF" info folder
[ "$rc" -eq 0 ] && grep -q '^UPPER ' out && grep -q '^lower ' out || fail "an ending in capitals is left out"
cp a.brdf A.BRDF
run "$HNBRDF" info A.BRDF
expect_failure "an ending in capitals" "A.BRDF: a published shader; make a model of it first"
cp a.brdf light.exr
sed 's/environment sky/environment light.exr/' small.scene >lit.scene
run "$HNBRDF" scene lit.scene --spp 1 -o ./light.exr
expect_failure "a scene over its own light" "light.exr: is read, and --output would overwrite it"
cmp -s a.brdf light.exr || fail "a scene over its own light: it is overwritten"

# Two rows at a time.
half() {
    awk -v odd="$1" 'NR % 2 == odd' table | while IFS= read -r line; do
        failures=0
        row "$line"
    done
}
half 0 &
half 1
wait
while IFS='|' read -r words rest; do
    count=$(cat "$words/failures" 2>/dev/null || echo 1)
    failures=$((failures + count))
done <table

finish
