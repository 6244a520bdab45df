// SPDX-License-Identifier: Apache-2.0
// A collection as a map, as visitors use it: by keys alone, with the mouse, on a small touch
// screen, as a page of its own and at a kiosk.
import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { little_light, source, start_server, until } from '../server.mjs';
import { start_screen_server } from '../screen_server.mjs';
import { launch, pictures, skip } from './chromium.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-collection-'));
const room = join(folder, 'content', 'room'), second = join(folder, 'content', 'second');

// Records in three departments, which differ in material, colour and century.
const departments = [['iron', 'war', '#404048', 1300], ['wool', 'winter', '#a02030', 1600],
  ['glass', 'feast', '#80c0a0', 1900]];
const records = departments.flatMap(([material, subject, color, year], k) =>
  Array.from({ length: 40 }, (_, i) => ({ id: `${material} ${i}`, title: `${material} thing ${i}`,
    maker: `Maker ${i % 5}`, date: String(year + i % 20), materials: [material, `kind ${i % 4}`],
    subjects: [subject, `theme ${(i + k) % 6}`], colors: [color],
    link: `https://example.org/${material}/${i}` })));

// The server of another museum, which has a picture of each thing of glass.
const asked_for = [];
const museum = createServer((question, reply) => {
  asked_for.push(question.url);
  reply.setHeader('content-type', 'image/jpeg');
  reply.end(readFileSync(join(source, 'content', 'first-room', 'poster.jpg')));
});

let server, browser;
before(async () => {
  if (skip) return;
  await new Promise((resolve) => museum.listen(0, '127.0.0.1', () => resolve(null)));
  const { port } = /** @type {any} */ (museum.address());
  for (const record of records.filter(({ id }) => id.startsWith('glass')))
    record.picture = `http://127.0.0.1:${port}/${record.id.slice(6)}.jpg`;
  for (const place of [room, second])
    cpSync(join(source, 'content', 'first-room'), place, { recursive: true });
  const exhibit = JSON.parse(readFileSync(join(room, 'exhibit.json'), 'utf8'));
  writeFileSync(join(second, 'exhibit.json'), JSON.stringify({ ...exhibit, id: 'second' }));
  writeFileSync(join(room, 'records.json'), JSON.stringify({ records }));
  const [object] = Object.keys(exhibit.objects);
  const collection = { source: 'records.json', title: { en: 'All our things' },
    objects: { 'glass 7': object } };
  writeFileSync(join(room, 'exhibit.json'), JSON.stringify({ ...exhibit, id: 'room', collection,
    allowed_hosts: [`127.0.0.1:${port}`] }));
  server = await start_server([...little_light], { content: join(folder, 'content') });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  if (server) assert.equal(await server.stop(), 0);
  museum.close();
  rmSync(folder, { recursive: true, force: true });
});

async function open(path, options = { viewport: { width: 1280, height: 720 } }) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  page.problems = [];
  page.said = [];
  page.on('pageerror', (error) => page.problems.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') page.problems.push(message.text());
  });
  page.on('websocket', (socket) => socket.on('framesent', ({ payload }) => {
    if (typeof payload === 'string') page.said.push(JSON.parse(payload));
  }));
  await page.goto(server.url + path);
  return page;
}
async function close(page) {
  assert.deepEqual(page.problems, []);
  await page.context().close();
}
const shot = async (page, name) => {
  if (pictures) await page.screenshot({ path: join(pictures, `collection-${name}.png`) });
};
const canvas = '.collection canvas';
// Waits until the map of that trail is there and at rest.
const map_is = (page, trail = '') => page.waitForFunction(([selector, wanted]) => {
  const { trail: now, settled } = document.querySelector(selector)?.dataset ?? {};
  return now === wanted && settled === 'true'
      && document.querySelector('.collection').ariaBusy === 'false';
}, [canvas, trail]);
const item = (page) => page.getAttribute(canvas, 'data-item');
const count = async (page) => Number(await page.getAttribute(canvas, 'data-items'));
const trail = (page) => page.getAttribute(canvas, 'data-trail');
const listed = (page) => page.locator('.collection [role=option]').count();
const said = (page) => page.textContent('.collection > [aria-live]');
const open_from_menu = async (page) => {
  await page.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 1);
  await page.click('#menu-button');
  assert.equal(await page.textContent('#collection-open'), 'All our things');
  await page.click('#collection-open');
  await map_is(page);
};

