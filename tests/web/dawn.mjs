// dawn.mjs: Dawn, Chromium's WebGPU, in this process (npm package webgpu), on SwiftShader.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { skip } from './browser.mjs';

// The npm packages, in the folder that HNBRDF_WEB_PACKAGES names.
export function requirePackage(name) {
  const folder = process.env.HNBRDF_WEB_PACKAGES ?? '';
  if (!existsSync(join(folder, 'installed'))) skip('no npm packages (test_web_packages)');
  return pathToFileURL(createRequire(join(folder, 'package.json')).resolve(name)).href;
}

// Calls use(gpu) with a GPU object; the classes of WebGPU are global meanwhile, as in a browser.
export async function withDawn(use) {
  const { create, globals } = await import(requirePackage('webgpu'));
  const driver = ['/usr/lib/chromium', '/usr/lib/chromium-browser', '/opt/google/chrome']
    .map((folder) => join(folder, 'vk_swiftshader_icd.json')).find(existsSync);
  if (driver) process.env.VK_ICD_FILENAMES = process.env.VK_DRIVER_FILES = driver;
  process.env.XDG_RUNTIME_DIR ??= tmpdir(); // its loader complains without one
  Object.assign(globalThis, globals);
  return use(create([]));
}
