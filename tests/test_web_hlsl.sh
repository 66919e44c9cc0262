#!/bin/sh
# test_web_hlsl.sh glslang|direct3d SOURCE HNBRDF PACKAGES SCRATCH: the exported HLSL and the examples for engines
# compile with glslang, or with Direct3D's own compilers, FXC (Shader Model 5.0) and DXC (6.0), without a warning: DLLs
# of the npm package webgpu under wine. FXC takes at most 4 s of processor time for four lights, unrolled, in the default style.
# Skipped (77) without glslang; without wine, MinGW or the package.
set -eu
compiler=$1 source=$2 hnbrdf=$3 packages=$4 scratch=$5
model=$source/examples/models/rgl_32x2.safetensors
dlls=$packages/node_modules/webgpu/dist/win32-x64
fail() { echo "failed: $*"; exit 1; }
need() { command -v "$1" > /dev/null || { echo "skipped: no $1"; exit 77; }; }
if [ "$compiler" = glslang ]; then
    need glslangValidator
else
    need wine
    need x86_64-w64-mingw32-gcc
    [ -f "$dlls/dxcompiler.dll" ] || { echo "skipped: no npm packages (test_web_packages)"; exit 77; }
fi
rm -rf "$scratch"
mkdir -p "$scratch"
export_to() { # FILE options...
    file=$1
    shift
    "$hnbrdf" export "$model" --materials irid_flake_paint1,paper_white --standalone "$@" -o "$file" > "$scratch/said"
}

# eval.N: N lights, unrolled; all: everything there is.
for style in default constants uniform; do
    case $style in
    default) set -- ;;
    uniform) set -- --weights uniform --weights-out "$scratch/weights.bin" ;;
    *) set -- --weights $style ;;
    esac
    export_to "$scratch/$style" --language hlsl "$@"
    for lights in 1 4; do
        {
            cat "$scratch/$style"
            cat << H
float4 main(float3 wo : TEXCOORD0, float3 lights[4] : TEXCOORD1) : SV_Target
{
    hnbrdf_material m = hnbrdf_scene_material(HNBRDF_MATERIAL_IRID_FLAKE_PAINT1);
    float3 sum = 0.0;
    [unroll] for (int i = 0; i < $lights; i++)
        sum += hnbrdf_eval(m, lights[i], wo);
    return float4(sum, 1.0);
}
H
        } > "$scratch/$style.$lights.hlsl"
    done
    {
        cat "$scratch/$style"
        cat << 'H'
float4 main(float3 wi : TEXCOORD0, float3 wo : TEXCOORD1, float2 u : TEXCOORD2) : SV_Target
{
    hnbrdf_material m = hnbrdf_scene_material(HNBRDF_MATERIAL_IRID_FLAKE_PAINT1);
    hnbrdf_sample_result drawn = hnbrdf_sample(m, wo, u);
    return float4(hnbrdf_eval(m, wi, wo) + hnbrdf_eval_analytic(m, wi, wo) + drawn.weight, hnbrdf_pdf(m, wi, wo));
}
H
    } > "$scratch/$style.all.hlsl"
done
export_to "$scratch/eval.hlsl.txt" --only eval --language hlsl
export_to "$scratch/eval.glsl.txt" --only eval --weights columns
sh "$source/tests/web/engine_texts.sh" "$source" "$scratch/eval.hlsl.txt" "$scratch/eval.glsl.txt" "$scratch"

if [ "$compiler" = glslang ]; then
    for file in "$scratch"/*.hlsl; do
        glslangValidator -D -V -S frag -e main "$file" -o "$scratch/out.spv" > "$scratch/said" ||
            fail "$(cat "$scratch/said")"
        echo "ok: $(basename "$file")"
    done
    glslangValidator -V "$scratch/godot.frag" -o "$scratch/out.spv" > "$scratch/said" || fail "$(cat "$scratch/said")"
    rm -rf "$scratch"
    exit
fi

# Which of the files each compiler gets: FXC takes long for constants and for all at once.
fxc_files="default.1 default.4 uniform.1 uniform.all unity unreal"
dxc_files="default.1 default.4 default.all constants.1 uniform.1 uniform.all unity unreal"
direct3d() { # DLL PROFILE names
    dll=$1 profile=$2
    shift 2
    (cd "$scratch" && for name in "$@"; do echo "$name.hlsl"; done |
        xargs timeout 240 wine direct3d.exe "Z:$dlls/$dll" "$profile") > "$scratch/said" 2> "$scratch/errors" ||
        fail "$dll: $(cat "$scratch/said" "$scratch/errors")"
    tr -d '\r' < "$scratch/said" | tee "$scratch/$profile"
    ! grep -q 'warning' "$scratch/$profile" || fail "$dll warns"
}
export WINEDEBUG=-all WINEPREFIX="$scratch/wine" WINEDLLOVERRIDES='d3dcompiler_47=n;mscoree=;mshtml='
x86_64-w64-mingw32-gcc -O2 -Wall -Wextra -Werror "$source/tests/web/direct3d.c" -o "$scratch/direct3d.exe"
# shellcheck disable=SC2086 # words
direct3d d3dcompiler_47.dll ps_5_0 $fxc_files
# shellcheck disable=SC2086
direct3d dxcompiler.dll ps_6_0 $dxc_files
four=$(sed -n 's/^ok ps_5_0 default\.4\.hlsl: \([0-9]*\) ms.*/\1/p' "$scratch/ps_5_0")
echo "parity: hlsl | FXC 5.0 and DXC 6.0 | wine | compiled"
[ "$four" -le 4000 ] || fail "FXC takes $four ms for four lights, at most 4000 expected"
wineserver -k 2> /dev/null || true # it would go on writing there
timeout 20 wineserver -w 2> /dev/null || true
rm -rf "$scratch" || { sleep 5; rm -rf "$scratch"; }
