// SPDX-License-Identifier: Apache-2.0
// `wellspring lamps`: pigments under lamps as text, CSV, JSON and a page; what is wrong is named.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { run, source } from '../server.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-pigments-'));
after(() => rmSync(folder, { recursive: true }));
const path = (name) => join(folder, name);
const lamps = (...args) => run('wellspring_lamps', args);

// Writes a table in per cent: grey, and two that are told apart by their blue alone.
const rows = Array.from({ length: 81 }, (_, i) => 380 + 5 * i)
  .map((nm) => `${nm},30,${nm < 500 ? 10 : 30},${nm < 500 ? 60 : 30}`);
writeFileSync(path('paints.csv'), `wavelength_nm,grey,ochre,blue\n${rows.join('\n')}\n`);

test('pigments are told in four forms', async () => {
  const { status, stdout, stderr } = await lamps('--pigments', path('paints.csv'), '--lamps',
      'candle,sodium', '--csv', path('a.csv'), '--json', path('a.json'), '--html', path('a.html'));
  assert.equal(status, 0, stderr);
  assert.match(stdout, /^candle +1930 /m);
  assert.match(stdout, /^ochre and blue: 0\.0 under sodium, \d+\.\d under D65$/m);
  const lines = readFileSync(path('a.csv'), 'utf8').trim().split('\n');
  assert.equal(lines.length, 1 + 3 * 3);
  assert.match(lines[0], /^pigment,lamp,X,Y,Z,L,a,b,de00_daylight/);
  const { pigments, metamers } = JSON.parse(readFileSync(path('a.json')));
  assert.ok(pigments[0].under.candle.de00_daylight < 0.01, 'grey stays grey');
  assert.equal(metamers.length, 3);
  const page = readFileSync(path('a.html'), 'utf8');
  assert.doesNotMatch(page, /<script|https?:|<link|<img/);
  assert.match(page, /<td class="look">/);
  const unused = await lamps('--pigments', path('paints.csv'), '--lamps', 'candle', '--adaptation',
      'none', '--json', path('b.json'));
  assert.equal(unused.status, 0, unused.stderr);
  const other = JSON.parse(readFileSync(path('b.json')));
  assert.ok(other.pigments[0].under.candle.de00_daylight > 20, 'a candle is orange in daylight');
});

test('an exhibit\'s materials are pigments', async () => {
  const { status, stdout, stderr } = await lamps(join(source, 'content/first-room'),
      '--lamps', 'A');
  assert.equal(status, 0, stderr);
  assert.match(stdout, /^dE00 from daylight +A$/m);
});

test('what is wrong is named', async () => {
  assert.equal((await lamps()).status, 2);
  const unknown = await lamps('--pigments', path('paints.csv'), '--lamps', 'torch');
  assert.equal(unknown.status, 2);
  assert.match(unknown.stderr, /no lamp 'torch'/);
  const none = await lamps('--pigments', path('none.csv'));
  assert.equal(none.status, 1);
  assert.match(none.stderr, /none\.csv/);
  writeFileSync(path('bad.csv'), 'nm,a\n400,0.1\n500,red\n700,0.2\n');
  const bad = await lamps('--pigments', path('bad.csv'));
  assert.equal(bad.status, 1);
  assert.match(bad.stderr, /bad\.csv: line 3: a: 'red' is no number/);
  const listed = await lamps('--list-lamps');
  assert.equal(listed.status, 0);
  assert.match(listed.stdout, /^LED-B1 /m);
});
