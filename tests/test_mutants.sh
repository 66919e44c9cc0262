#!/bin/sh
# test_mutants.sh MUTANTS.SH ROOT CC: mutants.sh finds planted changes of a small file, tells noticed
# ones from survivors and explained ones, and leaves the tree alone.
set -u
mutants=$1 root=$2 cc=$3
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

fail() {
    echo "test_mutants: $*" >&2
    exit 1
}

# ---- What is changed and what is left alone ------------------------------------------------------

mkdir -p "$work/tree/tests" "$work/tree/src" || exit 1
cp "$mutants" "$root/tests/mutate.c" "$root/tests/mutants_tests.txt" "$work/tree/tests/" || exit 1
touch "$work/tree/CMakeLists.txt" "$work/tree/README.md" "$work/tree/LICENSE" "$work/tree/.clang-format"
for folder in include shaders examples; do mkdir "$work/tree/$folder"; done
cat > "$work/tree/src/add.c" <<'END'
/* 1 + 2 in a comment, and // a - b */
#define TWICE(x) ((x) * 2)
#include <assert.h>
struct pair { int a[2]; };
int limit(const int *x, int n)
{
    int sum = 0, room[4];
    assert(n > 0 && x != 0);
    for (int i = 0; i < n; i++)
        sum += x[i];
    room[3] = sum; // i * 2
    if (room[3] >= 10)
        return 10;
    return "1 < 2"[0] ? room[3] : -1;
}
END
cat > "$work/expected" <<'END'
src/add.c:7: 0 -> (0 + 1): int sum = 0, room[4];
src/add.c:9: 0 -> (0 + 1): for (int i = 0; i < n; i++)
src/add.c:9: < -> <=: for (int i = 0; i < n; i++)
src/add.c:9: < -> >=: for (int i = 0; i < n; i++)
src/add.c:10: sum += x[i] -> (dropped): sum += x[i];
src/add.c:10: += -> -=: sum += x[i];
src/add.c:11: room[3] = sum -> (dropped): room[3] = sum; // i * 2
src/add.c:11: 3 -> (3 + 1): room[3] = sum; // i * 2
src/add.c:12: 3 -> (3 + 1): if (room[3] >= 10)
src/add.c:12: >= -> >: if (room[3] >= 10)
src/add.c:12: 10 -> (10 + 1): if (room[3] >= 10)
src/add.c:13: 10 -> (10 + 1): return 10;
src/add.c:14: 0 -> (0 + 1): return "1 < 2"[0] ? room[3] : -1;
src/add.c:14: 3 -> (3 + 1): return "1 < 2"[0] ? room[3] : -1;
src/add.c:14: - -> +: return "1 < 2"[0] ? room[3] : -1;
src/add.c:14: 1 -> (1 + 1): return "1 < 2"[0] ? room[3] : -1;
END
export CC="$cc"
sh "$work/tree/tests/mutants.sh" --list "$work/tree/src/add.c" > "$work/listed" || fail "--list failed"
cmp -s "$work/listed" "$work/expected" ||
    { diff "$work/expected" "$work/listed"; fail "other mutants than expected"; }
sh "$work/tree/tests/mutants.sh" --list --count 4 --seed 7 "$work/tree/src/add.c" > "$work/some"
[ "$(wc -l < "$work/some")" -eq 4 ] || fail "--count 4 does not list four"
sh "$work/tree/tests/mutants.sh" --list --count 4 --seed 7 "$work/tree/src/add.c" |
    cmp -s - "$work/some" || fail "the same seed chooses others"

# ---- Noticed, survived, explained ----------------------------------------------------------------

cat > "$work/tree/tests/main.c" <<'END'
int limit(const int *x, int n);
int main(void)
{
    const int x[4] = {1, 2, 3, 100};
    return !(limit(x, 3) == 6 && limit(x, 4) == 10 && limit(x + 3, 1) == 10);
}
END
build="$cc -fsanitize=bounds -fsanitize-undefined-trap-on-error tests/main.c src/add.c -o t"
run() {
    sh "$work/tree/tests/mutants.sh" --results "$work/results" --build "$build" --test ./t src/add.c > "$work/report" 2>&1
}
cd "$work/tree" || exit 1
cp src/add.c "$work/before"
run && fail "survivors, but the exit status is 0"
cat > "$work/survivors" <<'END'
src/add.c:12: >= -> >: if (room[3] >= 10)
src/add.c:12: 10 -> (10 + 1): if (room[3] >= 10)
src/add.c:14: 0 -> (0 + 1): return "1 < 2"[0] ? room[3] : -1;
src/add.c:14: - -> +: return "1 < 2"[0] ? room[3] : -1;
src/add.c:14: 1 -> (1 + 1): return "1 < 2"[0] ? room[3] : -1;
END
sed '1,/^survivors:/d' "$work/report" | cmp -s - "$work/survivors" ||
    { cat "$work/report"; fail "other survivors than expected"; }
grep -q '^all  *16  *11  *68.8%$' "$work/report" || { cat "$work/report"; fail "wrong share"; }
cmp -s src/add.c "$work/before" || fail "the tree was changed"

awk -F': ' '{ printf "src/add.c\t%s\t", $2; sub(/^[^:]*:[^:]*: [^:]*: /, ""); printf "%s\tplanted\n", $0 }' \
    "$work/survivors" > tests/mutants_accepted.txt
run || { cat "$work/report"; fail "explained survivors, but the exit status is not 0"; }
grep -q ' 5 are explained' "$work/report" || { cat "$work/report"; fail "explained ones not counted"; }

# A tree whose tests fail already says nothing about mutants.
sh tests/mutants.sh --build "$build" --test false src/add.c > "$work/report" 2>&1
[ $? -eq 2 ] || { cat "$work/report"; fail "a failing unchanged tree is not an error"; }

# ---- Many changes in one build behave as each alone ----------------------------------------------

$cc -std=c11 -O1 tests/mutate.c -o mutate || fail "mutate.c does not compile"
cp "$root/tests/mutant.h" tests/ || exit 1
cat > tests/choose.c <<'END'
#include <stdlib.h>
int hnbrdf_mutant = -1;
__attribute__((constructor)) static void choose(void)
{
    const char *text = getenv("HNBRDF_MUTANT");
    if (text)
        hnbrdf_mutant = atoi(text);
}
END
seq 0 15 | sed 's/.*/& &/' | ./mutate switch 0 src/add.c > src/switched.c 2> apart
$cc -fsanitize=bounds -fsanitize-undefined-trap-on-error -include tests/mutant.h tests/main.c \
    src/switched.c tests/choose.c -o t || fail "the switched file does not compile"
./t || fail "nothing is switched, but the values are others"
switched=0
for number in $(seq 0 15); do
    ! grep -qx "$number" apart || continue
    verdict=survived
    HNBRDF_MUTANT=$number ./t 2> /dev/null || verdict=noticed
    grep -q "^$verdict.*	src/add.c	$number	" "$work/results" ||
        fail "change $number is $verdict when switched, otherwise alone"
    switched=$((switched + 1))
done
[ "$switched" -ge 12 ] || fail "only $switched of 16 changes could be switched"

# ---- Every planted change of a file of the core is noticed ---------------------------------------

cd "$root" || exit 1
sh "$mutants" --count 4 --build "$cc -std=c11 -O1 -Isrc -Iinclude tests/test_half.c -lcmocka -lm -o t" \
    --test ./t src/core/half.h > "$work/report" 2>&1 || { cat "$work/report"; fail "half.h has survivors"; }
echo "test_mutants: passed"
