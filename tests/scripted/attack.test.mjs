// SPDX-License-Identifier: Apache-2.0
// Strangers who do what they like on the network, while a visitor watches and the machine's own
// health check asks. They come from other addresses of loopback than 127.0.0.1, which is trusted.
// WELLSPRING_SOAK=SECONDS makes crowds larger and lets each attack last that long.
import assert from 'node:assert/strict';
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import http from 'node:http';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, WebSocket, judges_memory, run, sleep, start_server, until as sooner_or_later }
  from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const soak = Number(process.env.WELLSPRING_SOAK ?? 0);  // seconds
const scale = soak ? 4 : 1;
const secret = 'a secret that no log may hold';
const places = 400 * scale;  // connections to the server, in all
const may_grow = 96;         // MiB, over all attacks together

const folder = mkdtempSync(join(tmpdir(), 'wellspring-attack-'));
const content = join(folder, 'content');
let server, watcher, descriptors_at_first, memory_at_first;

before(async () => {
  const made = await run('wellspring_new', ['giza', write_pyramid(folder), '--content', content]);
  assert.equal(made.status, 0, made.stderr);
  process.env.WELLSPRING_ADMIN_TOKEN = secret;
  process.env.WELLSPRING_LOG = 'debug';
  server = await start_server(['--exhibit', 'giza', '--max-visitors', '16', '--max-connections',
    String(places), '--no-bake'], { content });
  delete process.env.WELLSPRING_ADMIN_TOKEN;
  delete process.env.WELLSPRING_LOG;
  watcher = new Visitor(server);
  await watcher.hello();
  watcher.send({ type: 'input', seq: 1, move: [0, 0, 0], look: [0.2, 0] });
  await watcher.picture((picture) => picture.seq === 1);
  descriptors_at_first = descriptors();
  memory_at_first = await metric('resident_bytes');
});
after(async () => {
  if (server) assert.equal(await server.stop(), 0);
  rmSync(folder, { recursive: true, force: true });
});

const descriptors = () => readdirSync(`/proc/${server.child.pid}/fd`).length;
async function metric(name) {
  const text = await (await fetch(`${server.url}/metrics`)).text();
  return Number(new RegExp(`^wellspring_${name}(?:\\{.*\\})? (\\S+)$`, 'm').exec(text)[1]);
}
async function until(holds, what) {
  const said = () => server.log().split('\n').filter((line) => !/debug/.test(line)).slice(-20);
  await sooner_or_later(holds, () => `${what}\n${said().join('\n')}`);
}

// A socket from `address` that says `bytes` and reads what comes: {socket, reply(), ended}.
function stranger(address, bytes = '') {
  const socket = net.connect({ port: server.port, host: '127.0.0.1', localAddress: address });
  let reply = '';
  socket.on('data', (chunk) => { reply += chunk.toString('latin1'); });
  socket.on('error', () => {});
  const ended = new Promise((resolve) => socket.on('close', resolve));
  const one = { socket, reply: () => reply, ended, over: false };
  ended.then(() => { one.over = true; });
  one.said = Promise.race([ended,
    new Promise((resolve) => socket.on('connect', () => socket.write(bytes, resolve)))]);
  return one;
}
const upgrade = (path) => `GET ${path} HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\n` +
  'Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n' +
  'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n';
const masked = (first, text) =>
  Buffer.concat([Buffer.from([first, 0x80 | text.length, 0, 0, 0, 0]), Buffer.from(text)]);
const many = (count, make) => Array.from({ length: count }, (_, i) => make(i));
const end_all = async (list) => {
  for (const { socket } of list) socket.destroy();
  await Promise.all(list.map(({ ended }) => ended));
};

// The visitor who was there goes on, the health check is answered, and who comes is let in, also
// from `address`.
async function others_go_on(address = '127.0.0.77') {
  assert.equal((await fetch(`${server.url}/healthz`)).status, 200);
  const seq = ++watcher.seq || (watcher.seq = 2);
  const next = watcher.picture((picture) => picture.seq === seq);
  watcher.send({ type: 'input', seq, move: [0, 0, 0], look: [0.1, 0] });
  await next;
  const newcomer = new Visitor(server, { options: { localAddress: address } });
  const welcome = newcomer.next((item) => item.message?.type === 'welcome', 'welcome');
  await newcomer.opened;
  newcomer.send(
      { type: 'hello', exhibit: '', width: 160, height: 90, lang: 'en', role: 'visitor' });
  await welcome;
  await newcomer.close();
}
const last = () => sleep(soak * 1000);

test('a name that was made to lead here gets nothing, though its page agrees', async () => {
  const host = `evil.example:${server.port}`;
  const status = (options) => new Promise((resolve, reject) => http.get(
      { port: server.port, host: '127.0.0.1', agent: false, ...options }, (reply) => {
        reply.resume();
        resolve(reply.statusCode);
      }).on('error', reject));
  for (const path of ['/', '/healthz', '/metrics', '/status', '/api/v1/exhibits'])
    assert.equal(await status({ path, headers: { host } }), 421, path);
  assert.equal(await status({ path: '/', headers: { host: `127.0.0.1:${server.port}` } }), 200);
  const socket = new WebSocket(`${server.ws}/api/v1/visit`, 'wellspring.v1',
      { origin: `http://${host}`, headers: { host } });
  await assert.rejects(new Promise((resolve, reject) => {
    socket.on('open', resolve);
    socket.on('error', reject);
  }), /421/);
  assert.match(server.log(), /--allow-host evil\.example/);
});