test('the menu has the map where there is a collection, and only there', { skip }, async () => {
  const page = await open('/e/second?display=server&lang=en');
  await page.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 1);
  await page.click('#menu-button');
  assert(await page.isHidden('#collection-section'));
  await close(page);
});

test('keys alone choose, dive, go back, filter and leave', { skip }, async () => {
  const page = await open('/e/room?display=server&lang=en');
  await page.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 1);
  await page.focus('#menu-button');
  await page.keyboard.press('Enter');
  await page.focus('#collection-open');
  await page.keyboard.press('Enter');
  await map_is(page);
  assert.equal(await count(page), records.length);
  assert.match(await said(page), /about all 120 objects/);
  assert(await page.evaluate((one) => document.activeElement === document.querySelector(one),
      canvas), 'the map has the focus');
  await shot(page, 'wide');

  await page.keyboard.press('ArrowRight');
  const first = await item(page);
  assert(first);
  assert.match(await said(page), /^\w+ thing \d+, Maker \d, \d{4}\. Group: /);
  await page.keyboard.press('ArrowLeft');
  const left = await item(page);
  assert.notEqual(left, first, 'another object');
  await page.keyboard.press('Enter');
  assert.equal(await page.textContent('.collection .details h2'), left.replace(' ', ' thing '));
  const inside = async () => Number(/\d+/.exec(await page.textContent('.collection output'))[0]);
  const before = await inside();
  for (let i = 0; i < 4; i++) await page.keyboard.press(']');
  assert(await inside() > before, 'a larger circle');
  await shot(page, 'circle');
  await page.keyboard.press('Enter');
  await until(async () => /^\d+@[\d.]+$/.test(await trail(page)), 'a trail');
  const circle = await trail(page);
  await map_is(page, circle);
  assert(await count(page) < records.length);
  assert.match(await said(page), /objects?\. It /);
  assert.equal(await page.textContent('.collection [aria-current=step]'),
      `Around “${left.replace(' ', ' thing ')}”`);
  await page.keyboard.press('Backspace');
  await map_is(page);
  assert.equal(await count(page), records.length);
  await until(async () => await listed(page) === records.length, 'all are in the list again');

  await page.keyboard.press('1');
  assert.equal(await page.locator('.collection .groups [aria-pressed=true]').count(), 1);
  await until(async () => await listed(page) < records.length, 'a shorter list');
  const few = await listed(page);
  await page.focus('.collection .alone');
  await page.keyboard.press('Enter');
  await map_is(page, 'c0');
  assert.equal(await count(page), few, 'those of the group alone');
  await page.keyboard.press('Escape');
  await map_is(page);
  await page.keyboard.press('Escape');
  assert.equal(await page.locator('.collection').count(), 0);
  assert(!await page.evaluate(() => document.querySelector('main').inert));
  assert.equal(page.said.filter(({ type, move }) =>
    type === 'input' && move?.some((one) => one !== 0)).length, 0, 'no key walked');
  await close(page);
});

test('the list tells the objects in view and leads to one of the exhibit', { skip }, async () => {
  const page = await open('/e/room?display=server&lang=en');
  await open_from_menu(page);
  await until(async () => await listed(page) === records.length, 'all are in the list');
  assert.equal(await page.getAttribute('#collection-list', 'role'), 'listbox');
  assert.match(await page.textContent('#collection-in-view'), /120/);
  const names = await page.locator('.collection [role=option]').allTextContents();
  assert.match(names[0], /^glass thing 0Maker 0 · 1900$/);
  // Enlarged, the list is of what is still in view.
  await page.click('.collection .larger');
  await page.click('.collection .larger');
  await until(async () => await listed(page) < records.length, 'fewer');
  await page.click('.collection .whole');
  await until(async () => await listed(page) === records.length, 'all again');
  await page.focus('#collection-list');
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('ArrowDown');
  const active = await page.getAttribute('#collection-list', 'aria-activedescendant');
  assert.equal(await page.getAttribute(`#${active}`, 'aria-selected'), 'true');
  await page.locator('.collection [role=option]', { hasText: 'glass thing 7' }).first().click();
  assert.equal(await item(page), 'glass 7');
  const card = page.locator('.collection .details');
  assert.equal(await card.locator('h2').textContent(), 'glass thing 7');
  assert.equal(await card.locator('.by').textContent(), 'Maker 2 · 1907');
  assert.equal(await card.locator('a').getAttribute('href'), 'https://example.org/glass/7');
  assert.match(await card.locator('.truth').textContent(), /place|belongs/);
  // The picture comes by way of this server, which keeps it.
  const picture = card.locator('img');
  await until(() => picture.evaluate((one) => one.naturalWidth > 100), 'a picture');
  const address = await picture.evaluate((one) => one.src);
  assert(address.startsWith(`${server.url}/api/v1/exhibits/room/collection/pictures/`), address);
  const before = asked_for.filter((one) => one === '/7.jpg').length;
  const again = await fetch(address);
  assert.equal(again.headers.get('content-type'), 'image/jpeg');
  assert.equal(asked_for.filter((one) => one === '/7.jpg').length, before);
  const of_iron = await fetch(address.replace(/\d+$/, '3'));
  assert.equal((await of_iron.json()).error.code, 'no_picture');
  await card.locator('.there').click();
  await page.waitForSelector('#card:not([hidden])');
  assert.equal(await page.locator('.collection').count(), 0);
  assert(page.said.some(({ type, object }) => type === 'go' && object));
  await close(page);
});

