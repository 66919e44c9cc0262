// tool_babylon.mjs SCENES SCRATCH: Babylon's own preprocessor, line by line, keeps every exported text whole: what
// comes out compiles as GLSL ES 300, and HNBRDF_EXACT 0 and 1 choose what they promise.
import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { requirePackage } from './dawn.mjs';
import { fragment, namesIn } from './texts.mjs';

const [scenes, scratch] = process.argv.slice(2);
const { Process } = await import(requirePackage('@babylonjs/core/Engines/Processors/shaderProcessor.js'));
const { WebGL2ShaderProcessor } =
  await import(requirePackage('@babylonjs/core/Engines/WebGL/webGL2ShaderProcessors.js'));

function processed(text) {
  let result;
  Process(text, {
    defines: [], indexParameters: undefined, isFragment: true, shouldUseHighPrecisionShader: true,
    processor: new WebGL2ShaderProcessor(), supportsUniformBuffers: true, shadersRepository: '',
    includesShadersStore: {}, version: '200', platformName: 'WEBGL2', processingContext: null,
    isNDCHalfZRange: false, useReverseDepthBuffer: false, // as Babylon's WebGL2 engine has them
  }, (code) => { result = code; }, undefined);
  return `#version 300 es\n${result}`;
}

function errorsOf(name, exact) {
  const head = `precision highp float;\n${exact < 0 ? '' : `#define HNBRDF_EXACT ${exact}`}`;
  const text = processed(fragment(scenes, name, head, 'in vec3 wi;\nin vec3 wo;\nout vec4 colour;'));
  const file = join(scratch, `${name}.frag`);
  writeFileSync(file, text);
  try {
    execFileSync('glslangValidator', [file], { encoding: 'utf8', stdio: 'pipe' });
  } catch (error) {
    return error.stdout;
  }
  const [, chosen] = /^#define HNBRDF_EXP\(x\) (.*)$/m.exec(text) ?? [];
  const expected = exact === 1 ? 'hnbrdf_exp(x)' : 'exp(x)';
  return chosen === expected ? '' : `HNBRDF_EXP(x) is ${chosen}, expected ${expected}`;
}

let failed = 0;
for (const name of namesIn(scenes)) {
  const start = Date.now();
  const errors = [-1, 0, 1].map((exact) => errorsOf(name, exact)).filter(Boolean);
  console.log(`${errors.length ? 'FAILED' : 'ok'}: ${name}, ${Date.now() - start} ms\n${errors.join('\n')}`.trim());
  if (errors.length) failed = 1;
}
process.exit(failed);
