// SPDX-License-Identifier: Apache-2.0
// More visitors than seats: they wait, come in by turn, rest while nobody is there, and cost little
// meanwhile. WELLSPRING_CONNECTIONS: how many links are left idle at once.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, judges_memory, patience, sleep, start_server, until } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const many = Number(process.env.WELLSPRING_CONNECTIONS ?? 100);
const most_a_link = 256;  // KiB of the server's memory

const content = mkdtempSync(join(tmpdir(), 'wellspring-queue-'));
let server;
before(async () => {
  const folder = join(content, 'giza');
  mkdirSync(folder);
  write_pyramid(folder);
  const view = { position: [0, 0.5, 4], yaw_deg: 0, pitch_deg: 0, fov_deg: 55 };
  writeFileSync(join(folder, 'exhibit.json'), JSON.stringify({ id: 'giza', title: { en: 'Giza' },
    description: { en: 'A pyramid.' }, languages: ['en'], scene: 'pyramid.gltf', start: 'south',
    environment: { radiance: [1, 1, 1] },
    viewpoints: [{ ...view, name: 'south', title: { en: 'South' } },
      { ...view, name: 'east', title: { en: 'East' }, position: [4, 0.5, 0], yaw_deg: 90 }] }));
  server = await start_server(['--exhibit', 'giza', '--max-visitors', '2', '--idle-after', '3',
    '--idle-answer', '1', '--hidden-after', '1'], { content });
});
after(async () => {
  assert.equal(await server?.stop(), 0);
  rmSync(content, { recursive: true, force: true });
});

const size = { width: 64, height: 48 };
async function say_hello(fields = {}) {
  const visitor = new Visitor(server);
  await visitor.opened;
  visitor.send({ type: 'hello', ...size, ...fields });
  return visitor;
}
// Turns now and then: such a visitor is not asked whether they are there.
function keep_busy(visitor) {
  let seq = 1000;
  const timer = setInterval(() =>
      visitor.send({ type: 'input', seq: ++seq, look: [0.01, 0] }), 500);
  visitor.closed.then(() => clearInterval(timer));
}
async function come_in(fields) {
  const visitor = await say_hello(fields);
  await visitor.message('welcome');
  return visitor;
}
async function metric(name) {
  const text = await (await fetch(`${server.url}/metrics`)).text();
  return Number(new RegExp(`^wellspring_${name} (.*)$`, 'm').exec(text)[1]);
}

test('who finds no seat waits for their turn, and a kiosk does not', async () => {
  const inside = [await come_in(), await come_in()];
  inside.forEach(keep_busy);
  const first = await say_hello();
  assert.deepEqual(await first.message('waiting'), { type: 'waiting', place: 1, of: 1 });
  const second = await say_hello();
  assert.equal((await second.message('waiting')).place, 2);
  assert.equal(await metric('visitors_waiting'), 2);
  const kiosk = await come_in({ role: 'kiosk' });
  assert.equal(first.pictures + second.pictures, 0);

  await kiosk.close();

  const turn = second.message('waiting', ({ place }) => place === 1);
  const welcome = first.message('welcome');
  await inside[0].close();
  await Promise.all([welcome, turn, first.picture()]);
  const last = second.message('welcome');
  inside[1].socket.terminate();
  await last;
  await Promise.all([first.close(), second.close()]);
});

test('who does nothing is asked, rests, and goes on where they were', async () => {
  const visitor = await come_in();
  visitor.send({ type: 'viewpoint', seq: 1, name: 'east' });
  const { seconds } = await visitor.message('idle', ({ state }) => state === 'asked');
  assert.equal(seconds, 1);
  await visitor.message('idle', ({ state }) => state === 'paused');
  // The page hears of the pause before the next report of /metrics shows it.
  await until(async () => await metric('visits_resting') === 1, 'the visit rests');
  assert.equal(await metric('seats_taken'), 0);
  const { pictures } = visitor;
  await sleep(300);
  assert.equal(visitor.pictures, pictures);
  const welcome = visitor.message('welcome'), state = visitor.message('state');
  visitor.send({ type: 'presence', here: true });
  assert.equal((await welcome).resumed, true);
  assert.equal((await state).viewpoint, 'east');
  await visitor.picture();
  await visitor.close();
});

test('a hidden page rests, and waits where its seat has been taken', async () => {
  const hidden = await come_in();
  hidden.send({ type: 'presence', here: false });
  await hidden.message('idle', ({ state }) => state === 'paused');
  const others = [await come_in(), await come_in()];
  others.forEach(keep_busy);
  hidden.send({ type: 'presence', here: true });
  assert.equal((await hidden.message('waiting')).place, 1);
  const welcome = hidden.message('welcome');
  await others[0].close();
  assert.equal((await welcome).resumed, true);
  await Promise.all([hidden.close(), others[1].close()]);
});

test(`${many} idle links cost little, and a newcomer comes in beside them`,
    { timeout: patience * (120e3 + 100 * many) }, async () => {
      const resident = () => Number(/VmRSS:\s+(\d+)/.exec(
          readFileSync(`/proc/${server.child.pid}/status`, 'utf8'))[1]);
      const inside = [await come_in(), await come_in()];
      inside.forEach(keep_busy);
      await Promise.all(inside.map((one) => one.picture()));
      const before_them = resident(), links = [];
      while (links.length < many) {
        const some = Array.from({ length: Math.min(50, many - links.length) }, () => say_hello());
        links.push(...await Promise.all(some));
      }
      await links.at(-1).message('waiting', ({ of }) => of === many);
      const grown = resident() - before_them;
      const seen = inside[0].pictures;
      await sleep(1000);
      assert.ok(inside[0].pictures > seen, 'who is inside goes on getting pictures');
      const began = performance.now();
      await Promise.all(inside.map((one) => one.close()));
      await Promise.any(links.map((one) => one.picture()));
      console.log(JSON.stringify({ many, mib: resident() / 1024, kib_a_link: grown / many,
        first_ms: Math.round(performance.now() - began) }));
      if (judges_memory)
        assert.ok(grown < many * most_a_link, `${grown / many} KiB a link`);
      await Promise.all(links.map((one) => one.close()));
    });
