// SPDX-License-Identifier: Apache-2.0
// Grass that a page moves between keyframes stands as the server draws it at that time.
import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { read_picture } from '../../web/packet.js';
import { Visitor, source, start_server, until } from '../server.mjs';
import { by_processor, launch, pictures, skip } from './chromium.mjs';
import { begin_in_page } from './keyframes.mjs';

const width = 640, height = 360;
// Share of the difference that the page may leave: its blocks are coarser than blades.
const most_left = 0.93;
let server, browser;
const content = mkdtempSync(join(tmpdir(), 'wellspring_sway_'));

before(async () => {
  if (skip) return;
  cpSync(join(source, 'content/first-room'), join(content, 'first-room'), { recursive: true });
  const file = join(content, 'first-room/exhibit.json');
  const exhibit = JSON.parse(readFileSync(file, 'utf8'));
  const lawn = { id: 'grass', kind: 'lawn', place: { position: [0, 0, 0] }, area_m: [5, 4],
    blades: { density: 1500, height_m: 0.2, width_m: 0.012 }, wind: 1.5 };
  const view = { name: 'grass', title: { en: 'Grass' }, position: [1.6, 1.2, 1.6], yaw_deg: 45,
    pitch_deg: -32, fov_deg: 60 };
  exhibit.pieces = [...exhibit.pieces ?? [], lawn];
  exhibit.viewpoints.push(view);
  exhibit.start = 'grass';
  writeFileSync(file, JSON.stringify(exhibit));
  server = await start_server(['--exhibit', 'first-room', '--no-bake'], { content });
  browser = await launch(by_processor);
});
after(async () => {
  await browser?.close();
  await server?.stop();
  rmSync(content, { recursive: true });
});

// Returns keyframes of somebody who stands before the grass, `seconds` of wind from first to last.
async function keyframes(seconds, hello = {}) {
  const visitor = new Visitor(server), got = [];
  visitor.next(({ binary }) => {
    if (!binary) return false;
    const { buffer, byteOffset, length } = binary;
    const picture = read_picture(buffer.slice(byteOffset, byteOffset + length));
    if (picture?.sway && picture.still) got.push({ ...picture, bytes: Buffer.from(binary) });
    return false;
  }).catch(() => {});
  await visitor.hello({ display: 'local', width, height, ...hello });
  await until(() => got.length > 1 && got.at(-1).sway.time > got[0].sway.time + seconds,
      'keyframes at rest, whose grass sways');
  await visitor.close();
  return got;
}

// Draws each keyframe as it is, at the time of the one after it, and at as much before; returns the
// mean differences of pixels that sway from the one after it: of the first, the second, the third.
const compare = (page, packets) => page.evaluate(async (all) => {
  const { warp, load, pixels, end } = /** @type {any} */ (globalThis).drawing;
  const shots = [], sums = [0, 0, 0];
  const shot = (view, wind) => {
    if (!warp.show(view, 1e6, wind)) throw new Error('nothing is drawn');
    return pixels(view);
  };
  const pairs = [];
  for (let i = 0; i + 1 < all.length; i++) {
    const one = (await load(all[i])).keyframe, next = (await load(all[i + 1])).keyframe;
    const { view, sway } = one, { columns, codes } = sway, block = Math.ceil(view.width / columns);
    const gap = next.sway.time - sway.time;
    warp.add(one, 0, false);
    const [still, later, earlier] = [0, gap, -gap].map((after) => shot(view, sway.time + after));
    warp.add(next, 0, false);
    const truth = shot(view, next.sway.time);
    if (i === 0) shots.push(still, later, truth);
    const pair = [still, later, earlier].map((picture) => {
      let sum = 0, count = 0;
      for (let y = 0; y < view.height; y++)
        for (let x = 0; x < view.width; x++) {
          if (codes[Math.floor(y / block) * columns + Math.floor(x / block)] === 0) continue;
          const p = 4 * ((view.height - 1 - y) * view.width + x);
          for (let c = 0; c < 3; c++) sum += Math.abs(picture[p + c] - truth[p + c]);
          count++;
        }
      return sum / count;
    });
    pair.forEach((value, k) => { sums[k] += value / (all.length - 1); });
    pairs.push({ gap, pair });
  }
  // What a picture costs, with and without wind.
  const last = (await load(all.at(-1))).keyframe, cost = [];
  warp.add(last, 0, false);
  for (const after of [0, 0.3]) {
    const began = performance.now();
    for (let i = 0; i < 10; i++) shot(last.view, last.sway.time + after);
    cost.push((performance.now() - began) / 10);
  }
  end();
  return { sums, pairs, cost, shots: shots.map((rows) => [...rows]) };
}, packets.map(({ bytes }) => bytes.toString('base64')));

test('between keyframes grass goes where the next one has it', { skip }, async () => {
  const got = await keyframes(5);
  const bytes = got.map(({ sway, bytes: { length } }) => [sway.codes.length + 116, length]);
  const page = await browser.newPage();
  await page.goto(`${server.url}/healthz`);
  await page.evaluate(begin_in_page);
  const { sums, pairs, cost, shots } = await compare(page, got);
  console.log(JSON.stringify({ sums, pairs, cost, bytes }));
  if (pictures)
    shots.forEach((rows, i) => writeFileSync(join(pictures, `sway-${i}.rgba`),
        Uint8Array.from(rows)));
  const [still, moved, against] = sums;
  assert.ok(moved < most_left * still, `${moved} of ${still}`);
  assert.ok(against > still, 'wind the other way is farther off than none');
  for (const [sway, all] of bytes) assert.ok(sway < 0.1 * all, `${sway} of ${all} bytes`);
  await page.close();
});

test('the page moves grass at rest, unless its visitor asks for calm', { skip }, async () => {
  for (const reducedMotion of /** @type {const} */ (['no-preference', 'reduce'])) {
    const page = await browser.newPage({ viewport: { width: 480, height: 270 }, reducedMotion });
    await page.goto(`${server.url}/?display=local`);
    await page.waitForSelector('canvas.local:not([hidden])');
    const sways = reducedMotion === 'no-preference';
    await page.waitForSelector(`canvas.local[data-sways=${sways}]`);
    const frame = () => page.evaluate(() =>
      Number(document.getElementById('picture').dataset.frame ?? 0));
    const before = await frame();
    await until(async () => await frame() > before + 8, 'keyframes come');
    assert.equal(await page.getAttribute('canvas.local', 'data-sways'), String(sways));
    await page.close();
  }
});
