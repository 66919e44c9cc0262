// tool_slang.mjs FILE...: Slang takes the texts, which have an entry point, to every language that it writes.
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { compileSlang } from './slang.mjs';

let failed = 0;
for (const file of process.argv.slice(2)) {
  const text = readFileSync(file, 'utf8');
  for (const language of ['GLSL', 'HLSL', 'METAL', 'SPIRV', 'WGSL']) {
    const start = Date.now();
    let message = '';
    try {
      compileSlang(text, language);
    } catch (error) {
      message = error.message;
      failed = 1;
    }
    console.log(`${message ? 'FAILED' : 'ok'}: ${basename(file)} to ${language}, ${Date.now() - start} ms ${message}`);
  }
}
process.exit(failed);