test('the mouse draws the circle, the wheel enlarges, two clicks dive', { skip }, async () => {
  const page = await open('/collection?exhibit=room&lang=en');
  await map_is(page);
  await page.focus(canvas);
  await page.keyboard.press('ArrowRight');
  const slider = page.locator('.collection input[type=range]');
  const radius = async () => Number(await slider.inputValue());
  const box = await page.locator(canvas).boundingBox();
  // The grip lies at 0.6 radians on the rim; the object in the middle is taken by its dot.
  const at = await page.evaluate(() => {
    const one = document.querySelector('.collection canvas');
    return one.dataset.at.split(',').map(Number);
  });
  const [x, y] = [box.x + at[0], box.y + at[1]];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 40, y, { steps: 4 });
  const small = await radius();
  await page.mouse.move(x + 90, y, { steps: 4 });
  const large = await radius();
  await page.mouse.up();
  assert(small < large, `${small} and ${large}`);
  await page.keyboard.down('Shift');
  await page.mouse.wheel(0, 100);
  await page.keyboard.up('Shift');
  await until(async () => await radius() < large, 'the wheel makes the circle smaller');
  await slider.fill('0.5');
  await page.mouse.dblclick(x, y);
  await until(async () => /@/.test(await trail(page)), 'a dive');
  const circle = await trail(page);
  await map_is(page, circle);
  assert.equal(decodeURIComponent(new URL(page.url()).hash), `#${circle}`);
  await page.goBack();
  await map_is(page);
  await page.goForward();
  await map_is(page, circle);
  await page.reload();
  await map_is(page, circle);
  assert.match(await page.textContent('.collection .about'), /of 120 objects/);
  await close(page);
});

test('a trail that no map has leads to everything', { skip }, async () => {
  const page = await open('/collection?exhibit=room&lang=de#c77');
  await map_is(page);
  assert.equal(await count(page), records.length);
  // The browser itself notes that the server knows no such map.
  assert(page.problems.every((one) => /404/.test(one)));
  page.problems.length = 0;
  await close(page);
  const nothing = await open('/collection?exhibit=second&lang=en');
  await nothing.waitForSelector('#problem:not([hidden])');
  assert.match(await nothing.textContent('#problem'), /no collection/);
  await close(nothing);
});

test('a small touch screen has all of it, and nothing moves for who wants calm', { skip },
    async () => {
      const page = await open('/collection?exhibit=room&lang=en', { hasTouch: true, isMobile: true,
        viewport: { width: 360, height: 640 }, reducedMotion: 'reduce' });
      await map_is(page);
      await shot(page, 'phone');
      const sides = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
      assert(sides[0] <= sides[1], 'nothing is wider than the screen');
      await page.locator('.collection .group-list button').first().tap();
      await page.locator('.collection .alone').tap();
      await map_is(page, 'c0');
      await page.focus(canvas);
      await page.keyboard.press('ArrowUp');
      await page.waitForSelector(`${canvas}[data-at]`);
      const at = (await page.getAttribute(canvas, 'data-at')).split(',').map(Number);
      const box = await page.locator(canvas).boundingBox();
      await page.touchscreen.tap(box.x + at[0], box.y + at[1]);
      await page.waitForSelector('.collection .details:not([hidden])');
      await shot(page, 'phone-card');
      const small = await page.locator('.collection button:visible').evaluateAll((all) =>
        all.filter((one) => one.getBoundingClientRect().height < 43.5).map((one) => one.outerHTML));
      assert.deepEqual(small, [], 'fingers find all buttons');
      await page.locator('.collection .back').tap();
      await map_is(page);
      await close(page);
    });

