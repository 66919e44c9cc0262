#!/bin/sh
# test_cli_data.sh HNBRDF FILES SOURCES: where an option gives standard output to data, nothing else is written there:
# JSON is JSON, CSV is a table, SVG is XML, all of it. Every such option of every command.
set -u
ASAN_OPTIONS=detect_leaks=0 # the Vulkan driver is unloaded before leaks are looked for
export ASAN_OPTIONS
. "$(dirname "$0")/test_cli_support.sh"
SOURCES=$3
command -v python3 >/dev/null || { echo "no python3: skipped"; exit 77; }

# Reads lines "FORM FILE WORDS"; one line for each file that has not its form.
cat >forms.py <<'END'
import csv, json, sys, xml.dom.minidom
def refuse(word):
    raise ValueError(word + " is no JSON")
def check(form, path):
    if form == "json":
        json.load(open(path), parse_constant=refuse)
    elif form == "plot":
        assert xml.dom.minidom.parse(path).documentElement.tagName == "svg"
    else:
        rows = list(csv.reader(open(path, newline=""), strict=True))
        widths = {len(row) for row in rows}
        assert len(rows) > 1 and len(widths) == 1 and min(widths) > 1, "%d rows of %s columns" % (len(rows), sorted(widths))
        assert len(set(rows[0])) == len(rows[0]) and all(rows[0]), "a column without a name of its own"
for line in sys.stdin:
    form, path, words = line.rstrip("\n").split(" ", 2)
    try:
        check(form, path)
    except Exception as error:
        print("%s: %s" % (words, error))
END

"$FILES" . || exit 1
run "$HNBRDF" fit builtin:rough-clay builtin:velvet-crimson --steps 10 --pool 64 -o model.safetensors
[ "$rc" -eq 0 ] || { fail "no model to try with"; finish; }
printf 'wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0.6,0,0.8,0,0,1\n' >pairs.csv
printf 'camera from 0 0 4 to 0 0 0 fov 40\nsize 4 3\nenvironment sky\nmaterial a builtin rough-clay\nshape sphere material a\n' >small.scene
mkdir folder

# keep FORM WORDS...: the output, for forms.py.
count=0
keep() {
    form=$1
    shift
    [ "$rc" -eq 0 ] || fail "$*: exit $rc"
    count=$((count + 1))
    mv out "out.$count"
    echo "$form out.$count $*" >>kept
}
# row WORDS WHOLE ARGUMENTS: each option of its help that writes a text; of what takes its time, only tables.
row() {
    words=$1 options='csv|json|log|plot'
    arguments=$(echo " $3 " | sed 's/ --csv @ / /; s/ IN / model.safetensors /; s/@/output/; s/ --steps 2 / --steps 201 /')
    [ "$2" = whole ] || options='csv|json'
    [ "$words" != scene ] || arguments="$arguments --compare folder"
    for option in $("$HNBRDF" $words --help | sed -nE "s/^ *(-., )?--($options) FILE( .*)?\$/\\2/p"); do
        run "$HNBRDF" $words $arguments --$option -
        if [ "$words" = verify ] && [ "$rc" -ne 0 ] && [ ! -s out ]; then
            echo "verify: no device to try with"
            return
        fi
        keep "$option" "$words --$option -"
        rm -f output*
    done
}

while IFS='|' read -r words whole arguments <&3; do
    row "$words" "$whole" "$arguments"
done 3<<END
$(grep -v '^#' "$SOURCES/tests/command_lines.txt")
END
# The list of options is read from the help: that it found what is known to be there.
for known in fit:log fit:json fit:plot compare:csv compare:json scene:csv bake:json lobes:csv stability:csv bench:json; do
    grep -q " ${known%:*} --${known#*:} -\$" kept || fail "$known was not tried"
done

# Bytes: what a file gets, and the words elsewhere.
both="--pack half --weights uniform"
run "$HNBRDF" export model.safetensors $both --texels texels --weights-out weights-out -o out.glsl
expect_ok "export"
for option in texels weights-out; do
    other=texels
    [ "$option" = weights-out ] || other=weights-out
    run "$HNBRDF" export model.safetensors $both --$option - --$other other -o out.glsl
    [ "$rc" -eq 0 ] && cmp -s out $option && grep -q '^out.glsl: ' err || fail "export --$option -"
done
run "$HNBRDF" eval model.safetensors -m rough-clay -i pairs.csv -o -
keep csv "eval -o -"

python3 forms.py <kept >wrong || fail "forms.py"
while IFS= read -r line; do
    fail "$line"
done <wrong

finish
