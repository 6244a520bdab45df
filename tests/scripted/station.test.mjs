// SPDX-License-Identifier: Apache-2.0
// "What am I holding?" end to end: photographs -> tree -> exhibit -> server -> kiosk -> page.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { createServer } from 'node:net';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { deflateSync } from 'node:zlib';
import { Visitor, run, start_server, until } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-station-'));
const content = join(folder, 'content'), frames = join(folder, 'frames');
let server;

// The checksum of a PNG's chunk.
function checksum(bytes) {
  let value = ~0;
  for (const byte of bytes) {
    value ^= byte;
    for (let bit = 0; bit < 8; bit++) value = (value >>> 1) ^ (value & 1 ? 0xedb88320 : 0);
  }
  return ~value >>> 0;
}
function write_png(file, { width, height, pixels }) {
  const chunk = (type, bytes) => {
    const body = Buffer.concat([Buffer.from(type), bytes]), out = Buffer.alloc(body.length + 8);
    out.writeUInt32BE(bytes.length, 0);
    body.copy(out, 4);
    out.writeUInt32BE(checksum(body), body.length + 4);
    return out;
  };
  const head = Buffer.alloc(13), rows = Buffer.alloc((3 * width + 1) * height);
  head.writeUInt32BE(width, 0), head.writeUInt32BE(height, 4), head.set([8, 2, 0, 0, 0], 8);
  for (let y = 0; y < height; y++)
    pixels.copy(rows, y * (3 * width + 1) + 1, 3 * width * y, 3 * width * (y + 1));
  writeFileSync(file, Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'),
    chunk('IHDR', head), chunk('IDAT', deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]));
}
const picture = (width, height, grey) =>
    ({ width, height, pixels: Buffer.alloc(3 * width * height, grey) });
function fill({ width, pixels }, left, top, across, down, color) {
  for (let y = top; y < top + down; y++)
    for (let x = left; x < left + across; x++) pixels.set(color, 3 * (y * width + x));
}
// A card of many rectangles, others for another seed (a linear congruential generator).
function card(seed) {
  let state = seed;
  const random = (end) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor(state / 2 ** 32 * end);
  };
  const made = picture(320, 240, 200);
  for (let i = 0; i < 220; i++)
    fill(made, random(300), random(225), 6 + random(14), 5 + random(10),
        [random(256), random(256), random(256)]);
  return made;
}
function put(from, to, left, top) {
  for (let y = 0; y < from.height; y++)
    from.pixels.copy(to.pixels, 3 * ((y + top) * to.width + left), 3 * from.width * y,
        3 * from.width * (y + 1));
}

before(async () => {
  const cards = { tile: card(3), brick: card(11) };
  for (const [id, made] of Object.entries(cards)) {
    const place = join(folder, 'objects', id);
    mkdirSync(place, { recursive: true });
    write_png(join(place, 'front.png'), made);
    writeFileSync(join(place, 'object.json'),
        JSON.stringify({ title: { en: `The ${id}`, de: `Nr. ${id}` }, size: [0.12, 0.09] }));
  }
  mkdirSync(frames);
  for (let i = 0; i < 24; i++) {
    const frame = picture(640, 480, 90);
    fill(frame, 0, 0, 640, 140, [140, 120, 100]);
    if (i >= 4) put(cards.tile, frame, 120 + 3 * i, 110 + (i % 5));
    write_png(join(frames, `${String(i).padStart(3, '0')}.png`), frame);
  }
  const model = write_pyramid(folder);
  assert.equal((await run('wellspring_new', ['giza', model, '--content', content])).status, 0);
});
after(async () => {
  if (server) assert.equal(await server.stop(), 0);
  rmSync(folder, { recursive: true, force: true });
});

const exhibit_file = join(content, 'giza', 'exhibit.json');
const set_kiosk = (kiosk) => writeFileSync(exhibit_file, JSON.stringify(
    { ...JSON.parse(readFileSync(exhibit_file, 'utf8')), kiosks: [kiosk] }));
const check = () => run('wellspring_check', [join(content, 'giza')]);

