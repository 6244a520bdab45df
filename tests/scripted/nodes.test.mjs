// SPDX-License-Identifier: Apache-2.0
// Three equal servers behind HAProxy, as deploy/haproxy-nodes.cfg has it: visits outlive a server
// that dies, and one that is stopped. WELLSPRING_NODES_VISITORS: how many there are (6).
// WELLSPRING_NODES_NAMESPACES=1, as root: each server in a network namespace of its own.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { randomBytes } from 'node:crypto';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, little_light, patience, read_picture, run, sleep, source,
  start_server } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const count = Number(process.env.WELLSPRING_NODES_VISITORS ?? 6);
const spaces = process.env.WELLSPRING_NODES_NAMESPACES === '1';
const longest = 60000 * patience;  // milliseconds; only who fails waits so long
const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
const content = join(folder, 'content');
const proxy_socket = join(folder, 'haproxy.sock');
const names = ['node1', 'node2', 'node3'];
const nodes = new Map();   // name of the cookie -> server
const agents = new Map();  // -> port of its agent
let proxy, front;
const pages = [];

function free_port() {
  return new Promise((resolve) => {
    const socket = net.createServer().listen(0, '127.0.0.1', () => {
      const { port } = socket.address();
      socket.close(() => resolve(port));
    });
  });
}

const ip = (words) => {
  const { status, stderr } = spawnSync('ip', words.split(' '), { encoding: 'utf8' });
  assert.equal(status, 0, `ip ${words}: ${stderr}`);
};
const space_of = (name) => `wellspring-${name}`;
const host_of = (name) => (spaces ? `10.97.${names.indexOf(name)}.2` : '127.0.0.1');

function make_space(name) {
  const space = space_of(name), at = names.indexOf(name), link = `ws-${name}`;
  ip(`netns add ${space}`);
  ip(`link add ${link} type veth peer name inside netns ${space}`);
  ip(`addr add 10.97.${at}.1/24 dev ${link}`);
  ip(`link set ${link} up`);
  ip(`-n ${space} addr add ${host_of(name)}/24 dev inside`);
  ip(`-n ${space} link set inside up`);
  ip(`-n ${space} link set lo up`);
}

async function start_node(name) {
  if (spaces) make_space(name);
  agents.set(name, await free_port());
  nodes.set(name, await start_server(
      [...little_light, '--exhibit', 'giza', '--host', host_of(name),
        '--max-visitors', String(count), '--cache', join(folder, name),
        '--seal-key', join(folder, 'seal.key'), '--agent-port', String(agents.get(name))],
      { content, prefix: spaces ? ['ip', 'netns', 'exec', space_of(name)] : [] }));
}

// A visitor as the page is one: it keeps its cookie and the text that tells where its visit is, and
// comes back by itself, later each time (web/connection.js).
class Page {
  constructor(pose) { this.pose = pose; this.retries = 0; this.lines = 0; this.closes = []; }

  async enter() {
    const { headers } = await fetch(front.url);
    this.cookie = /wellspring=(\w+)/.exec(headers.get('set-cookie'))[1];
    this.first_node = this.cookie;
    await this.open();
    await this.seen;
    const settled = this.line.message('state', (state) => state.seq === 1);
    this.line.send({ type: 'camera', seq: 1, ...this.pose });
    await settled;
    for (const end = Date.now() + longest; !this.is_kept(); await sleep(50))
      assert.ok(Date.now() < end, 'the page is never told where it is');
  }

  // Says whether the token's text has the pose: a server seals the token, but its text is no
  // secret.
  is_kept() {
    if (!this.token) return false;
    const { place } = JSON.parse(Buffer.from(this.token.split('.')[0], 'base64url'));
    return this.pose.position.every((v, i) => Math.abs(v - place[i]) < 1e-3);
  }

  // Opens a line; when it breaks, another is opened later. `seen`: the first messages of each type
  // on this line.
  async open() {
    const headers = { cookie: `wellspring=${this.cookie}` };
    const line = new Visitor(front, { options: { headers } });
    this.line = line;
    line.socket.on('upgrade', (response) => {
      const set = /wellspring=(\w+)/.exec(response.headers['set-cookie'] ?? '');
      if (set) this.cookie = set[1];
    });
    this.seen = new Promise((resolve) => {
      const first = {};
      line.socket.on('message', (bytes, binary) => {
        const message = binary ? { type: read_picture(bytes) ? 'picture' : 'sound' }
          : JSON.parse(String(bytes));
        if (message.type === 'keep') this.token = message.token;
        if (message.type === 'welcome') this.lines++, this.retries = 0;
        first[message.type] ??= { ...message, at: performance.now() };
        if (first.welcome && first.state && first.picture) resolve(first);
      });
    });
    line.closed.then(({ code }) => {
      if (!this.left) this.closes.push(code), this.later();
    });
    await line.opened;
    line.send({ type: 'hello', exhibit: '', width: 64, height: 48, lang: 'en', role: 'visitor',
      ...(this.token ? { resume: this.token } : {}) });
  }

  later() {
    const seconds = Math.min(8, 0.4 * 2 ** this.retries++) * (0.75 + 0.5 * Math.random());
    setTimeout(() => { if (!this.left) this.open().catch(() => {}); }, 1000 * seconds);
  }

  leave() { this.left = true; return this.line.close(); }
}

const on = (name) => pages.filter((page) => page.cookie === name);

