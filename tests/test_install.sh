#!/bin/sh
# test_install.sh BUILD SOURCE SCRATCH: installs BUILD into SCRATCH, moves it, and builds and runs C and C++
# consumers against it: find_package and pkg-config, static and shared. Exit 77: nothing to test with.
set -eu
build=$1 source=$2 scratch=$3
consumer=$source/tests/consumer
unset CFLAGS CXXFLAGS LDFLAGS LD_LIBRARY_PATH PKG_CONFIG_PATH || true

fail() {
    echo "test_install: $*" >&2
    exit 1
}
for tool in cc c++ pkg-config; do
    command -v $tool > /dev/null || { echo "skipped: no $tool"; exit 77; }
done

rm -rf "$scratch"
cmake --install "$build" --prefix "$scratch/first" > "$scratch.log" || { cat "$scratch.log"; fail "install"; }
mv "$scratch/first" "$scratch/prefix" # nothing installed may remember where it was put
prefix=$scratch/prefix
for file in include/hnbrdf/hnbrdf.h share/hnbrdf/hybrid_brdf.glsl bin/hnbrdf share/man/man1/hnbrdf-fit.1 \
    share/bash-completion/completions/hnbrdf; do
    [ -e "$prefix/$file" ] || fail "$file was not installed"
done
! grep -rlF -e "$source" -e "$build" "$prefix/include" "$prefix/share" > "$scratch.log" ||
    fail "names the build machine: $(cat "$scratch.log")"
"$prefix/bin/hnbrdf" --help > /dev/null || fail "the installed command does not run"

# find_package, every target; the plain names static and shared.
for static in ON OFF; do
    out=$scratch/cmake-$static
    cmake -S "$consumer" -B "$out" -DCMAKE_PREFIX_PATH="$prefix" -DHNBRDF_USE_STATIC_LIBS=$static \
        -DCMAKE_BUILD_TYPE=Release > "$scratch.log" 2>&1 &&
        cmake --build "$out" >> "$scratch.log" 2>&1 || { cat "$scratch.log"; fail "find_package consumer"; }
    for program in c_static c_shared cxx_static cxx_shared fit_static fit_shared bake_static bake_shared \
        c_default fit_default bake_default; do
        "$out/$program" || fail "find_package: $program fails"
    done
    needs=$(objdump -p "$out/c_default" | sed -n 's/ *NEEDED *//p')
    case $static-$needs in
    ON-*libhnbrdf*) fail "hnbrdf::hnbrdf is shared although HNBRDF_USE_STATIC_LIBS is ON" ;;
    ON-* | OFF-*libhnbrdf*) ;;
    *) fail "hnbrdf::hnbrdf is static although HNBRDF_USE_STATIC_LIBS is OFF" ;;
    esac
done
# The examples, as a project of their own.
{
    cmake -S "$source/examples" -B "$scratch/examples" -DCMAKE_PREFIX_PATH="$prefix" -DHNBRDF_USE_STATIC_LIBS=OFF &&
        cmake --build "$scratch/examples"
} > "$scratch.log" 2>&1 || { cat "$scratch.log"; fail "the examples against the installed library"; }
# A version from the future must be refused.
mkdir -p "$scratch/future"
printf 'cmake_minimum_required(VERSION 3.18)\nproject(f C)\nfind_package(hnbrdf 1.0 REQUIRED CONFIG)\n' \
    > "$scratch/future/CMakeLists.txt"
! cmake -S "$scratch/future" -B "$scratch/future/b" -DCMAKE_PREFIX_PATH="$prefix" > "$scratch.log" 2>&1 ||
    fail "version 1.0 was found"

# pkg-config, shared and static.
pc=$(dirname "$(find "$prefix" -name hnbrdf.pc)")
export PKG_CONFIG_PATH="$pc"
libraries=$(pkg-config --variable=libdir hnbrdf)
[ -e "$(pkg-config --variable=shaderdir hnbrdf)/hybrid_brdf.glsl" ] || fail "shaderdir holds no hybrid_brdf.glsl"
# shellcheck disable=SC2046 # flags are words
{
    cc -std=c99 "$consumer/evaluate.c" $(pkg-config --cflags --libs hnbrdf) -o "$scratch/pc_c"
    c++ -std=c++11 "$consumer/evaluate.cpp" $(pkg-config --cflags --libs hnbrdf) -o "$scratch/pc_cxx"
    cc -std=c99 "$consumer/fit.c" $(pkg-config --cflags --libs hnbrdf_fit hnbrdf_metrics) -o "$scratch/pc_fit"
    cc -std=c99 "$consumer/bake.c" $(pkg-config --cflags --libs hnbrdf_bake) -o "$scratch/pc_bake"
    cc -std=c99 -static "$consumer/evaluate.c" $(pkg-config --static --cflags --libs hnbrdf) -o "$scratch/pc_c_static"
    c++ -std=c++11 -static "$consumer/evaluate.cpp" $(pkg-config --static --cflags --libs hnbrdf) \
        -o "$scratch/pc_cxx_static"
    cc -std=c99 -static "$consumer/fit.c" $(pkg-config --static --cflags --libs hnbrdf_fit hnbrdf_metrics) \
        -o "$scratch/pc_fit_static"
    cc -std=c99 -static "$consumer/bake.c" $(pkg-config --static --cflags --libs hnbrdf_bake) -o "$scratch/pc_bake_static"
}
for program in pc_c pc_cxx pc_fit pc_bake; do
    LD_LIBRARY_PATH=$libraries "$scratch/$program" || fail "pkg-config: $program fails"
done
for program in pc_c_static pc_cxx_static pc_fit_static pc_bake_static; do
    "$scratch/$program" || fail "pkg-config: $program fails"
done
rm -rf "$scratch" "$scratch.log"
