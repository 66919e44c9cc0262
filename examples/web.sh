#!/bin/sh
# web.sh webgl|three|babylon|webgpu [FOLDER]: shows examples/NAME with a material of the shipped model in your browser.
# Puts the page, the shader and the npm packages of examples/NAME/package.json (the exact versions there) into FOLDER
# (out/web/NAME) and serves it at http://localhost:8000 (PORT). Nothing is fetched by the page from elsewhere.
# HNBRDF names the command (build/hnbrdf), MATERIAL the material (irid_flake_paint1). --prepare first: without serving.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
serve=1
[ "${1-}" != --prepare ] || { serve=0; shift; }
name=${1-}
if [ -z "$name" ] || [ ! -f "$here/$name/index.html" ]; then
    echo "usage: sh $0 [--prepare] webgl|three|babylon|webgpu [FOLDER]" >&2
    exit 2
fi
folder=${2:-out/web/$name} hnbrdf=${HNBRDF:-build/hnbrdf} model=$here/models/rgl_32x2.safetensors
command -v "$hnbrdf" > /dev/null || { echo "web.sh: no command $hnbrdf: build it, or name it: HNBRDF=..." >&2; exit 1; }
command -v node > /dev/null || { echo "web.sh: no node (Node.js 18 or newer)" >&2; exit 1; }

mkdir -p "$folder"
cp "$here/$name"/* "$folder"
case $name in
webgpu) set -- --language wgsl -o "$folder/scene.wgsl" ;;
*) set -- -o "$folder/scene.glsl" ;;
esac
"$hnbrdf" export "$model" --materials "${MATERIAL:-irid_flake_paint1}" --only eval --standalone "$@" > /dev/null
if [ -f "$folder/package.json" ] && [ ! -e "$folder/node_modules" ]; then
    (cd "$folder" && npm install --ignore-scripts --no-audit --no-fund --no-save)
fi
[ $serve = 0 ] || exec node "$here/serve.mjs" "$folder" "${PORT:-8000}"
