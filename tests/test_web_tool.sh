#!/bin/sh
# test_web_tool.sh naga|babylon SOURCE SCENES PACKAGES SCRATCH: tools of engines take every exported text (SCENES: the
# program glsl_scenes). naga: wgpu's and Bevy's translator, then Tint, Chromium's and Dawn's. babylon: Babylon.js's
# preprocessor. Skipped (77) without node, the npm packages of web/package.json or glslang.
set -eu
tool=$1 source=$2 scenes=$3 scratch=$5
export HNBRDF_WEB_PACKAGES="$4"
command -v node > /dev/null || { echo "skipped: no node"; exit 77; }
command -v glslangValidator > /dev/null || { echo "skipped: no glslangValidator"; exit 77; }
rm -rf "$scratch"
mkdir -p "$scratch/processed"
"$scenes" "$scratch" > "$scratch/list"
mv "$scratch/list" "$scratch/names"
node "$source/tests/web/tool_$tool.mjs" "$scratch" "$scratch/processed"
rm -rf "$scratch"
