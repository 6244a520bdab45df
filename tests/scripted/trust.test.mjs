// SPDX-License-Identifier: Apache-2.0
// Who is trusted: kiosks on other machines, those who read how the server is, and what strangers
// are told. Requests that come through a proxy are from elsewhere, however near the proxy is.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, WebSocket, run, start_server, until } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-trust-'));
const content = join(folder, 'content');
const admin = 'the admin token of this test', house = 'a-token-for-any-kiosk',
    hall = 'a-token-for-the-hall';
const file = (name, text) => {
  writeFileSync(join(folder, name), text, { mode: 0o600 });
  return join(folder, name);
};
const elsewhere = { 'X-Forwarded-For': '192.0.2.7' };
const secret = (token) => ({ ...elsewhere, Authorization: `Bearer ${token}` });

let server;
before(async () => {
  const made = await run('wellspring_new', ['giza', write_pyramid(folder), '--content', content]);
  assert.equal(made.status, 0, made.stderr);
  process.env.WELLSPRING_ADMIN_TOKEN = admin;
  server = await start_server(['--sums', join(folder, 'sums.sqlite'), '--kiosk-token-file',
    file('kiosks', `# of this test\n${house}\nhall ${hall}\n`)], { content });
  delete process.env.WELLSPRING_ADMIN_TOKEN;
});
after(async () => {
  if (server) assert.equal(await server.stop(), 0);
  rmSync(folder, { recursive: true, force: true });
});
const ask = async (path, headers = {}, from = server) => {
  const reply = await fetch(from.url + path, { headers });
  return { status: reply.status, text: await reply.text() };
};
const metric = async (pattern) =>
  Number(new RegExp(`^wellspring_${pattern} (\\S+)$`, 'm').exec((await ask('/metrics')).text)?.[1]);

// An eye's connection: the status of its handshake, 101 where it is let in.
function knock(headers) {
  const socket = new WebSocket(`${server.ws}/api/v1/eye`, { headers });
  return new Promise((resolve) => {
    socket.on('open', () => resolve({ status: 101, socket }));
    socket.on('error', () => {});
    socket.on('unexpected-response', (request, reply) => {
      let text = '';
      reply.on('data', (chunk) => { text += chunk; });
      reply.on('end', () => resolve({ status: reply.statusCode, text }));
    });
  });
}
const person = (more = {}) => JSON.stringify({ type: 'observation', time: 1, presence: true,
  state: 'person', people: [{ id: 1, position: [0, 0, 1], rotation: [0, 0, 0], confidence: 1 }],
  ...more });

test('strangers cannot invent people, and fifty who try cost nothing', async () => {
  const watcher = new Visitor(server);
  await watcher.hello();
  const all = await Promise.all(Array.from({ length: 50 }, () => knock(elsewhere)));
  assert.deepEqual(all.map(({ status }) => status), Array(50).fill(401));
  const { error } = JSON.parse(all[0].text);
  assert.equal(error.code, 'not_trusted');
  assert.match(error.message, /WELLSPRING_KIOSK_TOKEN/);
  for (const wrong of [`${house}x`, admin, 'hall'])
    assert.equal((await knock(secret(wrong))).status, 401);
  assert.equal(await metric('kiosk_cameras'), 0);
  assert.equal(await metric('websockets_total'), 1);
  await watcher.picture();
  await watcher.close();
});

test('a camera with a token is believed, for its own kiosk alone', async (context) => {
  const { status, socket } = await knock(secret(hall));
  assert.equal(status, 101);
  const stage = (kiosk) => metric(`kiosk_stage\\{kiosk="${kiosk}",stage="person"\\}`);
  let told = '';
  socket.on('message', (text) => { told += text; });
  socket.send(person({ kiosk: 'yard' }));
  await until(() => told.includes('not_trusted'), 'it is told');
  assert.ok(Number.isNaN(await stage('yard')), 'there is no such kiosk');
  const timer = setInterval(() => socket.send(person()), 100);
  context.after(() => clearInterval(timer));
  await until(async () => await stage('hall') === 1, 'a person in the hall');
  socket.close();
  for (const headers of [secret(house), {}]) {  // or from this machine
    const one = await knock(headers);
    assert.equal(one.status, 101);
    one.socket.close();
  }
});

