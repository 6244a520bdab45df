// SPDX-License-Identifier: Apache-2.0
// One process that serves all exhibits of a folder, one of which is broken.
import assert from 'node:assert/strict';
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, run, source, start_server } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-museum-'));
const content = join(folder, 'content');
let server;

before(async () => {
  const model = write_pyramid(folder);
  assert.equal((await run('wellspring_new', ['giza', model, '--content', content])).status, 0);
  cpSync(join(content, 'giza'), join(content, 'meroe'), { recursive: true });
  const file = join(content, 'meroe', 'exhibit.json');
  const meroe = JSON.parse(readFileSync(file, 'utf8'));
  cpSync(join(source, 'tests', 'fuzz', 'package', 'picture.png'),
      join(content, 'meroe', 'front.png'));
  writeFileSync(file, JSON.stringify({ ...meroe, id: 'meroe', title: { en: 'Meroe' },
    poster: 'front.png',
    kiosks: [{ name: 'desert' }],
    objects: { stone: { node: 'Pyramid', title: { en: 'Stone' },
      door: { exhibit: 'giza', viewpoint: meroe.viewpoints[1].name } } } }));
  mkdirSync(join(content, 'ruin'));
  writeFileSync(join(content, 'ruin', 'exhibit.json'), '{"title": "x",\n"scene": ]}');
  server = await start_server([], { content });
});
after(async () => {
  assert.equal(await server?.stop(), 0);
  rmSync(folder, { recursive: true, force: true });
});

const get = (path, accept = 'text/html') => fetch(server.url + path, { headers: { accept } });

test('the front page is the list, and each exhibit has a page of its own', async () => {
  assert.match(await (await get('/')).text(), /front\.js/);
  const inner = await get('/e/meroe');
  assert.equal(inner.status, 200);
  assert.match(await inner.text(), /<base href="\.\.\/">[\s\S]*visit\.js/);
  const none = await get('/e/nineveh');
  assert.equal(none.status, 404);
  assert.match(await none.text(), /This door leads nowhere/);
  assert.equal((await get('/e/')).status, 404);
});

test('what there is, and what cannot be shown and why', async () => {
  const { exhibits, failed } = await (await get('/api/v1/exhibits')).json();
  assert.deepEqual(exhibits.map(({ id }) => id), ['giza', 'meroe']);
  assert.deepEqual(exhibits[1].objects[0].door,
      { exhibit: 'giza', viewpoint: exhibits[1].viewpoints[1].name });
  assert.equal(failed.length, 1);
  const posters = await Promise.all(exhibits.map(({ poster }) => get(poster)));
  assert.deepEqual(posters.map(({ status }) => status), [200, 200]);
  assert.deepEqual(posters.map(({ headers }) => headers.get('content-type')),
      ['image/jpeg', 'image/png']);
  assert.equal(failed[0].id, 'ruin');
  assert.match(failed[0].problems.join(), /exhibit\.json.*line 2/);
  assert.equal((await get('/api/v1/exhibits/ruin')).status, 404);
  assert.equal((await get('/api/v1/exhibits/meroe/still.jpg?width=32&height=32&spp=1')).status,
      200);
});

test('visitors come to the exhibit that they ask for, and are by themselves there', async () => {
  const visitors = {};
  for (const exhibit of ['', 'giza', 'meroe']) {
    const visitor = visitors[exhibit] = new Visitor(server);
    await visitor.opened;
    visitor.send({ type: 'hello', exhibit, width: 64, height: 48 });
    const welcome = await visitor.next((item) => item.message?.type === 'welcome');
    assert.equal(welcome.message.title, exhibit === 'meroe' ? 'Meroe' : 'Pyramid');
    await visitor.next((item) => item.picture);
  }
  const kiosk = new Visitor(server);
  await kiosk.opened;
  kiosk.send({ type: 'hello', role: 'kiosk', kiosk: 'desert', width: 64, height: 48 });
  const welcome = await kiosk.next((item) => item.message?.type === 'welcome');
  assert.equal(welcome.message.title, 'Meroe');
  const lost = new Visitor(server);
  await lost.opened;
  lost.send({ type: 'hello', exhibit: 'nineveh' });
  const error = await lost.next((item) => item.message?.type === 'error');
  assert.equal(error.message.code, 'unknown_exhibit');
  lost.send({ type: 'hello', exhibit: 'meroe', width: 64, height: 48 });
  await lost.next((item) => item.message?.type === 'welcome');
  for (const visitor of [...Object.values(visitors), kiosk, lost]) visitor.close();
});

test('figures of all exhibits, told apart', async () => {
  // The server renews /metrics now and then.
  let text = '';
  const visited = (id) =>
    new RegExp(`^wellspring_visits_total\\{exhibit="${id}"\\} [1-9]`, 'm').test(text);
  for (let k = 0; k < 50 && !['giza', 'meroe'].every(visited); k++) {
    await new Promise((resolve) => setTimeout(resolve, 100));
    text = await (await get('/metrics')).text();
  }
  assert.deepEqual(['giza', 'meroe'].filter(visited), ['giza', 'meroe']);
  assert.equal(text.match(/^# TYPE wellspring_visits_total /gm).length, 1);
  assert.match(text,
      /^wellspring_exhibit_failed\{exhibit="ruin",problem=".*exhibit\.json.*"\} 1$/m);
  assert.match(text, /^wellspring_connections /m);
  const names = text.split('\n').filter((line) => line && !line.startsWith('#'))
      .map((line) => line.slice(0, line.lastIndexOf(' ')));
  assert.equal(new Set(names).size, names.length, 'each sample once');
});

test('without any exhibit that can be shown it says what is wrong', async () => {
  const bad = join(folder, 'bad');
  cpSync(join(content, 'ruin'), join(bad, 'ruin'), { recursive: true });
  const { status, stderr } = await run('wellspring_server',
      ['--content', bad, '--web', join(source, 'web'), '--port', '0']);
  assert.equal(status, 1);
  assert.match(stderr, /ruin\/exhibit\.json.*line 2/);
});
