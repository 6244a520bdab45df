// SPDX-License-Identifier: Apache-2.0
// The page in headless Chromium: finding one's way, looking closer, and what new visitors stumble
// over.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { sleep, start_server } from '../server.mjs';
import { launch, pictures, skip } from './chromium.mjs';

let server, browser;
before(async () => {
  if (skip) return;
  server = await start_server();
  browser = await launch();
});
after(async () => {
  if (browser) await browser.close();
  if (server) await server.stop();
});

const laptop = { viewport: { width: 1280, height: 800 } };
const phone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

// Opens the page. options: as of Playwright's context. `script`: run in the page before its own.
// The page's messages to the server and from it are kept in page.said and page.heard.
async function open({ path = '/', options = laptop, script } = {}) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  page.said = [];
  page.heard = [];
  page.problems = [];
  page.on('pageerror', (error) => page.problems.push(String(error)));
  page.on('websocket', (socket) => {
    const note = (list) => ({ payload }) => {
      if (typeof payload === 'string') list.push(JSON.parse(payload));
    };
    socket.on('framesent', note(page.said));
    socket.on('framereceived', note(page.heard));
  });
  if (script) await page.addInitScript(script);
  await page.goto(server.url + path);
  await page.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 3);
  return page;
}
async function close(page) {
  assert.deepEqual(page.problems, []);
  await page.context().close();
}
// The first of the kept messages that fits, now or within 15 s.
async function message(list, type, fits = () => true) {
  for (const end = performance.now() + 15000; performance.now() < end; await sleep(50)) {
    const found = list.find((one) => one.type === type && fits(one));
    if (found) return found;
  }
  return assert.fail(`no ${type}: ${fits}`);
}
const last = (list, type) => list.filter((one) => one.type === type).at(-1);
const shot = async (page, name) => {
  if (pictures) await page.screenshot({ path: join(pictures, `${name}.png`) });
};
const distance = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));

test('a click on the floor leads there, a drag only looks round', { skip }, async () => {
  const page = await open();
  const { position: from } = await message(page.heard, 'state');
  await page.mouse.move(640, 600);
  await page.mouse.down();
  await page.mouse.move(760, 600, { steps: 6 });
  await page.mouse.up();
  const turned = () => page.said.filter(({ type }) => type === 'input')
      .reduce((sum, { look }) => sum + look[0], 0);
  for (const end = performance.now() + 5000; turned() < 0.08 && performance.now() < end;)
    await sleep(50);
  assert.ok(turned() > 0.08, `turned by ${turned()}`);
  assert.equal(last(page.said, 'go'), undefined, 'a drag is a look');
  await page.mouse.move(640, 600);
  await page.mouse.down();
  await page.mouse.move(760, 600, { steps: 6 });
  await page.mouse.move(640, 600, { steps: 6 });
  await page.mouse.up();
  assert.equal(last(page.said, 'go'), undefined, 'so is one that comes back');
  await page.mouse.click(640, 620);
  const { at } = await message(page.said, 'go');
  assert.ok(Math.abs(at[0] - 0.5) < 0.01 && Math.abs(at[1] - 0.775) < 0.01, `${at}`);
  const went = await message(page.heard, 'went');
  assert.equal(went.object, null);
  assert.ok(went.seconds > 0.5 && distance(went.place, from) > 0.5, JSON.stringify(went));
  await message(page.heard, 'state', ({ position }) => distance(position, went.place) < 0.05);
  await close(page);
});

test('where there is no way that is said quietly', { skip }, async () => {
  const page = await open();
  await page.evaluate(() => document.getElementById('map-button').click());
  await page.waitForFunction(() => document.getElementById('map-picture').dataset.at);
  const [x, y] = (await page.getAttribute('#map-picture', 'data-at')).split(',').map(Number);
  await page.locator('#map-picture').click({ position: { x, y } });
  await page.waitForFunction(() => !document.getElementById('notice').hidden);
  assert.equal(await page.textContent('#notice'), 'There is no way there.');
  await page.waitForFunction(() => document.getElementById('notice').hidden);
  await close(page);
});

test('the map shows where the visitor is, and a click on it leads there', { skip }, async () => {
  const page = await open();
  assert.equal(await page.getAttribute('#map-button', 'aria-expanded'), 'false');
  await page.keyboard.press('m');
  await page.waitForFunction(() => document.getElementById('map-picture').dataset.at);
  const before = await page.getAttribute('#map-picture', 'data-at');
  const box = await page.locator('#map-picture').boundingBox();
  await page.locator('#map-picture').click({ position: { x: box.width / 2, y: box.height / 2 } });
  const { to } = await message(page.said, 'go');
  const went = await message(page.heard, 'went');
  assert.ok(distance([to[0], to[2]], [went.place[0], went.place[2]]) < 1, 'where it was clicked');
  await message(page.heard, 'state', ({ position }) => distance(position, went.place) < 0.05);
  await page.waitForFunction((old) =>
      document.getElementById('map-picture').dataset.at !== old, before);
  await shot(page, 'map');
  await page.locator('#map-close').click();
  assert.equal(await page.evaluate(() => document.activeElement.id), 'map-button');
  await close(page);
});

