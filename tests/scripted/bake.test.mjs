// SPDX-License-Identifier: Apache-2.0
// The bake command as its user meets it: files out, and what it says of bad input.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { run, source, start_server, until } from '../server.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-bake-'));
after(() => rmSync(folder, { recursive: true, force: true }));
const cache = join(folder, 'cache');
const bake = (...args) => run('wellspring_bake', ['--cache', cache, ...args]);
const check = (package_folder) => run('wellspring_check', ['--cache', cache, package_folder]);
const passes_of = (said) => Number(/: (\d+) passes, error/.exec(said.stdout)?.[1]);

// A floor under a bulb: {folder} of its package.
function make_package(name, { metallic = 0, color = 0.5 } = {}) {
  const floor = [-2, 0, 2, 2, 0, 2, 2, 0, -2, -2, 0, -2];
  const up = [0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0];
  const bytes = Buffer.concat([Buffer.from(new Float32Array([...floor, ...up]).buffer),
    Buffer.from(new Uint16Array([0, 1, 2, 0, 2, 3]).buffer)]);
  const scene = {
    asset: { version: '2.0' }, extensionsUsed: ['KHR_lights_punctual'],
    extensions: { KHR_lights_punctual: { lights: [{ type: 'point', intensity: 5 }] } },
    buffers: [{ byteLength: bytes.length,
      uri: `data:application/octet-stream;base64,${bytes.toString('base64')}` }],
    bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 48 },
      { buffer: 0, byteOffset: 96, byteLength: 12 }],
    accessors: [
      { bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [-2, 0, -2],
        max: [2, 0, 2] },
      { bufferView: 1, componentType: 5126, count: 4, type: 'VEC3' },
      { bufferView: 2, componentType: 5123, count: 6, type: 'SCALAR' }],
    materials: [{ pbrMetallicRoughness: { baseColorFactor: [color, color, color, 1],
      metallicFactor: metallic } }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2,
      material: 0 }] }],
    cameras: [{ type: 'perspective', perspective: { yfov: 1, znear: 0.1 } }],
    nodes: [{ name: 'Floor', mesh: 0 },
      { name: 'Bulb', translation: [0, 2, 0], extensions: { KHR_lights_punctual: { light: 0 } } },
      { name: 'Eye', translation: [0, 1.6, 1], camera: 0 }],
    scenes: [{ nodes: [0, 1, 2] }], scene: 0,
  };
  const made = join(folder, name);
  mkdirSync(made, { recursive: true });
  writeFileSync(join(made, 'scene.gltf'), JSON.stringify(scene));
  writeFileSync(join(made, 'exhibit.json'),
      JSON.stringify({ title: 'Floor', languages: ['en'], scene: 'scene.gltf' }));
  return made;
}

// Goes on until so many passes are done, however slow the machine.
async function bake_passes(passes, ...args) {
  for (let i = 0; i < 40; i++) {
    const said = await bake(...args, '--time', '2s', '--resume');
    assert.equal(said.status, 0, said.stderr);
    if (passes_of(said) >= passes) return said;
  }
  assert.fail(`no ${passes} passes`);
}

test('bakes, goes on and keeps what servers look for', async () => {
  const floor = make_package('floor');
  const first = await bake(floor, '--time', '2s');
  assert.equal(first.status, 0, first.stderr);
  assert.match(first.stdout, /charts, \d+ texels, 1 layers: \d+ bytes/);
  assert.ok(statSync(join(cache, 'floor.bake')).size > 100000);
  const passes = passes_of(first);
  const later = await bake_passes(passes + 1, floor);
  assert.ok(passes_of(later) > passes);
  assert.ok(statSync(join(floor, 'light.maps')).size > 10000, 'the package carries its light');
  // Another scene is begun anew.
  make_package('floor', { color: 0.6 });
  const changed = await bake(floor, '--resume', '--time', '0.1s');
  assert.equal(changed.status, 0);
  assert.match(changed.stderr, /floor\.bake: stale/);
  const said = await check(floor);
  assert.match(said.stdout, /light\.maps: is stale: .*wellspring bake/);
  assert.ok(passes_of(changed) < passes_of(later));
});

