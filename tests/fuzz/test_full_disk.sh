#!/bin/sh
# test_full_disk.sh HNBRDF FILES: when the disk is full each command says so in one line, exits with 1, leaves the
# old file as it was and nothing beside it. Full means: a limit on the size of files, and, where mounting is
# allowed, a small tmpfs.
set -u
# shellcheck source=../test_cli_support.sh
. "$(dirname "$0")/../test_cli_support.sh"
"$FILES" . || exit 1
awk 'BEGIN { for (k = 0; k < 2000; k++) print "0,0,1,0.6,0,0.8" }' >pairs.csv
mkdir disk
reference=$PWD

# limited COMMAND...: files may grow to one block of 512 bytes. The signal for that is ignored, as the kernel
# does not send it when a disk is full.
limited() {
    sh -c 'trap "" XFSZ; ulimit -f 1; exec "$@"' limited "$@" </dev/null >/dev/null 2>err
    rc=$?
    : >out
}

# full: every command that writes a file, run by $how, into ./disk.
full() {
    for name in model.safetensors scene.glsl values.csv picture.png; do
        case $name in
        model.safetensors) set -- import "$reference/a.brdf" "$reference/b.brdf" ;;
        scene.glsl) set -- export "$reference/hybrid.safetensors" ;;
        values.csv) set -- eval "builtin:velvet-crimson" -i "$reference/pairs.csv" ;;
        picture.png) set -- render builtin:velvet-crimson --size 64 --spp 1 ;;
        esac
        printf 'old\n' >"disk/$name"
        $how "$HNBRDF" "$@" -o "disk/$name"
        expect_failure "$how: $name" "$name"
        [ "$(cat "disk/$name")" = old ] || fail "$how: $name: the old file is spoilt"
        rm -f "disk/$name"
        [ -z "$(ls disk)" ] || fail "$how: $name: left behind: $(ls disk)"
    done
}

how=limited
full

# In a mount namespace of its own, which ends with the shell.
if unshare -m true 2>/dev/null; then
    cat >in_tmpfs.sh <<'END'
mount -t tmpfs -o size=4k none disk || exit 77
exec "$@"
END
    crowded() {
        # The one page there is holds the old file.
        unshare -m sh in_tmpfs.sh sh -c 'printf "old\n" > "disk/$0"; "$@" 2> err.tmpfs; rc=$?
            [ "$(cat "disk/$0")" = old ] && [ "$(ls disk)" = "$0" ] || rc=50; exit $rc' "$name" "$@" >/dev/null 2>&1
        rc=$?
        cp err.tmpfs err 2>/dev/null
        : >out
    }
    if unshare -m sh in_tmpfs.sh true 2>/dev/null; then
        how=crowded
        full
    else
        echo "skipped: mounting a tmpfs is not allowed here"
    fi
else
    echo "skipped: a tmpfs needs a mount namespace, which is not to be had here"
fi
finish
