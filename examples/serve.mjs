// serve.mjs FOLDER [PORT]: shows a folder to browsers of this machine at http://localhost:PORT (8000; 0: any
// free one). A browser gives modules and WebGPU only to pages that come from a server.
import { createReadStream, realpathSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, sep } from 'node:path';
import { fileURLToPath } from 'node:url';

const types = {
  '.css': 'text/css', '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.json': 'application/json',
  '.mjs': 'text/javascript', '.png': 'image/png', '.wasm': 'application/wasm',
};

// The file of FOLDER that a request names, or null. Links may lead out of the folder, .. may not.
function fileOf(folder, url) {
  try {
    const path = decodeURIComponent(new URL(url, 'http://localhost').pathname);
    if (path.split(/[/\\]/).includes('..')) return null;
    const file = realpathSync(join(folder, path.endsWith('/') ? path + 'index.html' : path));
    return statSync(file).isFile() ? file : null;
  } catch {
    return null;
  }
}

// Serves folder; gives { url, close() } once it listens.
export function serve(folder, port = 0) {
  const server = createServer((request, response) => {
    const file = fileOf(folder, request.url);
    if (!file || request.method !== 'GET') {
      response.writeHead(404).end();
      return;
    }
    const type = types[extname(file)] ?? (/\.(f32|bin)$/.test(file) ? 'application/octet-stream' : 'text/plain');
    response.writeHead(200, { 'Content-Type': type, 'Cache-Control': 'no-store' });
    createReadStream(file).pipe(response);
  });
  return new Promise((resolve, reject) => {
    server.once('error', reject);
    server.listen(port, '127.0.0.1', () => resolve({
      url: `http://localhost:${server.address().port}/`,
      close: () => { server.closeAllConnections(); server.close(); },
    }));
  });
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [folder, port] = process.argv.slice(2);
  if (!folder) {
    console.error('usage: node serve.mjs FOLDER [PORT]');
    process.exit(2);
  }
  const { url } = await serve(folder + sep, Number(port ?? 8000));
  console.log(`${url} shows ${folder}; Ctrl-C stops`);
}
