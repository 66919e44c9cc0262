#!/bin/sh
# test_guest.sh SOURCE SCRATCH PLAIN MODEL: the library inside another project (tests/guest), with all
# that such a project may hand down: flags that allow wrong arithmetic, unity builds, headers and targets
# called like ours. The values keep the bits of PLAIN (fast_math.c as it was built here), the
# parent keeps everything of its own, and what is installed is found again. Exit 77: no gcc and no clang.
set -eu
source=$1 scratch=$2 plain=$3 model=$4
unset CFLAGS LDFLAGS LD_LIBRARY_PATH PKG_CONFIG_PATH || true

fail() {
    echo "test_guest: $*" >&2
    exit 1
}
rm -rf "$scratch"
mkdir -p "$scratch/an app"
work="$scratch/an app" # a folder with a space
ln -s "$source" "$work/hnbrdf" # the folder is called like the command
"$plain" "$model" > "$work/expected"
make=""
command -v ninja > /dev/null && make=Ninja

# parent FOLDER cmake-arguments...: configures tests/guest.
parent() {
    folder=$work/$1
    shift
    cmake ${make:+-G "$make"} -S "$source/tests/guest" -B "$folder" -DSUBPROJECT="$work/hnbrdf" "$@" \
        > "$work/log" 2>&1 || { cat "$work/log"; fail "configuring with $*"; }
}
# compile FOLDER targets...
compile() {
    folder=$work/$1
    shift
    cmake --build "$folder" -j 2 --target "$@" > "$work/log" 2>&1 ||
        { grep -E -A 6 'error|warning|undefined' "$work/log" || cat "$work/log"; fail "building $*"; }
}
# values FOLDER WHAT: the programs of the parent say what they should.
values() {
    "$work/$1/parent" "$model" "$work/broken.safetensors" > "$work/log" || {
        cat "$work/log"
        fail "$2"
    }
    "$work/$1/bits" "$model" > "$work/found"
    cmp -s "$work/expected" "$work/found" || fail "$2: other bits"
    echo "$2: $(wc -l < "$work/found") lines, the same bits"
}

# 1. Everything bad at once, by gcc and by clang; -O0.
built=""
wrong="-Ofast -ffast-math -ffinite-math-only -funsafe-math-optimizations -march=native"
for compiler in gcc clang; do
    command -v $compiler > /dev/null || continue
    case $compiler in
    gcc) flags="$wrong -fsingle-precision-constant -flto=2" variants=ON ;;
    *) flags=$wrong variants=OFF ;;
    esac
    parent $compiler -DCMAKE_C_COMPILER=$compiler -DCMAKE_C_FLAGS="$flags" -DHNBRDF_BUILD_FIT=OFF \
        -DHNBRDF_WITH_VARIANTS=$variants "-DPARENT_OPTIONS=-ffast-math;-ffinite-math-only"
    compile $compiler parent bits hnbrdf_shared
    values $compiler "$compiler $flags"
    # Linked with -ffast-math, a library would flush subnormals in the whole process.
    ! nm "$work/$compiler/hnbrdf/libhnbrdf.so" | grep -q set_fast_math ||
        fail "$compiler: libhnbrdf.so sets the flushing of subnormals"
    built=$compiler
done
[ -n "$built" ] || { echo "skipped: no gcc and no clang"; exit 77; }

# 2. Shared, from FetchContent, without optimisation; installed into folders given absolutely.
parent shared -DCMAKE_C_FLAGS=-O0 -DBUILD_SHARED_LIBS=ON -DAS=FetchContent -DHNBRDF_BUILD_FIT=OFF \
    -DHNBRDF_WITH_VARIANTS=OFF -DHNBRDF_INSTALL=ON -DCMAKE_INSTALL_PREFIX="$work/pre fix" \
    -DCMAKE_INSTALL_LIBDIR="$work/abs lib" -DCMAKE_INSTALL_INCLUDEDIR="$work/abs include"
