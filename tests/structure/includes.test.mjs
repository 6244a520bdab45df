// SPDX-License-Identifier: Apache-2.0
// The include direction of ARCHITECTURE.md, and what else the tree promises about itself.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join, relative } from 'node:path';
import { test } from 'node:test';

const root = process.env.WELLSPRING_SOURCE;

// layer -> layers it may include, besides itself.
const may_include = {
  base: [],
  wire: ['base'],
  frame: ['base'],
  denoise: ['base'],
  gltf: ['base'],
  world: ['gltf', 'base'],
  light: ['world', 'frame', 'base'],
  cache: ['light', 'world', 'frame', 'base'],
  picture: ['cache', 'denoise', 'light', 'world', 'frame', 'base'],
  avatar: ['gltf', 'base'],
  show: ['picture', 'cache', 'denoise', 'light', 'world', 'gltf', 'frame', 'avatar', 'wire',
    'base'],
  stream: ['wire', 'base'],
  kiosk: ['wire', 'base'],
};
// Heavy headers appear in .cpp files of these layers only.
const heavy = [
  [/^(boost\/(beast|asio)|boost\/)/, ['stream', 'kiosk']],
  [/^opencv2?\//, ['kiosk']],
  [/^embree[34]?\//, ['world']],
  [/^(pugixml|sndfile)/, ['avatar']],
  [/^espeak-ng\//, []],  // GPL: the voice program's one file
  [/^(turbojpeg|OpenEXR|Imf)/, ['frame']],
  [/^(dnnl|omp)/, ['denoise']],
];

// The one header of a folder through which its own files reach a heavy library; no other folder may
// see it.
const gateways = ['server/stream/asio.h', 'server/world/embree.h'];

function* sources(folder, kind = /\.(h|cpp)$/) {
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const path = join(folder, entry.name);
    if (entry.isDirectory() && entry.name !== 'node_modules') yield* sources(path, kind);
    else if (kind.test(entry.name)) yield path;
  }
}

function files() {
  const found = [];
  for (const top of ['server', 'avatar', 'kiosk', 'voice'])
    for (const path of sources(join(root, top))) {
      const name = relative(root, path);
      const parts = name.split('/');
      const layer = parts[0] === 'server' ? (parts.length > 2 ? parts[1] : 'main') : parts[0];
      const text = readFileSync(path, 'utf8');
      const includes =
          [...text.matchAll(/^\s*#\s*include\s*[<"]([^>"]+)[>"]/gm)].map((match) => match[1]);
      found.push({ name, layer: /main[^/]*\.cpp$/.test(name) ? 'main' : layer, text, includes,
          lines: text.split('\n').length });
    }
  return found;
}

const all = files();

test('there are sources to check', () => assert.ok(all.length > 50));

test('includes follow the direction of the layers', () => {
  const wrong = [];
  for (const { name, layer, includes } of all) {
    if (layer === 'main') continue;
    assert.ok(may_include[layer], `${name} belongs to no known layer`);
    for (const include of includes) {
      const target = include.split('/')[0];
      if (!include.includes('/') || !(target in may_include)) continue;
      if (target !== layer && !may_include[layer].includes(target))
        wrong.push(`${name} includes ${include}`);
    }
  }
  assert.deepEqual(wrong, []);
});

test('heavy headers stay in .cpp files of their own layer', () => {
  const wrong = [];
  for (const { name, layer, includes } of all)
    for (const include of includes)
      for (const [pattern, layers] of heavy)
        if (pattern.test(include)) {
          const speaks = name === 'voice/main.cpp' && /^espeak/.test(include);
          const program = layer === 'main' && (name.startsWith('kiosk/') || speaks);
          if (!(layers.includes(layer) || program)) wrong.push(`${name} includes ${include}`);
          else if (name.endsWith('.h') && !gateways.includes(name))
            wrong.push(`the header ${name} includes ${include}`);
        }
  assert.deepEqual(wrong, []);
});

test('what a gateway header brings in stays in its folder', () => {
  const path_of = (include) => ['', 'server/'].map((root) => root + include)
      .find((name) => all.some((file) => file.name === name));
  const reaches = (name, seen = new Set()) => {
    if (gateways.includes(name)) return name;
    if (seen.has(name)) return null;
    seen.add(name);
    const file = all.find((one) => one.name === name);
    for (const include of file.includes) {
      const next = path_of(include), found = next && reaches(next, seen);
      if (found) return found;
    }
    return null;
  };
  const wrong = [];
  for (const { name, layer } of all) {
    const gateway = reaches(name);
    if (gateway && gateway.split('/')[1] !== layer) wrong.push(`${name} sees ${gateway}`);
  }
  assert.deepEqual(wrong, []);
});

test('no line is longer than 100 columns, but what raw strings quote', () => {
  const wrong = [];
  const folders = ['server', 'avatar', 'kiosk', 'voice', 'web', 'content', 'tests'];
  const kind = /\.(h|cpp|js|mjs|py)$/;
  for (const path of folders.flatMap((top) => [...sources(join(root, top), kind)])) {
    const text = readFileSync(path, 'utf8')
        .replace(/R"(\w*)\([\s\S]*?\)\1"/g, (raw) => raw.replace(/[^\n]/g, ''));
    text.split('\n').forEach((line, i) => {
      if ([...line].length > 100) wrong.push(`${relative(root, path)}:${i + 1}`);
    });
  }
  assert.deepEqual(wrong, []);
});

test('one licence line per file, include guards, and no file over 500 lines', () => {
  const wrong = [];
  for (const { name, text, lines } of all) {
    if (!text.startsWith('// SPDX-License-Identifier: Apache-2.0\n'))
      wrong.push(`${name}: no SPDX line`);
    if (name.endsWith('.h') && !text.includes('#pragma once'))
      wrong.push(`${name}: no #pragma once`);
    if (lines > 500) wrong.push(`${name}: ${lines} lines`);
  }
  for (const path of sources(join(root, 'tests'))) {
    const lines = readFileSync(path, 'utf8').split('\n').length;
    if (lines > 500) wrong.push(`${relative(root, path)}: ${lines} lines`);
  }
  assert.deepEqual(wrong, []);
});
