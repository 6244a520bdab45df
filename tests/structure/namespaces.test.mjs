// SPDX-License-Identifier: Apache-2.0
// Every layer has a namespace of its own, in which each name means one thing.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join, relative } from 'node:path';
import { test } from 'node:test';
import { folder_of, may_include } from './layers.mjs';

const root = process.env.WELLSPRING_SOURCE;
const layers = Object.keys(may_include);
const space_of = (layer) => (layer === 'base' ? 'wellspring' : `wellspring::${layer}`);

function sources(layer) {
  return readdirSync(join(root, folder_of(layer)), { recursive: true, withFileTypes: true })
      .filter((entry) => entry.isFile() && /\.(h|cpp)$/.test(entry.name))
      .filter(({ name }) => !/^main[^/]*\.cpp$/.test(name))
      .map((entry) => join(entry.parentPath ?? entry.path, entry.name));
}
const all = layers.flatMap((layer) => sources(layer).map((path) =>
  ({ layer, name: relative(root, path), text: readFileSync(path, 'utf8') })));

// The namespaces of a file's lines that are indented by none: [{line, space}]; a nameless one ends
// in `::`.
function* spaced_lines({ text }) {
  const open = [];
  let declares = false;  // the line before names a type of elsewhere
  for (const line of text.split('\n')) {
    const begins = /^namespace ([\w:]*) ?[{]$/.exec(line);
    if (begins) open.push(begins[1]);
    else if (/^\} {2}\/\/ namespace/.test(line) || (line === '}' && declares)) open.pop();
    declares = /^(class|struct) \w+;/.test(line);
    yield { line, space: open.join('::') };
  }
}

test('what a layer defines lies in its namespace', () => {
  const wrong = [];
  for (const file of all)
    for (const { line, space } of spaced_lines(file)) {
      if (!/^(struct|class|enum class) \w+( : [\w: ]+)? \{/.test(line)) continue;
      if (!`${space}::`.startsWith(`${space_of(file.layer)}::`))
        wrong.push(`${file.name}: ${line} in ${space || 'no namespace'}`);
    }
  assert.deepEqual(wrong, []);
});

test('no type is defined twice in a namespace', () => {
  const homes = new Map();
  for (const file of all)
    for (const { line, space } of spaced_lines(file)) {
      const [, type] = /^(?:struct|class|enum class) (\w+)(?: : [\w:<> ,]+)? \{/.exec(line) ?? [];
      if (!type || space.endsWith('::')) continue;  // a nameless one is its file's own
      const name = `${space}::${type}`;
      homes.set(name, [...(homes.get(name) ?? []), file.name]);
    }
  assert.ok(homes.size > 500, `${homes.size} types`);
  assert.deepEqual([...homes].filter(([, files]) => files.length > 1), []);
});

test('a namespace sees those that its layer may include', () => {
  const text = readFileSync(join(root, 'server/base/layers.h'), 'utf8');
  const seen = Object.fromEntries([...text.matchAll(
      /^namespace (\w+) \{\n((?:using namespace \w+;\n)+)\}/gm)].map(([, space, uses]) =>
    [space, [...uses.matchAll(/using namespace (\w+)/g)].map(([, name]) => name).sort()]));
  for (const layer of layers.filter((name) => name !== 'base'))
    assert.deepEqual(seen[layer] ?? [],
        may_include[layer].filter((name) => name !== 'base').sort(), layer);
});
