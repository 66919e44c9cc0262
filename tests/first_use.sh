#!/bin/sh
# first_use.sh FOLDER [--all]: what somebody meets who has a bare Debian 12 and the README. Makes one in FOLDER
# (debootstrap; as root, needs the network and 4 GB), puts the last commit there, and does what the README says, word
# for word: the first command, then each snippet. Prints how long each takes, and when the first picture is there.
# --all runs the tests too (the second command, half an hour). What the README only names is made up: rgl/ and new.bsdf.
# first_use.sh --smoke: a clean copy and a bare environment on this machine: whether the copy has what the README links
# to, and whether it configures. Seconds; one of the tests.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
fail() {
    echo "first_use.sh: $*" >&2
    exit 1
}

# ---- In the bare system: first_use.sh --inside [--all] ----
# snippet LANGUAGE NUMBER: of the README.
snippet() {
    awk -v wanted="$1" -v number="$2" '/^```/ && !inside { inside = 1; mine = $0 == "```" wanted && ++count == number; next }
        /^```/ { inside = 0; mine = 0 } mine' README.md
}
timed() { # NAME COMMAND...
    name=$1
    shift
    begin=$(date +%s)
    "$@" > /tmp/step.log 2>&1 || { tail -n 30 /tmp/step.log && fail "$name: exit $?"; }
    printf '%6d s  %s\n' $(($(date +%s) - begin)) "$name"
}
# What `pkg-config --cflags --libs hnbrdf` gives suffices for the snippet in C, after `cmake --install`.
try_c() {
    { snippet c 1 | grep '^#'; echo 'int main(void) {'; snippet c 1 | grep -v '^#'; echo 'return 0; }'; } > /tmp/use.c
    # shellcheck disable=SC2046 # words
    cmake --install build && ldconfig && gcc /tmp/use.c $(pkg-config --cflags --libs hnbrdf) -o /tmp/use && /tmp/use
}
try_glsl() {
    build/hnbrdf export examples/models/rgl_32x2.safetensors --materials vch_silk_blue -o /tmp/scene.glsl
    { echo '#version 450'; snippet glsl 1 | grep '^#'
        echo 'layout(location = 0) in vec3 wi; layout(location = 1) in vec3 wo; layout(location = 2) in vec3 light;'
        echo 'layout(location = 0) out vec3 colour; void main() {'; snippet glsl 1 | grep -v '^#'; echo 'colour = radiance; }'; } > /tmp/use.frag
    glslangValidator -V -Ishaders -I/tmp /tmp/use.frag -o /tmp/use.spv
}
# The commands on one's own materials; a formula's table stands for measurements.
make_data() {
    gcc -std=c11 -Iinclude -DHNBRDF_STATIC tests/test_cli_files.c build/libhnbrdf_measured.a build/libhnbrdf.a -lm -o /tmp/files
    mkdir -p /tmp/data rgl && /tmp/files /tmp/data
    cp /tmp/data/lambert_rgb.bsdf rgl/vch_silk_blue.bsdf && cp /tmp/data/lambert_rgb.bsdf new.bsdf
}
inside() {
    cd "$source"
    begun=$(date +%s)
    line=$(snippet sh 1 | sed -n 1p)
    timed "$line" sh -c "$line"
    first=$(find out -name '*.png' -printf '%T@\n' | sort -n | sed -n '1s/\..*//p')
    echo "the first picture came after $((first - begun)) s"
    [ "$*" != --all ] || timed "$(snippet sh 1 | sed -n 2p)" sh -c "$(snippet sh 1 | sed -n 2p)"
    snippet sh 2 > /tmp/lines
    while IFS= read -r line; do timed "$line" sh -c "$line" < /dev/null; done < /tmp/lines
    PATH=$source/build:$PATH
    timed "the snippet in C" try_c
    timed "the snippet in GLSL" try_glsl
    timed "$(grep -o 'hnbrdf verify MODEL' README.md | sed -n 1p)" hnbrdf verify examples/models/rgl_32x2.safetensors
    make_data
    snippet sh 3 > /tmp/lines
    while IFS= read -r line; do timed "${line%%  *}" sh -c "$line" < /dev/null; done < /tmp/lines
    echo "done in $(($(date +%s) - begun)) s"
}

# ---- From outside ----
smoke() {
    command -v git > /dev/null && git -C "$source" rev-parse > /dev/null 2>&1 || { echo "skipped: no git here" && exit 77; }
    scratch=$(mktemp -d)
    trap 'rm -rf "$scratch"' EXIT
    git -C "$source" ls-files -z | (cd "$source" && xargs -0 tar -cf - --) | tar -xf - -C "$scratch"
    cd "$scratch"
    count=0
    for link in $(grep -o '](\([^)#:]*\)[)#]' README.md | sed 's/^](//; s/[)#]$//'); do
        count=$((count + 1))
        [ -e "$link" ] || fail "README.md links to $link, which is not there"
    done
    [ ! -e out ] && [ ! -e build ] || fail "out and build are in the repository: the README makes them"
    [ "$count" -gt 15 ] || fail "only $count links were found"
    for snippet in "sh 1" "sh 2" "sh 3" "c 1" "glsl 1"; do
        # shellcheck disable=SC2086 # two words
        [ -n "$(snippet $snippet)" ] || fail "the README has no snippet $snippet"
    done
    snippet sh 1 | sed 's/ *#.*//; s/^sh //' | while read -r script; do sh -n "$script" || fail "$script"; done
    line=$(snippet sh 2 | sed -n '1s/ &&.*//p')
    env -i HOME="$scratch" PATH=/usr/bin:/bin sh -c "$line" > log 2>&1 || { tail -n 20 log && fail "$line"; }
    [ -e build/CMakeCache.txt ] || fail "$line: makes no build/"
    echo "passed, $count links"
}
outside() {
    root=$1/root
    [ "$(id -u)" = 0 ] && command -v debootstrap > /dev/null || fail "run it as root, with debootstrap installed"
    [ ! -e "$root" ] || fail "$root: is there already; give a new folder"
    mkdir -p "$1"
    debootstrap --variant=minbase bookworm "$root" > "$1/debootstrap.log" || fail "debootstrap: see $1/debootstrap.log"
    cp /etc/resolv.conf "$root/etc/resolv.conf"
    for file in /etc/apt/apt.conf.d/*; do [ ! -f "$file" ] || cp "$file" "$root/etc/apt/apt.conf.d/"; done
    mkdir "$root/srv/hnbrdf"
    git -C "$source" archive HEAD | tar -xf - -C "$root/srv/hnbrdf"
    ! mount -t proc proc "$root/proc" 2> /dev/null || trap 'umount "$root/proc"' EXIT
    shift
    chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        sh /srv/hnbrdf/tests/first_use.sh --inside "$@"
}
case ${1:-} in
--inside) shift && inside "$@" ;;
--smoke) smoke ;;
-h | --help | "") sed -n '2,/^set /s/^# \{0,1\}//p' "$0" ;;
*) outside "$@" ;;
esac
