#!/bin/sh
# test_exports.sh SOURCE BUILD PART...: what the libraries in BUILD need and what they show.
set -eu
source=$1 build=$2
shift 2

fail() {
    echo "test_exports: $*" >&2
    exit 1
}

# libhnbrdf needs the C library and libm, nothing else.
for need in $(objdump -p "$build/libhnbrdf.so" | sed -n 's/ *NEEDED *//p'); do
    case $need in
    libc.so.* | libm.so.* | ld-linux*.so.* | libc.musl-*.so.*) ;;
    *) fail "libhnbrdf.so needs $need" ;;
    esac
done

# Every shared library shows exactly what its header declares; no symbol of a static one can collide.
declared() {
    sed 's|/\*.*\*/||' "$source/include/hnbrdf/$1.h" | tr '\n' ' ' | grep -o 'HNBRDF_API [^;(]*(' |
        grep -o 'hnbrdf_[a-z0-9_]*($' | tr -d '(' | sort
}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for part in "$@"; do
    header=${part#hnbrdf_}
    nm -D --defined-only "$build/lib$part.so" | awk '{ print $3 }' | sed 's/@.*//' | sort > "$scratch/shown"
    declared "$header" > "$scratch/declared"
    [ -s "$scratch/declared" ] || fail "no declarations found in $header.h"
    diff "$scratch/declared" "$scratch/shown" >&2 ||
        fail "lib$part.so does not show what $header.h declares (<: declared, >: shown)"
    foreign=$(nm --defined-only -g "$build/lib$part.a" | awk 'NF == 3 { print $3 }' | grep -v '^hnbrdf_' || true)
    [ -z "$foreign" ] || fail "lib$part.a has global symbols without the prefix hnbrdf_:" $foreign
done

# Evaluation is pure: src/core may call these and nothing else (second line: compiler and hardening).
archive=$build/libhnbrdf.a
# __cpu_model and __cpu_indicator_init are what __builtin_cpu_supports() asks.
allowed=' cos sin sincos atan2 sqrtf memcpy memmove memset vsnprintf __cpu_model __cpu_indicator_init
 __stack_chk_fail __memcpy_chk __memset_chk __vsnprintf_chk _GLOBAL_OFFSET_TABLE_ '
for path in "$source"/src/core/*.c; do
    object=$(basename "$path").o
    case $object in
    kernel_plain.c.o) ;;
    kernel_*) ar t "$archive" | grep -qx "$object" || continue ;; # another machine's
    esac
    ar t "$archive" | grep -qx "$object" || fail "libhnbrdf.a has no $object"
    for symbol in $(nm -A -u "$archive" 2> /dev/null | sed -n "s|.*:$object: *[Uw] ||p"); do
        case "$allowed" in
        *[[:space:]]"$symbol"[[:space:]]*) ;;
        *) [ "${symbol#hnbrdf_}" != "$symbol" ] || fail "src/core/$object uses $symbol" ;;
        esac
    done
done

# The rest of libhnbrdf reads and writes files, but never prints, ends the program, starts threads, or does
# what depends on the locale.
for symbol in $(nm -u "$archive" 2> /dev/null | awk 'NF == 2 { print $2 }'); do
    case $symbol in
    printf | puts | putchar | putc | vprintf | perror | stdout | stderr | exit | _exit | _Exit | quick_exit | \
        abort | __assert_fail | setlocale | pthread_* | thrd_* | mtx_* | __printf_chk | system | signal | strtod | \
        strtof | atof)
        fail "libhnbrdf.a uses $symbol" ;;
    esac
done
# The environment is read in one place, for HNBRDF_VARIANT.
for object in $(nm -A -u "$archive" 2> /dev/null | sed -n 's|.*:\([^:]*\): *[Uw] getenv$|\1|p'); do
    [ "$object" = choose_kernel.c.o ] || fail "$object reads the environment"
done