test('who never says hello takes no place among visitors', async () => {
  const silent = many(100, () => stranger('127.0.0.2', upgrade('/api/v1/visit')));
  await until(() => silent.every((one) => one.reply().includes(' 101 ')), 'all are let in');
  await others_go_on('127.0.0.2');
  await end_all(silent);
});

test('eyes of one address take no places of others', async () => {
  const eyes = many(300, () => stranger('127.0.0.3', upgrade('/api/v1/eye')));
  await until(() => eyes.every((one) => one.over || one.reply()), 'each is answered or closed');
  const let_in = eyes.filter((one) => one.reply().includes(' 101 ')).length;
  assert.ok(let_in > 0 && let_in <= 128, `${let_in} eyes`);
  assert.ok(eyes.some((one) => one.reply().includes(' 429 ')));
  await others_go_on();
  const own = new Visitor(server, { path: '/api/v1/eye' });
  await own.opened;
  await own.close();
  await end_all(eyes);
});

let silent;  // until the last test
test('requests that never end make place for others', async () => {
  const slow = [];
  for (let i = 0; i < places + 100; i++)  // more than there are places, from ten addresses
    slow.push(stranger(`127.0.1.${i % 10}`, 'GET / HTTP/1.1\r\nHost: localhost\r\nX-'));
  await Promise.all(slow.map((one) => one.said));
  await until(async () => await metric('connections_dropped_total') > 0, 'some made place');
  await others_go_on();
  await others_go_on('127.0.1.1');
  await last();
  await end_all(slow);
  silent = many(10, () => stranger('127.0.0.2', upgrade('/api/v1/visit')));
});

test('empty fragments and senseless messages are a flood', async () => {
  const floods = await metric('floods_closed_total');
  const empty = Buffer.concat([masked(1, ''), ...many(50000, () => masked(0, ''))]);
  const senseless = Buffer.concat(many(10000, (i) => masked(0x81, `{"type":${i}`)));
  const pings = Buffer.concat(many(50000, () => masked(0x89, '')));
  const began = performance.now();
  do {
    const bad = [empty, senseless, pings].flatMap((bytes) =>
      many(4 * scale, (i) => ({ bytes, ...stranger(`127.0.2.${i}`, upgrade('/api/v1/visit')) })));
    for (const one of bad) one.socket.once('data', () => one.socket.write(one.bytes));
    await others_go_on();
    await until(async () => await metric('floods_closed_total') >= floods + bad.length,
        'each is closed');
    await Promise.all(bad.map((one) => one.ended));
  } while (performance.now() < began + soak * 1000);
});

// Each says less than one peer may; together it is more than an address may say.
test('large texts are not read, and too many of them from one address are a flood', async () => {
  const floods = await metric('floods_closed_total');
  const arrays = `{"type":"input","seq":1,"x":[${'[],'.repeat(20999)}[]]}`;
  assert.ok(arrays.length < 64 * 1024);
  const wordy = many(12, () => new Visitor(server, { options: { localAddress: '127.0.6.1' } }));
  const told = wordy[0].message('error', ({ code }) => code === 'too_large');
  for (const one of wordy) await one.hello({ width: 16, height: 16 });
  for (const one of wordy)
    for (let i = 0; i < 25; i++) one.send(arrays);
  await told;
  await until(async () => await metric('floods_closed_total') > floods, 'some are closed');
  await others_go_on();
  for (const one of wordy) one.socket.terminate();
});

test('beside visitors who stop reading others still get pictures', async () => {
  const lazy = many(8, (i) =>
    new Visitor(server, { acknowledge: false, options: { localAddress: `127.0.3.${i}` } }));
  for (const one of lazy) {
    await one.hello();
    one.socket._socket.pause();
  }
  await others_go_on();
  await last();
  for (const one of lazy) one.socket.terminate();
});

test('clients that are killed in any state leave nothing behind', async () => {
  for (const signals of [['SIGKILL'], ['SIGSTOP', 'SIGKILL']]) {  // stopped: nobody answers
    const program = join(process.env.WELLSPRING_SOURCE, 'tests/scripted/clients_in_states.mjs');
    const child = spawn(process.execPath, [program, server.port],
        { stdio: ['ignore', 'pipe', 'inherit'] });
    await new Promise((resolve) => child.stdout.once('data', resolve));
    await sleep(300);
    for (const signal of signals) {
      child.kill(signal);
      await others_go_on();
      if (signal === 'SIGSTOP') await sleep(soak ? 45000 : 500);
    }
  }
});