test("a kiosk's guest opens the map from the book and walks to an object", { skip }, async () => {
  const page = await open('/kiosk?lang=en', { viewport: { width: 1080, height: 1920 } });
  await page.locator('#open-book').click();
  await page.waitForFunction(() => !document.getElementById('book').hidden);
  await page.locator('.tabs [data-chapter=contents]').click();
  await page.locator('#book .entry', { hasText: 'All our things' }).click();
  await page.waitForFunction(() =>
    document.getElementById('book').dataset.chapter === 'collection');
  await until(() => page.evaluate(() => {
    const preview = document.querySelector('#book .map-preview canvas');
    return preview?.getContext('2d').getImageData(0, 0, preview.width, preview.height).data
        .some((value) => value > 0);
  }), 'a small picture of the map');
  await shot(page, 'book');
  await page.locator('#book .entry', { hasText: 'Open the map' }).click();
  await map_is(page);
  await shot(page, 'kiosk');
  await until(async () => await listed(page) === records.length, 'the list');
  await page.locator('.collection [role=option]', { hasText: 'glass thing 7' }).first().click();
  assert.equal(await page.locator('.collection .details a').count(), 0, 'no way out of the kiosk');
  await page.locator('.collection .there').click();
  await page.waitForFunction(() => document.body.dataset.view === 'museum');
  await until(() => page.said.some(({ type, object }) => type === 'go' && object), 'a walk');
  await page.locator('#to-book').click();
  await page.waitForFunction(() => document.body.dataset.view === 'book');
  await close(page);
});

// Twenty things in two groups, of which each map has half of the last one's.
function plain_level(steps) {
  const many = 20 >> (steps ? steps.split(';').length : 0);
  return { title: { en: 'All our things' }, objects: 20, region: many, stress: 0.1, too_near: 0,
    clusters: [0, 1].map((i) => ({ terms: [`kind ${i}`], count: many / 2, from: 1500, to: 1600 })),
    items: Array.from({ length: many }, (_, i) => ({ index: i, id: `T ${i}`, title: `Thing ${i}`,
      x: i - many / 2, y: Math.sin(i), stress: 0.1, cluster: i % 2 })) };
}

test('hands in the air go through the map at a kiosk', { skip }, async () => {
  const exhibit = { id: 'room', title: { en: 'A room' }, description: { en: 'One room.' },
    languages: ['en'], stories: [], tours: [], viewpoints: [],
    collection: { en: 'All our things' }, book: { topics: [], partners: [], presentations: [] } };
  const played = await start_screen_server(exhibit, {}, plain_level);
  const page = await (await browser.newContext({ viewport: { width: 1920, height: 1080 } }))
      .newPage();
  try {
    await page.goto(`${played.url}/kiosk?lang=en`);
    await page.waitForFunction(() => document.querySelectorAll('.tabs button').length > 0);
    let number = 0;
    const air = (name) => played.send({ type: 'kiosk', kiosk: '', stage: 'engaged', cameras: 1,
      state: 'person', people: 1, distance: 0.8, storyteller: 'here', volume: 0.8,
      gesture: { name, number: ++number } });
    const view_is = (view) => page.waitForFunction(
        (wanted) => document.body.dataset.view === wanted, view);
    air('swipe_up');
    await view_is('book');
    await page.waitForFunction(() => !document.getElementById('book').hidden);
    air('2');  // of the contents: the museum, its map
    await page.waitForFunction(() => document.getElementById('book').dataset.chapter
      === 'collection');
    await shot(page, 'book-wide');
    air('1');
    await view_is('collection');
    await map_is(page);
    await until(() => played.heard.some((one) => one.type === 'kiosk' && one.showing === 'book'),
        'gestures are asked for');
    air('swipe_left');
    await until(async () => await item(page), 'something is chosen');
    const first = await item(page);
    air('swipe_left');
    await until(async () => await item(page) !== first, 'the next one');
    air('swipe_up');
    await page.waitForSelector('.collection .details:not([hidden])');
    await shot(page, 'kiosk-wide');
    air('swipe_up');
    await until(async () => /@/.test(await trail(page)), 'a dive');
    air('2');
    await until(async () => /;c1$/.test(await trail(page)), 'the second group alone');
    air('swipe_down');
    await until(async () => !/;/.test(await trail(page)), 'a step back');
    air('swipe_down');
    await map_is(page);
    air('swipe_down');
    await view_is('book');
    assert.equal(await page.locator('.collection').count(), 0);
  } finally {
    await page.context().close();
    await played.stop();
  }
});
