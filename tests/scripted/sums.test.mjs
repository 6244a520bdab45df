// SPDX-License-Identifier: Apache-2.0
// Daily sums of scripted visits: over restarts, beside a damaged file, and who may read them.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, run, sleep, start_server } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-sums-'));
const content = join(folder, 'content'), model = write_pyramid(folder);
before(async () => {
  assert.equal((await run('wellspring_new', ['giza', model, '--content', content])).status, 0);
});
after(() => rmSync(folder, { recursive: true, force: true }));
// Starts a server with an exhibit that is soon loaded: these tests do not look at it.
const start_small = (args = []) => start_server(['--exhibit', 'giza', ...args], { content });

// {"what key": value} of all days.
function parse(csv) {
  const lines = csv.trimEnd().split('\r\n');
  assert.equal(lines[0], 'day,what,key,value');
  const sums = {};
  for (const line of lines.slice(1)) {
    const [day, what, key, value] = line.split(',');
    assert.match(day, /^\d{4}-\d\d-\d\d$/);
    sums[`${what} ${key}`] = (sums[`${what} ${key}`] ?? 0) + Number(value);
  }
  return sums;
}
const read = async (server, query = '') =>
  parse(await (await fetch(`${server.url}/api/v1/sums.csv${query}`)).text());

async function visit(server, lang) {
  const visitor = new Visitor(server);
  await visitor.hello({ lang });
  return visitor;
}

test('visits are counted, and stay over a restart', async () => {
  const file = join(folder, 'kept', 'sums.sqlite');
  let server = await start_server(['--sums', file, '--cache', join(folder, 'cache')]);
  const visitor = await visit(server, 'de'), other = await visit(server, 'en');
  visitor.send({ type: 'tour', action: 'play' });
  visitor.send({ type: 'storyteller', story: 'well' });
  await sleep(2500);
  await visitor.close();
  await sleep(1000);
  const sums = await read(server);
  assert.equal(sums['visits castle'], 2);
  assert.equal(sums['languages castle/de'], 1);
  assert.equal(sums['languages castle/en'], 1);
  const keys = Object.keys(sums);
  assert.equal(keys.filter((key) => key.startsWith('tours_begun castle/')).length, 1);
  const dwelt = keys.filter((key) => key.startsWith('dwell_seconds castle/'))
      .reduce((sum, key) => sum + sums[key], 0);
  assert.ok(dwelt > 2 && dwelt < 30, `${dwelt} s`);
  await other.close();
  assert.equal(await server.stop(), 0);

  server = await start_server(['--sums', file, '--cache', join(folder, 'cache')]);
  const third = await visit(server, 'en');
  await sleep(600);
  const later = await read(server);
  assert.equal(later['visits castle'], 3);
  assert.equal(later['languages castle/en'], 2);
  assert.deepEqual(await read(server, '?from=1990-01-01&to=1990-12-31'), {});
  assert.equal((await read(server, '?from=1990-01-01'))['visits castle'], 3);
  for (const query of ['?from=yesterday', '?to=2026-02-30'])
    assert.equal((await fetch(`${server.url}/api/v1/sums.csv${query}`)).status, 400, query);
  await third.close();
  assert.equal(await server.stop(), 0);
});

test('a damaged file is put aside and named, and the server lives on', async () => {
  const file = join(folder, 'damaged.sqlite');
  writeFileSync(file, 'this is no database, however long one looks at it'.repeat(40));
  const server = await start_small(['--sums', file]);
  assert.equal((await fetch(`${server.url}/api/v1/sums.csv`)).status, 503);
  const visitor = await visit(server, 'en');
  await sleep(600);
  await visitor.close();
  assert.equal(await server.stop(), 0);
  assert.match(server.log(), /damaged\.sqlite: is damaged; it is now .*damaged\.sqlite\.damaged-/);
  assert.ok(readdirSync(folder).some((name) => name.startsWith('damaged.sqlite.damaged-')));
  assert.equal(readFileSync(file).toString('latin1', 0, 15), 'SQLite format 3');
});

test('where sums cannot be written the server serves', async () => {
  writeFileSync(join(folder, 'a-file'), '');
  const server = await start_small(['--sums', join(folder, 'a-file', 'sums.sqlite')]);
  const visitor = await visit(server, 'en');
  await visitor.close();
  assert.equal((await fetch(`${server.url}/healthz`)).status, 200);
  assert.equal(await server.stop(), 0);
  assert.match(server.log(), /sums cannot be written: .*a-file/);
  assert.match(server.log(), /the last sums are lost/);
});

test('the status says whether there are some', async () => {
  const told = async (server) => (await (await fetch(`${server.url}/api/v1/status`)).json()).sums;
  const some = await start_small(['--sums', join(folder, 'told.sqlite')]);
  assert.equal(await told(some), true);
  await some.stop();
  const none = await start_small();
  assert.equal(await told(none), false);
  assert.equal((await fetch(`${none.url}/api/v1/sums.csv`)).status, 404);
  await none.stop();
});
