// SPDX-License-Identifier: Apache-2.0
// `wellspring compare`: a print that is too large is found in its scan, and what is wrong is named.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { run } from '../server.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-compare-'));
after(() => rmSync(folder, { recursive: true }));
const path = (name) => join(folder, name);

// A ball of 20 voxels with a bump, half a millimetre each: shares of voxels as bytes.
const size = 64, voxel = 0.5;
const balls = [[32, 32, 32, 20], [32, 32, 52, 8]];
const values = new Uint8Array(size ** 3);
for (let i = 0; i < values.length; i++) {
  const place = [i % size, Math.floor(i / size) % size, Math.floor(i / size ** 2)];
  const distance = Math.min(...balls.map(([x, y, z, radius]) =>
    Math.hypot(place[0] - x, place[1] - y, place[2] - z) - radius));
  values[i] = 250 * Math.min(1, Math.max(0, 0.5 - distance / 2));
}
writeFileSync(path('scan.nrrd'), Buffer.concat([Buffer.from(`NRRD0004
type: uchar
dimension: 3
sizes: ${size} ${size} ${size}
spacings: ${voxel} ${voxel} ${voxel}
encoding: raw

`), values]));

// The surface of such a ball of 22 voxels, elsewhere in space, as text STL in millimetres.
function ball_stl(radius, shift) {
  const rings = 24, parts = 48;
  const place = (ring, part) => {
    const down = Math.PI * ring / rings, around = 2 * Math.PI * part / parts;
    return [Math.sin(down) * Math.cos(around), Math.sin(down) * Math.sin(around), Math.cos(down)]
      .map((v, i) => (v * radius * voxel + shift[i]).toFixed(5)).join(' ');
  };
  const facets = [];
  for (let ring = 0; ring < rings; ring++)
    for (let part = 0; part < parts; part++) {
      const [a, b] = [place(ring, part), place(ring + 1, part)];
      const [c, d] = [place(ring + 1, part + 1), place(ring, part + 1)];
      facets.push([a, b, c], [a, c, d]);
    }
  return ['solid ball', ...facets.map((corners) => 'facet normal 0 0 0\nouter loop\n' +
    corners.map((corner) => `vertex ${corner}\n`).join('') + 'endloop\nendfacet'), 'endsolid']
    .join('\n');
}
writeFileSync(path('ball.stl'), ball_stl(22, [500, 20, -3]));

test('a ball that is too large lacks a voxel of material everywhere, and its colours say so',
  async () => {
    const made = await run('wellspring_compare', [path('ball.stl'), path('scan.nrrd'),
      '--json', path('report.json'), '--csv', path('points.csv'), '--colored', path('out.glb')]);
    assert.equal(made.status, 0, made.stderr);
    assert.match(made.stdout, /ball\.stl: \d+ triangles/);
    const report = JSON.parse(readFileSync(path('report.json')));
    assert.equal(report.mesh.file, path('ball.stl'));
    assert.equal(report.registration.done, true);
    assert.ok(report.registration.iterations > 0);
    const { percentiles } = report.deviation;
    assert.ok(Math.abs(percentiles[3].distance_mm - 2 * voxel) < 0.2 * voxel,
      JSON.stringify(report.deviation));
    const lines = readFileSync(path('points.csv'), 'utf8').trim().split('\n');
    assert.equal(lines.length, report.deviation.points + 1);
    assert.match(lines[0], /^x_mm,y_mm,z_mm,/);
    assert.equal(readFileSync(path('out.glb')).toString('latin1', 0, 4), 'glTF');
  });

test('the coloured surface lies in the volume\'s frame and can be looked at closely', async () => {
  const first = JSON.parse(readFileSync(path('report.json')));
  const made = await run('wellspring_compare', [path('out.glb'), path('scan.nrrd'),
    '--no-register', '--json', path('again.json'), '--profile', '0,0,0', '--show', 'angle']);
  assert.equal(made.status, 0, made.stderr);
  const again = JSON.parse(readFileSync(path('again.json')));
  assert.equal(again.registration.done, false);
  assert.ok(Math.abs(again.deviation.mean_mm - first.deviation.mean_mm) < 0.01);
  assert.equal(again.color_scale.unit, 'degrees');
  const { ray_profile } = again;
  assert.equal(ray_profile.place_mm.length, ray_profile.slope_per_mm.length);
  const corner = readFileSync(path('points.csv'), 'utf8').split('\n')[1].split(',').slice(0, 3);
  const lens = await run('wellspring_compare', [path('out.glb'), path('scan.nrrd'),
    '--no-register', '--json', path('lens.json'), '--lens', [...corner, 5, 2].join(',')]);
  assert.equal(lens.status, 0, lens.stderr);
  const { box_plots, glyphs } = JSON.parse(readFileSync(path('lens.json')));
  assert.ok(box_plots.length > 4);
  assert.equal(glyphs.length, box_plots.length);
  assert.ok(box_plots[0].min_mm <= box_plots[0].mean_mm);
});

test('what is wrong is named', async () => {
  const compare = (...args) => run('wellspring_compare', args);
  assert.equal((await compare()).status, 2);
  assert.equal((await compare(path('ball.stl'))).status, 2);
  assert.equal((await compare(path('ball.stl'), path('scan.nrrd'), '--lens', '1,2,3,0,1')).status,
    2);
  writeFileSync(path('bad.stl'), 'solid\nvertex 1 2 x\n');
  const bad = await compare(path('bad.stl'), path('scan.nrrd'));
  assert.equal(bad.status, 1);
  assert.match(bad.stderr, /bad\.stl: byte \d+: 'x' is no number/);
  writeFileSync(path('pairs.json'), '{"pairs": []}');
  const few = await compare(path('ball.stl'), path('scan.nrrd'), '--points', path('pairs.json'));
  assert.equal(few.status, 1);
  assert.match(few.stderr, /three pairs/);
  writeFileSync(path('far.stl'), ball_stl(22, [9e7, 0, 0]));
  const far = await compare(path('far.stl'), path('scan.nrrd'), '--no-register');
  assert.equal(far.status, 0, far.stderr);
  assert.match(far.stdout, /not found on 100\.00 %/);
});
