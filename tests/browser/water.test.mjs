// SPDX-License-Identifier: Apache-2.0
// The well's water as numbers.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { source } from '../server.mjs';

const text = readFileSync(join(source, 'web/kiosk/water.js'), 'utf8');
const { make_water, cells, courant } = await import(
    `data:text/javascript,${encodeURIComponent(text)}`);
const heights = (water) => {
  const surface = water.surface();
  return Float64Array.from({ length: cells * cells }, (_, i) => surface[4 * i]);
};
const most = (values) => values.reduce((a, b) => Math.max(a, Math.abs(b)), 0);

test('the scheme is stable, and energy is kept without damping and never grows with it', () => {
  assert.ok(courant <= Math.SQRT1_2, `Courant number ${courant}`);
  const free = make_water(0);
  free.press(0.3, -0.2);
  free.advance(0.05);
  const at_first = free.energy();
  assert.ok(at_first > 1e-5);
  for (let i = 0; i < 300; i++) free.advance(0.1);  // half a minute, many ways to the rim and back
  assert.ok(Math.abs(free.energy() / at_first - 1) < 1e-4, `${free.energy()} of ${at_first}`);
  const damped = make_water();
  damped.press(-0.5, 0.4, 0.05);
  for (let i = 0, before = Infinity; i < 1200; i++) {
    damped.advance(1 / 120);
    const now = damped.energy();
    assert.ok(now <= before * (1 + 1e-6), `step ${i}: ${now} after ${before}`);
    before = now;
  }
});

test('a drop in the middle stays symmetric to the last bit', () => {
  const water = make_water();
  water.press(0, 0);
  water.advance(0.25);
  for (let k = 0; k < 12; k++) water.advance(0.1);
  const u = heights(water);
  assert.ok(most(u) > 1e-4);
  for (let j = 0; j < cells; j++)
    for (let i = 0; i < cells; i++) {
      const value = u[j * cells + i];
      assert.equal(value, u[i * cells + j]);
      assert.equal(value, u[j * cells + cells - 1 - i]);
      assert.equal(value, u[(cells - 1 - j) * cells + i]);
    }
});

test('15, 60 and 144 pictures a second show the same waves', () => {
  const at = (rate) => {
    const water = make_water();
    water.press(0.4, 0.1);
    for (let i = 0; i < 2 * rate; i++) water.advance(1 / rate);
    return heights(water);
  };
  const [slow, usual, quick] = [15, 60, 144].map(at);
  assert.ok(most(usual) > 1e-4);
  for (const other of [slow, quick]) {
    const apart = most(usual.map((u, i) => u - other[i]));
    assert.ok(apart < 0.02 * most(usual), `${apart} of ${most(usual)}`);
  }
});

test('waves run to the rim and come back; water is neither made nor lost; then it rests', () => {
  const water = make_water();
  assert.ok(water.at_rest());
  assert.ok(water.press(0, 0, 0.04));
  const ring = () => {  // mean height near the rim
    const u = heights(water);
    let sum = 0, count = 0;
    for (let j = 0; j < cells; j++)
      for (let i = 0; i < cells; i++) {
        const r = Math.hypot((i + 0.5) * 2 / cells - 1, (j + 0.5) * 2 / cells - 1);
        if (r > 0.9 && r < 0.98) sum += Math.abs(u[j * cells + i]), count++;
      }
    return sum / count;
  };
  const middle = () => Math.abs(heights(water)[(cells / 2) * (cells + 1)]);
  const before = ring();
  for (let i = 0; i < 11; i++) water.advance(0.1);  // 0.9 radii a second
  assert.ok(ring() > 5 * before, `${ring()} at the rim, ${before} at first`);
  for (let i = 0; i < 7; i++) water.advance(0.1);
  const low = middle();
  let back = 0;
  for (let i = 0; i < 9; i++) { water.advance(0.1); back = Math.max(back, middle()); }
  assert.ok(back > 2 * low, `${back} comes back, ${low} before`);
  assert.ok(Math.abs(water.volume()) < 1e-6, `volume ${water.volume()}`);
  for (let i = 0; i < 900 && !water.at_rest(); i++) water.advance(0.1);
  assert.ok(water.at_rest());
  assert.equal(water.energy(), 0);
});

test('touches outside, nonsense and long sleeps do no harm', () => {
  const water = make_water();
  for (const [x, y] of [[1.2, 0], [NaN, 0], [0, Infinity], [0.9, 0.9]])
    assert.equal(water.press(x, y), false);
  assert.equal(water.press(0, 0, NaN), false);
  assert.ok(water.at_rest());
  for (let i = 0; i < 400; i++) water.press(0.99 * Math.sin(i), 0.1 * Math.cos(i), 0.05);
  for (const seconds of [1e6, NaN, -5, Infinity]) water.advance(seconds);
  for (let i = 0; i < 50; i++) water.advance(0.2);
  assert.ok(heights(water).every(Number.isFinite));
  assert.ok(Number.isFinite(water.energy()));
});
