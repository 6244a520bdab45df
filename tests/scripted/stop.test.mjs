// SPDX-License-Identifier: Apache-2.0
// How a server ends, whatever it is at, and how it comes back.
import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { Visitor, patience, source, start_program, start_server, until } from '../server.mjs';

// Five are promised of a machine that has nothing else to do.
const soon = 15000 * patience;  // ms

const folder = mkdtempSync(join(tmpdir(), 'wellspring-stop-'));
after(() => rmSync(folder, { recursive: true, force: true }));
const usual = ['--exhibit', 'first-room', '--cache', join(folder, 'cache'), '--no-bake'];

async function ends(server, signal = 'SIGTERM') {
  const began = performance.now();
  const status = await server.stop(signal);
  const took = performance.now() - began;
  assert.ok(took < soon, `ended after ${took.toFixed(0)} ms`);
  return status;
}

async function metric(server, name) {
  const text = await (await fetch(`${server.url}/metrics`)).text();
  return Number(new RegExp(`^wellspring_${name} (\\S+)$`, 'm').exec(text)[1]);
}

const free_port = () => new Promise((resolve) => {
  const socket = net.createServer().listen(0, '127.0.0.1', () => {
    const { port } = socket.address();
    socket.close(() => resolve(port));
  });
});

const health = async (port) => {
  try {
    const answer = await fetch(`http://127.0.0.1:${port}/healthz`);
    return [answer.status, (await answer.json()).status];
  } catch { return [0, '']; }
};

const still = (server, query, options) =>
    fetch(`${server.url}/api/v1/exhibits/first-room/still.jpg?${query}`, options);
// A minute and more each, and no more than ten.
const dear = (i) => `width=1920&height=1080&spp=64&seconds=600&denoise=0&yaw=${i / 10}`;

test('dear pictures are given up when nobody waits, and when the server ends', async () => {
  // An address may ask for two pictures of an hour each: on no machine are these ten too many.
  const server = await start_server([...usual, '--still-seconds', '3600']);
  const leaving = new AbortController();
  const left = still(server, dear(0), { signal: leaving.signal }).catch(() => 'left');
  await until(async () => await metric(server, 'stills_waiting') === 1, 'it is begun');
  leaving.abort();
  assert.equal(await left, 'left');
  await until(async () => await metric(server, 'stills_waiting') === 0, 'it is given up');
  assert.equal(await metric(server, 'stills_given_up_total'), 1);

  const waiting = Array.from({ length: 10 }, (_, i) => still(server, dear(i + 1))
      .then(({ status }) => status, () => 'cut'));
  await until(async () => await metric(server, 'stills_waiting') === 10, 'ten are waited for');
  // A cheap one does not wait for them.
  const cheap = await Promise.race([still(server, 'width=64&height=36&spp=1&denoise=0'),
    ...waiting]);
  assert.equal(cheap.status, 200);
  assert.equal(await ends(server), 0);
  for (const status of await Promise.all(waiting)) assert.ok([503, 'cut'].includes(status), status);
});

test('what one picture may take is bounded, and named', async () => {
  const server = await start_server([...usual, '--still-seconds', '0.5']);
  const refused = await still(server, dear(0));
  assert.equal(refused.status, 400);
  const { error } = await refused.json();
  assert.equal(error.code, 'too_much_work');
  assert.match(error.message, /would fit$/);
  // So is what an address may take.
  let status = 200, number = 0;
  for (; status === 200 && number < 2000; number++) {
    const answers = await Promise.all(Array.from({ length: 8 }, (_, i) =>
        still(server, `width=64&height=64&spp=16&denoise=0&yaw=${(8 * number + i) / 2000}`)));
    const over = answers.find((one) => one.status !== 200);
    if (!over) continue;
    status = over.status;
    assert.ok(Number(over.headers.get('retry-after')) >= 1);
  }
  assert.equal(status, 429);
  const found = await still(server, 'width=64&height=64&spp=16&denoise=0&yaw=0');
  assert.equal(found.status === 200 || found.status === 429, true);
  assert.equal(await ends(server), 0);
});

test('a picture that was made is known by its tag', async () => {
  const server = await start_server(usual);
  const query = 'width=64&height=36&spp=1';
  const first = await still(server, query), tag = first.headers.get('etag');
  assert.ok(tag);
  const again = await still(server, query, { headers: { 'If-None-Match': tag } });
  assert.equal(again.status, 304);
  assert.equal(await metric(server, 'stills_made_total'), 1);
  assert.equal(await ends(server), 0);
});

test('it ends while it loads, and a second signal ends it at once', async () => {
  const port = await free_port();
  const loading = start_program(['--exhibit', 'castle', '--no-bake', '--port', String(port)]);
  await until(async () => (await health(port))[0] !== 0, 'it answers');
  const [status, word] = await health(port);
  if (word === 'loading') assert.equal(status, 503);
  assert.equal(await ends(loading), 0);

  const server = await start_server([...usual, '--drain', '600']);
  server.child.kill('SIGTERM');
  await until(async () => (await health(server.port)).join() === '503,draining', 'it drains');
  const late = new Visitor(server);
  await late.hello();  // a visitor who comes all the same is served
  assert.equal(await ends(server, 'SIGINT'), 130);
  assert.equal((await late.closed).code, 1006);
});

test('it ends while an exhibit is made anew', async () => {
  const content = join(folder, 'content');
  cpSync(join(source, 'content', 'first-room'), join(content, 'first-room'), { recursive: true });
  const server = await start_server(usual, { content });
  const file = join(content, 'first-room', 'exhibit.json');
  writeFileSync(file, `${readFileSync(file, 'utf8')}\n`);
  server.child.kill('SIGHUP');
  await until(() => server.log().includes('first-room has changed'), 'it is read');
  assert.equal(await ends(server), 0);
  assert.match(server.log(), /first-room is not read anew: the server ends/);
});

test('visits go on after a restart, and with another server that has the key', async () => {
  const key = join(folder, 'seal.key');
  const words = [...usual, '--seal-key', key];
  const server = await start_server(words);
  assert.equal(statSync(key).mode & 0o777, 0o600);
  const visitor = new Visitor(server);
  await visitor.hello();
  const where = { position: [0.5, 1.6, 0.5], yaw: 1, pitch: 0 };
  const there = ({ token }) =>
    JSON.parse(Buffer.from(token.split('.')[0], 'base64url')).place[0] === where.position[0];
  const kept = visitor.message('keep', there);
  visitor.send({ type: 'camera', seq: 7, ...where });
  const { token } = await kept;
  assert.equal(await ends(server), 0);
  assert.equal((await visitor.closed).code, 1001);

  // It can be joined before it has loaded.
  const port = await free_port();
  const next = start_program([...words, '--port', String(port)]);
  const place = { ws: `ws://127.0.0.1:${port}` };
  await until(async () => (await health(port))[0] !== 0, 'it answers');
  const back = new Visitor(place);
  const welcome = await back.hello({ resume: token });
  assert.equal(welcome.resumed, true);
  const state = await back.message('state');
  assert.deepEqual(state.position, where.position);
  assert.equal((await health(port))[1], 'ok');
  await back.close();
  assert.equal(await ends(next), 0);
});
