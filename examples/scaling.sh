#!/bin/sh
# scaling.sh DATA OUT [HNBRDF]: how a fit gets faster with processes on this machine, and what many more of them
# would exchange. Needs mpirun. OUT/scaling.csv: strong scaling (the same fit) and weak scaling (as many pairs a step
# for each process), one thread a process, the least of three runs in turn; OUT/paper.csv: 10, 100 and 1,000 processes
# on paper. Times mean something on a quiet machine only.
set -eu
[ $# -ge 2 ] || {
    echo "usage: sh $0 DATA OUT [HNBRDF]" >&2
    exit 2
}
data=$1 out=$2 hnbrdf=${3:-build/hnbrdf}
steps=${STEPS:-2000} # of a fit; HxN and pairs a material are the defaults
mkdir -p "$out"
options=""
mpirun --version | grep -q 'Open MPI' && options="--oversubscribe --bind-to none"
[ "$(id -u)" != 0 ] || options="$options --allow-run-as-root"

counts=1
while [ "$((${counts##* } * 2))" -le "$(getconf _NPROCESSORS_ONLN)" ]; do
    counts="$counts $((${counts##* } * 2))"
done

# run KIND RANKS BATCH: a line of the table.
run() {
    if [ "$2" = 1 ]; then
        set -- "$1" "$2" "$3" "$hnbrdf"
    else
        # shellcheck disable=SC2086 # words
        set -- "$1" "$2" "$3" mpirun $options -n "$2" "$hnbrdf"
    fi
    kind=$1 ranks=$2 batch=$3
    shift 3
    "$@" fit "$data" --steps "$steps" --batch "$batch" --threads 1 --json "$out/run.json" -o "$out/run.safetensors" \
        > "$out/run.log" 2>&1 || {
        cat "$out/run.log" >&2
        exit 1
    }
    printf '%s,%s,%s,%s,%s\n' "$kind" "$ranks" "$batch" \
        "$(sed -n 's/.*"seconds": \([0-9.]*\),.*/\1/p' "$out/run.json")" \
        "$(cksum < "$out/run.safetensors" | tr ' ' -)" >> "$out/runs.csv"
}

: > "$out/runs.csv"
for round in 1 2 3; do
    echo "round $round of 3" >&2
    for count in $counts; do
        run strong "$count" 2048
        [ "$count" = 1 ] || run weak "$count" $((2048 * count))
    done
done

# The least time of each; a model's sum shows that strong scaling changes no bit.
awk -F, '
    { key = $1 "," $2 "," $3 }
    !(key in least) || $4 < least[key] { least[key] = $4 }
    $1 == "strong" { if (sum == "") sum = $5; if ($5 != sum) { print "models differ" > "/dev/stderr"; bad = 1 } }
    !(key in seen) { seen[key] = 1; order[++n] = key }
    END {
        print "scaling,processes,pairs_a_step,seconds,times_faster"
        for (i = 1; i <= n; i++) {
            split(order[i], part, ",")
            work = part[1] == "weak" ? part[2] : 1
            printf "%s,%.3f,%.2f\n", order[i], least[order[i]], work * least["strong,1,2048"] / least[order[i]]
        }
        exit bad
    }' "$out/runs.csv" > "$out/scaling.csv"
cat "$out/scaling.csv"
"$hnbrdf" bench --scaling --csv "$out/paper.csv"
cat "$out/paper.csv"
