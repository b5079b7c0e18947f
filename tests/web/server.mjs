// A small server for the built viewer and for files of the tests, on the loopback interface, with the headers that make the page
// cross-origin isolated. `gyre view` is the real one; here nothing native has to be built.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';

const TYPES = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.json': 'application/json',
  '.svg': 'image/svg+xml',
  '.webp': 'image/webp',
  '.woff2': 'font/woff2',
  '.wasm': 'application/wasm',
};

// `files`: what lies under /files/, by name.
export async function serve(root, files = {}, { isolated = true } = {}) {
  const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    if (isolated) {
      response.setHeader('Cross-Origin-Opener-Policy', 'same-origin');
      response.setHeader('Cross-Origin-Embedder-Policy', 'require-corp');
    }
    try {
      const given = path.startsWith('/files/') ? files[path.slice('/files/'.length)] : undefined;
      const clean = normalize(path === '/' ? '/index.html' : path);
      const body = given ?? (await readFile(join(root, clean)));
      response.setHeader('Content-Type', TYPES[extname(clean)] ?? 'application/octet-stream');
      response.end(body);
    } catch {
      response.statusCode = 404;
      response.end('not found');
    }
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => new Promise((resolve) => server.close(resolve)) };
}
