#!/bin/sh
# test_web_example.sh NAME SOURCE HNBRDF PACKAGES SCRATCH: the page of examples/, as examples/web.sh prepares it,
# shows in a browser what the C library says. NAME is that of its folder, then perhaps _ and a word that only
# web/examples.mjs knows. PACKAGES: the folder with the npm packages of web/package.json. Skipped (77) without node,
# the packages or a browser.
set -eu
name=$1 example=${1%%_*} source=$2 hnbrdf=$3 packages=$4 scratch=$5
command -v node > /dev/null || { echo "skipped: no node"; exit 77; }
rm -rf "$scratch"
mkdir -p "$scratch/$name"
if [ -f "$source/examples/$example/package.json" ]; then
    [ -f "$packages/installed" ] || { echo "skipped: no npm packages (test_web_packages)"; exit 77; }
    # The versions that a user gets are the ones that are tested.
    sed -n 's/^ *"\(@*[a-z/]*\)": "\([0-9][0-9.]*\)",*$/\1 \2/p' "$source/examples/$example/package.json" |
        while read -r package version; do
            grep -q "\"version\": \"$version\"" "$packages/node_modules/$package/package.json" || {
                echo "failed: examples/$example has $package $version, the tests have another"
                exit 1
            }
        done
    ln -s "$packages/node_modules" "$scratch/$name/node_modules"
fi
HNBRDF=$hnbrdf MATERIAL=irid_flake_paint1 sh "$source/examples/web.sh" --prepare "$example" "$scratch/$name"
node "$source/tests/web/example.mjs" "$scratch/$name" "$hnbrdf" "$source/examples/models/rgl_32x2.safetensors" \
    irid_flake_paint1 "$scratch/$name.png"