test('an object is looked at closer, read about, and its story heard', { skip }, async () => {
  const page = await open({ path: '/?lang=de' });
  await page.locator('#menu-button').click();
  await page.locator('#objects [data-object=horse]').click();
  await page.waitForSelector('#card:not([hidden])');
  assert.equal(await page.textContent('#card-title'), 'Bronzenes Pferd');
  assert.match(await page.textContent('#card-text'), /Glocken/);
  const facts = await page.locator('#card-facts dt').allTextContents();
  assert.deepEqual(facts, ['Von', 'Zeit', 'Material', 'Nummer', 'Rechte']);
  assert.ok(await page.locator('#card-manifest').isHidden(), 'it has none');
  const went = await message(page.heard, 'went');
  await message(page.heard, 'state', ({ position }) => distance(position, went.place) < 0.05);
  await shot(page, 'card');
  // The horse is in the middle of the picture, and a click finds it as well.
  page.heard.length = 0;
  await sleep(1000);
  await page.mouse.click(640, 400);
  assert.equal((await message(page.heard, 'went')).object, 'horse');
  await page.locator('#card-story').click();
  await message(page.said, 'storyteller', ({ story }) => story === 'horse');
  await page.keyboard.press('Escape');
  await page.waitForSelector('#card', { state: 'hidden' });
  await page.evaluate(() => document.getElementById('player-stop').click());
  await close(page);
});

test('calm visitors leap, by their browser\'s wish or their own', { skip }, async () => {
  const page = await open({ options: { ...laptop, reducedMotion: 'reduce' } });
  await message(page.said, 'settings', ({ comfort }) => comfort === true);
  await page.mouse.click(640, 620);
  assert.equal((await message(page.heard, 'went')).seconds, 0);
  await page.locator('#menu-button').click();
  assert.ok(await page.locator('#comfort').isChecked());
  await page.locator('#comfort').uncheck();
  await message(page.said, 'settings', ({ comfort }) => comfort === false);
  await page.reload();
  await page.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 3);
  assert.equal(await page.locator('#comfort').isChecked(), false, 'its own wish is kept');
  await close(page);
});

test('all places fit at 1280 pixels, and the row scrolls by wheel where they do not',
    { skip }, async () => {
  const page = await open();
  const fits = await page.evaluate(() => {
    const row = document.getElementById('places');
    return row.scrollWidth <= row.clientWidth;
  });
  assert.ok(fits);
  await page.setViewportSize({ width: 700, height: 600 });
  await page.locator('#places').hover();
  await page.mouse.wheel(0, 2000);
  await page.waitForFunction(() => {
    const row = document.getElementById('places'), end = row.lastElementChild;
    return row.scrollLeft > 0
        && end.getBoundingClientRect().right <= row.getBoundingClientRect().right;
  });
  // One preview after the other, each small.
  await page.waitForFunction(() =>
      [...document.querySelectorAll('#places img')].some((image) => image.naturalWidth > 0));
  await page.keyboard.press('0');
  const tenth = await page.evaluate(() =>
      document.getElementById('places').children[9].dataset.viewpoint);
  assert.equal((await message(page.said, 'viewpoint')).name, tenth);
  await close(page);
});

