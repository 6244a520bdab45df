// SPDX-License-Identifier: Apache-2.0
// The page's shader and the server's warp are one: keyframes of a walk, as both show them from the
// same views.
import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { cross } from '../../web/display/view.js';
import { read_picture } from '../../web/packet.js';
import { Visitor, run, start_server, until } from '../server.mjs';
import { by_processor, launch, pictures, skip } from './chromium.mjs';
import { begin_in_page } from './keyframes.mjs';

const most_flip = 0.01;

let server, browser, folder;
before(async () => {
  if (skip) return;
  server = await start_server(['--exhibit', 'first-room']);
  browser = await launch(by_processor);
  folder = mkdtempSync(join(tmpdir(), 'wellspring_warp_'));
});
after(async () => {
  await browser?.close();
  await server?.stop();
  if (folder) rmSync(folder, { recursive: true });
});

// Pictures of somebody who walks and turns: the keyframe before, the next, and a wide one.
async function walk() {
  const visitor = new Visitor(server), got = [];
  let first = null, next = null, wide = null;
  const from_first = ({ keyframe }) =>
    Math.hypot(...keyframe.view.eye.map((v, i) => v - first.keyframe.view.eye[i]));
  visitor.next(({ binary }) => {
    if (!binary) return false;
    const { buffer, byteOffset, length } = binary;
    const picture = read_picture(buffer.slice(byteOffset, byteOffset + length));
    if (!picture?.keyframe || picture.layer) return false;
    got.push({ ...picture, bytes: Buffer.from(binary) });
    return false;
  }).catch(() => {});
  await visitor.hello({ display: 'local', width: 640, height: 360 });
  await until(() => { first = got.find(({ around }) => !around); return first; }, 'a keyframe');
  visitor.send({ type: 'input', seq: 1, move: [0.5, 0, 0.3], look: [0.15, 0.05] });
  await until(() => {
    wide = got.find(({ around }) => around);
    next = got.find((one) => !one.around && from_first(one) > 0.15);
    return wide && next;
  }, 'a wide keyframe and one from elsewhere');
  await visitor.close();
  return { first, next, wide };
}

// The view moved by metres along its axes and turned to the left.
function moved({ view }, [right, up, forward], turn = 0) {
  const { eye, tan_half_fov, middle } = view, sin = Math.sin(turn), cos = Math.cos(turn);
  const turned = view.forward.map((v, i) => cos * v - sin * view.right[i]);
  return { tan_half_fov: tan_half_fov * 360 / view.height, middle, width: 640, height: 360,
    eye: eye.map((v, i) => v + right * view.right[i] + up * view.up[i] + forward * view.forward[i]),
    right: cross(turned, view.up), up: view.up, forward: turned };
}

// Returns each view's pixels, as the page draws them.
const draw = (page, steps) => page.evaluate(async (all) => {
  const { warp, load, pixels, end } = /** @type {any} */ (globalThis).drawing;
  const drawn = {};
  for (const { bytes, name, view } of all) {
    if (bytes) {
      const { picture, keyframe } = await load(bytes);
      if (picture.around) warp.set_around(keyframe);
      else warp.add(keyframe, 0, false);
      continue;
    }
    if (!warp.show(view, 1e6)) throw new Error(`${name} is not drawn`);
    const { width, height } = view, rows = pixels(view), rgb = [];
    for (let y = height - 1; y >= 0; y--)  // the lowest row is the first
      for (let i = 4 * y * width; i < 4 * (y + 1) * width; i += 4)
        rgb.push(rows[i], rows[i + 1], rows[i + 2]);
    drawn[name] = rgb;
  }
  end();
  return drawn;
}, steps);

test('shader and server draw the same picture', { skip }, async () => {
  const { first, next, wide } = await walk();
  const steps = [
    { packet: first },
    { name: 'same', view: moved(first.keyframe, [0, 0, 0]) },
    { name: 'small', view: moved(first.keyframe, [0.03, 0.01, 0.05], 0.02) },
    { name: 'large', view: moved(first.keyframe, [0.3, 0, 0.4], -0.1) },
    { name: 'outside', view: moved(first.keyframe, [0, 0, 0], 0.4) },
    { packet: next },
    { name: 'two', view: moved(next.keyframe, [-0.25, 0, -0.2], 0.05) },
    { packet: wide },
    { name: 'three', view: moved(next.keyframe, [0.3, 0, 0.3]) },
    { name: 'wide', view: moved(next.keyframe, [0.05, 0, 0], 0.6) },
  ];
  const page = await browser.newPage();
  await page.goto(`${server.url}/healthz`);
  await page.evaluate(begin_in_page);
  const drawn = await draw(page, steps.map(({ packet, ...step }) =>
    packet ? { bytes: packet.bytes.toString('base64') } : step));
  for (const [name, rgb] of Object.entries(drawn))
    writeFileSync(join(folder, `${name}.rgb`), Uint8Array.from(rgb));
  steps.forEach(({ packet }, i) => {
    if (packet) writeFileSync(join(folder, `${i}.packet`), packet.bytes);
  });
  writeFileSync(join(folder, 'steps.json'), JSON.stringify(steps.map(({ packet, ...step }, i) =>
    packet ? { packet: `${i}.packet` } : step)));
  const { status, stdout, stderr } = await run('wellspring_bench', ['--warp', folder]);
  assert.equal(status, 0, stderr);
  if (pictures) cpSync(folder, join(pictures, 'display-warp'), { recursive: true });
  const flips = JSON.parse(stdout);
  console.log(stdout.trim());
  assert.deepEqual(Object.keys(flips), Object.keys(drawn).sort());
  for (const [name, flip] of Object.entries(flips))
    assert.ok(flip <= most_flip, `${name}: FLIP ${flip}`);
  await page.close();
});
