#!/bin/sh
# test_language_gpu.sh HNBRDF SCENES SPIRV_CASE MODEL: exported HLSL, compiled by glslang, gives the values of C on the first
# Vulkan device, and its bits in the exact build where the device rounds as C does: the parity body of `hnbrdf verify`.
# SPIRV_CASE runs a compute shader (spirv_case.c).
set -eu
hnbrdf=$1 scenes=$2 spirv_case=$3 model=$4
command -v glslangValidator > /dev/null || { echo 'skipped: no glslangValidator'; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "test_language_gpu: $*" >&2; exit 1; }

# FUNCTION VECTORS SLOTS: a compute shader that calls it for a row of VECTORS and a slot.
shader() {
    cat << END
StructuredBuffer<float4> rows : register(t0);
RWStructuredBuffer<float4> results : register(u1);
[numthreads(64, 1, 1)] void main(uint3 id : SV_DispatchThreadID)
{
    uint count, stride;
    rows.GetDimensions(count, stride);
    if (id.x * $2 >= count)
        return;
    uint at = id.x * $2;
    results[id.x * $3 + id.y] = $1($(for k in $(seq 0 $(($2 - 1))); do printf 'rows[at + %d], ' "$k"; done)int(id.y));
}
END
}

compile() { # SCENE PARITY FUNCTION VECTORS SLOTS, to case.spv
    { echo '#define HNBRDF_WEIGHTS_REGISTER b2'; cat "$1" "$2"; shader "$3" "$4" "$5"; } > case.hlsl
    glslangValidator -D -V -S comp -e main case.hlsl -o case.spv > messages 2>&1 || { cat messages; fail "$3 does not compile"; }
}

run() { # VECTORS SLOTS INPUTS OUTPUTS
    weights=''
    [ ! -e weights.bin ] || weights=weights.bin
    "$spirv_case" case.spv "$3" "$1" "$2" "$4" $weights > device.txt || { code=$?; cat device.txt; exit $code; }
}

try() { # MODEL OPTIONS...
    of=$1
    shift
    rm -rf "$work/case"
    "$hnbrdf" verify "$of" --language hlsl --pairs 512 --hand-out "$work/case" "$@" > /dev/null
    cd "$work/case"
    compile scene_exact.hlsl parity_exact.hlsl hnbrdf_probe 1 2
    run 1 2 probe.f32 probe_results.f32
    compile scene_exact.hlsl parity_exact.hlsl hnbrdf_parity 4 8
    run 4 8 inputs.f32 outputs_exact.f32
    compile scene.hlsl parity.hlsl hnbrdf_parity 4 8
    run 4 8 inputs.f32 outputs.f32
    "$hnbrdf" verify "$of" --hand-in . > said || { cat said; fail "$of is not within the bounds"; }
    echo "ok: $(basename "$of") on $(cat device.txt)"
    echo "parity: hlsl | Vulkan compute (glslang -D) | $(cat device.txt) | executed"
}

"$scenes" "$work" hlsl > /dev/null
try "$model" --materials vch_silk_blue --weights columns
try "$work/hybrid_8x4_rotated.safetensors" --weights uniform
