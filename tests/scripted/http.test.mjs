// SPDX-License-Identifier: Apache-2.0
// HTTP as scripts and browsers use it, and as attackers do.
import assert from 'node:assert/strict';
import net from 'node:net';
import { after, before, test } from 'node:test';
import { start_server } from '../server.mjs';

let server;
before(async () => { server = await start_server(); });
after(async () => { if (server) assert.equal(await server.stop(), 0); });
const get = (path, options) => fetch(server.url + path, options);

// Sends bytes as they are and returns the first line of the reply.
function raw(text) {
  return new Promise((resolve, reject) => {
    const socket = net.connect(server.port, '127.0.0.1', () => socket.write(text));
    let reply = '';
    socket.on('data', (chunk) => { reply += chunk; if (reply.includes('\r\n')) socket.destroy(); });
    socket.on('close', () => resolve(reply.split('\r\n')[0]));
    socket.on('error', reject);
    socket.setTimeout(20000, () => socket.destroy());
  });
}

test('health, metrics and description', async () => {
  const health = await get('/healthz');
  assert.equal(health.status, 200);
  assert.deepEqual(await health.json(), { status: 'ok' });
  const metrics = await get('/metrics');
  assert.match(metrics.headers.get('content-type'), /^text\/plain/);
  const text = await metrics.text();
  for (const name of ['pictures_total', 'visitors', 'resident_bytes', 'bad_samples_total',
      'connections'])
    assert.match(text, new RegExp(`^wellspring_${name} [0-9.e+]+$`, 'm'));
  const api = await (await get('/api/v1/')).json();
  for (const path of ['/healthz', '/metrics', '/api/v1/exhibits', '/api/v1/visit', '/api/v1/eye'])
    assert.ok(api.paths.some((one) => one.path === path), path);
});

test('exhibits', async () => {
  const { exhibits } = await (await get('/api/v1/exhibits')).json();
  const castle = exhibits.find((exhibit) => exhibit.id === 'castle');
  assert.ok(castle.viewpoints.length >= 5);
  assert.ok(castle.tours.length >= 1);
  assert.deepEqual(await (await get('/api/v1/exhibits/castle')).json(), castle);
  const missing = await get('/api/v1/exhibits/atlantis');
  assert.equal(missing.status, 404);
  assert.equal((await missing.json()).error.code, 'unknown_exhibit');
});

test('a still picture, and its wrong parameters', async () => {
  const path = '/api/v1/exhibits/castle/still.jpg';
  const still = await get(`${path}?viewpoint=hall&width=96&height=64&spp=4`);
  assert.equal(still.status, 200);
  assert.equal(still.headers.get('content-type'), 'image/jpeg');
  const bytes = Buffer.from(await still.arrayBuffer());
  assert.deepEqual([...bytes.subarray(0, 2)], [0xff, 0xd8]);
  const same = await get(`${path}?viewpoint=hall&width=96&height=64&spp=4`);
  const again = Buffer.from(await same.arrayBuffer());
  assert.ok(bytes.equals(again), 'the same question gives the same picture');
  const comment = (jpeg) => jpeg.subarray(6, 4 + jpeg.readUInt16BE(4)).toString();
  assert.equal(bytes.readUInt16BE(2), 0xfffe, 'a comment comes first');
  assert.match(comment(bytes),
      /^4 samples a pixel by path, (denoised by the network base|not denoised)$/);
  const plain = Buffer.from(await (await get(
      `${path}?viewpoint=hall&width=96&height=64&spp=4&denoise=0`)).arrayBuffer());
  assert.match(comment(plain), /^4 samples a pixel by path, not denoised$/);
  assert.equal(plain.subarray(50).equals(bytes.subarray(50)), !comment(bytes).includes('network'));
  for (const query of ['width=0', 'width=99999', 'height=-4', 'spp=zero', 'spp=1e9', 'denoise=2',
      'width=3840&height=3840&spp=1024'])
    assert.equal((await get(`${path}?${query}`)).status, 400, query);
  assert.equal((await get(`${path}?viewpoint=moon`)).status, 404);
});

test('pages, their types, their caching and their policy', async () => {
  for (const [path, type] of [['/', 'text/html'], ['/kiosk', 'text/html'], ['/status', 'text/html'],
      ['/visit.js', 'text/javascript'], ['/style.css', 'text/css'],
      ['/icon.svg', 'image/svg+xml']]) {
    const reply = await get(path);
    assert.equal(reply.status, 200, path);
    assert.ok(reply.headers.get('content-type').startsWith(type), path);
    assert.equal(reply.headers.get('x-content-type-options'), 'nosniff');
    assert.match(reply.headers.get('content-security-policy'), /default-src 'none'/);
    await reply.arrayBuffer();
    const again = await get(path, { headers: { 'if-none-match': reply.headers.get('etag') } });
    assert.equal(again.status, 304, path);
  }
});

test('what is not there, and what may not be asked', async () => {
  assert.equal((await get('/nothing')).status, 404);
  assert.equal((await get('/api/v1/exhibits/castle/secret')).status, 404);
  for (const method of ['POST', 'PUT', 'DELETE'])
    assert.equal((await get('/', { method })).status, 405, method);
  const head = await get('/', { method: 'HEAD' });
  assert.equal(head.status, 200);
  assert.equal((await head.text()).length, 0);
});

test('no path leaves the pages', async () => {
  for (const path of ['/../../etc/passwd', '/%2e%2e/%2e%2e/etc/passwd', '/%252e%252e/etc/passwd',
      '/..%2f..%2fetc/passwd', '//etc/passwd', '/..\\..\\etc\\passwd', '/%00', '/visit.js%00.html',
      '/.git/config', '/../CMakeLists.txt']) {
    const host = `127.0.0.1:${server.port}`;
    const line = await raw(`GET ${path} HTTP/1.1\r\nHost: ${host}\r\nConnection: close\r\n\r\n`);
    assert.match(line, /^HTTP\/1\.1 40[04] /, path);
  }
});

test('broken requests do not harm', async () => {
  for (const text of ['\r\n\r\n', 'GET\r\n\r\n', 'GET / HTTP/9.9\r\n\r\n',
      `GET / HTTP/1.1\r\nHost: x\r\nX: ${'a'.repeat(100000)}\r\n\r\n`,
      Buffer.from([0x16, 3, 1, 2, 0, 1, 0, 1, 0xfc, 3, 3]),
      'POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999999\r\n\r\n'])
    await raw(text).catch(() => {});
  assert.equal((await get('/healthz')).status, 200);
});
