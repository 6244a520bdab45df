// SPDX-License-Identifier: Apache-2.0
// Keyframes with depth, as pages that draw for themselves get them, and the camera of such a page.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { decode_disparity, inflate } from '../../web/display/disparity.js';
import { eval_waves, make_wind_clock } from '../../web/display/sway.js';
import { make_mapping } from '../../web/display/view.js';
import { make_walker } from '../../web/display/walker.js';
import { read_picture } from '../../web/packet.js';
import { Visitor, sleep, source, start_server, until } from '../server.mjs';

let server;
before(async () => { server = await start_server(['--exhibit', 'first-room']); });
after(async () => { if (server) assert.equal(await server.stop(), 0); });

const golden = (name = 'keyframe') => {
  const lines = readFileSync(join(source, `tests/protocol/${name}.hex`), 'utf8').split('\n');
  const words = lines.filter((line) => !line.startsWith('#')).join(' ').trim().split(/\s+/);
  return Uint8Array.from(words, (word) => parseInt(word, 16));
};
const depth_of = ({ payload, keyframe: { color_bytes, view } }) =>
  decode_disparity(payload.subarray(color_bytes), view.width, view.height);

test('the page reads a keyframe as it is documented', async () => {
  const picture = read_picture(golden().buffer);
  assert.deepEqual(picture.keyframe, { color_bytes: 4, cuts: 3, unit: 0.5,
    view: { eye: [1.5, -2.25, 1024.5], right: [1, 0, 0], up: [0, 1, 0], forward: [0, 0, -1],
      tan_half_fov: 0.5, middle: [0.25, -0.125], width: 8, height: 4 } });
  assert.deepEqual([...await depth_of(picture)],
      [10, 15, 20, 25, 30, 35, 300, 7, 20, 25, 30, 35, 40, 45, 300, 7, 30, 35, 40, 45, 50, 55, 60,
        9, 40, 45, 50, 55, 60, 65, 70, 65535]);
});

test('the page reads how grass sways', async () => {
  const packed = golden('keyframe_sway'), { sway, ...picture } = read_picture(packed.buffer);
  const { codes, ...rest } = sway, none = { push: [0, 0], wave: [0, 0], rate: 0, phase: 0 };
  assert.deepEqual(rest, { columns: 2, rows: 1, unit: 1, time: 12.5, waves: [
    { push: [0.5, -0.25], wave: [1, 2], rate: 1.5, phase: 0.75 },
    { push: [0, 1], wave: [0, 0], rate: 2, phase: -1 }, none, none] });
  assert.deepEqual([...await inflate(codes, 2)], [0, 7]);
  assert.deepEqual([...await depth_of(picture)],
      [...await depth_of(read_picture(golden().buffer))], 'the depth is what it was');
  assert.equal(read_picture(golden().buffer).sway, null);
  for (const [at, value] of [[26, 231], [117, 1], [120, 0], [122, 0], [127, 0x7f], [135, 0x7f]]) {
    const bad = packed.slice();
    bad[at] = value;
    if (at === 127 || at === 135) bad[at - 1] = 0xff;
    assert.equal(read_picture(bad.buffer), null, `byte ${at}`);
  }
});

test('what wind has moved is the difference of two pushes', () => {
  const waves = [{ push: [0.5, -0.25], wave: [1, 2], rate: 1.5, phase: 0.75 },
    { push: [0.1, 1], wave: [0.3, -7], rate: 7.9, phase: -1 }];
  const place = [0.7, -1.9];
  const push = (seconds) => [0, 1].map((k) => waves.reduce((sum, one) => sum + one.push[k]
      * Math.sin(one.wave[0] * place[0] + one.wave[1] * place[1] + one.phase
        - one.rate * seconds), 0));
  for (const seconds of [0.02, 0.5, 3, -1]) {
    const { sums, phases } = eval_waves(waves, seconds);
    const moved = [0, 1].map((k) => phases.reduce((sum, phase, i) => sum + sums[4 * i + k]
        * Math.cos(sums[4 * i + 2] * place[0] + sums[4 * i + 3] * place[1] + phase), 0));
    for (const k of [0, 1])
      assert.ok(Math.abs(moved[k] - (push(seconds)[k] - push(0)[k])) < 1e-9, `${seconds}`);
  }
});

test('the wind goes on evenly, whenever pictures come', () => {
  const clock = make_wind_clock();
  assert.ok(Number.isNaN(clock.at(5)));
  clock.note(100, 1000);
  assert.equal(clock.at(1000), 100);
  let last = 100;
  for (let now = 1100, i = 0; now < 20000; now += 500, i++) {
    clock.note(100 + (now - 1000) / 1000 - 0.1 * (i % 3), now);  // as much later
    for (let t = now; t < now + 500; t += 100) {
      const at = clock.at(t);
      assert.ok(at > last && at < last + 0.16, `${at} after ${last}`);
      last = at;
    }
  }
  clock.note(7, 20000);  // another server
  assert.equal(clock.at(20000), 7);
});

