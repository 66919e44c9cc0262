# test_cli_commands.sh: every command of the table is in `hnbrdf --help`, explains itself with
# examples that start with its name, and refuses wrong options in the same words.
set -u
. "$(dirname "$0")/test_cli_support.sh"
SOURCES=$3

# The table itself: ROW(name, "what it does").
sed -n 's/^ *ROW(\([a-z]*\), "\(.*\)").*/\1 \2/p' "$SOURCES/src/cli/commands.h" >commands
[ "$(wc -l <commands)" -ge 18 ] || fail "fewer commands than there were: $(wc -l <commands)"

run "$HNBRDF" --help
[ "$rc" = 0 ] && [ ! -s err ] || fail "hnbrdf --help"
sed -n '/^commands:$/,/^$/s/^  \([a-z]*\)  *\(.*\)/\1 \2/p' out >listed
cmp -s commands listed || fail "hnbrdf --help does not list the commands of commands.h"

while read -r name about; do
    [ -f "$SOURCES/src/cli/cmd_$name.c" ] || fail "$name: no cmd_$name.c"
    run "$HNBRDF" "$name" --help
    [ "$rc" = 0 ] && [ ! -s err ] || fail "$name --help: exit $rc"
    cp out help
    grep -q "^usage: hnbrdf $name " help || fail "$name --help has no usage line"
    grep -q '^options:$' help || fail "$name --help has no options"
    sed -n '/^examples:$/,$p' help | grep -q "^  .*hnbrdf $name " || fail "$name --help has no example"
    awk 'length > 120' help | grep . && fail "$name --help has a line that is too long"
    run "$HNBRDF" help "$name"
    cmp -s out help || fail "help $name and $name --help differ"

    # Wrong options: exit 2, one line that says what, one that says where help is.
    run "$HNBRDF" "$name" --no-such-option
    [ "$rc" = 2 ] && [ ! -s out ] || fail "$name --no-such-option: exit $rc"
    grep -q "^hnbrdf $name: unknown option --no-such-option" err || fail "$name --no-such-option"
    grep -q "^try: hnbrdf $name --help$" err || fail "$name: no hint"
    [ "$(wc -l <err)" = 2 ] || fail "$name --no-such-option: more than two lines"
    # Every option that takes a value asks for it.
    for option in $(sed -n 's/^  *\(-., \)\{0,1\}--\([a-z-]*\) [A-Za-z].*/\2/p' help); do
        run "$HNBRDF" "$name" "--$option"
        [ "$rc" = 2 ] || fail "$name --$option without its value: exit $rc"
        grep -q "^hnbrdf $name: --$option needs a value: --$option " err || fail "$name --$option: no message"
    done
done <commands

# A slip of the keys is understood, as a command and as the word of an option.
run "$HNBRDF" comapre
[ "$rc" = 2 ] && grep -q "did you mean 'compare'" err || fail "comapre"
run "$HNBRDF" fit builtin -o x --schedule cosin
[ "$rc" = 2 ] || fail "--schedule cosin: exit $rc"
grep -q "^hnbrdf fit: --schedule: found 'cosin', expected cosine, linear or constant (did you mean cosine?)$" err ||
    fail "--schedule cosin"
run "$HNBRDF" compare a b --sampler nothing
grep -q "^hnbrdf compare: --sampler: found 'nothing', expected uniform, cosine or grid$" err || fail "--sampler nothing"
for net in 32 32x 32x0 0x2 65x2 32x2x 32,2 x; do
    run "$HNBRDF" fit builtin -o x --net "$net"
    [ "$rc" = 2 ] && grep -q "is not HxN, as in 32x2" err || fail "--net $net"
done

finish
