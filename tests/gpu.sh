#!/bin/sh
# gpu.sh: everything that a graphics card is asked, in at most six minutes and without a network: does the exported
# shader give what C gives (verify), how far from the truth (stability), how fast (bench, bench --growth, bake).
#
#   sh tests/gpu.sh OUT [DEVICE]      builds where there is no build/hnbrdf, then measures; CSVs and logs go to OUT
#   sh tests/gpu.sh --pack            for a machine without compilers: builds what is needed here, and puts it with its
#                                     libraries and the shader compiler into out/gpu-pack, some 35 MB, to go along
#
# DEVICE as `hnbrdf verify --list` counts (default: the first that is no software driver, else 0: a rehearsal).
# QUICK=1 is a try of half a minute. SECONDS_IN_ALL (default 345) is shared out; what does not fit is left out and said. OUT/summary.txt tells what
# came of each step, OUT/device.txt the machine. Exit status 0 if verify and stability hold and bench ran.
set -u
here=$(cd "$(dirname "$0")/.." && pwd)

packed=$here/out/gpu-pack
without="-DCMAKE_BUILD_TYPE=Release -DHNBRDF_BUILD_TESTS=OFF -DHNBRDF_BUILD_EXAMPLES=OFF -DHNBRDF_WITH_EMBREE=OFF
         -DHNBRDF_WITH_MPI=OFF -DHNBRDF_WITH_HDF5=OFF -DHNBRDF_WITH_EGL=OFF"

if [ "${1:-}" = --pack ]; then
    compiler=$(command -v glslangValidator) || { echo "no glslangValidator to pack" >&2; exit 1; }
    # shellcheck disable=SC2086 # words
    cmake -S "$here" -B "$here/build-gpu" $without >/dev/null && cmake --build "$here/build-gpu" -j "$(nproc)" --target hnbrdf_cli || exit 1
    rm -rf "$packed"
    mkdir -p "$packed/lib"
    cp "$here/build-gpu/hnbrdf" "$compiler" "$packed/"
    # All but the C library and the drivers, which must be that machine's own.
    for program in "$packed/hnbrdf" "$packed/glslangValidator"; do
        ldd "$program" | sed -n 's/.*=> \(\/[^ ]*\) .*/\1/p'
    done | sort -u | grep -v '/lib\(c\|m\|pthread\|dl\|rt\)\.so' | while read -r library; do
        cp -L "$library" "$packed/lib/"
    done
    du -sh "$packed"
    exit 0
fi

out=${1:?gpu.sh OUT [DEVICE]}
mkdir -p "$out"
out=$(cd "$out" && pwd)
started=$(date +%s)
all=${SECONDS_IN_ALL:-345}
status=0
left() { echo $((all - $(date +%s) + started)); }
say() { echo "$(($(date +%s) - started)) s: $*" | tee -a "$out/summary.txt"; }

# step NAME SECONDS COMMAND...: at most so long, and no longer than there is; output in OUT/NAME.txt.
step() {
    name=$1 most=$2
    shift 2
    [ "$most" -le "$(left)" ] || most=$(left)
    if [ "$most" -lt 5 ]; then
        say "$name: left out, the time is over"
        return 1
    fi
    timeout "$most" "$@" >"$out/$name.txt" 2>"$out/$name.err"
    rc=$?
    case $rc in
    0) say "$name: good" ;;
    124) say "$name: stopped after $most s" ;;
    *) say "$name: exit $rc, $(tail -n 1 "$out/$name.err")" ;;
    esac
    return $rc
}

: >"$out/summary.txt"
{
    uname -a
    nvidia-smi || true
    ls /usr/share/vulkan/icd.d /etc/vulkan/icd.d || true
    ldconfig -p | grep -i 'vulkan\|GLX_nvidia\|EGL' || true
} >"$out/machine.txt" 2>&1

# ---- a program
hnbrdf=$here/build/hnbrdf
if [ -n "${HNBRDF_PROGRAM:-}" ]; then
    hnbrdf=$HNBRDF_PROGRAM
elif [ -x "$packed/hnbrdf" ]; then
    hnbrdf=$packed/hnbrdf
    LD_LIBRARY_PATH=$packed/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
    PATH=$packed:$PATH
    export LD_LIBRARY_PATH PATH
elif [ ! -x "$hnbrdf" ]; then
    # shellcheck disable=SC2086 # words
    step configure 30 cmake -S "$here" -B "$here/build" $without
    step build 150 cmake --build "$here/build" -j "$(nproc)" --target hnbrdf_cli
fi
"$hnbrdf" --version >>"$out/machine.txt" 2>&1 || { say "no program: $hnbrdf"; exit 1; }
"$hnbrdf" verify --list >"$out/device.txt" 2>&1
device=${2:-$(sed -n 's/^vulkan \([0-9]*\): .*/\1 &/p' "$out/device.txt" | grep -v ', cpu,' | head -n 1 | cut -d' ' -f1)}
device=${device:-0}
grep -q "^vulkan $device:" "$out/device.txt" || { say "no Vulkan device $device: see machine.txt"; exit 1; }
say "device $(grep "^vulkan $device:" "$out/device.txt")"

# ---- what it is asked, the most important first; the shipped model and, of it, what is small enough
model=$here/examples/models/rgl_32x2.safetensors
m=vch_silk_blue,chm_mint
pairs=4096 rounds='--rounds 6' blocks=4
[ "${QUICK:-0}" = 0 ] || { pairs=256 rounds='--quick' blocks=1; }
step verify 60 "$hnbrdf" verify "$model" -m $m -d "$device" --pairs $pairs --csv "$out/verify.csv" || status=1
# shellcheck disable=SC2086 # words
step bench 90 "$hnbrdf" bench "$model" -d "$device" $rounds --csv "$out/bench.csv" --json "$out/bench.json" || status=1
step stability 60 "$hnbrdf" stability "$model" -d "$device" --blocks $blocks --csv "$out/stability.csv" || status=1
[ "${QUICK:-0}" = 0 ] || { say "done; exit $status"; exit $status; }
step verify_half 30 "$hnbrdf" verify "$model" -m vch_silk_blue --precision half -d "$device" --pairs 2048 \
    --csv "$out/verify_half.csv"
step verify_fragment 30 "$hnbrdf" verify "$model" -m vch_silk_blue --stage fragment -d "$device" --pairs 2048 \
    --csv "$out/verify_fragment.csv"
step growth 60 "$hnbrdf" bench --growth --quick -d "$device" --csv "$out/growth.csv"
step bake 45 "$hnbrdf" bake "$model" -m vch_silk_blue --net 8x2 --steps 2000 --restarts 1 -d "$device" \
    --csv "$out/bake.csv" -o "$out/bake.safetensors"
say "done, $(left) s left; exit $status"
exit $status
