// SPDX-License-Identifier: Apache-2.0
// What a curator types: a new exhibit of a model, its check, its run, and mistakes.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { data, run, source, start_server } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-curator-'));
after(() => rmSync(folder, { recursive: true, force: true }));
const content = join(folder, 'content');

const model = write_pyramid(folder);

test('a model becomes an exhibit that is good and can be visited', async () => {
  const made = await run('wellspring_new', ['giza', model, '--content', content]);
  assert.equal(made.status, 0, made.stderr);
  assert.ok(existsSync(join(content, 'giza', 'pyramid.bin')));
  const checked = await run('wellspring_check', [join(content, 'giza')]);
  assert.equal(checked.status, 0, checked.stdout);
  assert.match(checked.stdout, /good, 0 notes/);
  const server = await start_server(['--exhibit', 'giza'], { content });
  try {
    const exhibit = await (await fetch(`${server.url}/api/v1/exhibits/giza`)).json();
    assert.deepEqual(exhibit.title, { en: 'Pyramid' });
    assert.ok(exhibit.viewpoints.length >= 2 && exhibit.viewpoints.length <= 5);
    assert.deepEqual(exhibit.credits, [{ file: 'pyramid.gltf', title: 'Pyramid',
      author: 'A. Mason', license: 'CC0', source: 'https://example.org',
      copyright: '2024 A. Mason' }]);
  } finally {
    assert.equal(await server.stop(), 0);
  }
  const before = readFileSync(join(content, 'giza', 'exhibit.json'), 'utf8');
  const again = await run('wellspring_new', ['giza', model, '--content', content]);
  assert.equal(again.status, 1);
  assert.match(again.stderr, /there already/);
  assert.equal(readFileSync(join(content, 'giza', 'exhibit.json'), 'utf8'), before);
  assert.equal((await run('wellspring_new', ['giza'])).status, 2);
});

// Scenes that others made, each of its kind: what is said of it, how many views it gets at least,
// and the notes that it may have.
const scenes = [
  { file: 'khronos/Duck/glTF-Binary/Duck.glb', told: /a sky was added/, views: 5 },
  { file: 'khronos/CesiumMilkTruck/glTF-Binary/CesiumMilkTruck.glb', told: /is 4\.8\d m across/ },
  { file: 'khronos/CesiumMan/glTF-Binary/CesiumMan.glb', told: /is 1\.5\d* m across/ },
  { file: 'khronos/Suzanne/glTF/Suzanne.gltf', told: /seen from outside/ },
  { file: 'khronos/TextureCoordinateTest/glTF/TextureCoordinateTest.gltf', views: 3 },  // flat
  { file: 'khronos/TwoSidedPlane/glTF/TwoSidedPlane.gltf', views: 3 },                  // lying
  { file: 'khronos/Cameras/glTF/Cameras.gltf', views: 4, notes: /not perspective/ },  // one-sided
  { file: 'assimp/draco/2CylinderEngine.gltf' },
  { file: 'khronos/BoxAnimated/glTF-Binary/BoxAnimated.glb' },
  { file: 'khronos/AnimatedMorphSphere/glTF-Binary/AnimatedMorphSphere.glb' },
  { file: 'castle/gltf/multiple_animated_lights/multiple_animated_lights.gltf',
    told: /its own light is enough/, notes: /too bright/ },
  { file: 'castle/gltf/normal_maps_scaled_object/normal_maps_scaled_object.glb', views: 3 },
  { file: 'castle/gltf/camera_animation/camera_animation.glb', notes: /normals without/ },
  { file: 'ozz/rigged_simple.gltf', told: /is 9\.\d+ m across/ },
];
const gltf = join(data, '1_gltf');
const no_scenes = !existsSync(gltf) && `there are no scenes in ${gltf}`;

test('scenes that others made become exhibits', { skip: no_scenes }, async () => {
  for (const [n, { file, told = /sky|light/, views = 1, notes = /^$/ }] of scenes.entries()) {
    const id = `scene-${n}`, place = join(content, id);
    const made = await run('wellspring_new', [id, join(gltf, file), '--content', content]);
    assert.equal(made.status, 0, `${file}: ${made.stderr}`);
    assert.match(made.stdout + made.stderr, told, file);
    const exhibit = JSON.parse(readFileSync(join(place, 'exhibit.json')));
    assert.ok(exhibit.viewpoints.length >= views, `${file}: ${exhibit.viewpoints.length} views`);
    const checked = await run('wellspring_check', [place]);
    assert.equal(checked.status, 0, `${file}: ${checked.stdout}`);
    for (const note of `${checked.stdout}${checked.stderr}`.match(/^note: .*/gm) ?? [])
      assert.match(note, notes, file);
    rmSync(place, { recursive: true });
  }
});

test('what cannot be shown is refused, and nothing is left', { skip: no_scenes }, async () => {
  const foreign = JSON.parse(readFileSync(join(gltf, 'castle/gltf/lines/lines.gltf'), 'utf8'));
  foreign.extensionsUsed = foreign.extensionsRequired = ['KHR_texture_basisu'];
  const basis = join(folder, 'basis.gltf');
  writeFileSync(basis, JSON.stringify(foreign));
  for (const [file, why] of [
    [join(gltf, 'castle/gltf/lines/lines.gltf'), /there is nothing to see/],
    [basis, /KHR_texture_basisu/]]) {
    const { status, stderr } = await run('wellspring_new',
        ['refused', file, '--content', content]);
    assert.equal(status, 1);
    assert.match(stderr, why);
    assert.ok(!existsSync(join(content, 'refused')));
  }
});

test('an exhibit that is not there: those that are', async () => {
  const args = ['--content', join(source, 'content'), '--web', join(source, 'web'), '--port', '0'];
  const { status, stderr } = await run('wellspring_server', [...args, '--exhibit', 'catsle']);
  assert.equal(status, 1);
  assert.match(stderr, /no exhibit 'catsle'.*did you mean 'castle'\?.*there are .*castle/);
});

test('a port that is taken is told before anything is loaded', async () => {
  const taken = net.createServer();
  await new Promise((done) => taken.listen(0, '127.0.0.1', done));
  // An exhibit that cannot be loaded: of the two mistakes the port's is the first.
  const broken = join(folder, 'broken');
  mkdirSync(join(broken, 'x'), { recursive: true });
  writeFileSync(join(broken, 'x', 'exhibit.json'), '{');
  const args = ['--web', join(source, 'web'), '--content', broken, '--exhibit', 'x', '--port'];
  const { status, stderr } = await run('wellspring_server', [...args, `${taken.address().port}`]);
  await new Promise((done) => taken.close(done));
  assert.equal(status, 1);
  assert.match(stderr, /cannot listen on 127\.0\.0\.1:\d+/);
  assert.doesNotMatch(stderr, /not JSON/);
  const free = await run('wellspring_server', [...args, '0']);
  assert.match(free.stderr, /not JSON at line 1, column/);
});

test('gestures and faces are listed, and proposed', async () => {
  const { status, stdout } = await run('wellspring_avatar', ['--list-gestures']);
  assert.equal(status, 0);
  const { gestures } = JSON.parse(readFileSync(join(source, 'avatar/library/gestures.json')));
  for (const { name } of gestures) assert.match(stdout, new RegExp(`^  ${name} `, 'm'));
  for (const name of ['joy', 'neutral', 'surprise']) assert.match(stdout, new RegExp(`\\b${name}`));
  const wrong = await run('wellspring_avatar', ['x.x3d', '--gesture', 'wvae']);
  assert.equal(wrong.status, 2);
  assert.match(wrong.stderr, /did you mean 'wave'\?/);
});
