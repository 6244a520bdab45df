// SPDX-License-Identifier: Apache-2.0
// Comments are sentences: tests/structure/fragments.mjs says which are none.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join, relative } from 'node:path';
import { test } from 'node:test';
import { fragments } from './fragments.mjs';

const root = process.env.WELLSPRING_SOURCE;
test('no comment begins with Of, What, Where or That', () => {
  const sources = ['server', 'avatar', 'kiosk', 'voice', 'tests'].flatMap((top) =>
    readdirSync(join(root, top), { withFileTypes: true, recursive: true })
        .filter((entry) => entry.isFile() && /\.(h|cpp)$/.test(entry.name))
        .map((entry) => join(entry.parentPath ?? entry.path, entry.name)));
  assert.ok(sources.length > 500);
  const found = sources.flatMap((path) => fragments(readFileSync(path, 'utf8'))
      .map(({ line, text }) => `${relative(root, path)}:${line}: ${text}`));
  assert.deepEqual(found, []);
});

test('what is no sentence is found', () => {
  const lines = (source) => fragments(source).map(({ line }) => line);
  const source = '// Of the depth.\n\nint a;  // what is seen\n\n// Is. Where it\n';
  assert.deepEqual(lines(source), [1, 3, 5]);
  assert.deepEqual(lines('// Returns what is seen, of all.\nauto s = "// Of it";\n// Ends.\n'), []);
  assert.deepEqual(lines('// Returns the share\n// of the depth. The rest\n// stays.\n'), []);
});
