// parity_webgpu.mjs: runs a case of `hnbrdf verify --hand-out --language wgsl` by a compute shader of WebGPU, in a page
// or in a program that has Dawn.

export const GROUP = 64; // rows a workgroup

// Around the exported texts: a thread for every row, which calls the function for every slot. group 0 is the caller's,
// the scene's weights are where its own text says.
function computeText(texts, inputs, slots, call) {
  const values = Array.from({ length: inputs }, (_, i) => `rows[row * ${inputs}u + ${i}u]`).join(', ');
  return `${texts.join('\n')}
@group(1) @binding(0) var<storage, read> rows: array<vec4<f32>>;
@group(1) @binding(1) var<storage, read_write> results: array<vec4<f32>>;
@compute @workgroup_size(${GROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let row = id.x;
    if (row >= arrayLength(&rows) / ${inputs}u) {
        return;
    }
    for (var slot = 0; slot < ${slots}; slot++) {
        results[row * ${slots}u + u32(slot)] = ${call}(${values}, slot);
    }
}`;
}

// Pipelines by their text: a case that has the text of one before runs its pipeline, with its own weights.
const pipelines = new Map();

async function compile(device, code) {
  if (pipelines.has(code)) return pipelines.get(code);
  const module = device.createShaderModule({ code });
  const { messages } = await module.getCompilationInfo();
  const errors = messages.filter(({ type }) => type === 'error');
  if (errors.length) throw new Error(errors.map((m) => `${m.lineNum}:${m.linePos}: ${m.message}`).join('\n'));
  const pipeline =
    await device.createComputePipelineAsync({ layout: 'auto', compute: { module, entryPoint: 'main' } });
  pipelines.set(code, pipeline);
  return pipeline;
}

function filled(device, usage, bytes) {
  const buffer = device.createBuffer({ size: Math.ceil(bytes.byteLength / 16) * 16, usage, mappedAtCreation: true });
  new Uint8Array(buffer.getMappedRange()).set(new Uint8Array(bytes.buffer ?? bytes));
  buffer.unmap();
  return buffer;
}

// What the shader makes of `numbers`, `inputs` vec4 a row: a Float32Array of `slots` vec4 a row. The weights, if any,
// are binding 0 of group 0.
async function run(device, code, numbers, inputs, slots, weights) {
  const usage = globalThis.GPUBufferUsage;
  const pipeline = await compile(device, code);
  const rows = numbers.length / (4 * inputs);
  const size = 16 * slots * rows;
  const output = device.createBuffer({ size, usage: usage.STORAGE | usage.COPY_SRC });
  const staging = device.createBuffer({ size, usage: usage.COPY_DST | usage.MAP_READ });
  const group = (index, buffers) => device.createBindGroup({
    layout: pipeline.getBindGroupLayout(index),
    entries: buffers.map((buffer, binding) => ({ binding, resource: { buffer } })),
  });
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  if (weights) pass.setBindGroup(0, group(0, [filled(device, usage.UNIFORM, weights)]));
  pass.setBindGroup(1, group(1, [filled(device, usage.STORAGE, numbers), output]));
  pass.dispatchWorkgroups(Math.ceil(rows / GROUP));
  pass.end();
  encoder.copyBufferToBuffer(output, 0, staging, 0, size);
  device.queue.submit([encoder.finish()]);
  await staging.mapAsync(globalThis.GPUMapMode.READ);
  const results = new Float32Array(staging.getMappedRange().slice(0));
  staging.unmap();
  return results;
}

let adapter = null;
let device = null;

// computeText makes WGSL of the texts; otherwise as runCase().
export async function runWith(computeText, read, gpu) {
  const text = async (name) => new TextDecoder().decode(await read(name));
  const floats = async (name) => new Float32Array(await read(name));
  const about = JSON.parse(await text('case.json'));
  adapter ??= await gpu?.requestAdapter();
  if (!adapter) throw new Error('no WebGPU adapter');
  device ??= await adapter.requestDevice();
  const known = pipelines.size;
  let failure = null;
  device.onuncapturederror = ({ error }) => { failure ??= error.message; };
  const weights = about.weights_bytes ? await read('weights.bin') : null;
  const inputs = await floats('inputs.f32');
  const files = {};
  for (const build of ['', '_exact']) {
    const texts = [await text(`scene${build}.${about.extension}`), await text(`parity${build}.${about.extension}`)];
    const code = computeText(texts, 4, about.slots, 'hnbrdf_parity');
    files[`outputs${build}.f32`] = await run(device, code, inputs, 4, about.slots, weights);
    if (!build) continue;
    const probe = computeText(texts, 1, about.probe_slots, 'hnbrdf_probe');
    files['probe_results.f32'] = await run(device, probe, await floats('probe.f32'), 1, about.probe_slots, null);
  }
  if (failure) throw new Error(failure);
  const { vendor, architecture, description } = adapter.info;
  const name = `WebGPU: ${[vendor, architecture, description].filter(Boolean).join(' ')}`;
  return { device: name, compiled: pipelines.size - known, files };
}

// read(name) gives a file of the case as an ArrayBuffer; gpu is a GPU object. Gives { device, compiled:
// how many pipelines, files: { name: Float32Array } }.
export const runCase = (read, gpu = globalThis.navigator.gpu) => runWith(computeText, read, gpu);
