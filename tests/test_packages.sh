#!/bin/sh
# test_packages.sh BUILD SOURCE SCRATCH MODEL: every way to have the library, one row each: installed
# (CMake package, pkg-config), in a folder (subproject, FetchContent), as one file, as Debian packages and as a
# .tar.gz made by cpack. In all of them a small program prints the same bits, and hnbrdf_add_shader() the same
# shaders, of MODEL and then of an edit of it. Debian packages: no error of lintian. Exit 77: no cc or no cmake.
set -eu
build=$1 source=$2 scratch=$3 model=$4
here=$source/tests/packaged
unset CFLAGS CXXFLAGS LDFLAGS LD_LIBRARY_PATH PKG_CONFIG_PATH || true

fail() {
    echo "test_packages: $*" >&2
    exit 1
}
logged() {
    "$@" > "$scratch/log" 2>&1 || { cat "$scratch/log" >&2; fail "$*"; }
}
row() {
    printf '%-14s %-30s %s\n' "$1" "$2" "$3"
}
command -v cc > /dev/null || { echo "skipped: no cc"; exit 77; }
rm -rf "$scratch"
mkdir -p "$scratch"
generator=""
! command -v ninja > /dev/null || generator="-G Ninja"
command=$build/hnbrdf

# What all have to say.
"$command" export "$model" -o "$scratch/model.glsl" > /dev/null
first=$("$command" info "$model" --without-physics | sed -n '/^material /{n;s/ .*//p;q;}')
other=$scratch/other.safetensors
"$command" edit "$model" --material "$first" --set alpha=0.3 -o "$other" > /dev/null
"$command" export "$other" -o "$scratch/other.glsl" > /dev/null
same() { # WAY PROGRAM WHAT...
    "$2" "$model" > "$scratch/found" || fail "$1: $2 fails"
    [ -e "$scratch/expected" ] || cp "$scratch/found" "$scratch/expected"
    cmp -s "$scratch/expected" "$scratch/found" || fail "$1: not the bits of the others"
    row "$1" "$3" "the same bits"
}

# project WAY NAME cmake-arguments...: the CMake project, its program and its shaders.
project() {
    way=$1 name=$2
    shift 2
    folder=$scratch/$name
    mkdir -p "$folder"
    cp "$model" "$folder/scene.safetensors"
    # shellcheck disable=SC2086 # words
    logged cmake $generator -S "$here" -B "$folder" -DWAY="$way" -DMODEL=scene.safetensors -DCMAKE_C_FLAGS=-O0 "$@"
    logged cmake --build "$folder" -j 2
    cmp -s "$scratch/model.glsl" "$folder/consumer.glsl" || fail "$name: consumer.glsl is not what export writes"
    cp "$other" "$folder/scene.safetensors" # another model, another shader; and none where nothing changed
    logged cmake --build "$folder"
    cmp -s "$scratch/other.glsl" "$folder/consumer.glsl" || fail "$name: the shader is not made anew"
    touch -r "$folder/consumer.glsl" "$scratch/time"
    logged cmake --build "$folder"
    [ ! "$folder/consumer.glsl" -nt "$scratch/time" ] || fail "$name: the shader is made again"
    same "$name" "$folder/consumer" "shader made, made anew"
}

prefix=$scratch/prefix
logged cmake --install "$build" --prefix "$prefix"
project package "CMake package" -DCMAKE_PREFIX_PATH="$prefix" -DMATERIALS="$first"
folder="$scratch/CMake package"
grep -q 'scene_eval' "$folder/shaders/scene.hlsl" || fail "the options of hnbrdf_add_shader() do not arrive"
grep -q "consumer.glsl;.*shaders/scene.hlsl" "$folder/shaders.txt" || fail "HNBRDF_SHADERS: $(cat "$folder/shaders.txt")"
# A material that is not there fails the build with the command's own message, and leaves no file.
cmake -DMATERIALS=nobody "$folder" > "$scratch/log" 2>&1
rm -f "$folder/shaders/scene.hlsl"
! cmake --build "$folder" > "$scratch/log" 2>&1 || fail "a material that is not there is taken"
grep -q "nobody" "$scratch/log" || fail "the missing material is not named"
[ ! -e "$folder/shaders/scene.hlsl" ] || fail "a shader is left of a failed export"
# No command: said when the project is configured.
mv "$prefix/bin/hnbrdf" "$prefix/bin/elsewhere"
! PATH=$(dirname "$(command -v cmake)"):/nowhere cmake -S "$here" -B "$scratch/none" -DWAY=package -DMODEL=x \
    -DCMAKE_PREFIX_PATH="$prefix" > "$scratch/log" 2>&1 || [ -x /usr/bin/hnbrdf ] || fail "no command, and no word of it"
