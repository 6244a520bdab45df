// SPDX-License-Identifier: Apache-2.0
// What a curator types: a new exhibit of a model, its check, its run, and mistakes.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import net from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { run, source, start_server } from '../server.mjs';
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