test('two fingers walk, a tap goes, on a phone', { skip }, async () => {
  const page = await open({ options: phone });
  const client = await page.context().newCDPSession(page);
  const touch = (type, points) => client.send('Input.dispatchTouchEvent',
      { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  await touch('touchStart', [[150, 400], [240, 400]]);
  for (let i = 1; i <= 8; i++) await touch('touchMove', [[150 - 5 * i, 400], [240 + 5 * i, 400]]);
  await touch('touchEnd', []);
  await message(page.said, 'input', ({ move }) => move[2] > 0.3);
  await message(page.said, 'input', ({ move }) => move[2] === 0);
  assert.equal(last(page.said, 'go'), undefined);
  await page.touchscreen.tap(195, 620);
  await message(page.said, 'go');
  const went = await message(page.heard, 'went');
  assert.ok(went.seconds > 0);
  await shot(page, 'phone');
  await close(page);
});

test('a gamepad walks, looks, goes on to the next place and opens the menu', { skip }, async () => {
  const page = await open({ script: () => {
    const pad = { connected: true, axes: [0, 0, 0, 0],
      buttons: Array.from({ length: 16 }, () => ({ pressed: false })) };
    window.test_pad = pad;
    navigator.getGamepads = () => [null, pad];
  } });
  const set = (change) => page.evaluate(change);
  await set(() => { window.test_pad.axes = [0, -1, 0.1, 0]; });
  const walk = await message(page.said, 'input', ({ move }) => move[2] > 1);
  assert.equal(walk.look[0], 0, 'a stick at rest is never quite in the middle');
  await set(() => { window.test_pad.axes = [0, 0, 1, 0]; });
  await message(page.said, 'input', ({ look }) => look[0] < 0);
  await set(() => { window.test_pad.axes = [0, 0, 0, 0]; });
  const press = async (index) => {
    await page.evaluate((i) => { window.test_pad.buttons[i].pressed = true; }, index);
    await sleep(150);
    await page.evaluate((i) => { window.test_pad.buttons[i].pressed = false; }, index);
    await sleep(150);
  };
  await press(0);
  const places = await page.evaluate(() =>
      [...document.getElementById('places').children].map((one) => one.dataset.viewpoint));
  assert.equal((await message(page.said, 'viewpoint')).name, places[1], 'after the first');
  assert.equal(page.said.filter(({ type }) => type === 'viewpoint').length, 1);
  await press(1);
  await page.waitForSelector('#menu:not([hidden])');
  const focused = () => page.evaluate(() => document.activeElement.id);
  assert.equal(await focused(), 'menu-close');
  await press(13);
  assert.notEqual(await focused(), 'menu-close');
  await press(12);
  await press(0);
  assert.ok(await page.locator('#menu').isHidden());
  await close(page);
});

test('data can be saved, and figures are for technicians', { skip }, async () => {
  const page = await open();
  await page.locator('#menu-button').click();
  assert.ok(await page.locator('#figures').isHidden());
  await page.locator('#figures-on').check();
  await page.waitForFunction(() => /fps/.test(document.getElementById('figures').textContent));
  assert.ok(await page.locator('#figures').isVisible());
  await page.locator('input[value=saver]').check();
  const saver = await message(page.said, 'settings', ({ fps }) => fps > 0);
  assert.ok(saver.width * saver.height <= 640 * 360 * 1.05 && saver.quality < 60);
  await page.waitForFunction(() => document.getElementById('picture').width <= 640);
  await page.reload();
  await message(page.said, 'hello', ({ width, height }) => width * height < 640 * 360 * 1.05);
  await shot(page, 'saver');
  await close(page);
});

test('subtitles stay while controls fade, and give way to no hands', { skip }, async () => {
  const page = await open();
  await page.locator('#menu-button').click();
  await page.locator('#stories [data-story=crown]').click();
  await page.waitForSelector('#subtitle:not([hidden])');
  const top = () => page.evaluate(() =>
      document.getElementById('subtitle').getBoundingClientRect().bottom);
  await page.mouse.move(600, 300);
  await sleep(900);
  const above = await top();
  const player = await page.locator('#player').boundingBox();
  assert.ok(above <= player.y + 1, `subtitle down to ${above}, player from ${player.y}`);
  await page.evaluate(() => document.activeElement.blur());
  await page.waitForSelector('body.quiet');
  await page.waitForSelector('#subtitle:not([hidden])');
  await sleep(900);
  assert.equal(await page.evaluate(() => getComputedStyle(
      document.getElementById('subtitle')).opacity), '1');
  assert.ok(await top() > 770, `at the foot of 800 pixels: ${await top()}`);
  await shot(page, 'subtitle');
  await page.evaluate(() => document.getElementById('player-stop').click());
  await close(page);
});

test('after Escape the focus is where it was before the menu', { skip }, async () => {
  const page = await open();
  const focused = () => page.evaluate(() => document.activeElement.id);
  await page.locator('#menu-button').focus();
  await page.keyboard.press('Enter');
  assert.equal(await focused(), 'menu-close');
  await page.keyboard.press('Escape');
  assert.equal(await focused(), 'menu-button');
  await close(page);
});

test('what the address asks for and is not there is said kindly', { skip }, async () => {
  const wrong = await open({ path: '/?exhibit=moon' });
  await wrong.waitForFunction(() => !document.getElementById('notice').hidden);
  assert.equal(await wrong.textContent('#notice'),
      'There is no exhibit “moon” here. Welcome to Falconwell Castle instead.');
  await shot(wrong, 'unknown');
  await close(wrong);
  const tongue = await open({ path: '/?lang=xx' });
  await tongue.waitForFunction(() => !document.getElementById('notice').hidden);
  assert.match(await tongue.textContent('#notice'), /“xx”.*English, Deutsch, Slovenčina/);
  assert.equal(await tongue.getAttribute('html', 'lang'), 'en');
  await close(tongue);
  const right = await open({ path: '/?exhibit=castle&lang=sk' });
  await sleep(500);
  assert.ok(await right.locator('#notice').isHidden());
  await close(right);
});

test('an address with nothing behind it is a page for people, and no icon is missing',
    { skip }, async () => {
  const page = await browser.newPage();
  const answer = await page.goto(`${server.url}/nothing/at/all`);
  assert.equal(answer.status(), 404);
  assert.match(answer.headers()['content-type'], /text\/html/);
  assert.equal(await page.textContent('h1'), 'This door leads nowhere');
  assert.equal(await page.locator('a').first().getAttribute('href'), '/');
  await shot(page, 'missing');
  await page.close();
  assert.equal((await fetch(`${server.url}/favicon.ico`)).status, 200);
  const plain = await fetch(`${server.url}/nothing`);
  assert.equal((await plain.json()).error.code, 'not_found');
});