test('what is no keyframe is refused before it takes memory', async () => {
  const good = golden();
  for (let length = 0; length < 120; length++)
    assert.equal(read_picture(good.slice(0, length).buffer), null, `${length} bytes`);
  for (const [at, value] of [[26, 115], [31, 255], [36, 0], [38, 0], [103, 0xbf], [115, 0xff]]) {
    const bad = good.slice();
    bad[at] = value;
    assert.equal(read_picture(bad.buffer), null, `byte ${at}`);
  }
  const { payload } = read_picture(good.buffer), code = payload.subarray(4);
  await assert.rejects(decode_disparity(code, 8, 5), /depth/);
  await assert.rejects(decode_disparity(code, 7, 4), /depth/);
  for (let length = 0; length < code.length; length++)
    await assert.rejects(decode_disparity(code.subarray(0, length), 8, 4));
  for (let at = 0; at < 16; at++) {  // more runs than pixels, or other counts than there are
    const bad = code.slice();
    bad[at] ^= 0x81;
    await assert.rejects(decode_disparity(bad, 8, 4), `byte ${at}`);
  }
});

// The share of the pixels of `from` whose places have the same depth in `to`, of those in it, or as
// a pixel at most `reach` away.
function share_alike(from, to, reach = 0) {
  const { one, across, down, baseline } = make_mapping(from.view, to.view);
  const { width, height } = from.view;
  let alike = 0, all = 0;
  const step = width > 200 ? 3 : 1;
  for (let y = 0; y < height; y += step)
    for (let x = 0; x < width; x += step) {
      const w = from.units[y * width + x] * from.unit;
      const at = [0, 1, 2].map((i) =>
        one[i] + (x + 0.5) * across[i] + (y + 0.5) * down[i] + w * baseline[i]);
      const [px, py] = [at[0] / at[2], at[1] / at[2]].map(Math.floor);
      if (!(at[2] > 0 && px >= 0 && py >= 0 && px < to.view.width && py < to.view.height)) continue;
      all++;
      const is_alike = (qx, qy) => {
        const there = to.units[qy * to.view.width + qx] * to.unit;
        return Math.abs(w / at[2] - there) < 6 * to.unit + 0.01 * there;
      };
      const near = (middle, side) => Array.from({ length: 2 * reach + 1 }, (_, i) =>
        Math.min(side - 1, Math.max(0, middle + i - reach)));
      alike += near(py, to.view.height).some((qy) =>
        near(px, to.view.width).some((qx) => is_alike(qx, qy))) ? 1 : 0;
    }
  assert.ok(all > 300, `${all} places are in both`);
  return alike / all;
}

async function next_keyframe(visitor, wanted = ({ around }) => !around) {
  let found = null;
  await visitor.next((item) => {
    if (!item.binary) return false;
    const { buffer, byteOffset, length } = item.binary;
    const picture = read_picture(buffer.slice(byteOffset, byteOffset + length));
    if (!picture?.keyframe || !wanted(picture)) return false;
    found = picture;
    return true;
  }, 'keyframe');
  const { view, unit } = found.keyframe;
  return { ...found, view, unit, units: await depth_of(found) };
}

test('keyframes of a walk show the same places', async () => {
  const visitor = new Visitor(server);
  const first = next_keyframe(visitor);
  // A wide one comes as soon as a keyframe is out, or with the walk.
  const wide = next_keyframe(visitor, ({ around }) => around);
  await visitor.hello({ display: 'local', parts: true });
  const before_turn = await first;
  assert.deepEqual([...before_turn.payload.subarray(0, 2)], [0xff, 0xd8]);
  assert.ok(before_turn.view.width >= 320 && before_turn.view.height >= 176);
  const pose = visitor.message('pose', ({ seq }) => seq === 1);
  visitor.send({ type: 'input', seq: 1, move: [0.4, 0, 0.4], look: [0.15, 0.05] });
  const from_start = (eye) => Math.hypot(...eye.map((v, i) => v - before_turn.view.eye[i]));
  const turned = await next_keyframe(visitor, ({ seq, keyframe, around }) =>
    !around && seq === 1 && from_start(keyframe.view.eye) > 0.1);
  visitor.send({ type: 'input', seq: 2, move: [0, 0, 0], look: [0, 0] });
  const { led, cut, position } = await pose;
  assert.equal(led, false);
  assert.equal(cut, turned.keyframe.cuts);
  assert.equal(position.length, 3);
  assert.ok(share_alike(before_turn, turned) > 0.85, 'places are found again');
  assert.ok(share_alike(turned, before_turn) > 0.85, 'and the other way round');
  // The surroundings are a wide view of few pixels.
  const { view, unit, units } = await wide;
  assert.ok(view.tan_half_fov * view.width / view.height > 1.4);
  assert.ok(view.width * view.height < before_turn.view.width * before_turn.view.height / 5);
  const pixel = (one) => one.tan_half_fov / one.height;
  const reach = Math.ceil(pixel(view) / pixel(turned.view));
  assert.ok(share_alike({ view, unit, units }, turned, reach) > 0.8, 'it shows the same room');
  // At rest, changes of the picture come in parts.
  await visitor.picture(({ parts, flags }) => parts?.length > 0 && !(flags & 4));
  await visitor.close();
});

