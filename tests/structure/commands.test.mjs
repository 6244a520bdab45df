// SPDX-License-Identifier: Apache-2.0
// The command line's promises: exit status 0 done, 1 the input is wrong, 2 the command line is
// wrong.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync, mkdirSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { run, source } from '../server.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-'));
after(() => rmSync(folder, { recursive: true, force: true }));
const castle = join(source, 'content', 'castle');

const triangle = {
  asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, name: 'Sail' }],
  meshes: [{ primitives: [{ attributes: { POSITION: 0 }, material: 0 }] }],
  materials: [{ emissiveFactor: [1, 0.5, 0.25], doubleSided: true }],
  accessors: [{
    bufferView: 0, componentType: 5126, count: 3, type: 'VEC3', min: [-1, -1, 0], max: [1, 1, 0],
  }],
  bufferViews: [{ buffer: 0, byteLength: 36 }],
  buffers: [{ byteLength: 36, uri: 'data:application/octet-stream;base64,' +
    Buffer.from(new Float32Array([-1, -1, 0, 1, -1, 0, 0, 1, 0]).buffer).toString('base64') }],
};
const scene = join(folder, 'triangle.gltf');
writeFileSync(scene, JSON.stringify(triangle));

test('render writes linear and tone-mapped pictures', async () => {
  for (const name of ['out.png', 'out.jpg', 'out.pfm', 'out.exr']) {
    const out = join(folder, name);
    const args = [scene, '--technique', 'path', '--eye', '0,0,3', '--target', '0,0,0', '--fov',
        '50', '--size', '32x24', '--spp', '4', '--seed', '3', '--out', out];
    const { status, stderr } = await run('wellspring_render', args);
    assert.equal(status, 0, stderr);
    assert.doesNotMatch(stderr, /\[[#.]+\]/, 'how far it is, is for terminals');
    assert.ok(statSync(out).size > 100);
  }
  // The middle of the picture is the emitter's radiance, exactly.
  const pfm = readFileSync(join(folder, 'out.pfm'));
  const header = pfm.toString('latin1', 0, 40).split('\n').slice(0, 3).join('\n').length + 1;
  const at = (x, y, c) => pfm.readFloatLE(header + 4 * (3 * (y * 32 + x) + c));
  assert.deepEqual([0, 1, 2].map((c) => at(16, 10, c)), [1, 0.5, 0.25]);
});

test('the same seed gives the same bits', async () => {
  const picture = async (name, threads) => {
    const out = join(folder, name);
    const { status, stderr } = await run('wellspring_render',
        [scene, '--technique', 'path', '--size', '24x24', '--spp', '3', '--seed', '7', '--threads',
            String(threads), '--out', out]);
    assert.equal(status, 0, stderr);
    return readFileSync(out);
  };
  assert.deepEqual(await picture('a.pfm', 1), await picture('b.pfm', 3));
});

test('techniques are listed by name', async () => {
  const { status, stdout } = await run('wellspring_render', ['--list-techniques']);
  assert.equal(status, 0);
  for (const name of ['path', 'direct']) assert.match(stdout, new RegExp(`^${name}\\b`, 'm'));
});

test('a wrong command line is 2', async () => {
  const out = join(folder, 'x.png');
  for (const args of [[], [scene], [scene, '--out', out, '--technique', 'magic'],
      [scene, '--out', out, '--size', '10'], [scene, '--out', out, '--spp', '0'],
      [scene, '--out', join(folder, 'x.tiff')], [scene, '--out', out, '--camera', 'nowhere']]) {
    const { status, stderr } = await run('wellspring_render', args);
    assert.equal(status, 2, `${args.join(' ')}\n${stderr}`);
    assert.ok(stderr.length > 0);
  }
  assert.equal((await run('wellspring_server', ['--port', 'eighty'])).status, 2);
  assert.equal((await run('wellspring_server', ['--technique', 'magic'])).status, 2);
  assert.equal((await run('wellspring_kiosk', [])).status, 2);
  assert.equal((await run('wellspring_check', [])).status, 2);
  assert.equal((await run('wellspring_avatar', [])).status, 2);
  assert.equal((await run('wellspring_speak', [])).status, 2);
});

test('wrong input is 1 and named', async () => {
  const bad = join(folder, 'bad.gltf');
  writeFileSync(bad,
      JSON.stringify({ ...triangle, accessors: [{ ...triangle.accessors[0], count: 400 }] }));
  const { status, stderr } = await run('wellspring_render',
      [bad, '--out', join(folder, 'x.png'), '--size', '8x8', '--spp', '1']);
  assert.equal(status, 1);
  assert.match(stderr, /bad\.gltf/);
  assert.match(stderr, /accessors\/0/);
  const no_scene = [join(folder, 'none.glb'), '--out', join(folder, 'x.png')];
  assert.equal((await run('wellspring_render', no_scene)).status, 1);
  assert.equal((await run('wellspring_avatar', [join(folder, 'none.x3d'), '--info'])).status, 1);
  assert.equal((await run('wellspring_kiosk', ['--camera', join(folder, 'none.mp4'), '--print']))
      .status, 1);
  assert.equal((await run('wellspring_speak', ['Hello', '--audio', join(folder, 'none.wav')]))
      .status, 1);
});

test('the kiosk learns gestures from recordings, and names a bad one', async () => {
  const recordings = join(folder, 'recordings'), learnt = join(folder, 'gestures.json');
  mkdirSync(recordings);
  const made = await run('wellspring_kiosk', ['--train', 'generated', '--gestures', learnt]);
  assert.equal(made.status, 0, made.stderr);
  const labels = JSON.parse(readFileSync(learnt)).gestures.map((gesture) => gesture.label);
  for (const label of ['0', '9', 'wave', 'point', 'swipe_left']) assert.ok(labels.includes(label));
  const places = [...Array(30).keys()].map((i) => [i / 20, i / 40, 0.5]);
  for (const name of ['a.json', 'c.json'])
    writeFileSync(join(recordings, name), JSON.stringify({ label: 'dash', places }));
  const few = await run('wellspring_kiosk', ['--train', recordings, '--gestures', learnt]);
  assert.equal(few.status, 1);
  assert.match(few.stderr, /three recordings of 'dash'/);
  writeFileSync(join(recordings, 'd.json'), JSON.stringify({ label: 'dash', places }));
  const train = ['--train', recordings, '--gestures', learnt];
  assert.equal((await run('wellspring_kiosk', train)).status, 0);
  assert.equal(JSON.parse(readFileSync(learnt)).gestures[0].label, 'dash');
  writeFileSync(join(recordings, 'b.json'), JSON.stringify({ label: 'dash', places: [[0, 0]] }));
  const bad = await run('wellspring_kiosk', train);
  assert.equal(bad.status, 1);
  assert.match(bad.stderr, /b\.json: \/places/);
  assert.equal((await run('wellspring_kiosk', ['--train', recordings])).status, 2);
});

test('the station names a folder that it cannot learn from', async () => {
  assert.equal((await run('wellspring_station', [])).status, 2);
  const objects = join(folder, 'objects'), out = join(folder, 'objects.json');
  mkdirSync(join(objects, 'coin'), { recursive: true });
  const bad = await run('wellspring_station', ['--learn', objects, '--out', out]);
  assert.equal(bad.status, 1);
  assert.match(bad.stderr, /objects\/coin: has no photograph/);
  writeFileSync(out, '{"root": "a", "nodes": {"a": {"kind": "model"}}}');
  const eye = await run('wellspring_kiosk', ['--camera', 'synthetic', '--no-pace', '--print',
      '--station', out]);
  assert.equal(eye.status, 1);
  assert.match(eye.stderr, /objects\.json: \/nodes\/a\/id/);
});

test('check accepts the castle and lists every problem of a bad package', async () => {
  const good = await run('wellspring_check', [castle]);
  assert.equal(good.status, 0, good.stdout);
  assert.ok(!good.stdout.includes('no ground'), good.stdout);
  const bad = join(folder, 'broken');
  mkdirSync(bad);
  writeFileSync(join(bad, 'exhibit.json'), JSON.stringify({
    id: 'other', title: { en: 'Broken' }, scene: '../castle/scene.glb', exposure: -1, typo: 1,
    viewpoints: [{ name: 'a', position: [0, 0], fov_deg: 400 }], start: 'b',
    tours: [{ id: 't', stops: [{ viewpoint: 'c' }] }],
  }));
  const { status, stdout } = await run('wellspring_check', [bad]);
  assert.equal(status, 1);
  for (const place of ['/id', '/scene', '/exposure', '/typo', '/viewpoints/0/position',
      '/viewpoints/0/fov_deg', '/start', '/tours/0/stops/0/viewpoint'])
    assert.ok(stdout.includes(place), `${place} is not named in\n${stdout}`);
  assert.equal((await run('wellspring_check', [join(folder, 'nothing')])).status, 1);
});

test('check notes where nobody can walk', async () => {
  const folly = join(folder, 'folly');
  mkdirSync(folly);
  // The triangle lies on the ground.
  const rotation = [-Math.SQRT1_2, 0, 0, Math.SQRT1_2];
  const lying = { ...triangle, nodes: [{ mesh: 0, rotation }] };
  writeFileSync(join(folly, 'scene.gltf'), JSON.stringify(lying));
  const at = (name, position, yaw_deg, pitch_deg) => ({ name, position, yaw_deg, pitch_deg });
  const exhibit = { title: { en: 'Folly' }, scene: 'scene.gltf', walk: {},
    viewpoints: [at('on', [0, 1.65, 0.5], 0, -80), at('beside', [3, 1.65, 0], 90, -35)] };
  writeFileSync(join(folly, 'exhibit.json'), JSON.stringify(exhibit));
  const { status, stdout } = await run('wellspring_check', [folly]);
  assert.equal(status, 0, stdout);
  assert.match(stdout, /^note: .*exhibit\.json: \/viewpoints\/1\/position: no ground .*'beside'/m);
  assert.ok(!stdout.includes('/viewpoints/0'), stdout);
  writeFileSync(join(folly, 'exhibit.json'), JSON.stringify({ ...exhibit, walk: undefined }));
  const flying = await run('wellspring_check', [folly]);
  assert.ok(!flying.stdout.includes('/viewpoints'), flying.stdout);
});

test('avatar tells the storyteller\'s joints', async () => {
  const { status, stdout, stderr } = await run('wellspring_avatar',
      [join(castle, 'figures', 'storyteller.x3d'), '--json']);
  assert.equal(status, 0, stderr);
  const info = JSON.parse(stdout);
  const names = info.joints.map((joint) => joint.name);
  for (const name of ['humanoid_root', 'sacroiliac', 'l_hip', 'r_knee', 'skullbase', 'l_shoulder',
      'r_elbow', 'l_radiocarpal'])
    assert.ok(names.includes(name), `${name} is missing`);
});
