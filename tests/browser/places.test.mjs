// SPDX-License-Identifier: Apache-2.0
// Places on a collection's map: directions, circles, turns, the window, the trail.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { test } from 'node:test';

const web = join(process.env.WELLSPRING_SOURCE, 'web/collection');
const { in_circle, make_turn, nearest_place, next_place, usual_radius } =
    await import(join(web, 'places.js'));
const { circle_step, groups_step, make_trail, read_steps } = await import(join(web, 'trail.js'));
const { make_view } = await import(join(web, 'view.js'));
const { clearness, map_truth, place_truth } = await import(join(web, 'truth.js'));

let seed = 12345;
const random = () => { seed = (seed * 48271) % 2147483647; return seed / 2147483647; };
const places = Array.from({ length: 150 }, () => [4 * random() - 2, 3 * random() - 1.5]);
const arrows = [[1, 0], [-1, 0], [0, 1], [0, -1]];

test('an arrow leads to the nearest object in its quarter, and arrows lead everywhere', () => {
  const cross = [[0, 0], [1, 0.2], [2, 0], [-1, -0.9], [0.1, 3], [0.5, -2]];
  assert.deepEqual(arrows.map((way) => next_place(cross, 0, way)), [1, 3, 4, 5]);
  assert.equal(next_place(cross, 2, [1, 0]), -1, 'nothing lies farther to the right');
  assert.equal(next_place(cross, 0, [1, 0], (i) => i !== 1), 2);
  const reached = new Set([0]);
  for (const from of reached)
    for (const way of arrows) {
      const to = next_place(places, from, way);
      if (to >= 0) reached.add(to);
    }
  assert.equal(reached.size, places.length);
});

test('circles hold what lies in them, at first a share of all', () => {
  const radius = usual_radius(places, places[7]);
  const inside = in_circle(places, places[7], radius);
  assert(inside.includes(7));
  assert(Math.abs(inside.length - 0.12 * places.length) <= 2, `${inside.length}`);
  const pair = [[0, 0], [1, 1]];
  assert.equal(in_circle(pair, pair[0], usual_radius(pair, pair[0])).length, 2);
  assert.equal(nearest_place(places, places[3]), 3);
  assert.equal(nearest_place([[9, 9]], [0, 0], 1), -1);
});

test('a new map is turned and mirrored onto the last one', () => {
  for (const mirror of [1, -1]) {
    const [cos, sin] = [Math.cos(2.1), Math.sin(2.1)];
    const seen = places.map(([x, y]) => [cos * x - sin * mirror * y, sin * x + cos * mirror * y]);
    const turn = make_turn(places.map((place, i) => [place, seen[i]]));
    seen.map(turn).forEach((place, i) =>
      place.forEach((value, k) => assert(Math.abs(value - places[i][k]) < 1e-9)));
  }
  assert.deepEqual(make_turn([])([1, 2]), [1, 2]);
  assert.deepEqual(make_turn([[[1, 1], [5, 5]]])([1, 2]), [1, 2]);
});

test('the window shows everything, enlarges at a place and comes back', () => {
  const view = make_view();
  view.resize(800, 600);
  view.fit(places, 76);
  for (const place of places) {
    const [x, y] = view.to_screen(place);
    assert(x > 20 && x < 780 && y > 20 && y < 600 - 76, `${x}, ${y}`);
    view.to_map([x, y]).forEach((value, k) => assert(Math.abs(value - place[k]) < 1e-9));
  }
  const before = view.to_map([100, 200]);
  view.zoom_at(3, [100, 200]);
  view.to_map([100, 200]).forEach((value, k) => assert(Math.abs(value - before[k]) < 1e-9));
  assert(Math.abs(view.zoom() - 3) < 1e-9);
  for (const place of places) {
    view.reveal(place);
    assert(view.has(view.to_screen(place)));
  }
  view.zoom_at(1e9, [0, 0]);
  assert(view.zoom() <= 40.001);
  view.fit([[1, 1], [1, 1]]);
  assert(view.has(view.to_screen([1, 1])), 'equal places have a size of nothing');
});

test('a trail is written as the server reads it, and nothing else is', () => {
  assert.equal(circle_step(12, 0.123456789), '12@0.123457');
  assert.equal(groups_step(new Set([4, 0, 2])), 'c0,2,4');
  assert.deepEqual(read_steps('12@0.35;c0,2'), ['12@0.35', 'c0,2']);
  for (const wrong of ['', 'x', '12@', 'c', '12@0.3;<b>', Array(25).fill('c0').join(';')])
    assert.deepEqual(read_steps(wrong), []);
  const trail = make_trail(read_steps('1@2'));
  trail.add('c1', 'Only wool');
  assert.equal(trail.text(), '1@2;c1');
  trail.set('1@2;c1;c0');
  assert.deepEqual(trail.names(), ['', 'Only wool', '']);
  trail.cut(1);
  assert.equal(trail.text(), '1@2');
});

test('the truth of a place is told by its stress beside that of the map', () => {
  assert.deepEqual([0, 0.3, 0.4, 0.9].map((stress) => place_truth(stress, 0.3)), [0, 1, 2, 3]);
  assert.equal(place_truth(0.1, 0.02), 0, 'true is true, however much truer the others are');
  assert.deepEqual([0.05, 0.2, 0.4, 0.6].map(map_truth), [0, 1, 2, 3]);
  const clear = [0, 0.3, 0.6, 2].map((stress) => clearness(stress, 0.3));
  assert.equal(clear[0], 1);
  assert(clear[1] > clear[2] && clear[2] > clear[3] - 1e-9 && clear[3] > 0.3);
});
