#!/bin/sh
# test_pages.sh HNBRDF FILES SOURCES BUILD COMPILER: every snippet of every page, word for word. Commands run in a folder
# with the files that pages name, shortened as example_support.sh says; C compiles, and runs where it is a whole; shaders
# compile; Python runs. What cannot be tried here is in a list below with the reason; a language that is in none fails.
set -u
. "$(dirname "$0")/test_cli_support.sh"
SOURCES=$3 BUILD=$4 CC=$5
. "$SOURCES/tests/example_support.sh"

# LANGUAGE|REASON
cat >untried <<'END'
cmake|lines of a project that has the package installed; test_install and test_guest build such projects
cpp|MSL; no compiler for Metal is here, test_language_run runs such a text as C++
js|WGSL and pages; test_web* show them in a browser
ts|likewise
html|likewise
END

# One snippet a file, snippets/NUMBER.LANGUAGE; its page and line in snippets/NUMBER.at.
mkdir snippets
(cd "$SOURCES" && { ls README.md src/README.md tests/README.md && find examples -name '*.md' -not -path '*/node_modules/*' | sort; }) >pages
while read -r page; do
    awk -v page="$page" -v made="$(find snippets -name '*.at' | wc -l)" '
        /^ *```/ && !inside {
            inside = 1; indent = index($0, "`") - 1; language = substr($0, indent + 4)
            name = sprintf("snippets/%03d", ++made); print page ":" FNR > (name ".at"); close(name ".at")
            if (language == "") language = "none"
            next
        }
        /^ *```/ { inside = 0; close(name "." language); next }
        inside { print substr($0, indent + 1) > (name "." language) }' "$SOURCES/$page"
done <pages
[ "$(find snippets -name '*.at' | wc -l)" -gt 25 ] || fail "few snippets were found"

# ---- One language each: try_LANGUAGE FILE, in the folder `here` ----
# Where a page says MAP, the reader puts what he has.
try_sh() {
    sed -e 's/\bMAP\b/studio.hdr/' -e 's#build/hnbrdf#hnbrdf#' \
        -e ':a' -e '/\\$/N; s/\\\n *//; ta' "$1" >lines
    while IFS= read -r line <&3; do try_example "$line"; done 3<lines
}

# A snippet with #include is a whole: statements go into main(). Others are of a renderer that has these.
try_c() {
    grep '^#include' "$1" >whole.c && whole=1 || whole=0
    [ $whole -eq 1 ] || cat >whole.c <<'END'
#include <hnbrdf/hnbrdf.h>
static hnbrdf_model *model;
static const hnbrdf_material *material;
static float wi[3], wo[3], u[2], throughput[3], light[3], radiance[3], by_light;
END
    echo '#include <stdio.h>' >>whole.c
    how=-fsyntax-only
    if grep -q '^static\|^int main' "$1"; then
        grep -v '^#include' "$1" >>whole.c
    else
        { echo 'int main(void) {' && grep -v '^#include' "$1" && echo 'return 0; }'; } >>whole.c
        [ $whole -eq 0 ] || how="-o whole $BUILD/libhnbrdf.a -lm"
    fi
    # shellcheck disable=SC2086 # words
    "$CC" -std=c11 -Wall -Wextra -Werror -Wno-unused -DHNBRDF_STATIC -I"$SOURCES/include" -I"$SOURCES/src" \
        -I"$SOURCES/tests/fuzz" whole.c $how >out 2>err || fail "$at: does not compile"
    [ "$how" = -fsyntax-only ] || (cd "$SOURCES" && "$SCRATCH/whole") >out 2>err || fail "$at: does not run"
}

# Statements go into main(), beside what a shader has; uniforms stay outside.
try_glsl() {
    command -v glslangValidator >/dev/null || { skipped=$((skipped + 1)) && return; }
    # A whole one, which reads what `verify --hand-out` writes: the tests of that option run such a shader.
    ! grep -q '^#version' "$1" || { left=$((left + 1)) && return; }
    [ -f here/scene.glsl ] && ! grep -q hnbrdf_material_unpack "$1" ||
        (cd here && hnbrdf export examples/models/rgl_32x2.safetensors --pack half -o scene.glsl) >out 2>err || fail "$at: export"
    grep '^#include' "$1" >includes || printf '#include "hybrid_brdf.glsl"\n#include "scene.glsl"\n' >includes
    {
        printf '#version 450\n#extension GL_GOOGLE_include_directive : require\n'
        cat includes
        grep '^uniform' "$1"
        printf 'layout(location = 0) out vec4 colour;\nlayout(location = 0) in vec2 uv;\n'
        k=1
        for name in l v t b n wi wo light to_light to_viewer; do
            echo "layout(location = $k) in vec3 $name;"
            k=$((k + 1))
        done
        echo 'void main() {'
        ! grep -q scene.glsl includes || echo 'hnbrdf_material m = hnbrdf_scene_material(0);'
        echo '{'
        grep -v '^#\|^uniform' "$1"
        printf '}\n}\n'
    } >shader.frag
    glslangValidator -V --auto-map-bindings -o shader.spv -I"$SOURCES/shaders" -Ihere shader.frag >out 2>err || fail "$at: does not compile"
}

try_hlsl() {
    command -v glslangValidator >/dev/null || { skipped=$((skipped + 1)) && return; }
    cp "$1" here/shader.hlsl
    (cd here && glslangValidator -D -V -S frag -e main -o shader.spv shader.hlsl) >out 2>err || fail "$at: does not compile"
}

# Those of a page go on from each other: they run as one, after the last.
try_python() { cat "$1" >>program.py; }
run_python() {
    [ -s program.py ] || return 0
    for python in python3 /usr/bin/python3 ''; do $python -c 'import numpy' 2>/dev/null && break; done
    [ -n "$python" ] || { skipped=$((skipped + 1)) && return; }
    (cd here && PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$SOURCES/examples/python HNBRDF_LIBRARY_PATH=$BUILD $python ../program.py) \
        >out 2>err </dev/null || fail "$page: its Python does not run"
    : >program.py
}

# Each page begins with the same files. The tracked model is a copy: pages may write over it.
begin_page() {
    page=$1
    rm -rf here
    cp -r start here
    rm here/examples
    mkdir here/examples
    cp -r "$SOURCES/examples/models" "$SOURCES"/examples/*.scene here/examples
    (cd here && for name in gold silk; do hnbrdf export model.safetensors --prefix $name -o $name.glsl || exit; done) \
        >out 2>err || fail "the files that pages name"
}

seen=0 left=0 skipped=0 page=
: >program.py
for found in snippets/*.at; do
    at=$(cat "$found")
    for snippet in "${found%.at}".*; do [ "$snippet" = "$found" ] || break; done
    language=${snippet##*.}
    if [ "${at%:*}" != "$page" ]; then
        run_python
        begin_page "${at%:*}"
    fi
    case $language in
    sh | c | glsl | hlsl | python) try_$language "$snippet" ;;
    *) grep -q "^$language|." untried && left=$((left + 1)) || fail "$at: nobody tries snippets in '$language'" ;;
    esac
done
run_python
echo "$(find snippets -name '*.at' | wc -l) snippets with $seen commands; $left only looked at, $skipped without what they need"
finish