// Every one of them has a picture of where it was; says how long that took.
async function all_come_back(lost, since, say) {
  const lines = new Map(lost.map((page) => [page, page.lines]));
  const took = await Promise.all(lost.map(async (page) => {
    for (const end = since + longest; page.lines <= lines.get(page); await sleep(10))
      assert.ok(performance.now() < end, `never back: closes ${page.closes}`);
    const { welcome, state, picture } = await page.seen;
    assert.ok(welcome.resumed, 'the other server knows the text');
    state.position.forEach((v, i) => assert.ok(Math.abs(v - page.pose.position[i]) < 1e-3,
        `${state.position} was ${page.pose.position}`));
    assert.ok(Math.abs(state.yaw - page.pose.yaw) < 1e-3);
    assert.ok(Math.abs(state.pitch - page.pose.pitch) < 1e-3);
    return (picture.at - since) / 1000;
  }));
  took.sort((a, b) => a - b);
  say(`${took.length} visits have a picture of the same pose again after ` +
      `${took[took.length >> 1].toFixed(1)} s (median), ${took.at(-1).toFixed(1)} s (all)`);
}

before(async () => {
  writeFileSync(join(folder, 'seal.key'), randomBytes(32), { mode: 0o600 });
  await run('wellspring_new', ['giza', write_pyramid(folder), '--content', content]);
  for (const name of names) await start_node(name);
  const port = await free_port();
  front = { url: `http://127.0.0.1:${port}/`, ws: `ws://127.0.0.1:${port}` };
  const places = names.map((name) =>
      [name.toUpperCase(), `${host_of(name)}:${nodes.get(name).port}`]);
  for (const name of names)
    places.push([name.toUpperCase().replace('NODE', 'AGENT'), String(agents.get(name))]);
  writeFileSync(join(folder, 'asked.cfg'), `global\n  stats socket ${proxy_socket} level user\n`);
  const files = [join(source, 'deploy', 'haproxy-nodes.cfg'), join(folder, 'asked.cfg')];
  proxy = spawn('haproxy', files.flatMap((file) => ['-f', file]), {
    stdio: ['ignore', 'ignore', 'pipe'],
    env: { ...process.env, ...Object.fromEntries(places), MUSEUM: `127.0.0.1:${port}`,
      PATH: `${process.env.PATH}:/usr/sbin` } });
  let said = '';
  proxy.stderr.on('data', (chunk) => { said += chunk; });
  for (const end = Date.now() + longest; ; await sleep(50)) {
    const answer = await fetch(`${front.url}healthz`).catch(() => null);
    if (answer?.status === 200) break;
    assert.ok(Date.now() < end && proxy.exitCode === null, said);
  }
});
after(async () => {
  await Promise.all(pages.map((page) => page.leave()));
  proxy?.kill('SIGKILL');
  for (const server of nodes.values()) await server.stop('SIGKILL');
  if (spaces) for (const name of names) spawnSync('ip', ['netns', 'del', space_of(name)]);
  rmSync(folder, { recursive: true, force: true });
});

// All that a socket says until it ends.
function read_socket(place, words = '') {
  return new Promise((resolve, reject) => {
    const socket = net.connect(place, () => socket.write(words));
    let said = '';
    socket.on('data', (chunk) => { said += chunk; });
    socket.on('end', () => resolve(said));
    socket.on('error', reject);
  });
}

test('each server weighs what it says that it serves', async () => {
  const weights = async () => {
    const rows = (await read_socket({ path: proxy_socket }, 'show stat\n')).split('\n')
        .map((row) => row.split(','));
    const column = rows[0].indexOf('weight');
    return names.map((name) => Number(rows.find((row) => row[1] === name)[column]));
  };
  const said = async (name) => {
    const line = await read_socket({ host: host_of(name), port: agents.get(name) });
    return Number(/^(\d+)%\n$/.exec(line)[1]);
  };
  for (const end = Date.now() + longest; ; await sleep(100)) {
    const known = await Promise.all(names.map(said)), now = await weights();
    assert.ok(known.every((one) => one >= 1 && one <= count), `${known}`);
    if (now.every((weight, i) => weight === known[i])) break;
    assert.ok(Date.now() < end, `${now} are not ${known}`);
  }
});

test('visitors are spread, and each stays with one server', async () => {
  for (let k = 0; k < count; k++) {
    const way = 2 * Math.PI * k / count;
    pages.push(new Page({ position: [0.5 * Math.sin(way), 1.6, 0.5 * Math.cos(way)], yaw: way - 3,
      pitch: -0.1 }));
    await pages.at(-1).enter();
  }
  for (const name of names) assert.ok(on(name).length > 0, `nobody is on ${name}`);
  assert.ok(pages.every((page) => page.cookie === page.first_node && page.lines === 1));
});

test('visits of a server that is killed go on with another', async (context) => {
  const lost = on('node1'), others = pages.filter((page) => !lost.includes(page));
  const since = performance.now();
  nodes.get('node1').child.kill('SIGKILL');
  await all_come_back(lost, since, (text) => context.diagnostic(text));
  assert.equal(on('node1').length, 0);
  assert.ok(others.every((page) => page.closes.length === 0), 'nobody else notices');
});

test('visits of a server that is stopped go on with another', async (context) => {
  const lost = on('node2'), others = on('node3');
  const before_it = others.map((page) => page.closes.length);
  const since = performance.now();
  const ended = nodes.get('node2').stop();
  await all_come_back(lost, since, (text) => context.diagnostic(text));
  assert.equal(await ended, 0);
  assert.ok(lost.every((page) => page.closes.includes(1001)), 'they are told');
  assert.deepEqual(others.map((page) => page.closes.length), before_it);
  assert.equal(on('node3').length, count);
});
