// SPDX-License-Identifier: Apache-2.0
// A wall of screens, as a program sees it: one wide picture in parts, under one number, shown at a
// word of the server's.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Visitor, little_light, start_server, until } from '../server.mjs';

let server;
before(async () => { server = await start_server(['--exhibit', 'first-room', ...little_light]); });
after(async () => { if (server) assert.equal(await server.stop(), 0); });

// A screen that notes the numbers of its pictures, and of those that it is to show.
async function open(column) {
  const tile = new Visitor(server);
  const wall = { name: 'hall', columns: 2, rows: 1, column, row: 0, bezel: [0.05, 0] };
  const seen = { tile, pictures: [], shown: [], sizes: new Set() };
  tile.socket.on('message', (bytes, binary) => {
    if (binary) {
      seen.pictures.push(bytes.readUInt32LE(4));
      seen.sizes.add(`${bytes.readUInt16LE(20)}x${bytes.readUInt16LE(22)}`);
      return;
    }
    const message = JSON.parse(String(bytes));
    if (message.type === 'show') seen.shown.push(message.frame);
  });
  await tile.hello({ width: 160, height: 120, wall });
  return seen;
}
const has_all = (list, of) => of.every((frame) => list.includes(frame));

test('two tiles get the same moments, and one that goes stops nobody', async () => {
  const [left, right] = [await open(0), await open(1)];
  await until(() => right.pictures.length > 0, 'the first picture');
  const from = right.pictures[0];
  let seq = 0;
  const turned = () => {
    left.tile.send({ type: 'input', seq: ++seq, look: [0.04, 0], move: [0, 0, 0] });
    const both = left.pictures.filter((frame) => right.pictures.includes(frame));
    return both.length > 12 && has_all(left.shown, both.slice(0, 10))
      && has_all(right.shown, both.slice(0, 10));
  };
  await until(turned, 'ten moments are shown by both');
  const since = left.pictures.filter((frame) => frame >= from).slice(0, 10);
  assert.deepEqual(right.pictures.slice(0, 10), since, 'no moment goes to one of them alone');
  assert.deepEqual([...left.sizes], ['160x120']);

  left.tile.socket.terminate();
  const before = right.shown.length;
  await until(() => {
    right.tile.send({ type: 'input', seq: ++seq, look: [0.04, 0], move: [0, 0, 0] });
    return right.shown.length > before + 10;
  }, 'the other goes on');
  const again = await open(0);
  await until(() => {
    right.tile.send({ type: 'input', seq: ++seq, look: [0.04, 0], move: [0, 0, 0] });
    return again.shown.some((frame) => right.shown.includes(frame));
  }, 'it comes back');
  await again.tile.close();
  await right.tile.close();
});

test('a part that cannot be is refused', async () => {
  const wrong = new Visitor(server);
  await wrong.opened;
  const error = wrong.message('error');
  wrong.send({ type: 'hello', wall: { name: 'hall', columns: 2, column: 2, row: 0 } });
  const { code, message } = await error;
  assert.equal(code, 'bad_field');
  assert.match(message, /wall\.column/);
  await wrong.close();
});
