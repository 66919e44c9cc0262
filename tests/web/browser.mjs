// browser.mjs: a browser of the Chromium family without a window, driven over its own pipe (the DevTools protocol),
// with its software GPU (SwiftShader) for WebGL2 and WebGPU.
import { spawn } from 'node:child_process';
import { accessSync, constants, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { delimiter, join } from 'node:path';

export const SKIPPED = 77;

// Ends the test as skipped.
export function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(SKIPPED);
}

function findBrowser() {
  if (process.env.HNBRDF_CHROMIUM) return process.env.HNBRDF_CHROMIUM;
  for (const name of ['chromium-headless-shell', 'chromium', 'chromium-browser', 'google-chrome']) {
    for (const folder of (process.env.PATH ?? '').split(delimiter)) {
      const path = join(folder, name);
      try {
        accessSync(path, constants.X_OK);
        return path;
      } catch { /* the next one */ }
    }
  }
  return null;
}

const flags = [
  '--headless', '--remote-debugging-pipe', '--no-first-run', '--disable-extensions', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--mute-audio', '--hide-scrollbars', '--force-device-scale-factor=1',
  '--force-color-profile=srgb', '--disable-dev-shm-usage', '--disable-gpu-watchdog', '--ignore-gpu-blocklist',
  '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--enable-unsafe-webgpu',
  '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan', '--use-vulkan=swiftshader', // shows WebGPU's canvas
];

// Messages of the protocol end with a 0 byte; fd 3 takes them, fd 4 gives them.
class Connection {
  constructor(child) {
    this.child = child;
    this.next = 1;
    this.waiting = new Map();
    this.listeners = [];
    this.rest = Buffer.alloc(0);
    child.stdio[4].on('data', (data) => this.receive(data));
    child.on('exit', (code, signal) => {
      this.dead = `the browser ended (${signal ?? code})`;
      for (const { reject } of this.waiting.values()) reject(new Error(this.dead));
      this.waiting.clear();
    });
    child.stdio[3].on('error', () => {}); // told by 'exit'
  }

  receive(data) {
    this.rest = Buffer.concat([this.rest, data]);
    for (let end = this.rest.indexOf(0); end >= 0; end = this.rest.indexOf(0)) {
      this.take(JSON.parse(this.rest.subarray(0, end).toString()));
      this.rest = this.rest.subarray(end + 1);
    }
  }

  take(message) {
    const waiting = this.waiting.get(message.id);
    if (!waiting) {
      for (const listener of this.listeners) listener(message);
      return;
    }
    this.waiting.delete(message.id);
    if (message.error) waiting.reject(new Error(message.error.message));
    else waiting.resolve(message.result);
  }

  send(method, params = {}, sessionId = undefined) {
    if (this.dead) return Promise.reject(new Error(this.dead));
    const id = this.next++;
    this.child.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + '\0');
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
  }
}

class Page {
  constructor(connection, sessionId) {
    this.connection = connection;
    this.sessionId = sessionId;
    this.messages = []; // console output and uncaught errors
    connection.listeners.push((m) => this.listen(m));
  }

  send(method, params) {
    return this.connection.send(method, params, this.sessionId);
  }

  listen({ sessionId, method, params }) {
    if (sessionId !== this.sessionId) return;
    if (method === 'Runtime.consoleAPICalled') {
      const text = params.args.map((a) => a.value ?? a.description ?? a.type).join(' ');
      this.messages.push(`${params.type}: ${text}`);
    } else if (method === 'Runtime.exceptionThrown') {
      const { text, exception } = params.exceptionDetails;
      this.messages.push(`uncaught: ${exception?.description ?? text}`);
    } else if (method === 'Page.loadEventFired') {
      this.loaded?.();
    }
  }

  async open(url) {
    const loaded = new Promise((resolve) => { this.loaded = resolve; });
    await this.send('Page.navigate', { url });
    await loaded;
  }

  // The value (JSON) of an expression, awaited where it is a promise.
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate',
      { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) {
      const { exception, text } = exceptionDetails;
      throw new Error(exception?.description ?? exception?.value ?? text);
    }
    return result.value;
  }

  // What the page looks like: a PNG file as a Buffer.
  async screenshot() {
    return Buffer.from((await this.send('Page.captureScreenshot', { format: 'png' })).data, 'base64');
  }
}

// Starts the browser, calls use(page), and ends the browser whatever happens. size: that of the page in pixels.
export async function withPage(use, { size = [256, 256] } = {}) {
  const path = findBrowser() ?? skip('no chromium-headless-shell, chromium or google-chrome');
  const profile = mkdtempSync(join(tmpdir(), 'hnbrdf-web-'));
  const root = process.getuid?.() === 0 ? ['--no-sandbox'] : [];
  const child = spawn(path, [...flags, ...root, `--user-data-dir=${profile}`, 'about:blank'],
    { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'], detached: true });
  child.on('error', () => {});
  try {
    const connection = new Connection(child);
    const { targetId } = await connection.send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await connection.send('Target.attachToTarget', { targetId, flatten: true });
    const page = new Page(connection, sessionId);
    await page.send('Page.enable');
    await page.send('Runtime.enable');
    await page.send('Emulation.setDeviceMetricsOverride',
      { width: size[0], height: size[1], deviceScaleFactor: 1, mobile: false });
    return await use(page);
  } finally {
    const ended = new Promise((resolve) => {
      if (child.exitCode === null && !child.signalCode) child.once('exit', resolve);
      else resolve();
    });
    try { process.kill(-child.pid, 'SIGKILL'); } catch { /* it ended by itself */ }
    await ended;
    rmSync(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 50 });
  }
}
