// SPDX-License-Identifier: Apache-2.0
// `wellspring import`: what it makes hangs in an exhibit, and what is wrong is named.
import assert from 'node:assert/strict';
import { cpSync, existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync }
  from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { run, source } from '../server.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-import-'));
after(() => rmSync(folder, { recursive: true }));
const poster = join(source, 'content/first-room/poster.jpg');

test('a picture becomes a pyramid that an exhibit hangs', async () => {
  const exhibit = join(folder, 'room');
  cpSync(join(source, 'content/first-room'), exhibit, { recursive: true });
  const made =
      await run('wellspring_import', ['picture', poster, '--width', '1.2', '--out', exhibit]);
  assert.equal(made.status, 0, made.stderr);
  assert.match(made.stderr, /poster\.tif: \d+ x \d+ texels, \d+ levels/);
  const piece = JSON.parse(made.stdout);
  assert.equal(piece.width_m, 1.2);
  const file = join(exhibit, 'exhibit.json');
  const manifest = JSON.parse(readFileSync(file));
  manifest.id = 'room';
  manifest.pieces = [piece];
  writeFileSync(file, JSON.stringify(manifest));
  const checked = await run('wellspring_check', [exhibit]);
  assert.equal(checked.status, 0, checked.stdout + checked.stderr);

  const again = await run('wellspring_import', ['picture', poster, '--out', exhibit]);
  assert.equal(again.status, 1);
  assert.match(again.stderr, /poster\.tif: is there already/);
  const anew = await run('wellspring_import', ['picture', poster, '--out', exhibit, '--overwrite']);
  assert.equal(anew.status, 0, anew.stderr);
});

test('what is no picture is named, and nothing is left of it', async () => {
  const wrong = join(folder, 'wrong.jpg'), out = join(folder, 'out');
  writeFileSync(wrong, 'no picture');
  const made = await run('wellspring_import', ['picture', wrong, '--out', out]);
  assert.equal(made.status, 1);
  assert.match(made.stderr, /wrong\.jpg: vips cannot turn it into a TIFF/);
  assert.deepEqual(existsSync(out) ? readdirSync(out) : [], []);
  const none = await run('wellspring_import', ['picture', join(folder, 'none.tif'), '--out', out]);
  assert.match(none.stderr, /none\.tif: is no file/);
  assert.equal((await run('wellspring_import', ['picture'])).status, 2);
  assert.equal((await run('wellspring_import', ['statue', wrong])).status, 2);
});