test('two rounds a second end where they end', async () => {
  const visitor = new Visitor(server);
  const first = next_keyframe(visitor, ({ still, around }) => still && !around);
  await visitor.hello({ display: 'local', parts: true });
  const before = await first;
  const kinds = [];
  visitor.socket.on('message', (bytes, binary) => {
    const picture = binary && read_picture(bytes.buffer.slice(bytes.byteOffset,
        bytes.byteOffset + bytes.length));
    if (picture?.keyframe) kinds.push(picture.around);
  });
  for (let seq = 1; seq <= 60; seq++) {  // 4 pi radians in a second
    visitor.send({ type: 'input', seq, move: [0, 0, 0], look: [4 * Math.PI / 60, 0] });
    await sleep(1000 / 60);
  }
  visitor.send({ type: 'input', seq: 61, move: [0, 0, 0], look: [Math.PI / 2, 0] });
  const after = await next_keyframe(visitor, ({ seq, still, around }) =>
    seq === 61 && still && !around);
  const [x, , z] = before.view.forward;
  assert.ok(Math.abs(after.view.forward[0] - z) + Math.abs(after.view.forward[2] + x) < 0.01,
      'a quarter to the left');
  assert.ok(kinds.some((around) => !around), 'keyframes came meanwhile');
  kinds.reduce((one, next) => {
    assert.ok(!(one && next), 'wide ones take turns with others');
    return next;
  });
  await visitor.close();
});

test('what moves before who stands comes as a layer of its own', async (t) => {
  const castle = await start_server(['--exhibit', 'castle', '--no-bake']);
  t.after(() => castle.stop());
  const visitor = new Visitor(castle);
  const { storyteller } = await visitor.hello({ display: 'local', parts: true });
  const still = next_keyframe(visitor, ({ still, around, layer }) => still && !around && !layer);
  const first = next_keyframe(visitor, ({ layer }) => layer);
  visitor.send({ type: 'viewpoint', seq: 1, name: storyteller.viewpoint });
  const layer = await first, whole = await still;
  const there = layer.units.filter((units) => units > 0).length, all = layer.units.length;
  assert.ok(there > 0.1 * all && there < 0.9 * all, `${there} of ${all} pixels show something`);
  assert.ok(3 * all <= whole.units.length);
  // It lies before the room, and where the room's view has it.
  assert.ok(share_alike(layer, whole) < 0.5);
  assert.deepEqual(layer.view.eye, whole.view.eye);
  assert.deepEqual(layer.view.forward, whole.view.forward);
  const moved = await next_keyframe(visitor, ({ layer, frame }) => layer && frame > whole.frame);
  assert.notDeepEqual(moved.payload, layer.payload, 'she breathes');
  // A visitor who walks gets the storyteller in the keyframe.
  visitor.send({ type: 'input', seq: 2, move: [0.3, 0, 0], look: [0, 0] });
  await next_keyframe(visitor, ({ seq, still, around }) => seq === 2 && !still && !around);
  await visitor.close();
});

test('who can draw no more gets finished pictures from then on', async () => {
  const visitor = new Visitor(server);
  await visitor.hello({ display: 'local', parts: true });
  await next_keyframe(visitor);
  visitor.send({ type: 'settings', display: 'server' });
  visitor.send({ type: 'input', seq: 1, move: [0, 0, 0], look: [0.2, 0] });
  await visitor.picture(({ seq, header, parts }) => seq === 1 && header === 28 && !parts);
  await visitor.close();
});

test('who asks for nothing gets finished pictures', async () => {
  const visitor = new Visitor(server);
  await visitor.hello();
  const picture = await visitor.picture();
  assert.equal(picture.flags & 4, 0);
  assert.equal(picture.header, 28);
  await until(() => visitor.pictures > 2);
  assert.ok(visitor.messages.every(({ type }) => type !== 'pose'));
  await visitor.close();
});

