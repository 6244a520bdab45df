// SPDX-License-Identifier: Apache-2.0
// The page in headless Chromium: things that move when they are touched, and objects that are
// looked at from all sides.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { sleep, start_server } from '../server.mjs';
import { launch, pictures, skip } from './chromium.mjs';
import { difference, look as look_at } from './pixels.mjs';

let server, browser;
before(async () => {
  if (skip) return;
  server = await start_server(['--exhibit', 'first-room', '--no-bake']);
  browser = await launch();
});
after(async () => {
  if (browser) await browser.close();
  if (server) await server.stop();
});

const laptop = { viewport: { width: 1280, height: 800 } };
const phone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

async function open(options) {
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
  await page.goto(server.url);
  await page.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 3);
  return page;
}
async function close(page) {
  assert.deepEqual(page.problems, []);
  assert.deepEqual(page.heard.filter(({ type }) => type === 'error'), []);
  await page.context().close();
}
// Opens the card of an object, which is chosen in the menu.
async function look_closer(page, id) {
  await page.click('#menu-button');
  await page.locator(`#objects [data-object=${id}]`).click();
  await page.waitForFunction(() => !document.getElementById('card').hidden);
  if (await page.locator('#menu').isVisible()) await page.keyboard.press('Escape');
}
const state_is = async (page, fits) => {
  const ends = performance.now() + 20000;
  while (performance.now() < ends) {
    const state = page.heard.filter(({ type }) => type === 'state').at(-1);
    if (state && fits(state)) return state;
    await sleep(50);
  }
  return assert.fail(`no such state: ${fits}`);
};
const shot = async (page, name) => {
  if (pictures) await page.screenshot({ path: join(pictures, `${name}.png`) });
};
const look = (page) => look_at(page, 32, 20);
// Waits until the picture has changed by that much.
async function changes(page, from, least) {
  const ends = performance.now() + 20000;
  let now = 0;
  while (performance.now() < ends) {
    now = difference(await look(page), from);
    if (now > least) return;
    await sleep(100);
  }
  assert.fail(`the picture changed by ${now}`);
}

test('the card of a cupboard has a button that opens and shuts it', { skip }, async () => {
  const page = await open(laptop);
  await look_closer(page, 'cupboard');
  await state_is(page, ({ seq }) => seq > 0);
  await sleep(3000);  // until the way there is gone and the picture rests
  const button = page.locator('#card-animations button');
  assert.equal(await button.getAttribute('aria-pressed'), 'false');
  const shut = await look(page);
  await button.focus();
  await page.keyboard.press('Enter');
  await page.waitForSelector('#card-animations button[aria-pressed=true]');
  await changes(page, shut, 1);
  await shot(page, 'cupboard-open');
  await button.click();
  await page.waitForSelector('#card-animations button[aria-pressed=false]');
  await close(page);
});

for (const [name, options] of Object.entries({ laptop, phone }))
  test(`a vase is turned and put back (${name})`, { skip }, async () => {
    const page = await open(options);
    await look_closer(page, 'vase');
    await page.locator('#card-around').click();
    await state_is(page, ({ around }) => around === 'vase');
    assert.equal(await page.getAttribute('#card-around', 'aria-pressed'), 'true');
    assert.ok(await page.locator('#card-around-hint').isVisible());
    await sleep(2000);
    await shot(page, `vase-${name}`);
    const before = await look(page);
    const { width, height } = options.viewport, middle = [0.75 * width, 0.4 * height];
    await page.mouse.move(...middle);
    await page.mouse.down();
    await page.mouse.move(middle[0] - 0.3 * width, middle[1] + 0.1 * height, { steps: 8 });
    await page.mouse.up();
    await changes(page, before, 2);
    await shot(page, `vase-${name}-turned`);
    await page.keyboard.press('Escape');
    await state_is(page, ({ around }) => around === null);
    assert.ok(await page.locator('#card').isHidden());
    await close(page);
  });
