// SPDX-License-Identifier: Apache-2.0
// Documents are short, and what they name exists.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { basename, join, relative } from 'node:path';
import { test } from 'node:test';

const root = process.env.WELLSPRING_SOURCE;
const read = (name) => readFileSync(join(root, name), 'utf8');

function files(folder, kind) {
  return readdirSync(join(root, folder), { withFileTypes: true, recursive: true })
      .filter((entry) => entry.isFile() && kind.test(entry.name))
      .map((entry) => join(entry.parentPath ?? entry.path, entry.name));
}
const sources = ['server', 'avatar', 'kiosk', 'voice', 'tests']
    .flatMap((top) => files(top, /\.(h|cpp)$/))
    .map((file) => ({ name: relative(root, file), text: readFileSync(file, 'utf8') }));
const code = sources.map(({ text }) => text).join('\n');

const tops = 'server|avatar|kiosk|tests|docs|base|json|wire|frame|attention|denoise|gltf|world|' +
    'light|cache|picture|show|stream';
const place = new RegExp(`\`((?:${tops})/[\\w./]*)\``, 'g');

// `a/b`, `a/b.h`, `a/b/` or a stem of files: a place in the tree, seen from its root or server/.
function is_place(name) {
  const found = ['', 'server/', 'tests/'].map((top) => top + name.replace(/\/$/, ''));
  return found.some((path) => ['', '.h', '.cpp'].some((end) => existsSync(join(root, path + end))));
}
const documents = ['ARCHITECTURE.md', 'CONTRIBUTING.md', 'README.md', 'BENCHMARKS.md',
  'CHANGELOG.md', 'docs/terms.md', 'docs/tried.md', 'docs/mechanisms.md', 'content/README.md'];

test('ARCHITECTURE.md has at most 250 lines', () =>
  assert.ok(read('ARCHITECTURE.md').split('\n').length <= 250));

test('every function in ARCHITECTURE.md exists', () => {
  const names = [...read('ARCHITECTURE.md').matchAll(/\b([a-z_0-9]+)\(\)/g)].map((m) => m[1]);
  assert.ok(names.length > 20, 'the drawings name functions');
  const missing = names.filter((name) => !new RegExp(`[ *&:]${name}\\(`).test(code));
  assert.deepEqual(missing, []);
});

test('every file and folder that a document names exists', () => {
  const wrong = [];
  for (const document of documents) {
    for (const [, name] of read(document).matchAll(place))
      if (!is_place(name) && !/NAME/.test(name)) wrong.push(`${document}: ${name}`);
  }
  assert.deepEqual(wrong, []);
});

test('every mechanism in docs/mechanisms.md is there', () => {
  const rows = read('docs/mechanisms.md').split('\n').filter((line) => /^\| [a-z]/.test(line));
  assert.ok(rows.length > 15);
  const wrong = [];
  for (const row of rows.slice(1))
    for (const [, name] of row.split('|')[1].matchAll(/`([\w/]+)\*?`/g)) {
      const known = is_place(name) || new RegExp(`\\b${name}`).test(code) ||
          ['cache', 'picture', 'picture/still', 'world/raster']
              .some((folder) => is_place(`${folder}/${name}`));
      if (!known) wrong.push(name);
    }
  assert.deepEqual(wrong, []);
});

test('lines of documents end at 100 columns, but in tables', () => {
  const wrong = [];
  for (const document of documents)
    read(document).split('\n').forEach((line, i) => {
      const free = /^\s*\||https?:/.test(line);
      if ([...line].length > 100 && !free) wrong.push(`${document}:${i + 1}`);
    });
  assert.deepEqual(wrong, []);
});

test('slow tests that are listed exist, each with a reason', () => {
  const lines = read('tests/slow.txt').split('\n').filter((line) => line && line[0] !== '#');
  assert.ok(lines.length > 0);
  for (const line of lines) {
    const [, suite, name, reason] = /^(\w+)\.(\w+) +(.+)$/.exec(line) ?? [];
    assert.ok(reason, line);
    assert.ok(new RegExp(`TEST(_F|_P)?\\(${suite},\\s*${name}\\)`).test(code), line);
  }
});

test('every file that a comment names exists', () => {
  const names = new Set(sources.map(({ name }) => basename(name)));
  const wrong = [];
  for (const { name, text } of sources)
    for (const [, comment] of text.matchAll(/(?:^|\s)\/\/ (.*)/g))
      for (const [file] of comment.matchAll(/(?<![\w/.*])[\w/]+\.(?:h|cpp)\b/g))
        if (!(file.includes('/') ? is_place(file) : names.has(file)))
          wrong.push(`${name}: ${file}`);
  assert.deepEqual(wrong, []);
});

test('a term stands in the header that docs/terms.md names', () => {
  const plain = (text) => text.replace(/([a-z])([A-Z])/g, '$1 $2').replace(/\n\s*\/\/ ?/g, ' ')
      .replace(/[-_]/g, ' ').toLowerCase();
  const wrong = [];
  let found = 0;
  const rows = read('docs/terms.md').split('\n').filter((line) => /^\| (?!-|term)/.test(line));
  for (const row of rows) {
    const [term, , from] = row.slice(1).split('|').map((cell) => cell.trim());
    const headers = [...from.matchAll(/`([\w/]+)\.h`/g)].map(([, stem]) => `${stem}.h`);
    if (headers.length === 0) continue;
    const text = plain(sources.filter(({ name }) => headers.some((one) => name.endsWith(one)))
        .map((one) => `${one.name}\n${one.text}`).join('\n'));
    const words = plain(term.replace(/`/g, '').replace(/ \(.*\)/, '')).split(', ');
    if (words.some((word) => text.includes(word.replace(/s$/, '')))) found++;
    else wrong.push(`${term}: ${headers}`);
  }
  assert.ok(found > 100, `${found} terms`);
  assert.deepEqual(wrong, []);
});