// A stranger's page: a visit that comes by a proxy.
async function page(hello) {
  const socket = new WebSocket(`${server.ws}/api/v1/visit`, 'wellspring.v1',
      { headers: elsewhere });
  await new Promise((resolve) => socket.on('open', resolve));
  const answer = new Promise((resolve) => socket.on('message', (text, binary) => {
    const message = binary ? {} : JSON.parse(text);
    if (['welcome', 'error'].includes(message.type)) resolve(message);
  }));
  socket.send(JSON.stringify({ type: 'hello', width: 64, height: 64, ...hello }));
  const { type, code } = await answer;
  socket.close();
  return code ?? type;
}

test('a page elsewhere is a kiosk by its token alone', async () => {
  const kiosk = (more) => page({ role: 'kiosk', ...more });
  assert.equal(await kiosk({}), 'not_trusted');
  assert.equal(await kiosk({ kiosk: 'hall', token: `${hall}x` }), 'not_trusted');
  assert.equal(await kiosk({ kiosk: 'yard', token: hall }), 'not_trusted');
  assert.equal(await kiosk({ kiosk: 'hall', token: hall }), 'welcome');
  assert.equal(await kiosk({ kiosk: 'yard', token: house }), 'welcome');
  assert.equal(await page({ role: 'visitor' }), 'welcome');
});

// Hands bytes on, and says in the first request for whom, as proxies do: its port.
function start_proxy(context) {
  const proxy = net.createServer((client) => {
    const target = net.connect(server.port, '127.0.0.1');
    client.once('data', (chunk) => {
      target.write(chunk.toString('latin1').replace('\r\n',
          '\r\nX-Forwarded-For: 192.0.2.7\r\n'), 'latin1');
      client.pipe(target);
    });
    target.pipe(client);
    for (const [one, other] of [[client, target], [target, client]])
      one.on('error', () => other.destroy());
  });
  context.after(() => proxy.close());
  return new Promise((resolve) => proxy.listen(0, '127.0.0.1', () =>
    resolve(proxy.address().port)));
}

test('the kiosk program shows its token, and says what it lacks', async (context) => {
  const port = await start_proxy(context);
  const start = (args, env = {}) => {
    const child = spawn(join(process.env.WELLSPRING_BIN, 'wellspring_kiosk'),
        ['--camera', 'synthetic-live', '--loop', '--server', `ws://127.0.0.1:${port}`, ...args],
        { stdio: ['ignore', 'ignore', 'pipe'], env: { ...process.env, ...env } });
    context.after(() => child.kill('SIGKILL'));
    const one = { child, log: '' };
    child.stderr.on('data', (chunk) => { one.log += chunk; });
    return one;
  };
  const stop = async ({ child }) => {
    const ended = new Promise((resolve) => child.on('close', resolve));
    child.kill('SIGTERM');
    await ended;
  };
  const bare = start([]);
  await until(() => bare.log.includes('--token-file FILE'), 'it says what it lacks');
  await stop(bare);
  const wrong = start(['--token-file', file('wrong', 'this-is-another-token')]);
  await until(() => wrong.log.includes('does not know this kiosk token'), 'it is unknown');
  await stop(wrong);
  const right = start(['--config', file('kiosk.json',
      JSON.stringify({ token_file: file('right', `${hall}\n`) }))]);
  await until(async () => await metric('kiosk_cameras') === 1, 'it is let in');
  await stop(right);
  await until(async () => await metric('kiosk_cameras') === 0, 'it has gone');
  const by_environment = start([], { WELLSPRING_KIOSK_TOKEN: hall });
  await until(async () => await metric('kiosk_cameras') === 1, 'it is let in');
  for (const what of ['cmdline', 'environ']) {
    const text = readFileSync(`/proc/${by_environment.child.pid}/${what}`, 'latin1');
    assert.ok(!text.includes(hall), what);
  }
  for (const { log } of [bare, wrong, right, by_environment])
    for (const token of [hall, 'this-is-another-token']) assert.ok(!log.includes(token));
  await stop(by_environment);
});

