#!/bin/sh
# test_gpu_script.sh HNBRDF FILES: the quick form of gpu.sh, on whatever Vulkan device there is.
set -u
. "$(dirname "$0")/test_cli_support.sh"
script=$(dirname "$0")/gpu.sh
ASAN_OPTIONS=detect_leaks=0 # the Vulkan driver is unloaded before leaks are looked for
HNBRDF_PROGRAM=$HNBRDF
export ASAN_OPTIONS HNBRDF_PROGRAM
"$HNBRDF" verify --list >devices 2>&1
grep -q '^vulkan 0:' devices && command -v glslangValidator >/dev/null || { echo "no Vulkan device or compiler"; exit 77; }

QUICK=1 sh "$script" out_gpu 0 >out 2>err || fail "gpu.sh: exit $?"
for step in verify bench stability; do
    grep -q "s: $step: good" out_gpu/summary.txt || fail "$step: $(cat out_gpu/summary.txt)"
    [ "$(wc -l <"out_gpu/$step.csv")" -gt 2 ] || fail "no rows in $step.csv"
done
grep -q '^vulkan 0:' out_gpu/device.txt || fail "the device is not told"
QUICK=1 SECONDS_IN_ALL=3 sh "$script" out_late 0 >out 2>err && fail "without time, and yet exit 0"
grep -q 'left out, the time is over\|stopped after' out_late/summary.txt || fail "what was left out is not told"
sh "$script" out_none 63 >out 2>err && fail "no such device, and yet exit 0"
grep -q 'no Vulkan device 63' out || fail "a device that is not there"

finish