[ -x /usr/bin/hnbrdf ] || grep -q 'HNBRDF_COMMAND' "$scratch/log" || { cat "$scratch/log"; fail "no command: not said"; }
mv "$prefix/bin/elsewhere" "$prefix/bin/hnbrdf"

# What a release would be: an archive with one folder.
ln -s "$source" "$scratch/hnbrdf-source"
tar -chzf "$scratch/source.tar.gz" -C "$scratch" hnbrdf-source/CMakeLists.txt hnbrdf-source/LICENSE \
    hnbrdf-source/include hnbrdf-source/shaders hnbrdf-source/src
without="-DHNBRDF_BUILD_FIT=OFF -DHNBRDF_WITH_VARIANTS=OFF"
# shellcheck disable=SC2086 # words
{
    project subproject subproject -DSUBPROJECT="$source" $without -DHNBRDF_COMMAND="$command"
    project FetchContent FetchContent -DSUBPROJECT="$scratch/source.tar.gz" $without -DHNBRDF_COMMAND="$command"
}

pc=$(dirname "$(find "$prefix" -name hnbrdf.pc)")
if command -v pkg-config > /dev/null; then
    # shellcheck disable=SC2046 # flags are words
    logged cc -std=c99 "$here/consumer.c" $(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs hnbrdf) \
        "-Wl,-rpath,$(PKG_CONFIG_PATH=$pc pkg-config --variable=libdir hnbrdf)" -o "$scratch/pc"
    same pkg-config "$scratch/pc" "one line"
else
    row pkg-config "skipped" "no pkg-config"
fi
if [ -e "$build/amalgamation/hnbrdf.c" ]; then
    logged cc -std=c99 -DONE_FILE -DHNBRDF_NO_VARIANTS -I"$build/amalgamation" "$here/consumer.c" \
        "$build/amalgamation/hnbrdf.c" -lm -o "$scratch/one"
    same amalgamation "$scratch/one" "one line"
fi

# What cpack makes.
archives=TGZ
! command -v dpkg-deb > /dev/null || archives="TGZ;DEB"
logged cpack --config "$build/CPackConfig.cmake" -G "$archives" -B "$scratch/packed"
mkdir -p "$scratch/tgz"
tar -xzf "$scratch"/packed/hnbrdf-*.tar.gz -C "$scratch/tgz" --strip-components 1
project package "tar.gz" -DCMAKE_PREFIX_PATH="$scratch/tgz"
if [ "$archives" = TGZ ]; then
    row .deb "skipped" "no dpkg-deb"
else
    for package in "$scratch"/packed/*.deb; do
        logged dpkg-deb -x "$package" "$scratch/root"
    done
    [ "$(find "$scratch/packed" -maxdepth 1 -name '*.deb' | wc -l)" = 3 ] || fail "not three Debian packages"
    for package in "$scratch"/packed/*.deb; do
        dpkg-deb -c "$package" | awk '$1 !~ /^d/ { print $6 }'
    done | sort | uniq -d > "$scratch/log"
    [ ! -s "$scratch/log" ] || fail "two Debian packages hold $(cat "$scratch/log")"
    project package ".deb" -DCMAKE_PREFIX_PATH="$scratch/root/usr" -DHNBRDF_USE_STATIC_LIBS=OFF
    objdump -p "$scratch/root/usr/lib/"*/libhnbrdf.so "$scratch/root/usr/lib/libhnbrdf.so" 2> /dev/null |
        grep -q RUNPATH && fail ".deb: libhnbrdf.so has a RUNPATH"
    if command -v lintian > /dev/null; then
        lintian --fail-on error --tag-display-limit 0 "$scratch"/packed/*.deb > "$scratch/log" 2>&1 ||
            { grep '^E:' "$scratch/log" >&2; fail "errors of lintian"; }
        row lintian "$(grep -c '^W:' "$scratch/log" || true) warnings" "no error"
    else
        row lintian "skipped" "not installed"
    fi
fi
rm -rf "$scratch"