test('how the server is, is told here and to who has the token', async () => {
  for (const path of ['/metrics', '/api/v1/status', '/api/v1/speeds', '/api/v1/sums.csv']) {
    assert.equal((await ask(path)).status, 200, path);
    assert.equal((await ask(path, secret(admin))).status, 200, path);
    for (const headers of [elsewhere, { Forwarded: 'for=192.0.2.7' }, { 'X-Real-IP': '::1' },
      { Via: '1.1 proxy' }, secret(house), secret(`${admin}x`)]) {
      const refused = await ask(path, headers);
      assert.equal(refused.status, 401, `${path} ${JSON.stringify(headers)}`);
      assert.equal(JSON.parse(refused.text).error.code, 'wrong_token');
    }
  }
  // A page of somebody else whose name leads here.
  const rebound = await new Promise((resolve) => {
    const socket = net.connect(server.port, '127.0.0.1', () =>
      socket.write('GET /metrics HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n'));
    let text = '';
    socket.on('data', (chunk) => { text += chunk; });
    socket.on('close', () => resolve(text));
  });
  assert.match(rebound, /^HTTP\/1\.1 4(01|03|21) /);
  assert.deepEqual(JSON.parse((await ask('/healthz', elsewhere)).text), { status: 'ok' });
  assert.equal((await ask('/status', elsewhere)).status, 200, 'the page asks for the token');
});

test('without a token it is told here alone, unless it is open', async () => {
  const bare = await start_server(['--exhibit', 'giza'], { content });
  const refused = await ask('/metrics', elsewhere, bare);
  assert.equal(refused.status, 401);
  assert.match(JSON.parse(refused.text).error.message, /WELLSPRING_ADMIN_TOKEN/);
  assert.equal((await ask('/metrics', {}, bare)).status, 200);
  await bare.stop();
  const open = await start_server(['--exhibit', 'giza', '--open-status'], { content });
  assert.equal((await ask('/api/v1/status', elsewhere, open)).status, 200);
  await open.stop();
});

test('who sends too much is counted, and said in words', async (context) => {
  const visitor = new Visitor(server);
  await visitor.opened;
  const flood = () => {
    for (let i = 0; i < 2000 && visitor.socket.readyState === WebSocket.OPEN; i++)
      visitor.socket.ping();
  };
  const timer = setInterval(flood, 5);
  context.after(() => clearInterval(timer));  // a failed test ends, too
  assert.equal((await visitor.closed).code, 1008);
  assert.equal(await metric('floods_closed_total'), 1);
  assert.equal(await metric('accept_errors_total'), 0);
  await until(async () => JSON.parse((await ask('/api/v1/status')).text).findings.some(({ what }) =>
    what === '1 connection was closed for sending too much'), 'it is said');
});

test('no log, command line or environment tells a token', () => {
  assert.match(server.log(), /joined from/);
  const texts = [server.log(), ...['cmdline', 'environ'].map((what) =>
    readFileSync(`/proc/${server.child.pid}/${what}`, 'latin1'))];
  for (const token of [admin, house, hall])
    for (const text of texts) assert.ok(!text.includes(token));
});

test('a wrong file of tokens is named with its line, and nothing starts', async () => {
  const bad = file('bad', `${house}\nhall short-secret\n`);
  for (const option of ['--kiosk-token-file', '--admin-token-file']) {
    const { status, stderr } = await run('wellspring_server', ['--content', content, option, bad]);
    assert.equal(status, 1);
    assert.ok(stderr.includes(`${bad}: line 2: a token has at least 16 characters`), stderr);
    assert.ok(!stderr.includes('short-secret'));
  }
});
