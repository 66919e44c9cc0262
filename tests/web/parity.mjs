// parity.mjs webgl|webgpu|dawn|slang FOLDER...: runs cases of `hnbrdf verify --hand-out FOLDER` in a browser (WebGL2,
// WebGPU) or on Dawn, Chromium's WebGPU, in this process (WGSL, Slang). What came out goes into each FOLDER, for
// `hnbrdf verify --hand-in`.
import { mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { serve } from '../../examples/serve.mjs';
import { withPage } from './browser.mjs';
import { withDawn } from './dawn.mjs';

const [api, ...folders] = process.argv.slice(2);
const module = {
  webgl: 'parity_webgl.mjs', webgpu: 'parity_webgpu.mjs', dawn: 'parity_webgpu.mjs', slang: 'parity_slang.mjs',
}[api];
if (!module || !folders.length) {
  console.error('usage: node parity.mjs webgl|webgpu|dawn|slang FOLDER...');
  process.exit(2);
}

function write(folder, { device, compiled, files }, start) {
  for (const [name, floats] of Object.entries(files)) writeFileSync(join(folder, name), floats);
  writeFileSync(join(folder, 'device.txt'), device + '\n');
  const seconds = ((Date.now() - start) / 1000).toFixed(2);
  console.log(`${basename(folder)} on ${device}: ${compiled} shaders compiled, ${seconds} s`);
}

// In a page that sees the module as run.mjs and cases as case/NUMBER/. Floats travel as base64.
async function runInPage(page, number) {
  const { files, ...found } = await page.evaluate(`(async () => {
    const { runCase } = await import('/run.mjs');
    const { device, compiled, files } = await runCase(async (name) => {
      const response = await fetch('/case/${number}/' + name);
      if (!response.ok) throw new Error('no ' + name);
      return response.arrayBuffer();
    });
    const texts = Object.entries(files).map(([name, floats]) => {
      const bytes = new Uint8Array(floats.buffer);
      let text = '';
      for (let i = 0; i < bytes.length; i += 4096) text += String.fromCharCode(...bytes.subarray(i, i + 4096));
      return [name, btoa(text)];
    });
    return { device, compiled, files: Object.fromEntries(texts) };
  })()`);
  const floats = Object.entries(files).map(([name, text]) => [name, Buffer.from(text, 'base64')]);
  return { ...found, files: Object.fromEntries(floats) };
}

async function inBrowser() {
  const root = mkdtempSync(join(tmpdir(), 'hnbrdf-parity-'));
  writeFileSync(join(root, 'index.html'), '<!doctype html><title>parity</title>');
  symlinkSync(fileURLToPath(new URL(module, import.meta.url)), join(root, 'run.mjs'));
  mkdirSync(join(root, 'case'));
  folders.forEach((folder, number) => symlinkSync(resolve(folder), join(root, 'case', String(number))));
  const server = await serve(root);
  try {
    await withPage(async (page) => {
      await page.open(server.url);
      for (const [number, folder] of folders.entries()) {
        const start = Date.now();
        write(folder, await runInPage(page, number), start);
      }
    });
  } finally {
    server.close();
    rmSync(root, { recursive: true });
  }
}

async function inProcess() {
  const { runCase } = await import(`./${module}`);
  await withDawn(async (gpu) => {
    for (const folder of folders) {
      const start = Date.now();
      const read = async (name) => new Uint8Array(readFileSync(join(folder, name))).buffer;
      write(folder, await runCase(read, gpu), start);
    }
  });
}

await (api.startsWith('web') ? inBrowser() : inProcess());
process.exit(0); // Dawn would keep the process
