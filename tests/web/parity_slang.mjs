// parity_slang.mjs: runs a case of `hnbrdf verify --hand-out --language slang` on WebGPU: Slang's compiler makes WGSL.
import { GROUP, runWith } from './parity_webgpu.mjs';
import { compileSlang } from './slang.mjs';

// `precise` of the exact build: this version of Slang would write the word into WGSL, which has none. The order of
// operations is then not kept, which slot 7 of each row has to say.
function computeText(texts, inputs, slots, call) {
  const values = Array.from({ length: inputs }, (_, i) => `rows[row * ${inputs} + ${i}]`).join(', ');
  return compileSlang(`#define precise
${texts.join('\n')}
[[vk::binding(0, 1)]] StructuredBuffer<float4> rows;
[[vk::binding(1, 1)]] RWStructuredBuffer<float4> results;
[shader("compute")]
[numthreads(${GROUP}, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    uint count, stride;
    uint row = id.x;
    rows.GetDimensions(count, stride);
    if (row >= count / ${inputs})
        return;
    for (int slot = 0; slot < ${slots}; slot++)
        results[row * ${slots} + slot] = ${call}(${values}, slot);
}`, 'WGSL');
}

export async function runCase(read, gpu) {
  const found = await runWith(computeText, read, gpu);
  const exact = found.files['outputs_exact.f32'];
  for (let i = 31; i < exact.length; i += 32) exact[i] = 0;
  return found;
}
