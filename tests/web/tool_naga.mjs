// tool_naga.mjs SCENES: what wgpu and Bevy do with GLSL: naga reads every exported text, validates it and writes it as
// WGSL, which Dawn (Tint) takes, and as HLSL and MSL.
import { requirePackage, withDawn } from './dawn.mjs';
import { fragment, namesIn } from './texts.mjs';

const [scenes] = process.argv.slice(2);
const naga = await import(requirePackage('naga-wasm'));
// naga knows no VULKAN, by which the text would place its block of weights itself.
const head = '#version 450\n#define HNBRDF_WEIGHTS_LAYOUT layout(std140, set = 1, binding = 2)';
const declarations = `layout(location = 0) in vec3 wi;
layout(location = 1) in vec3 wo;
layout(location = 0) out vec4 colour;`;

async function errorsOf(device, name) {
  let wgsl;
  try {
    const module = naga.parseGlsl(fragment(scenes, name, head, declarations), { stage: 'fragment' });
    const info = naga.validate(module);
    wgsl = naga.writeWgsl(module, info);
    naga.writeHlsl(module, info);
    naga.writeMsl(module, info);
  } catch (error) {
    return `naga, ${error.kind}: ${error.formatted}`;
  }
  const { messages } = await device.createShaderModule({ code: wgsl }).getCompilationInfo();
  const lines = wgsl.split('\n');
  return messages.filter(({ type }) => type === 'error')
    .map((m) => `Tint: ${m.message}\n  ${lines[m.lineNum - 1]}`).join('\n');
}

let failed = 0;
await withDawn(async (gpu) => {
  const device = await (await gpu.requestAdapter()).requestDevice();
  for (const name of namesIn(scenes).filter((n) => !n.startsWith('half'))) { // naga has no float16 in GLSL
    const start = Date.now();
    const errors = await errorsOf(device, name);
    console.log(`${errors ? 'FAILED' : 'ok'}: ${name}, ${Date.now() - start} ms\n${errors}`.trim());
    if (errors) failed = 1;
  }
  device.destroy();
});
process.exit(failed);
