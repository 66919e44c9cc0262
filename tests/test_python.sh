#!/bin/sh
# test_python.sh SOURCE BUILD COMPILER: examples/python over the shared libraries of BUILD: its layouts, enums and
# functions are those of the headers, its results those of C, and its examples run. Skipped without NumPy.
set -u
source=$1 build=$2 compiler=$3
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
failures=0
fail() {
    echo "test_python: $*" >&2
    failures=$((failures + 1))
}

python=
for name in python3 /usr/bin/python3; do
    if $name -c 'import numpy' 2> /dev/null; then python=$name && break; fi
done
[ -n "$python" ] || { echo "skipped: no Python with NumPy (package python3-numpy)"; exit 77; }
export PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$source/examples/python" HNBRDF_LIBRARY_PATH="$build"

# ---- The layouts, as assertions in C. One field less, and one value moved, must be noticed. ----
compile() { "$compiler" -std=c11 -fsyntax-only -I"$source/include" -x c "$1" > "$scratch/log" 2>&1; }
$python "$source/tests/test_python_layouts.py" "$source/include" > "$scratch/layouts.c" || fail "functions: see above"
[ "$(grep -c '^_Static_assert' "$scratch/layouts.c")" -gt 200 ] || fail "few layouts are compared"
compile "$scratch/layouts.c" || fail "layouts: $(grep -m 3 error: "$scratch/log")"
for change in 's/sizeof(hnbrdf_fit_options) == /&1 + /' 's/offsetof(hnbrdf_material, latent) == /&4 + /' \
    's/== HNBRDF_LOBES_FIT/!= HNBRDF_LOBES_FIT/'; do
    sed "$change" "$scratch/layouts.c" > "$scratch/wrong.c"
    ! cmp -s "$scratch/layouts.c" "$scratch/wrong.c" || fail "$change changes nothing"
    ! compile "$scratch/wrong.c" || fail "$change is not noticed"
done

# ---- Results and errors ----
$python "$source/tests/test_python.py" "$source" "$scratch" || fail "results: see above"

# ---- Where the libraries are ----
(cd "$scratch" && HNBRDF_LIBRARY_PATH=$scratch $python -c 'import hnbrdf; hnbrdf.material()') 2> "$scratch/log"
tail -n 1 "$scratch/log" | grep -q "^ImportError: libhnbrdf.* is not in $scratch: set HNBRDF_LIBRARY_PATH" ||
    fail "a folder without libraries: $(tail -n 1 "$scratch/log")"

# ---- The examples ----
$python "$source/examples/python/numpy_network.py" "$scratch/pruned.safetensors" > "$scratch/out" || fail "numpy_network.py"
# Within 1e-6 of f, or of 1 where f is less: sums of 22 products of numbers about 1, rounded to 2^-24.
awk '/differ by/ { seen = $NF <= 1e-6 } END { exit !seen }' "$scratch/out" || fail "numpy_network.py: $(cat "$scratch/out")"
[ -s "$scratch/pruned.safetensors" ] || fail "numpy_network.py writes no model"
if $python -c 'import torch' 2> /dev/null; then
    $python "$source/examples/python/torch_network.py" "$scratch/trained.safetensors" > "$scratch/out" || fail "torch_network.py"
    awk '/differ by/ { seen = $NF <= 1e-6 } END { exit !seen }' "$scratch/out" || fail "torch_network.py: $(cat "$scratch/out")"
else
    echo "torch_network.py: skipped without PyTorch (package python3-torch)"
fi
! find "$source/examples/python" -name __pycache__ | grep -q . || fail "Python leaves files in the source"
[ "$failures" -eq 0 ] || exit 1
echo passed
