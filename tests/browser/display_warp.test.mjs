// SPDX-License-Identifier: Apache-2.0
// The page's shader draws of a keyframe what the server's warp makes of it: the same packets, from
// the same places.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { read_picture } from '../../web/packet.js';
import { Visitor, run, start_server } from '../server.mjs';
import { by_processor, launch, skip } from './chromium.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-warp-'));
let server, browser;
before(async () => {
  if (skip) return;
  server = await start_server(['--exhibit', 'first-room']);
  browser = await launch(by_processor);
});
after(async () => {
  await browser?.close();
  await server?.stop();
  rmSync(folder, { recursive: true, force: true });
});

// Two packets of a walk, a keyframe and a wide one of about the same place.
async function walk() {
  const visitor = new Visitor(server), found = {};
  const ready = visitor.next((item) => {
    if (!item.binary) return false;
    const { buffer, byteOffset, length } = item.binary;
    const bytes = buffer.slice(byteOffset, byteOffset + length), picture = read_picture(bytes);
    if (picture?.keyframe && !picture.layer) {
      found[picture.around ? 'around' : 'newest'] = Buffer.from(bytes);
      if (!picture.around) found.view = picture.keyframe.view;
    }
    return Boolean(found.newest && found.around);
  }, 'both keyframes');
  await visitor.hello({ display: 'local', width: 640, height: 360 });
  visitor.send({ type: 'input', seq: 1, move: [0.3, 0, 0.3], look: [0.1, 0] });
  await ready;
  await visitor.close();
  return found;
}

const plus = (a, b, share) => a.map((v, i) => v + share * b[i]);
// The view of who goes on by that much to the right and ahead, and turns to the left.
function moved(view, right, ahead, turn) {
  const eye = plus(plus(view.eye, view.right, right), view.forward, ahead);
  return { ...view, width: 640, height: 360, middle: [0, 0], eye,
    forward: plus(view.forward.map((v) => Math.cos(turn) * v), view.right, -Math.sin(turn)),
    right: plus(view.right.map((v) => Math.cos(turn) * v), view.forward, Math.sin(turn)) };
}

// In a page: the pixels of views, RGB in base64, each of some of the packets, in base64.
async function draw_in_page(cases) {
  const { read_picture: read } = await import('./packet.js');
  const { make_warp } = await import('./display/warp.js');
  const worker = new Worker('display/decoder.js', { type: 'module' });
  const bytes_of = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const decode = (picture) => new Promise((done) => {
    const { color_bytes, view, unit, cuts } = picture.keyframe, { width, height } = view;
    worker.onmessage = ({ data }) => done({ view, unit, cuts, ...data });
    worker.postMessage({ id: 0, color: picture.payload.slice(0, color_bytes),
      depth: picture.payload.slice(color_bytes), width, height });
  });
  const pixels = [];
  for (const { packets, view } of cases) {
    const canvas = document.createElement('canvas'), warp = make_warp(canvas, () => {});
    for (const packet of packets) {
      const picture = read(bytes_of(packet).buffer), keyframe = await decode(picture);
      if (picture.around) warp.set_around(keyframe);
      else warp.add(keyframe, 0, false);
    }
    warp.show(view, 1e6);
    const gl = canvas.getContext('webgl2'), { width, height } = view;
    const rgba = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
    let text = '';
    for (let y = height - 1; y >= 0; y--)
      for (let i = 4 * y * width; i < 4 * (y + 1) * width; i++)
        if (i % 4 < 3) text += String.fromCharCode(rgba[i]);
    pixels.push(btoa(text));
  }
  worker.terminate();
  return pixels;
}

test('the shader draws what the server\'s warp makes', { skip }, async (t) => {
  const { newest, around, view } = await walk();
  writeFileSync(join(folder, 'newest'), newest);
  writeFileSync(join(folder, 'around'), around);
  // What a farther step uncovers the page takes from the wide keyframe, the server does not.
  const both = ['newest', 'around'];
  const cases = [
    { keyframes: ['newest'], view: moved(view, 0, 0, 0), most: 0.001 },
    { keyframes: ['newest'], view: moved(view, 0.03, 0.02, 0.01), most: 0.01 },
    { keyframes: both, view: moved(view, 0.02, 0.01, 0.05), most: 0.015 },
    { keyframes: ['newest'], view: moved(view, 0.2, 0.1, 0), most: 0.012 },
    { keyframes: ['newest'], view: moved(view, -0.1, 0.5, 0.02), most: 0.025 },
    { keyframes: both, view: moved(view, 0.1, 0, 0.3), most: 0.04 },
  ];
  const page = await browser.newPage();
  await page.goto(`${server.url}/?display=server`);
  const shown = await page.evaluate(draw_in_page, cases.map(({ keyframes, view: one }) => ({
    view: one, packets: keyframes.map((name) =>
      (name === 'newest' ? newest : around).toString('base64')) })));
  shown.forEach((pixels, i) =>
    writeFileSync(join(folder, `${i}.rgb`), Buffer.from(pixels, 'base64')));
  writeFileSync(join(folder, 'cases.json'),
      JSON.stringify(cases.map((one, i) => ({ ...one, shown: `${i}.rgb` }))));
  const { status, stdout, stderr } = await run('wellspring_bench', ['--compare-page', folder]);
  assert.equal(status, 0, stderr);
  const flips = JSON.parse(stdout);
  t.diagnostic(`FLIP ${flips.map((one) => one.toFixed(4)).join(', ')}`);
  assert.equal(flips.length, cases.length);
  flips.forEach((flip, i) => assert.ok(flip <= cases[i].most, `case ${i}: ${flip}`));
});
