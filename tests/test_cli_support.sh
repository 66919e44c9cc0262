# test_cli_support.sh: what the tests of the command line share. Sourced after `set -u` with
# HNBRDF (the command) and FILES (the program that writes files to read) as arguments 1 and 2.
HNBRDF=$1
FILES=$2
LC_ALL=C
export LC_ALL
SCRATCH=$(mktemp -d) || exit 1
trap 'rm -rf "$SCRATCH"' EXIT
trap 'exit 1' HUP INT TERM
cd "$SCRATCH" || exit 1
failures=0

# fail TEXT: counts a failure and shows the last command's output.
fail() {
    failures=$((failures + 1))
    echo "FAILED: $*"
    [ ! -s out ] || sed 's/^/  stdout: /;5q' out
    [ ! -s err ] || sed 's/^/  stderr: /;20q' err
}

# run COMMAND...: leaves out, err and rc; stdin is empty unless the caller redirects it into `run_in`.
run() {
    "$@" </dev/null >out 2>err
    rc=$?
}
# run_in TEXT COMMAND...: TEXT is printf's format, fed to stdin.
run_in() {
    input=$1
    shift
    printf "$input" | "$@" >out 2>err
    rc=$?
}

# expect_ok NAME: the last command ended well and said nothing on stderr.
expect_ok() {
    [ "$rc" -eq 0 ] && [ ! -s err ] || fail "$1: exit $rc, expected 0 and nothing on stderr"
}
# expect_usage NAME TEXT: wrong usage: exit 2, a message with TEXT, nothing on stdout.
expect_usage() {
    [ "$rc" -eq 2 ] && [ ! -s out ] && grep -q -e "$2" err || fail "$1: exit $rc, expected 2 and '$2'"
}
# expect_failure NAME TEXT: exit 1 and exactly one line on stderr beside warnings, with TEXT.
expect_failure() {
    [ "$rc" -eq 1 ] && [ "$(grep -vc '^hnbrdf: warning: ' err)" -eq 1 ] && grep -q -e "$2" err ||
        fail "$1: exit $rc, expected 1 and one line with '$2'"
}
# expect_out NAME TEXT: stdout is TEXT, printf's format.
expect_out() {
    printf "$2" >expected
    cmp -s out expected || fail "$1: stdout differs, expected: $(head -c 300 expected)"
}

finish() {
    [ "$failures" -eq 0 ] || { echo "$failures failures"; exit 1; }
    echo "passed"
    exit 0
}
