#!/bin/sh
# test_exports.sh SOURCE LIBHNBRDF.so LIBHNBRDF.a OTHER.so...: what the libraries need and what they show.
set -eu
source=$1 shared=$2 archive=$3
shift 3

fail() {
    echo "test_exports: $*" >&2
    exit 1
}

# libhnbrdf needs the C library and libm, nothing else.
for need in $(objdump -p "$shared" | sed -n 's/ *NEEDED *//p'); do
    case $need in
    libc.so.* | libm.so.* | ld-linux*.so.* | libc.musl-*.so.*) ;;
    *) fail "$shared needs $need" ;;
    esac
done

# Every library shows exactly what its header declares.
declared() {
    sed 's|/\*.*\*/||' "$source/include/hnbrdf/$1.h" | tr '\n' ' ' | grep -o 'HNBRDF_API [^;(]*(' |
        grep -o 'hnbrdf_[a-z0-9_]*($' | tr -d '(' | sort
}
for library in "$shared" "$@"; do
    header=$(basename "$library" .so | sed 's/^lib//; s/^hnbrdf_//')
    shown=$(nm -D --defined-only "$library" | awk '{ print $3 }' | sed 's/@.*//' | sort)
    expected=$(declared "$header")
    [ -n "$expected" ] || fail "no declarations found in $header.h"
    [ "$shown" = "$expected" ] || {
        echo "$shown" > "$library.shown"
        echo "$expected" | diff - "$library.shown" >&2 || true
        rm -f "$library.shown"
        fail "$library does not show what $header.h declares (<: declared, >: shown)"
    }
done

# Evaluation is pure: src/core may call these and nothing else (the last two lines: compiler and hardening).
allowed=' cos sin sincos sqrtf memcpy memset vsnprintf
 __stack_chk_fail __memcpy_chk __memset_chk __vsnprintf_chk _GLOBAL_OFFSET_TABLE_ '
own=$(nm "$archive" 2> /dev/null | awk '$2 ~ /^[TRDB]$/ { print $3 }')
core=$(cd "$source/src/core" && ls ./*.c | sed 's|^\./||; s|\.c$|.c.o|')
for object in $core; do
    for symbol in $(nm -A -u "$archive" 2> /dev/null | sed -n "s|.*:$object: *[Uw] ||p"); do
        case "$allowed $own " in
        *[[:space:]]"$symbol"[[:space:]]*) ;;
        *) fail "src/core/$object uses $symbol" ;;
        esac
    done
    ar t "$archive" | grep -qx "$object" || fail "$archive has no $object"
done

# The rest of libhnbrdf reads and writes files, but never prints, ends the program, or starts threads.
for symbol in $(nm -u "$archive" 2> /dev/null | awk 'NF == 2 { print $2 }'); do
    case $symbol in
    printf | puts | putchar | putc | vprintf | perror | stdout | stderr | exit | _exit | _Exit | quick_exit | \
        abort | __assert_fail | setlocale | pthread_* | thrd_* | mtx_* | __printf_chk | system | signal | strtod | \
        strtof | atof | getenv)
        fail "$archive uses $symbol" ;;
    esac
done
