// SPDX-License-Identifier: Apache-2.0
// One visitor who orders as fast as the socket takes it, beside one who walks: the walker's
// pictures go on coming, and the last order wins. And many who leave: their memory goes back.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { Visitor, judges_memory, sleep, start_server } from '../server.mjs';

const seconds = 1.5;    // length of each count
const least_kept = 0.3;  // share of the pictures; half would be the other's by right

let server;
before(async () => { server = await start_server(['--no-bake']); });
after(async () => { if (server) assert.equal(await server.stop(), 0); });

const turn = (list, i) => list[i % list.length];
// kind: [orders a second, the i-th of them]
const storms = {
  teller: [300, (i, { storytellers }) =>
    ({ type: 'storyteller', teller: turn(storytellers, i).id })],
  visible: [100, (i) => ({ type: 'storyteller', visible: i % 2 === 0 })],
  story: [100, (i, { stories }) => ({ type: 'storyteller', story: turn(stories, i).id })],
  size: [100, (i) => ({ type: 'settings', width: 320 + 8 * (i % 40), height: 180 })],
  place: [100, (i, { viewpoints }) =>
    ({ type: 'viewpoint', seq: i + 1, name: turn(viewpoints, i).name })],
  camera: [100, (i) =>
    ({ type: 'camera', seq: i + 1, position: [i % 2 ? 3 : -3, 1.6, 0], yaw: i, pitch: 0 })],
};

test('a storm of orders takes no pictures from others', async () => {
  const walker = new Visitor(server);
  await walker.hello();
  let seq = 0;
  const walk = setInterval(() => walker.send({
    type: 'input', seq: ++seq, move: [0, 0, seq % 60 < 30 ? 0.3 : -0.3], look: [0.01, 0],
  }), 40);
  const count = async () => {
    const before_it = walker.pictures;
    await sleep(1000 * seconds);
    return walker.pictures - before_it;
  };
  const other = new Visitor(server);
  const welcome = await other.hello();
  await other.picture();
  const few = [];
  for (const [kind, [rate, order]] of Object.entries(storms)) {
    const alone = await count();
    let sent = 0;
    const began = performance.now();
    const storm = setInterval(() => {
      for (const due = (performance.now() - began) / 1000 * rate; sent < due;)
        other.send(order(sent++, welcome));
    }, 3);
    const kept = await count();
    clearInterval(storm);
    assert.ok(sent > 50, `${kind}: ${sent} sent`);
    if (kept < least_kept * alone) few.push(`${kind}: ${kept} pictures after ${alone}`);
  }
  clearInterval(walk);
  assert.deepEqual(few, []);
  await Promise.all([walker.close(), other.close()]);
});

test('the last order of a storm wins', async () => {
  const visitor = new Visitor(server);
  const { storytellers, viewpoints } = await visitor.hello();
  const last = storytellers.at(-1).id, place = viewpoints[1].name;
  const seen = Promise.all([
    visitor.message('agent', ({ teller, visible }) => teller === last && !visible),
    visitor.message('state', ({ viewpoint, seq }) => viewpoint === place && seq === 1000),
    visitor.picture(({ width, height, seq }) => width === 160 && height === 96 && seq === 1000),
  ]);
  for (let i = 0; i < 60; i++) {
    visitor.send({ type: 'storyteller', teller: turn(storytellers, i).id });
    visitor.send({ type: 'storyteller', visible: i % 2 === 0 });
    visitor.send({ type: 'viewpoint', seq: i + 1, name: turn(viewpoints, i).name });
    visitor.send({ type: 'settings', width: 320 + 8 * (i % 10), height: 184 });
  }
  visitor.send({ type: 'storyteller', teller: last });
  visitor.send({ type: 'storyteller', visible: false });
  visitor.send({ type: 'viewpoint', seq: 1000, name: place });
  visitor.send({ type: 'settings', width: 160, height: 96 });
  await seen;
  await visitor.close();
});

// Kiosks' pages: nothing is kept of them for coming back.
test('memory of those who have left goes back to the system', {
  skip: !judges_memory && 'memory is not judged with a sanitizer',
}, async () => {
  const resident = () => Number(/^RssAnon:\s+(\d+)/m.exec(
      readFileSync(`/proc/${server.child.pid}/status`, 'utf8'))[1]) / 1024;
  const begin = resident();
  const pages = Array.from({ length: 6 }, () => new Visitor(server));
  await Promise.all(pages.map(async (page, i) => {
    await page.hello({ role: 'kiosk', kiosk: `kiosk ${i}`, width: 640, height: 360 });
    for (let seq = 1; seq <= 3; seq++) {
      page.send({ type: 'input', seq, move: [0, 0, 0.3], look: [0.3, 0] });
      await page.picture((picture) => picture.seq === seq);
    }
  }));
  const most = resident();
  await Promise.all(pages.map((page) => page.close()));
  let left = resident();
  for (let i = 0; i < 300 && left - begin > 0.6 * (most - begin); i++) {
    await sleep(100);
    left = resident();
  }
  const say = (mib) => `${mib.toFixed(0)} MiB`;
  assert.ok(most - begin > 40, `they took ${say(most - begin)}`);
  assert.ok(left - begin <= 0.6 * (most - begin),
      `${say(left - begin)} of ${say(most - begin)} are kept`);
});
