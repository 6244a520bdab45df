// SPDX-License-Identifier: Apache-2.0
// HTTP as scripts and browsers use it, and as attackers do.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import http from 'node:http';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { gunzipSync } from 'node:zlib';
import { Visitor, patience, run, source, start_server } from '../server.mjs';

const token = 'a token of the tests';
let server;
before(async () => {
  process.env.WELLSPRING_ADMIN_TOKEN = token;
  server = await start_server();
  delete process.env.WELLSPRING_ADMIN_TOKEN;
});
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
    socket.setTimeout(20000 * patience, () => socket.destroy());
  });
}

// Returns the reply as it is on the line; fetch() would unpack it.
function on_the_line(path, headers = {}, method = 'GET') {
  return new Promise((resolve, reject) => {
    http.request(server.url + path, { method, headers, agent: false }, (reply) => {
      const parts = [];
      reply.on('data', (part) => parts.push(part));
      reply.on('end', () => resolve({ status: reply.statusCode, headers: reply.headers,
        body: Buffer.concat(parts) }));
    }).on('error', reject).end();
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
      /^4 samples a pixel by gather, (denoised by the network base|not denoised: .*)$/);
  const plain = Buffer.from(await (await get(
      `${path}?viewpoint=hall&width=96&height=64&spp=4&denoise=0`)).arrayBuffer());
  assert.match(comment(plain), /^4 samples a pixel by gather, not denoised$/);
  assert.equal(plain.subarray(50).equals(bytes.subarray(50)), !comment(bytes).includes('network'));
  // The example of README.md: however slow the machine is, it comes, and says what it has.
  const example = await get(`${path}?viewpoint=hall&width=1280&height=720&spp=16`);
  assert.equal(example.status, 200);
  const samples = Number(example.headers.get('still-samples'));
  assert.ok(samples >= 1 && samples <= 16, `${samples}`);
  assert.match(example.headers.get('still-denoised'),
      /^(yes|no; the network's weights are missing)$/);
  const has = comment(Buffer.from(await example.arrayBuffer()));
  assert.match(has, new RegExp(`^${samples} samples a pixel by gather, `));
  for (const query of ['width=0', 'width=99999', 'height=-4', 'spp=zero', 'spp=1e9', 'denoise=2',
      'seconds=0', 'seconds=long'])
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

test('text goes as gzip to those who take it, and is the same', async () => {
  const gzip = { 'accept-encoding': 'gzip, deflate, br' };
  for (const path of ['/', '/read', '/visit.js', '/copy.js', '/style.css', '/icon.svg', '/no.html',
      '/api/v1/', '/api/v1/exhibits/castle', '/api/v1/exhibits/castle/map']) {
    const accept = path === '/no.html' ? { accept: 'text/html' } : {};
    const plain = await on_the_line(path, accept);
    const packed = await on_the_line(path, { ...accept, ...gzip });
    assert.equal(packed.status, plain.status, path);
    assert.equal(packed.headers['content-encoding'], 'gzip', path);
    assert.equal(plain.headers['content-encoding'], undefined, path);
    assert.ok(packed.body.length < plain.body.length, path);
    assert.ok(gunzipSync(packed.body).equals(plain.body), path);
    for (const { headers, body } of [plain, packed]) {
      assert.match(headers.vary, /\bAccept-Encoding$/, path);
      assert.equal(Number(headers['content-length']), body.length, path);
    }
    const head = await on_the_line(path, { ...accept, ...gzip }, 'HEAD');
    for (const name of ['content-encoding', 'content-length', 'content-type', 'etag', 'vary'])
      assert.equal(head.headers[name], packed.headers[name], `${name} of ${path}`);
    assert.equal(head.body.length, 0);
  }
  const map = await on_the_line('/api/v1/exhibits/castle/map', gzip);
  assert.ok(map.body.length < 5000, `${map.body.length} bytes`);
});

test('each form of a text has a tag of its own', async () => {
  const gzip = { 'accept-encoding': 'gzip' }, path = '/visit.js';
  const plain = await on_the_line(path), packed = await on_the_line(path, gzip);
  const tags = [plain, packed].map(({ headers }) => headers.etag);
  assert.notEqual(tags[0], tags[1]);
  const status = async (tag, headers) =>
    (await on_the_line(path, { 'if-none-match': tag, ...headers })).status;
  assert.deepEqual([await status(tags[0]), await status(tags[1])], [304, 200]);
  assert.deepEqual([await status(tags[0], gzip), await status(tags[1], gzip)], [200, 304]);
  assert.equal(await status(`W/${tags[1]}`, gzip), 304, 'as a proxy may have weakened it');
  const known = await on_the_line(path, { 'if-none-match': tags[1], ...gzip });
  assert.deepEqual([known.headers.etag, known.headers.vary, known.headers['content-encoding']],
      [tags[1], 'Accept-Encoding', undefined]);
});

test('what is no text, or not wanted as gzip, goes as it is', async () => {
  const script = readFileSync(join(source, 'web', 'visit.js'));
  for (const header of ['identity', 'br', 'gzip;q=0', 'gzip;q=0, *', '*;q=0', 'gzip;q=many',
      'gzip;q=0.5, identity']) {
    const reply = await on_the_line('/visit.js', { 'accept-encoding': header });
    assert.equal(reply.headers['content-encoding'], undefined, header);
    assert.ok(reply.body.equals(script), header);
  }
  const all = { 'accept-encoding': '*' };
  const picture = '/api/v1/exhibits/castle/files/book/plan.jpg';
  for (const path of ['/kiosk/well.jpg', picture, '/healthz']) {
    const { headers } = await on_the_line(path, all);
    assert.deepEqual([headers['content-encoding'], headers.vary], [undefined, undefined], path);
  }
  const part = await on_the_line(picture, { ...all, range: 'bytes=10-19' });
  assert.deepEqual([part.status, part.body.length], [206, 10]);
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

const announce = (body, { headers = {}, on = server, method = 'POST' } = {}) =>
  fetch(`${on.url}/api/v1/admin/announce`, { method,
    body: typeof body === 'string' ? body : JSON.stringify(body),
    headers: { 'content-type': 'application/json', authorization: `Bearer ${token}`,
      ...headers } });

test('announcements reach visitors and kiosks, and those that come later', async () => {
  const visitor = new Visitor(server), kiosk = new Visitor(server);
  await visitor.hello();
  await kiosk.hello({ role: 'kiosk' });
  const heard = [visitor, kiosk].map((page) => page.message('announce'));
  const text = { en: 'We close in ten minutes.', sk: 'O desať minút zatvárame.' };
  const reply = await announce({ text, seconds: 600, urgent: true });
  assert.equal(reply.status, 200);
  const { id } = await reply.json();
  for (const said of await Promise.all(heard))
    assert.deepEqual(said, { type: 'announce', id, text, seconds: 600, urgent: true });
  const later = new Visitor(server), told = later.message('announce');
  await later.hello();
  const { seconds, ...rest } = await told;
  assert.deepEqual(rest, { type: 'announce', id, text, urgent: true });
  assert.ok(seconds > 0 && seconds <= 600);
  const back = visitor.message('announce', (message) => message.id > id);
  assert.equal((await announce({ text: '' })).status, 200);
  assert.deepEqual((await back).text, {});
  assert.match(await (await get('/metrics')).text(), /^wellspring_house_open 1$/m);
  assert.ok(!server.log().includes(token));
  await Promise.all([visitor, kiosk, later].map((page) => page.close()));
});

test('only who has the token announces, and only what is right', async () => {
  const text = 'Hello.';
  for (const authorization of ['', 'Bearer', `Bearer ${token}x`, `Basic ${token}`, token]) {
    const reply = await announce({ text }, { headers: { authorization } });
    assert.equal(reply.status, 401, authorization);
    assert.equal(reply.headers.get('www-authenticate'), 'Bearer');
  }
  for (const [body, names] of [[{}, 'text'], [{ text, seconds: 0 }, 'seconds'],
      [{ text, urgent: 'yes' }, 'urgent'], [{ text, loud: 1 }, 'loud'], ['{', 'JSON']]) {
    const reply = await announce(body);
    assert.equal(reply.status, 400);
    const { error } = await reply.json();
    assert.ok(error.message.includes(names), error.message);
  }
  assert.equal((await announce('x'.repeat(17000))).status, 413);
  const other = { headers: { 'content-type': 'text/plain' } };
  assert.equal((await announce({ text }, other)).status, 415);
  const evil = { headers: { origin: 'http://evil.example' } };
  assert.equal((await announce({ text }, evil)).status, 403);
  const read = await get('/api/v1/admin/announce');
  assert.equal(read.status, 405);
  assert.equal(read.headers.get('allow'), 'POST');
  const api = await (await get('/api/v1/')).json();
  assert.ok(api.paths.some(({ method, path }) =>
    method === 'POST' && path === '/api/v1/admin/announce'));
});

test('without a token nobody announces; a closed house says so', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
  const file = (name, content) => {
    writeFileSync(join(folder, name), content);
    return join(folder, name);
  };
  const house = file('house.json', JSON.stringify({ hours: {}, kiosks: [{ name: 'hall' }] }));
  const closed = await start_server(['--house', house]);
  try {
    const reply = await announce({ text: 'Hello.' }, { on: closed });
    assert.equal(reply.status, 403);
    assert.match((await reply.json()).error.message, /WELLSPRING_ADMIN_TOKEN/);
    const kiosk = new Visitor(closed), told = kiosk.message('house');
    await kiosk.hello({ role: 'kiosk' });
    assert.equal((await told).open, false);
    const metrics = await (await fetch(`${closed.url}/metrics`)).text();
    assert.match(metrics, /^wellspring_house_open 0$/m);
    await kiosk.close();
  } finally {
    await closed.stop();
  }
  const bad = file('bad.json', JSON.stringify({ hours: { mon: ['9', '17'] }, volume: 2 }));
  const refused = await run('wellspring_server', ['--content', join(source, 'content'), '--web',
    join(source, 'web'), '--port', '0', '--house', bad]);
  assert.equal(refused.status, 1);
  for (const place of ['bad.json: /hours/mon', 'bad.json: /volume'])
    assert.ok(refused.stderr.includes(place), refused.stderr);
  const short = await run('wellspring_server', ['--admin-token-file', file('token', 'short\n')]);
  assert.equal(short.status, 1);
  assert.match(short.stderr, /16 characters/);
  assert.ok(!short.stderr.includes('short'));
  rmSync(folder, { recursive: true });
});

test('the book, and the files that it names', async () => {
  const { book } = await (await get('/api/v1/exhibits/castle')).json();
  assert.ok(book.topics.length >= 4);
  assert.ok(book.partners.length >= 2);
  assert.equal(book.presentations.length, 3);
  const things = [...book.topics, ...book.partners];
  for (const { slides } of book.presentations) things.push(...slides);
  const types = { jpg: 'image/jpeg', webm: 'video/webm' };
  for (const thing of things) {
    const path = thing.image ?? thing.video;
    assert.ok(path.startsWith('/api/v1/exhibits/castle/files/'), path);
    for (const lang of ['en', 'de', 'sk']) assert.ok(thing.alt[lang], `${path} in ${lang}`);
    const reply = await get(path);
    assert.equal(reply.status, 200, path);
    assert.equal(reply.headers.get('content-type'), types[path.split('.').pop()], path);
    const body = await reply.arrayBuffer();
    assert.equal(Number(reply.headers.get('content-length')), body.byteLength);
    const again = await get(path, { headers: { 'if-none-match': reply.headers.get('etag') } });
    assert.equal(again.status, 304, path);
  }
});

test('parts of a film, as browsers ask for them', async () => {
  const { book } = await (await get('/api/v1/exhibits/castle')).json();
  const path = book.presentations.flatMap(({ slides }) => slides).find(({ video }) => video).video;
  const whole = await get(path);
  assert.equal(whole.headers.get('accept-ranges'), 'bytes');
  const etag = whole.headers.get('etag'), all = Buffer.from(await whole.arrayBuffer());
  const part = async (range, more = {}) => {
    const reply = await get(path, { headers: { range, ...more } });
    return [reply.status, reply.headers.get('content-range'),
      Buffer.from(await reply.arrayBuffer())];
  };
  const size = all.length;
  for (const [range, begin, end] of [['bytes=0-', 0, size], ['bytes=1000-1999', 1000, 2000],
      ['bytes=-7', size - 7, size], [`bytes=${size - 1}-${size + 5}`, size - 1, size]]) {
    const [status, where, bytes] = await part(range, { 'if-range': etag });
    assert.equal(status, 206, range);
    assert.equal(where, `bytes ${begin}-${end - 1}/${size}`);
    assert.ok(bytes.equals(all.subarray(begin, end)), range);
  }
  const [status, where] = await part(`bytes=${size}-`);
  assert.deepEqual([status, where], [416, `bytes */${size}`]);
  const [other, , bytes] = await part('bytes=5-9', { 'if-range': '"of another"' });
  assert.equal(other, 200);
  assert.ok(bytes.equals(all));
  const head = await get(path, { method: 'HEAD' });
  assert.equal(Number(head.headers.get('content-length')), size);
});

test('no other file of a package can be asked for', async () => {
  const files = '/api/v1/exhibits/castle/files/';
  for (const name of ['exhibit.json', 'scene.glb', 'book/paper.py', 'book/', 'book', '',
      'book/../exhibit.json', 'book/%2e%2e/exhibit.json', 'book/%252e%252e/exhibit.json',
      '..%2f..%2f..%2fetc%2fpasswd', '/etc/passwd', '%2fetc%2fpasswd', 'book//plan.jpg',
      './book/plan.jpg', 'book\\plan.jpg', 'book/plan.jpg%00', 'book/plan.jpg/', 'BOOK/PLAN.JPG']) {
    const host = `127.0.0.1:${server.port}`;
    const line = await raw(
        `GET ${files}${name} HTTP/1.1\r\nHost: ${host}\r\nConnection: close\r\n\r\n`);
    assert.match(line, /^HTTP\/1\.1 40[04] /, name);
  }
  assert.equal((await get(`${files}book/plan.jpg`)).status, 200);
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
