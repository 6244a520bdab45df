// SPDX-License-Identifier: Apache-2.0
// A wall of screens in a browser: the assistant's links, tiles in step, lines that go on from one
// to the next.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { little_light, start_server, until } from '../server.mjs';
import { launch, pictures, skip } from './chromium.mjs';
import { difference, shrink_in_page } from './pixels.mjs';

let server, browser, problems;
before(async () => {
  if (skip) return;
  server = await start_server(['--exhibit', 'first-room', ...little_light]);
  browser = await launch();
  problems = [];
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

async function open(address, width = 320, height = 240) {
  const page = await browser.newPage({ viewport: { width, height } });
  page.on('pageerror', (error) => problems.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') problems.push(message.text());
  });
  await page.goto(address);
  return page;
}
const wall = '/wall?name=hall&columns=2&rows=2';
const shown = (page) => page.evaluate(() => /** @type {any} */ (window).wall_shown);

test('the assistant has a link and a test pattern for every screen', { skip }, async () => {
  const page = await open(`${server.url}${wall}&bezel=8,6&screen=400,300`);
  const links = await page.$$eval('.grid a', (all) => all.map(({ href }) => href));
  assert.equal(links.length, 8);
  assert.ok(links.every((link) => link.includes('bezel=8%2C6')));
  if (pictures)
    await page.screenshot({ path: join(pictures, 'wall-assistant.png'), fullPage: true });
  await page.goto(links[3]);
  assert.equal(await page.textContent('.number'), '2');
  // Two pictures and the frame between them: 0.02 of a picture.
  const box = (await page.getAttribute('.pattern', 'viewBox')).split(' ').map(Number);
  assert.ok(Math.abs(box[0] - 1.36) < 1e-9 && Math.abs(box[2] - 4 / 3) < 1e-9, String(box));
  if (pictures) await page.screenshot({ path: join(pictures, 'wall-pattern.png') });
  await page.goto(`${server.url}${wall}&column=2&row=0`);
  assert.match(await page.textContent('[role=alert]'), /column must be/);
  assert.deepEqual(problems, []);
  await page.close();
});

test('tiles show one picture in step', { skip }, async (t) => {
  // What the four show together is what one screen as wide and high shows.
  const one = '/wall?name=whole&columns=1&rows=1&column=0&row=0';
  const whole = await open(server.url + one, 640, 480);
  const pages = [];
  for (let i = 0; i < 4; i++)
    pages.push(await open(`${server.url}${wall}&column=${i % 2}&row=${Math.floor(i / 2)}`));
  for (const page of [whole, ...pages])
    await page.waitForFunction(() => /** @type {any} */ (window).wall_shown?.length > 1);
  const columns = 40, rows = 30;
  const look = async (page, width = columns, height = rows, path = undefined) => {
    const bytes = await page.screenshot(path && { path });
    return page.evaluate(shrink_in_page, [bytes.toString('base64'), width, height]);
  };
  let differs;
  await until(async () => {
    const all = await look(whole, 2 * columns, 2 * rows);
    differs = [];
    for (let i = 0; i < 4; i++) {
      const x = columns * (i % 2), y = rows * Math.floor(i / 2);
      const part = Array.from({ length: rows }, (_, row) => all.slice(
          4 * ((y + row) * 2 * columns + x), 4 * ((y + row) * 2 * columns + x + columns))).flat();
      differs.push(difference(part, await look(pages[i], columns, rows,
          pictures && join(pictures, `wall-${Math.floor(i / 2)}-${i % 2}.png`))));
    }
    return Math.max(...differs) < 5;
  }, () => `tiles show parts of one picture: they differ by ${differs}`);
  await whole.close();
  t.diagnostic(`tiles differ from their parts of the whole by ${differs.map((d) => d.toFixed(2))}`);
  const from = Math.max(...await Promise.all(pages.map(async (page) =>
    (await shown(page)).at(-1).frame)));
  await pages[2].keyboard.down('ArrowLeft');
  const lists = async () => Promise.all(pages.map(async (page) =>
    new Map((await shown(page)).map(({ frame, at }) => [frame, at]))));
  let all;
  await until(async () => {
    all = await lists();
    return [...all[0].keys()].filter((frame) => frame > from).length > 40;
  }, 'forty pictures');
  await pages[2].keyboard.up('ArrowLeft');
  const common = [...all[0].keys()].filter((frame) => frame > from
    && all.every((list) => list.has(frame)));
  const differences = common.map((frame) => {
    const times = all.map((list) => list.get(frame));
    return Math.max(...times) - Math.min(...times);
  }).sort((a, b) => a - b);
  t.diagnostic(`a moment is shown within ${differences[differences.length >> 1].toFixed(1)} ms by `
    + `all (median of ${differences.length}), ${differences.at(-1).toFixed(1)} ms at most`);
  assert.ok(common.length > 20, `${common.length} moments were shown by all four`);

  const leader = await open(`${server.url}/?wall=hall`);
  await leader.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 1);
  await leader.focus('#picture');
  const still = await look(pages[1]);
  await until(async () => {
    await leader.keyboard.press('ArrowLeft', { delay: 200 });
    return difference(still, await look(pages[1])) > 5;
  }, 'the wall turns with a page that leads it');
  await leader.close();

  await pages[0].close();
  const before = (await shown(pages[1])).at(-1).frame;
  await pages[1].keyboard.down('ArrowRight');
  await until(async () => (await shown(pages[1])).at(-1).frame > before + 5, 'the others go on');
  assert.deepEqual(problems, []);
});
