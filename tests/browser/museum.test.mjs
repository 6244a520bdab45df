// SPDX-License-Identifier: Apache-2.0
// The page in headless Chromium: the front door of several exhibits, a visit that goes on, and
// questions to the storyteller.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { make_two_exhibits } from '../scripted/pyramid.mjs';
import { little_light, sleep, start_server } from '../server.mjs';
import { launch, pictures, skip } from './chromium.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-front-'));
const content = join(folder, 'content'), keys = join(folder, 'cache');

let server, browser;
const start = (port = 0) => start_server(['--cache', keys, ...little_light], { content, port });
before(async () => {
  if (skip) return;
  await make_two_exhibits(folder);
  const file = join(content, 'giza', 'exhibit.json');
  writeFileSync(file, JSON.stringify({ ...JSON.parse(readFileSync(file, 'utf8')),
    title: { en: 'Pyramid', de: 'Pyramide' }, description: { en: 'A pyramid made of six faces.' },
    objects: { stone: { node: 'Pyramid', title: { en: 'The stones' },
      door: { exhibit: 'castle', viewpoint: 'well' } } } }));
  server = await start();
  browser = await launch();
});
after(async () => {
  if (browser) await browser.close();
  if (server) await server.stop();
  rmSync(folder, { recursive: true, force: true });
});

async function open(path, options = { viewport: { width: 1280, height: 800 } }) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  page.heard = [];
  page.problems = [];
  page.on('pageerror', (error) => page.problems.push(String(error)));
  page.on('websocket', (socket) => socket.on('framereceived', ({ payload }) => {
    if (typeof payload === 'string') page.heard.push(JSON.parse(payload));
  }));
  await page.goto(server.url + path);
  return page;
}
async function close(page) {
  assert.deepEqual(page.problems, []);
  await page.context().close();
}
const pictured = (page) => page.waitForFunction(
    () => Number(document.getElementById('picture').dataset.frame) > 2);
async function message(page, type, fits = () => true, from = 0) {
  for (const end = performance.now() + 20000; performance.now() < end; await sleep(50)) {
    const found = page.heard.slice(from).find((one) => one.type === type && fits(one));
    if (found) return found;
  }
  return assert.fail(`no ${type}: ${fits}`);
}
const shot = async (page, name) => {
  if (pictures) await page.screenshot({ path: join(pictures, `${name}.png`) });
};

test('the front door shows every exhibit, and leads into it', { skip }, async () => {
  for (const [name, viewport] of [['laptop', { width: 1280, height: 800 }],
    ['phone', { width: 390, height: 844 }]]) {
    const page = await open('/', { viewport, locale: 'de-DE' });
    await page.waitForSelector('#exhibits a >> nth=1');
    const titles = await page.locator('#exhibits strong').allTextContents();
    assert.equal(titles.length, 2);
    assert.equal(titles[1], 'Pyramide');
    assert.equal(await page.textContent('h1'), 'Was möchten Sie sehen?');
    // The castle's own poster, and a still where there is none.
    await page.waitForFunction(() =>
        [...document.images].every((image) => image.complete)
        && [...document.images].map((image) => image.naturalWidth).join() === '1280,640', null);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
    assert.ok(!wide, 'nothing sticks out');
    await shot(page, `front-${name}`);
    await page.click('#exhibits a >> nth=1');
    await pictured(page);
    assert.equal(new URL(page.url()).pathname, '/e/giza');
    assert.equal((await message(page, 'welcome')).exhibit, 'giza');
    await close(page);
  }
});

test('a door of an exhibit leads to another', { skip }, async () => {
  const page = await open('/e/giza');
  await pictured(page);
  await page.click('#menu-button');
  await page.click('#objects button');
  await page.waitForSelector('#card-door:not([hidden])');
  await shot(page, 'door');
  await page.click('#card-door');
  await page.waitForURL('**/e/castle?viewpoint=well');
  await pictured(page);
  await message(page, 'state', ({ viewpoint }) => viewpoint === 'well');
  await close(page);
});

test('a visit goes on after a reload and a new start of the server', { skip }, async () => {
  const page = await open('/e/castle?viewpoint=hall');
  await pictured(page);
  await page.locator('#places button').nth(2).click();
  const { viewpoint } = await message(page, 'state', (state) => state.viewpoint
      && state.viewpoint !== 'hall');
  const { viewpoints } = await message(page, 'welcome');
  const index = viewpoints.findIndex(({ name }) => name === viewpoint);
  await message(page, 'keep', ({ token }) =>
    JSON.parse(Buffer.from(token.split('.')[0], 'base64url')).viewpoint === index);
  let heard = page.heard.length;
  await page.reload();
  await pictured(page);
  assert.equal((await message(page, 'welcome', () => true, heard)).resumed, true);
  assert.equal((await message(page, 'state', () => true, heard)).viewpoint, viewpoint);
  heard = page.heard.length;
  const { port } = server;
  await server.stop();
  await page.waitForSelector('#notice:not([hidden])');
  server = await start(port);
  const back = await message(page, 'welcome', () => true, heard);
  assert.equal(back.resumed, true);
  assert.equal((await message(page, 'state', () => true, heard)).viewpoint, viewpoint);
  await close(page);
});

test('a question is answered by the storyteller', { skip }, async () => {
  const page = await open('/e/castle');
  await pictured(page);
  await page.click('#menu-button');
  assert.ok(await page.locator('#questions button').count() >= 2);
  await page.locator('#ask-section').scrollIntoViewIfNeeded();
  await shot(page, 'ask');
  await page.fill('#question', 'How deep is the well?');
  await page.press('#question', 'Enter');
  const reply = await message(page, 'reply');
  assert.equal(reply.found, 'sure');
  await page.waitForFunction(() => document.getElementById('subtitle').textContent
      .includes('Seventy metres'));
  assert.ok(await page.locator('#menu').isHidden(), 'the menu is out of the way');
  await shot(page, 'answer');
  await close(page);
});

test('the story of a kiosk goes on at home', { skip }, async () => {
  const page = await open('/e/castle?story=crown&lang=de');
  await pictured(page);
  await message(page, 'agent', ({ story }) => story === 'crown');
  assert.equal((await message(page, 'welcome')).lang, 'de');
  await close(page);
});