test('without descriptors nobody new comes in, and then again', async () => {
  const { pid } = server.child;
  const before = execFileSync('prlimit', ['--pid', pid, '--nofile', '--noheadings', '--raw',
    '--output', 'SOFT,HARD']).toString().trim().split(/\s+/).join(':');
  execFileSync('prlimit', ['--pid', pid, `--nofile=${descriptors() + 1}:${before.split(':')[1]}`]);
  const waiting = many(10, (i) =>
    stranger(`127.0.5.${i}`, 'GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n'));
  await until(() => /Too many open files/.test(server.log()), 'it is said');
  const seq = ++watcher.seq;
  const next = watcher.picture((picture) => picture.seq === seq);
  watcher.send({ type: 'input', seq, move: [0, 0, 0], look: [0.1, 0] });
  await next;
  execFileSync('prlimit', ['--pid', pid, `--nofile=${before}`]);
  await until(() => waiting.every((one) => one.reply().includes(' 200 ')), 'all are answered');
  await end_all(waiting);
  await others_go_on();
  assert.ok(await metric('accept_errors_total') > 0);
});

test('a server that was stopped for a while goes on', async () => {
  server.child.kill('SIGSTOP');
  await sleep(soak ? 20000 : 1000);
  server.child.kill('SIGCONT');
  await others_go_on();
});

test('a full disk is said, and harms no visit', async (t) => {
  const disk = mkdtempSync(join(folder, 'disk-'));
  const mount = `mount -t tmpfs -o size=64k tmpfs ${disk} && ` +
    `head -c 60000 /dev/zero > ${disk}/full`;
  if (spawnSync('unshare', ['-m', 'sh', '-c', mount]).status !== 0)
    return t.skip('only root may mount a small disk');
  const program = join(process.env.WELLSPRING_BIN, 'wellspring_server');
  const child = spawn('unshare', ['-m', 'sh', '-c', `${mount} && exec "$@"`, 'sh', program,
    '--exhibit', 'giza', '--port', '0', '--content', content,
    '--web', join(process.env.WELLSPRING_SOURCE, 'web'), '--sums', join(disk, 'sums.sqlite'),
    '--cache', join(disk, 'cache')], { stdio: ['ignore', 'pipe', 'pipe'] });
  let out = '', log = '';
  child.stderr.on('data', (chunk) => { log += chunk; });
  child.stdout.on('data', (chunk) => { out += chunk; });
  const ended = new Promise((resolve) => child.on('close', resolve));
  await until(() => /http:\S+:\d+\//.test(out) || child.exitCode !== null, 'it starts');
  const visitor = new Visitor({ ws: `ws:${/http:(\/\/\S+:\d+)\//.exec(out)[1]}` });
  await visitor.hello();
  await visitor.picture();
  await visitor.close();
  child.kill('SIGTERM');
  assert.equal(await ended, 0, log);
  assert.match(log, /sums/, 'what could not be written is named');
});

test('no secret is in the log, whatever is asked how', async () => {
  const authorization = `Bearer ${secret}`, encoded = encodeURIComponent(secret);
  for (const path of ['/', '/metrics', '/nothing', '/../x', '/api/v1/sums.csv', '/api/v1/visit',
    '/api/v1/admin/announce'])
    for (const [more, method] of [['', 'GET'], ['Host: evil.example\r\n', 'GET'], ['', 'POST'],
      ['X-Forwarded-For: 203.0.113.1\r\n', 'GET'], ['Content-Length: x\r\n', 'GET']]) {
      const one = stranger('127.0.0.1', `${method} ${path}?token=${encoded} HTTP/1.1\r\n` +
        `Host: localhost\r\nAuthorization: ${authorization}\r\nCookie: ${secret}\r\n${more}` +
        'Connection: close\r\n\r\n');
      await one.ended;
    }
  const visitor = new Visitor(server, { options: { headers: { authorization } } });
  await visitor.hello({ resume: secret });
  visitor.send({ type: secret });
  visitor.send(`{"type":"hello","resume":"${secret}`);
  await visitor.picture();
  await visitor.close();
  assert.match(server.log(), /debug .* GET \//, 'requests are in the log');
  for (const text of [secret, encoded, secret.replaceAll(' ', '+')])
    assert.ok(!server.log().includes(text), server.log().split('\n')
        .find((line) => line.includes(text)));
});

test('after all of it connections, descriptors and memory are given back', async () => {
  await until(() => silent.every((one) => one.over), 'who said nothing has been closed');
  assert.ok(silent.every((one) => one.reply().includes('no first message came')));
  await watcher.close();
  await until(async () => await metric('connections') <= 2, 'connections end');
  await until(() => descriptors() <= descriptors_at_first + 1, 'descriptors are given back');
  const grown = (await metric('resident_bytes') - memory_at_first) / 2 ** 20;
  const status = readFileSync(`/proc/${server.child.pid}/status`, 'utf8');
  console.log(JSON.stringify(
      { grown_mib: Math.round(grown), most: /VmHWM:\s+(.*)/.exec(status)[1] }));
  if (judges_memory) assert.ok(grown < may_grow, `memory grew by ${grown} MiB`);
  assert.equal(await metric('bad_samples_total'), 0);
});