function start_kiosk(url) {
  const child = spawn(join(process.env.WELLSPRING_BIN, 'wellspring_kiosk'),
      ['--camera', frames, '--loop', '--rate', '10', '--name', 'hall', '--server', url, '--print',
        '--no-hands'], { stdio: ['ignore', 'pipe', 'pipe'] });
  const held = new Set();
  let log = '', rest = '';
  child.stderr.on('data', (chunk) => { log += chunk; });
  child.stdout.on('data', (chunk) => {
    const lines = (rest + chunk).split('\n');
    rest = lines.pop();
    for (const line of lines) {
      const { holding } = JSON.parse(line);
      if (holding) held.add(holding.id ?? holding.class);
    }
  });
  const ended = new Promise((resolve) => child.on('close', resolve));
  return { held, log: () => log, stop: () => { child.kill('SIGTERM'); return ended; } };
}

test('photographs become a tree, and a faulty one is named by check', async () => {
  const tree = join(content, 'giza', 'objects.json');
  const learnt = await run('wellspring_station',
      ['--learn', join(folder, 'objects'), '--out', tree]);
  assert.equal(learnt.status, 0, learnt.stderr);
  assert.match(learnt.stdout, /^2 objects/);
  set_kiosk({ name: 'hall', station: 'objects.json' });
  const good = await check();
  assert.equal(good.status, 0, good.stdout);
  const text = readFileSync(tree, 'utf8');
  writeFileSync(tree, text.replace('"solver": "pattern"', '"solver": "smell"'));
  const smells = await check();
  assert.equal(smells.status, 1);
  assert.match(smells.stdout, /objects\.json.*smell/);
  writeFileSync(tree, text.slice(0, text.length / 2));
  const cut = await check();
  assert.equal(cut.status, 1);
  assert.match(cut.stdout, /station.*objects\.json/);
  writeFileSync(tree, text);
  set_kiosk({ name: 'hall', station: 'none.json' });
  assert.match((await check()).stdout, /station.*none\.json/);
  set_kiosk({ name: 'hall', station: 'objects.json' });
});

test('a kiosk takes it from the server, names what is held, and the page is told', async () => {
  server = await start_server([], { content });
  const answer = await fetch(`${server.url}/api/v1/station?kiosk=hall`);
  assert.equal(answer.status, 200);
  assert.equal(answer.headers.get('content-type'), 'application/json');
  assert.deepEqual(Object.keys((await answer.json()).nodes).filter((name) => name.length < 6)
      .sort(), ['brick', 'tile']);
  assert.equal((await fetch(`${server.url}/api/v1/station`)).status, 200, 'the only one');
  assert.equal((await fetch(`${server.url}/api/v1/station?kiosk=attic`)).status, 404);
  const page = new Visitor(server);
  await page.hello({ role: 'kiosk', kiosk: 'hall' });
  const told = page.message('kiosk', (message) => message.holding?.id === 'tile');
  const kiosk = start_kiosk(server.ws);
  const { holding } = await told;
  assert.deepEqual(holding.title, { en: 'The tile', de: 'Nr. tile' });
  assert.equal(await kiosk.stop(), 0);
  assert.deepEqual([...kiosk.held], ['tile']);
  await page.close();
  assert.equal(await server.stop(), 0);
  server = null;
});

test('a server that is away at first is asked when it is there', async () => {
  const probe = createServer().listen(0, '127.0.0.1');
  await new Promise((resolve) => probe.on('listening', resolve));
  const { port } = probe.address();
  await new Promise((resolve) => probe.close(resolve));
  const kiosk = start_kiosk(`ws://127.0.0.1:${port}`);
  await until(() => /none are until/.test(kiosk.log()), () => kiosk.log());
  assert.equal(kiosk.held.size, 0);
  server = await start_server([], { content, port });
  await until(() => kiosk.held.has('tile'), () => kiosk.log());
  assert.equal(kiosk.log().match(/none are until/g).length, 1, 'it is said once');
  assert.equal(await kiosk.stop(), 0);
});

test('a tree of random bytes is named, and nothing starts', async () => {
  const wrong = join(folder, 'wrong.json');
  for (const bytes of ['{"root": 3}', '\x00\xff\x17\x80'.repeat(99), '']) {
    writeFileSync(wrong, Buffer.from(bytes, 'latin1'));
    const { status, stderr } = await run('wellspring_kiosk',
        ['--camera', frames, '--station', wrong, '--print']);
    assert.equal(status, 1);
    assert.match(stderr, /wrong\.json/);
  }
});