// A server that walks as ours does, `away` ms there and back, whose visitor comes to a wall at
// x = 2. Returns how far the page's camera was from the server's when that had heard all, and the
// farthest that it ever went back, metres.
function walk_with(away, { stalls = false, wall = Infinity } = {}) {
  const walker = make_walker(), there = { position: [0, 1.6, 0], velocity: 0, move: 0, seq: 0 };
  walker.set_ground({ free: (x) => x < wall });
  const tell = () => ({ seq: there.seq, position: [...there.position], yaw: -Math.PI / 2, pitch: 0,
    roll: 0, fov: 1, middle: [0, 0], cut: 0, led: false });
  const to_server = [], to_page = [{ at: 0, pose: tell() }];
  let back = 0, farthest = 0, blocked_until = 0;
  for (let now = 0, seq = 0; now <= 6000; now += 10) {
    if (now === 1000 || now === 3000) {
      const move = now === 1000 ? 1.4 : 0;
      walker.sent(++seq, [0, 0, move]);
      to_server.push({ at: now + away / 2, seq, move });
    }
    while (to_server[0]?.at <= now) Object.assign(there, to_server.shift());
    there.velocity += (there.move - there.velocity) * (1 - Math.exp(-0.01 / 0.09));
    const next = there.position[0] + 0.01 * there.velocity;
    if (next < wall) there.position[0] = next;
    if (stalls && now % 1000 === 500) blocked_until = now + 400;  // a packet was lost
    if (now % 30 === 0) to_page.push({ at: Math.max(now + away / 2, blocked_until), pose: tell() });
    while (to_page[0]?.at <= now) walker.told(to_page.shift().pose, now, away);
    walker.advance(0.01, now);
    const [x] = walker.pose()?.position ?? [0];
    farthest = Math.max(farthest, x);
    back = Math.max(back, farthest - x);
  }
  return { apart: Math.abs(walker.pose().position[0] - there.position[0]), back, farthest };
}

test('the camera walks at once and ends where the server has it', () => {
  for (const away of [0, 50, 150, 300]) {
    const { apart, back } = walk_with(away);
    assert.ok(apart < 0.005, `${apart} m apart after ${away} ms`);
    assert.ok(back < 0.03, `${back} m back after ${away} ms`);
    const stalled = walk_with(away, { stalls: true });
    assert.ok(stalled.apart < 0.005, `${stalled.apart} m apart after stalls and ${away} ms`);
  }
});

test('a wall does not throw the camera back', () => {
  for (const away of [0, 50, 150, 300]) {
    const { apart, back, farthest } = walk_with(away, { wall: 2 });
    assert.ok(farthest < 2.02 && apart < 0.02 && back < 0.03, `${away} ms: ${farthest} ${back}`);
  }
});

test('a turn is seen at once, and not again when the server has heard of it', () => {
  const walker = make_walker();
  const told = (seq, yaw) => ({ seq, position: [0, 0, 0], yaw, pitch: 0, roll: 0, fov: 1,
    middle: [0, 0], cut: 0,
    led: false });
  walker.told(told(0, 0), 0, 100);
  assert.ok(!walker.advance(0.016, 0));
  walker.turn([0.5, 2]);
  assert.ok(walker.advance(0.016, 16), 'it is to be drawn before the server says anything');
  assert.ok(!walker.advance(0.016, 32));
  walker.sent(1, [0, 0, 0]);
  assert.equal(walker.pose().yaw, 0.5);
  assert.ok(walker.pose().pitch < 1.5);  // as far up as one can look
  walker.turn([0.25, -1]);
  walker.sent(2, [0, 0, 0]);
  walker.told({ ...told(1, 0.5), pitch: 1.45 }, 100, 100);
  for (let now = 100; now < 400; now += 16) walker.advance(0.016, now);
  assert.ok(Math.abs(walker.pose().yaw - 0.75) < 1e-9);
  // Another place is shown at once, and a led camera goes where it is led.
  walker.told({ ...told(2, 1), position: [5, 0, 0], cut: 1 }, 400, 100);
  assert.deepEqual(walker.pose().position, [5, 0, 0]);
  for (let now = 400, x = 5; now < 1400; now += 20, x += 0.02) {
    walker.told({ ...told(2, 1), position: [x, 0, 0], cut: 1, led: true }, now, 100);
    walker.advance(0.02, now);
  }
  assert.ok(Math.abs(walker.pose().position[0] - 6) < 0.06, `${walker.pose().position[0]}`);
});
