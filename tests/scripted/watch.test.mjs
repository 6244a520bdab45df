// SPDX-License-Identifier: Apache-2.0
// What a curator sees with --watch: a change at once, a mistake with its file and line while the
// old exhibit goes on, and its end.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, run, sleep, start_server } from '../server.mjs';
import { write_pyramid } from './pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-watch-'));
const content = join(folder, 'content'), model = write_pyramid(folder);
const file = join(content, 'giza', 'exhibit.json');
let server;
before(async () => {
  const made = await run('wellspring_new', ['giza', model, '--content', content]);
  assert.equal(made.status, 0, made.stderr);
  server = await start_server(['--exhibit', 'giza', '--watch'], { content });
});
after(async () => {
  await server?.stop();
  rmSync(folder, { recursive: true, force: true });
});

const good = () => JSON.parse(readFileSync(file, 'utf8'));
const save = (exhibit) => writeFileSync(file, JSON.stringify(exhibit, null, 2));
const findings = async () =>
  (await (await fetch(`${server.url}/api/v1/status`)).json()).findings.map((one) => one.about);

// Does as a page does: tries again until the server is back.
async function come_back() {
  for (let i = 0; ; i++) {
    const visitor = new Visitor(server);
    try {
      return { visitor, welcome: await visitor.hello() };
    } catch (error) {
      if (i > 100) throw error;
      await sleep(50);
    }
  }
}

test('a change is shown at once, on the same port', async () => {
  const { visitor, welcome } = await come_back();
  assert.equal(welcome.title, 'Pyramid');
  assert.equal(welcome.watched, true);
  const changed = good();
  changed.title.en = 'A great pyramid';
  save(changed);
  await visitor.closed;
  const next = await come_back();
  assert.equal(next.welcome.title, 'A great pyramid');
  await next.visitor.close();
});

test('a mistake is told with its place, and the exhibit goes on', async () => {
  const text = readFileSync(file, 'utf8'), { visitor } = await come_back();
  let told = visitor.message('problems');
  writeFileSync(file, text.replace(/\n/, '\n\n  "oops" 1,\n'));
  let { list } = await told;
  assert.equal(list.length, 1);
  assert.equal(list[0].file, 'exhibit.json');
  assert.match(`${list[0].where} ${list[0].what}`, /line 3/);
  await sleep(600);  // the report is made anew now and then
  assert.ok((await findings()).includes('exhibit'));
  const other = new Visitor(server), also = other.message('problems');
  const welcome = await other.hello();
  assert.equal(welcome.title, 'A great pyramid', 'as it was before');
  assert.deepEqual((await also).list, list, 'who comes is told, too');
  await other.close();

  const wrong = JSON.parse(text);
  wrong.start = 'nowhere';
  told = visitor.message('problems');
  save(wrong);
  ({ list } = await told);
  assert.ok(list.some(({ where, what }) => /start.*nowhere/.test(where + what)),
      JSON.stringify(list));

  writeFileSync(file, text);
  await visitor.closed;
  const mended = await come_back();
  assert.equal(mended.welcome.title, 'A great pyramid');
  await sleep(600);
  assert.ok(!(await findings()).includes('exhibit'));
  assert.ok(!mended.visitor.messages.some(({ type }) => type === 'problems'));
  await mended.visitor.close();
});

test('files that editors leave, and a touch of nothing, change nothing', async () => {
  const { visitor } = await come_back();
  writeFileSync(join(content, 'giza', '.exhibit.json.swp'), 'x');
  writeFileSync(join(content, 'giza', 'exhibit.json~'), 'x');
  await sleep(2000);
  assert.equal(visitor.socket.readyState, 1);
  await visitor.close();
});

test('without --watch a change waits for the next start', async () => {
  const plain = await start_server(['--exhibit', 'giza'], { content });
  const visitor = new Visitor(plain), welcome = await visitor.hello();
  assert.equal(welcome.watched, undefined);
  const changed = good();
  changed.title.en = 'Unseen';
  save(changed);
  await sleep(2000);
  assert.equal(visitor.socket.readyState, 1);
  await visitor.close();
  await plain.stop();
});

test('of two exhibits the changed one is new, and a visit goes on at its place', async () => {
  const made = await run('wellspring_new', ['uruk', model, '--content', content]);
  assert.equal(made.status, 0, made.stderr);
  const both = await start_server(['--watch'], { content });
  try {
    const enter = async (exhibit, resume = '') => {
      for (let i = 0; ; i++) {
        const visitor = new Visitor(both);
        try {
          return { visitor, welcome: await visitor.hello({ exhibit, resume }) };
        } catch (error) {
          if (i > 100) throw error;
          await sleep(50);
        }
      }
    };
    const { visitor, welcome } = await enter('giza');
    visitor.send({ type: 'camera', seq: 1, position: [0.5, 1.5, 3.25], yaw: 0.25, pitch: 0 });
    await sleep(4500);  // the page is told where its visit is now and then
    const { token } = visitor.messages.filter(({ type }) => type === 'keep').at(-1);
    const changed = JSON.parse(readFileSync(join(content, 'uruk', 'exhibit.json'), 'utf8'));
    changed.title.en = 'Uruk';
    writeFileSync(join(content, 'uruk', 'exhibit.json'), JSON.stringify(changed));
    await visitor.closed;
    const { exhibits } = await (async () => {
      for (;;) {
        const answer = await fetch(`${both.url}/api/v1/exhibits`).catch(() => null);
        if (answer?.ok) return answer.json();
        await sleep(50);
      }
    })();
    assert.deepEqual(exhibits.map(({ title }) => title.en), [welcome.title, 'Uruk']);
    const { visitor: back } = await enter('giza', token);
    const { position, yaw } = await back.message('state');
    assert.deepEqual(position, [0.5, 1.5, 3.25]);
    assert.ok(Math.abs(yaw - 0.25) < 1e-3);
    await back.close();
  } finally {
    await both.stop();
  }
});
