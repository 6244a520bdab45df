// SPDX-License-Identifier: Apache-2.0
// The picture as the page draws it from keyframes with depth, by WebGL2 in headless Chromium, which
// does it without a graphics card.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { start_server, until } from '../server.mjs';
import { by_processor, launch, pictures, skip } from './chromium.mjs';
import { difference, look } from './pixels.mjs';

let server, browser;
before(async () => {
  if (skip) return;
  server = await start_server(['--exhibit', 'first-room']);
  browser = await launch(by_processor);
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

async function open(display, from = server, context = { viewport: { width: 480, height: 270 } }) {
  const page = await browser.newPage(context), problems = [];
  page.on('pageerror', (error) => problems.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') problems.push(message.text());
  });
  await page.goto(`${from.url}/?display=${display}`);
  await page.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 3);
  return { page, problems };
}
const shot = (page) => look(page, 48, 13, { x: 0, y: 60, width: 480, height: 130 });

// The page once nothing fades and no turn goes on.
async function settled(page, see = () => shot(page)) {
  let last = await see();
  await until(async () => {
    const before = last;
    last = await see();
    return difference(before, last) < 0.5;
  }, 'it stands');
  return last;
}

test('it shows what finished pictures show, and turns at once', { skip }, async () => {
  const finished = await open('server'), own = await open('local');
  assert.equal(await own.page.evaluate(() => document.body.dataset.display), 'local');
  await own.page.waitForSelector('canvas.local:not([hidden])');
  await until(async () => difference(await shot(own.page), await shot(finished.page)) < 4,
      'both show the same room');
  if (pictures) await own.page.screenshot({ path: join(pictures, 'display-room.png') });
  const before_turn = await shot(own.page);
  await own.page.keyboard.down('ArrowLeft');
  await until(async () => difference(before_turn, await shot(own.page)) > 8, 'it turns');
  await own.page.keyboard.up('ArrowLeft');
  await settled(own.page);
  for (const { page } of [finished, own]) {
    await page.evaluate(() => { location.hash = '#place=0.5,1.6,1.5,0.4,0'; });
  }
  await until(async () => difference(await shot(own.page), await shot(finished.page)) < 4,
      'both show the same place');
  for (const { page, problems } of [finished, own]) {
    assert.deepEqual(problems, []);
    await page.close();
  }
});

test('a lost context comes back with the picture', { skip }, async () => {
  const { page, problems } = await open('local');
  await page.waitForSelector('canvas.local:not([hidden])');
  const first = await settled(page);
  const hidden = await page.evaluate(async () => {
    const canvas = document.querySelector('canvas.local');
    const happens = (event) =>
      new Promise((done) => { canvas.addEventListener(event, done, { once: true }); });
    const loses = /** @type {any} */ (canvas).getContext('webgl2')
        .getExtension('WEBGL_lose_context');
    const lost = happens('webglcontextlost'), back = happens('webglcontextrestored');
    loses.loseContext();
    await lost;
    const was = /** @type {any} */ (canvas).hidden;
    setTimeout(() => loses.restoreContext(), 50);
    await back;
    return was;
  });
  assert.ok(hidden);
  await page.waitForSelector('canvas.local:not([hidden])');
  await until(async () => difference(first, await shot(page)) < 12, 'the picture is back');
  assert.deepEqual(problems, []);
  await page.close();
});

test('it goes on while the server is frozen, and says so', { skip }, async (t) => {
  const frozen = await start_server(['--exhibit', 'first-room']);
  t.after(() => frozen.stop());
  const { page, problems } = await open('local', frozen);
  const before = await settled(page);
  frozen.child.kill('SIGSTOP');
  t.after(() => frozen.child.kill('SIGCONT'));
  const said = page.getByText('The server is silent').waitFor();
  await page.keyboard.down('ArrowLeft');
  await until(async () => difference(before, await shot(page)) > 8, 'it turns');
  await page.keyboard.up('ArrowLeft');
  await said;
  frozen.child.kill('SIGCONT');
  await page.getByText('The server is silent').waitFor({ state: 'hidden' });
  const frame = () => page.evaluate(() =>
    Number(document.getElementById('picture').dataset.frame));
  const then = await frame();
  await page.keyboard.press('ArrowRight');
  await until(async () => await frame() > then, 'pictures come again');
  assert.deepEqual(problems, []);
  await page.close();
});

test('an upright phone of three pixels a point is shown as sharply', { skip }, async () => {
  const phone = { viewport: { width: 270, height: 480 }, deviceScaleFactor: 3, isMobile: true };
  let shown;
  for (const display of ['server', 'local']) {
    const { page, problems } = await open(display, server, phone);
    if (display === 'local') {
      await page.waitForSelector('canvas.local:not([hidden])');
      const { width, height } = await page.evaluate(() => {
        const { width, height } = document.querySelector('canvas.local');
        return { width, height };
      });
      assert.ok(height > 480 && height > width, `${width}x${height}`);
    }
    const clip = { x: 0, y: 100, width: 270, height: 240 };
    const see = () => look(page, 27, 24, clip);
    if (display === 'server') shown = await settled(page, see);
    let differs;
    await until(async () => {
      differs = difference(shown, await see());
      return differs < 4;
    }, () => `both show the same: they differ by ${differs}`);
    assert.deepEqual(problems, []);
    await page.close();
  }
});

test('without WebGL2 pictures come finished', { skip }, async () => {
  const page = await browser.newPage({ viewport: { width: 480, height: 270 } });
  await page.addInitScript(() => {
    const make = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function getContext(kind, ...rest) {
      return kind === 'webgl2' ? null : make.call(this, kind, ...rest);
    };
  });
  await page.goto(`${server.url}/?display=local`);
  await page.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 3);
  assert.equal(await page.evaluate(() => document.body.dataset.display), 'server');
  assert.equal(await page.locator('canvas.local').count(), 0);
  await page.close();
});
