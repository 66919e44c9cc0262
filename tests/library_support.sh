# library_support.sh: to be sourced by tests that build the library again, for another machine, by another
# compiler or with a sanitizer, and run plain programs on it. They set $source, $scratch (a directory) and $name.

fail() {
    echo "$name: $*" >&2
    exit 1
}
skip() {
    echo "skipped: $*"
    exit 77
}

# library TARGET cmake-arguments...: builds TARGET alone, nothing but the libraries configured, into
# $scratch/build; what was printed is shown on failure.
library() {
    target=$1
    shift
    rm -rf "$scratch"
    mkdir -p "$scratch/work"
    {
        cmake -S "$source" -B "$scratch/build" -DHNBRDF_WERROR=ON -DHNBRDF_BUILD_CLI=OFF -DHNBRDF_BUILD_TESTS=OFF \
            -DHNBRDF_BUILD_EXAMPLES=OFF -DHNBRDF_WITH_OPENEXR=OFF -DHNBRDF_WITH_VULKAN=OFF "$@" &&
            cmake --build "$scratch/build" --target "$target" -j 2
    } > "$scratch/log" 2>&1 || {
        cat "$scratch/log"
        fail "building $target"
    }
}

# program NAME COMPILER flags... : NAME.c and what it uses from tests/, linked with what library() built.
program() {
    program=$1
    shift
    libraries="$scratch/build/libhnbrdf.a"
    [ ! -f "$scratch/build/libhnbrdf_measured.a" ] || libraries="$scratch/build/libhnbrdf_measured.a $libraries"
    # shellcheck disable=SC2086 # $libraries is words
    "$@" -std=c11 -D_POSIX_C_SOURCE=200809L -DHNBRDF_STATIC -ffp-contract=off -I"$source/include" -I"$source/src" \
        -I"$source/tests" "$source/tests/$program.c" "$source/tests/variants_sweep.c" $libraries -lm -lpthread \
        -o "$scratch/$program" > "$scratch/log" 2>&1 || {
        cat "$scratch/log"
        fail "compiling $program.c"
    }
}