test('every exhibit is good, and its light is of its scene as it is', async () => {
  for (const name of ['castle', 'first-room', 'chapel', 'galaxies']) {
    const said = await check(join(source, 'content', name));
    assert.match(said.stdout, /good, 0 notes/);
  }
});

test('shards are merged into one', async () => {
  const hall = make_package('hall'), part = (i) => join(cache, `hall.${i}of2.bake`);
  for (const i of [1, 2]) {
    await bake_passes(1, hall, '--shard', `${i}/2`);
    assert.ok(existsSync(part(i)));
  }
  assert.ok(!existsSync(join(hall, 'light.maps')), 'half of it is no map');
  const alone = await bake('--merge', part(1));
  assert.equal(alone.status, 1);
  assert.match(alone.stderr, /shards are missing: 1 of 2/);
  const twice = await bake('--merge', part(1), part(1));
  assert.equal(twice.status, 1);
  assert.match(twice.stderr, /not another shard/);
  const merged = await bake('--merge', part(1), part(2));
  assert.equal(merged.status, 0, merged.stderr);
  assert.ok(passes_of(merged) >= 1);
  assert.ok(existsSync(join(cache, 'hall.bake')));
  assert.ok(existsSync(join(hall, 'light.maps')));
  make_package('hall', { color: 0.6 });
  const stale = await bake('--merge', part(1), part(2));
  assert.equal(stale.status, 1);
  assert.ok(stale.stderr.includes(`${part(1)}: stale`), stale.stderr);
});

test('servers bake while nobody needs the cores, nor waits for a still picture', async () => {
  make_package('room', { color: 0.9 });
  const server = await start_server(['--exhibit', 'room', '--cache', join(folder, 'served')],
      { content: folder });
  const read = async (name) => {
    const text = await (await fetch(`${server.url}/metrics`)).text();
    return Number(new RegExp(`^wellspring_${name}(?:{.*})? (\\d+)$`, 'm').exec(text)[1]);
  };
  await until(async () => await read('bake_working') === 1);
  const gone = new AbortController();
  const still = fetch(`${server.url}/api/v1/exhibits/room/still.jpg?` +
      'width=1920&height=1080&spp=32&seconds=3600',
      { signal: gone.signal }).catch(() => 'given up');
  await until(async () => await read('bake_working') === 0);
  assert.equal(await read('stills_waiting'), 1);
  gone.abort();
  assert.equal(await still, 'given up');
  await until(async () => await read('bake_working') === 1);
  assert.equal(await server.stop(), 0);
});

test('where nothing is diffuse it ends at once', async () => {
  const said = await bake(make_package('metal', { metallic: 1 }), '--time', '1h');
  assert.equal(said.status, 0, said.stderr);
  assert.match(said.stdout, /^0 charts/);
  assert.ok(!existsSync(join(folder, 'metal', 'light.maps')));
});

test('a wrong command line is 2, wrong input 1, and both are told', async () => {
  const floor = make_package('other');
  for (const [args, what] of [[[], /content\/castle is expected/],
      [[floor, '--time', 'soon'], /--time soon: a time/], [[floor, '--time', '-3s'], /a time/],
      [[floor, '--time', '0'], /a time/], [[floor, '--time', '5x'], /a time/],
      [[floor, '--shard', '3/2'], /--shard 3\/2: i\/N/], [[floor, '--shard', '1'], /i\/N/],
      [[floor, '--shard', '1/2x'], /i\/N/], [[floor, '--fast'], /--fast/]]) {
    const said = await bake(...args);
    assert.equal(said.status, 2, `${args}: ${said.stdout}${said.stderr}`);
    assert.match(said.stdout + said.stderr, what);
  }
  const junk = join(folder, 'junk.bake');
  writeFileSync(junk, 'no bake');
  for (const [args, what] of [[[join(folder, 'atlantis'), '--time', '1s'], /atlantis/],
      [['--merge', junk], /junk\.bake: not a bake/],
      [[floor, '--merge', junk], /junk\.bake: damaged/],
      [[floor, '--merge', join(folder, 'none.bake')], /none\.bake: not found/]]) {
    const said = await bake(...args);
    assert.equal(said.status, 1, `${args}: ${said.stdout}${said.stderr}`);
    assert.match(said.stderr, what);
  }
  assert.ok(!existsSync(join(cache, 'atlantis.bake')));
});
