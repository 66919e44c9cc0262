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

# headers PART: those that declare it; libhnbrdf has all that no other part has.
headers() {
    [ "$1" = hnbrdf ] || { echo "${1#hnbrdf_}"; return; }
    for header in "$source"/include/hnbrdf/*.h; do
        name=$(basename "$header" .h)
        case " $parts " in *" hnbrdf_$name "*) ;; *) echo "$name" ;; esac
    done
}
# Every shared library shows exactly what its headers declare; no symbol of a static one can collide.
declared() {
    for name in $(headers "$1"); do
        sed 's|/\*.*\*/||; /^ *# *define/d' "$source/include/hnbrdf/$name.h"
    done | tr '\n' ' ' | grep -oE 'HNBRDF_(API|EXPERIMENTAL) [^;(]*\(' |
        grep -o 'hnbrdf_[a-z0-9_]*($' | tr -d '(' | sort -u
}
parts=$*
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
for part in "$@"; do
    nm -D --defined-only "$build/lib$part.so" | awk '{ print $3 }' | sed 's/@.*//' | sort > "$scratch/shown"
    declared "$part" > "$scratch/declared"
    [ -s "$scratch/declared" ] || fail "no declarations of $part found"
    diff "$scratch/declared" "$scratch/shown" >&2 ||
        fail "lib$part.so does not show what its headers declare (<: declared, >: shown)"
    foreign=$(nm --defined-only -g "$build/lib$part.a" | awk 'NF == 3 { print $3 }' | grep -v '^hnbrdf_' || true)
    [ -z "$foreign" ] || fail "lib$part.a has global symbols without the prefix hnbrdf_:" $foreign
done

# Evaluation is pure: src/core may call these and nothing else (second line: compiler and hardening).
archive=$build/libhnbrdf.a
# __cpu_model and __cpu_indicator_init are what __builtin_cpu_supports() asks.
allowed=' cos sin sincos atan2 sqrtf memcpy memmove memset strcmp strcpy snprintf vsnprintf __cpu_model __cpu_indicator_init
 __stack_chk_fail __memcpy_chk __memset_chk __strcpy_chk __snprintf_chk __vsnprintf_chk _GLOBAL_OFFSET_TABLE_ '
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

# No part prints, ends the program, catches or raises signals, leaves by a jump, changes rounding, or
# does what depends on the locale; only the trainer starts threads. And none keeps anything that can be written to
# from one call to the next: what is not constant belongs to the caller.
for part in "$@"; do
    archive=$build/lib$part.a
    for symbol in $(nm -u "$archive" 2> /dev/null | awk 'NF == 2 { print $2 }'); do
        case $symbol in
        printf | fprintf | puts | fputs | putchar | putc | fputc | vprintf | vfprintf | perror | stdin | stdout | \
            stderr | __printf_chk | __fprintf_chk | __vfprintf_chk | exit | _exit | _Exit | quick_exit | atexit | \
            on_exit | abort | __assert_fail | system | signal | __sysv_signal | sigaction | sigprocmask | sigaltstack | \
            raise | kill | setjmp | _setjmp | __sigsetjmp | longjmp | siglongjmp | \
            fesetround | fesetenv | feholdexcept | feenableexcept | setlocale | uselocale | newlocale | localeconv | \
            strtod | strtof | strtold | atof | strcoll | toupper | tolower | __ctype_* | sscanf | __isoc99_sscanf | \
            getenv | secure_getenv | environ | rand | srand | random | strtok | localtime | gmtime)
            fail "lib$part.a uses $symbol" ;;
        pthread_* | thrd_* | mtx_*)
            [ "$part" = hnbrdf_fit ] || fail "lib$part.a uses $symbol" ;;
        esac
    done
    # Tables of pointers in .data.rel.ro are constant; the linker alone writes them.
    written=$(objdump -t "$archive" | awk '/[ \t](\.(data|bss|tdata|tbss)[^ \t]*|\*COM\*)\t/ && !/\.data\.rel\.ro/ &&
        $NF !~ /^\./ { print $NF }')
    [ -z "$written" ] || fail "lib$part.a keeps what can be written to:" $written
done
# errno is looked at where a file is written, to say why it cannot be.
for part in "$@"; do
    for object in $(nm -A -u "$build/lib$part.a" 2> /dev/null | sed -n 's|.*:\([^:]*\): *[Uw] __errno\(_location\)*$|\1|p'); do
        case $object in
        files.c.o | files_*.c.o) ;;
        *) fail "$object looks at errno" ;;
        esac
    done
done
# What src/base gives to several parts is in one archive, so that static ones link together.
twice=$(for part in "$@"; do ar t "$build/lib$part.a"; done | sort | uniq -d |
    while read -r object; do [ ! -e "$source/src/base/${object%.o}" ] || echo "$object"; done)
[ -z "$twice" ] || fail "in several archives:" $twice