compile shared all
values shared "shared, -O0"
install_and_use() {
    lib=$1 prefix=$2
    cmake --install "$work/shared" > "$work/log" || { cat "$work/log"; fail "installing to $lib"; }
    mkdir -p "$work/use"
    cat > "$work/use/CMakeLists.txt" << 'C'
cmake_minimum_required(VERSION 3.25)
project(use C)
find_package(hnbrdf REQUIRED CONFIG COMPONENTS ${PARTS})
if(NOT EXISTS "${hnbrdf_SHADER_DIR}/hybrid_brdf.glsl")
  message(FATAL_ERROR "hnbrdf_SHADER_DIR is '${hnbrdf_SHADER_DIR}'")
endif()
add_executable(use "${CONSUMER}/evaluate.c")
target_link_libraries(use hnbrdf::hnbrdf_static)
C
    rm -rf "$work/use/b"
    cmake ${make:+-G "$make"} -S "$work/use" -B "$work/use/b" -Dhnbrdf_DIR="$lib/cmake/hnbrdf" \
        -DCONSUMER="$source/tests/consumer" > "$work/log" 2>&1 && cmake --build "$work/use/b" >> "$work/log" 2>&1 &&
        "$work/use/b/use" || { cat "$work/log"; fail "find_package: $lib"; }
    # A part that was not built is named.
    rm -rf "$work/use/b"
    ! cmake ${make:+-G "$make"} -S "$work/use" -B "$work/use/b" -Dhnbrdf_DIR="$lib/cmake/hnbrdf" -DPARTS=fit \
        > "$work/log" 2>&1 || fail "find_package finds a part that was not built"
    tr -s '\n ' ' ' < "$work/log" | grep -q 'asked for fit; this hnbrdf was built with hnbrdf alone' ||
        { cat "$work/log"; fail "find_package does not name the part that was not built"; }
    command -v pkg-config > /dev/null || return 0
    flags=$(PKG_CONFIG_PATH="$lib/pkgconfig" pkg-config --static --cflags --libs hnbrdf)
    eval "cc '$source/tests/consumer/evaluate.c' $flags -Wl,-rpath,'$lib' -o '$work/pc'" && "$work/pc" ||
        fail "pkg-config: $flags"
    shaders=$(PKG_CONFIG_PATH="$lib/pkgconfig" pkg-config --variable=shaderdir hnbrdf | sed 's/\\//g')
    [ -e "$shaders/hybrid_brdf.glsl" ] || fail "pkg-config: shaderdir is $shaders"
}
install_and_use "$work/abs lib" "$work/pre fix"
[ -e "$work/abs include/hnbrdf/hnbrdf.h" ] || fail "CMAKE_INSTALL_INCLUDEDIR is not heeded"
rm -rf "$work/abs lib" "$work/abs include" "$work/pre fix"
parent shared -DCMAKE_INSTALL_LIBDIR=lib/deep/er -DCMAKE_INSTALL_INCLUDEDIR=include
compile shared all
cmake --install "$work/shared" --prefix "$work/first" > "$work/log"
mv "$work/first" "$work/moved here"
install_and_use "$work/pre fix/lib/deep/er" "$work/pre fix"
rm -rf "$work/pre fix"
flags=$(PKG_CONFIG_PATH="$work/moved here/lib/deep/er/pkgconfig" pkg-config --cflags --libs hnbrdf 2> /dev/null) ||
    flags=none
[ "$flags" = none ] || eval "cc '$source/tests/consumer/evaluate.c' $flags -o '$work/pc'" ||
    fail "pkg-config after moving: $flags"

# 3. Everything asked for: all targets have our name, and programs stay in our folder.
if [ -e "$(dirname "$plain")/test_math" ]; then
    for generator in "Ninja Multi-Config" "Unix Makefiles"; do
        case $generator in Ninja*) command -v ninja > /dev/null || continue ;; esac
        make=$generator
        parent all -DHNBRDF_BUILD_CLI=ON -DHNBRDF_BUILD_TESTS=ON -DHNBRDF_BUILD_EXAMPLES=ON
        cat "$work"/all/programs-*.txt > "$work/programs"
        grep -q '/hnbrdf$' "$work/programs" || fail "$generator: no command"
        ! grep -v "^$work/all/hnbrdf/" "$work/programs" || fail "$generator: programs outside our folder"
        ! sort "$work/programs" | uniq -d | grep . || fail "$generator: two programs of one name"
        rm -rf "$work/all"
    done
    make=""
    parent none -DBUILD_TESTING=OFF -DHNBRDF_BUILD_CLI=ON -DHNBRDF_BUILD_TESTS=ON
    [ "$(ctest --test-dir "$work/none/hnbrdf" -N 2> /dev/null | sed -n 's/^Total Tests: //p')" = 0 ] ||
        fail "BUILD_TESTING=OFF is not obeyed"
fi
rm -rf "$scratch"
