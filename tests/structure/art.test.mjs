// SPDX-License-Identifier: Apache-2.0
// What the exhibits' packages hold is what the scripts in art/ make.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { hash_files, hash_scripts, parts } from '../../art/make.mjs';

const root = process.env.WELLSPRING_SOURCE;
const made = JSON.parse(readFileSync(join(root, 'art/made.json'), 'utf8'));

test('each part was made of its scripts as they are', () => {
  assert.deepEqual(Object.keys(made), Object.keys(parts));
  const old = Object.keys(parts).filter((name) => made[name].scripts !== hash_scripts(parts[name]));
  assert.deepEqual(old, [], 'node art/make.mjs PART makes them again');
});

test('each file is the one that was made', () => {
  for (const [name, part] of Object.entries(parts))
    assert.deepEqual(hash_files(part, join(root, part.into)), made[name].files, name);
});

test('an unknown part is refused by name', () => {
  const { status, stderr } = spawnSync('node', [join(root, 'art/make.mjs'), 'castle/moat'],
      { encoding: 'utf8' });
  assert.equal(status, 2);
  assert.match(stderr, /no part castle\/moat; there are castle\/scene/);
});

test('the torch is made again, byte by byte', (t) => {
  const { status } = spawnSync('python3', ['-c', 'import zlib, struct, json']);
  if (status !== 0) return t.skip('no python3');
  const again = spawnSync('node', [join(root, 'art/make.mjs'), '--check', 'castle/torch'],
      { encoding: 'utf8' });
  assert.equal(again.status, 0, again.stdout + again.stderr);
});
