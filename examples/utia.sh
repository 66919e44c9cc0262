#!/bin/sh
# utia.sh: what the grid of UTIA files (15 and 7.5 degrees) does to a fit. Materials from formulas are written as UTIA
# files; those, and networks fitted to them, are compared with the formulas. Writes a Markdown table. Needs python3.
#
#   sh examples/utia.sh [NAME...] > table.md     built-in materials; the anisotropic ones by default
#
# STEPS (default 16000) sets how long each network is trained, PAIRS (default 20000) how many pairs a material the
# files are compared with, KEEP a folder for the files and models (default: none is kept).
set -eu
hnbrdf=${HNBRDF:-$(dirname "$0")/../build/hnbrdf}
steps=${STEPS:-16000} pairs=${PAIRS:-20000}
# shellcheck disable=SC2046 # one word a material
[ $# -gt 0 ] || set -- $("$hnbrdf" info builtin:anisotropic | awk 'NR > 1 { print $1 }')
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
folder=${KEEP:-$work/kept}
mkdir -p "$folder/utia"

cat > "$work/utia.py" << 'END'
"""utia.py nodes | draw SAMPLER N | pack | smape TRUTH: pairs of directions, UTIA's table of doubles, the error."""
import math, random, struct, sys
def direction(theta, phi):
    return (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))
def write(wi, wo):
    print(",".join("%.9g" % x for x in (*wi, *wo)))
def values(file):
    next(file)
    return [[float(x) for x in line.split(",")] for line in file]
def uniform():
    z, phi = random.uniform(0.01, 1), random.uniform(0, 2 * math.pi)
    return direction(math.acos(z), phi)
def turned(w, theta, phi):
    x, z = math.cos(theta) * w[0] + math.sin(theta) * w[2], math.cos(theta) * w[2] - math.sin(theta) * w[0]
    return (math.cos(phi) * x - math.sin(phi) * w[1], math.sin(phi) * x + math.cos(phi) * w[1], z)
def grid():
    """MERL's own grid: theta_h = u^2 pi/2, all else uniform."""
    while True:
        theta, phi = random.random() ** 2 * math.pi / 2, random.uniform(0, 2 * math.pi)
        d = direction(random.uniform(0, math.pi / 2), random.uniform(0, 2 * math.pi))
        wi, wo = turned(d, theta, phi), turned((-d[0], -d[1], d[2]), theta, phi)
        if min(wi[2], wo[2]) >= 0.01:
            return wi, wo
if sys.argv[1] == "nodes":
    all = [direction(math.radians(15 * t), math.radians(7.5 * p)) for t in range(6) for p in range(48)]
    for wi in all:
        for wo in all:
            write(wi, wo)
elif sys.argv[1] == "draw":
    random.seed(1)
    for _ in range(int(sys.argv[3])):
        write(*(grid() if sys.argv[2] == "grid" else (uniform(), uniform())))
elif sys.argv[1] == "pack":
    table = values(sys.stdin)
    for c in range(3):
        sys.stdout.buffer.write(struct.pack("<%dd" % len(table), *(f[c] for f in table)))
else:
    sum, n = 0.0, 0
    for f, g in zip(values(open(sys.argv[2])), values(sys.stdin)):
        for a, b in zip(f, g):
            sum += 2 * abs(a - b) / (a + b) if a != b else 0.0
            n += 1
    print("%.4f" % (sum / n))
END

python3 "$work/utia.py" nodes > "$work/nodes.csv"
for sampler in grid uniform; do
    python3 "$work/utia.py" draw $sampler "$pairs" > "$work/$sampler.csv"
done
data=
for name in "$@"; do
    data="$data builtin:$name"
    "$hnbrdf" eval "builtin:$name" -i "$work/nodes.csv" | python3 "$work/utia.py" pack > "$folder/utia/$name.bin"
    for sampler in grid uniform; do
        "$hnbrdf" eval "builtin:$name" -i "$work/$sampler.csv" > "$work/truth.csv"
        "$hnbrdf" eval "$folder/utia/$name.bin" --utia raw -i "$work/$sampler.csv" |
            python3 "$work/utia.py" smape "$work/truth.csv" > "$work/$name.table.$sampler"
    done
done

# measure MODEL PREFIX: SMAPE of each material of a model against the formulas, and PSNR.
measure() {
    for sampler in grid uniform; do
        # shellcheck disable=SC2086 # one word a material
        "$hnbrdf" compare "$folder/$1.safetensors" $data --sampler $sampler --csv "$work/$1.$sampler" > /dev/null
    done
    # shellcheck disable=SC2086 # one word a material
    "$hnbrdf" sheet "$folder/$1.safetensors" $data --size 64 -o "$work/sheet.png" |
        awk '/PSNR/ { reading = 1; next } reading && NF >= 5 { print $1 "," $NF }' > "$work/$1.psnr"
}
# shellcheck disable=SC2086 # one word a material
"$hnbrdf" fit $data --steps "$steps" -o "$folder/formula.safetensors" > "$work/log"
"$hnbrdf" fit "$folder/utia" --utia raw --steps "$steps" -o "$folder/file.safetensors" > "$work/log"
measure formula
measure file

of() {
    awk -F, -v name="$1" -v column="$3" '$1 == name { print $column }' "$2"
}
cat << END
| material | the file: grid, uniform | fitted to the file: grid, uniform, PSNR | fitted to the formula |
|---|---|---|---|
END
for name in "$@"; do
    echo "$name $(cat "$work/$name.table.grid" "$work/$name.table.uniform" | tr '\n' ' ')" \
        "$(for model in file formula; do of "$name" "$work/$model.grid" 2; of "$name" "$work/$model.uniform" 2
           of "$name" "$work/$model.psnr" 2; done | tr '\n' ' ')"
done | awk '{ printf "| %s | %.3f, %.3f | %.3f, %.3f, %.1f dB | %.3f, %.3f, %.1f dB |\n",
                     $1, $2, $3, $4, $5, $6, $7, $8, $9
              for (k = 2; k <= 9; k++) sum[k] += $k }
     END { printf "| mean | %.3f, %.3f | %.3f, %.3f, %.1f dB | %.3f, %.3f, %.1f dB |\n", sum[2] / NR, sum[3] / NR,
                  sum[4] / NR, sum[5] / NR, sum[6] / NR, sum[7] / NR, sum[8] / NR, sum[9] / NR }'
