// SPDX-License-Identifier: Apache-2.0
// Slow lines and old or locked browsers: how much the page weighs, and what it does where something
// is missing that others have.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { source, start_server } from '../server.mjs';
import { launch, pictures, skip } from './chromium.mjs';

const cache = mkdtempSync(join(tmpdir(), 'wellspring-modest-'));
const heaviest = 150000;  // bytes of the visitor's page on the line, without pictures and sound

let server, browser;
before(async () => {
  if (skip) return;
  server = await start_server(['--cache', cache, '--no-bake']);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
  rmSync(cache, { recursive: true, force: true });
});

// A page in a browser from which `lose` has taken something.
async function open(lose = () => {}, path = '/', options = {}) {
  const context = await browser.newContext({ viewport: { width: 960, height: 540 },
    locale: 'en-GB', ...options });
  const page = await context.newPage();
  page.problems = [];
  page.requests = [];
  page.on('pageerror', (error) => page.problems.push(String(error)));
  page.on('requestfinished', (request) => page.requests.push(request));
  await page.addInitScript(lose);
  await page.goto(server.url + path);
  return page;
}
const pictured = (page, most = 2) => page.waitForFunction(
    (n) => Number(document.getElementById('picture').dataset.frame) > n, most);
async function close(page, name) {
  if (pictures && name) await page.screenshot({ path: join(pictures, `${name}.png`) });
  await page.context().close();
}

for (const path of ['/', '/?display=server'])
  test(`the page weighs less than 150 kB, and is soon there: ${path}`, { skip }, async (t) => {
    const page = await open(() => {
      new MutationObserver((changes, observer) => {
        const canvas = document.getElementById('picture');
        if (!canvas?.dataset.frame) return;
        /** @type {any} */ (window).first_picture = performance.now();
        observer.disconnect();
      }).observe(document, { subtree: true, childList: true, attributeFilter: ['data-frame'] });
    }, path);
    await pictured(page);
    await page.waitForFunction(() => /** @type {any} */ (window).first_picture);
    const parts = page.requests.filter((request) => !request.url().includes('/api/'));
    const sizes = await Promise.all(parts.map(async (request) => {
      const { responseBodySize, responseHeadersSize } = await request.sizes();
      return [responseBodySize, responseHeadersSize];
    }));
    const has_icon = parts.some((request) => request.url().endsWith('icon.svg'));
    const icon = has_icon ? 0 : statSync(join(source, 'web', 'icon.svg')).size;
    const [bodies, heads] = [0, 1].map((k) => sizes.reduce((sum, size) => sum + size[k], 0));
    const bytes = bodies + heads + icon;
    const milliseconds = Math.round(await page.evaluate('window.first_picture'));
    t.diagnostic(`${bytes} bytes in ${parts.length} answers, ${heads} of them their headers; first `
      + `picture ${milliseconds} ms after the address`);
    assert.ok(parts.length > 10, 'scripts are counted');
    assert.ok(bytes < heaviest, `${bytes} bytes`);
    await close(page);
  });

test('scripts of the page are asked for at once, none only after another', { skip }, async () => {
  const page = await open();
  await pictured(page);
  // A worker asks for its own, among them some that the page has.
  const of_worker = ['display/decoder.js', 'display/disparity.js'];
  const scripts = [...new Set(page.requests
      .filter((request) => request.resourceType() === 'script')
      .map((request) => new URL(request.url()).pathname.slice(1)))]
      .filter((name) => !of_worker.includes(name)).sort();
  const preloaded = await page.$$eval('link[rel=modulepreload], script[src]', (all) =>
    all.map((one) => one.getAttribute('href') ?? one.getAttribute('src')).sort());
  assert.deepEqual(preloaded, scripts);
  await close(page);
});

test('without a WebSocket the page says what it needs', { skip }, async () => {
  const page = await open(() => { delete /** @type {any} */ (window).WebSocket; });
  await page.waitForSelector('#too-old');
  assert.match(await page.textContent('#too-old'), /needs a newer browser/);
  assert.doesNotMatch(await page.textContent('#veil'), /Opening/);
  await close(page, 'modest-socket');
  // The page says it in the visitor's language, too.
  const german = await open(() => { delete /** @type {any} */ (window).WebSocket; }, '/',
      { locale: 'de-DE' });
  await german.waitForSelector('#too-old:lang(de)');
  await close(german);
});

test('without means for pictures, sound, memory or the clipboard a visit goes on', { skip },
    async () => {
      const page = await open(() => {
        const all = /** @type {any} */ (window);
        for (const name of ['createImageBitmap', 'OffscreenCanvas', 'ResizeObserver',
          'AudioContext', 'PointerEvent'])
          delete all[name];
        for (const name of ['localStorage', 'sessionStorage'])
          Object.defineProperty(window, name,
              { get() { throw new DOMException('not allowed', 'SecurityError'); } });
        Object.defineProperty(navigator, 'clipboard', { value: undefined });
        Object.defineProperty(navigator, 'getGamepads', { value: undefined });
        Object.defineProperty(document, 'fullscreenEnabled', { value: false });
      });
      await pictured(page, 4);
      assert.ok(await page.isHidden('#sound-button'), 'no button that does nothing');
      assert.ok(await page.isHidden('#whole-screen'));
      await page.click('#menu-button');
      await page.click('#languages button:text("Deutsch")');
      await page.waitForFunction(() => document.documentElement.lang === 'de');
      await page.click('#share-copy');
      await page.waitForFunction(() => document.getElementById('share-link').value);
      await page.click('#stories button');
      await page.waitForFunction(() => !document.getElementById('subtitle').hidden);
      assert.deepEqual(page.problems, []);
      await close(page, 'modest-visit');
      const read = await open(() => {
        Object.defineProperty(window, 'localStorage',
            { get() { throw new DOMException('not allowed', 'SecurityError'); } });
      }, '/read');
      await read.click('#languages button:text("Deutsch")');
      await read.waitForSelector('h1:text("Burg Falkenbrunn")');
      assert.deepEqual(read.problems, []);
      await close(read);
    });

test('where sound is not allowed a story is read in its subtitles', { skip }, async () => {
  const page = await open(() => {
    AudioContext.prototype.resume = () => Promise.reject(new DOMException('', 'NotAllowedError'));
    Object.defineProperty(AudioContext.prototype, 'state', { get: () => 'suspended' });
  });
  await pictured(page);
  await page.click('#menu-button');
  await page.click('#stories button');
  await page.waitForFunction(() => !document.getElementById('subtitle').hidden);
  assert.equal(await page.getAttribute('#sound-button', 'data-sound'), 'waiting');
  assert.equal(await page.getAttribute('#sound-button', 'aria-label'), 'Turn sound on');
  assert.deepEqual(page.problems, []);
  await close(page);
});

test('a museum that is full, or does not answer, says so before its doors', { skip }, async () => {
  for (const [words, answer] of [['The museum is full', { type: 'error', code: 'full' }],
    ['broken', null]]) {
    const context = await browser.newContext({ locale: 'en-GB' }), page = await context.newPage();
    await page.routeWebSocket(/visit$/, (socket) => {
      if (answer) socket.send(JSON.stringify(answer));
      else socket.close();
    });
    await page.goto(server.url);
    await page.waitForFunction((part) => {
      const line = document.getElementById('notice'), box = line.getBoundingClientRect();
      const on_top = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
      return line.textContent.includes(part) && on_top === line;
    }, words);
    await close(page, `modest-${answer?.code ?? 'closed'}`);
  }
});

test('who waits reads their place, and who is asked answers by any key', { skip }, async () => {
  const context = await browser.newContext({ locale: 'en-GB' }), page = await context.newPage();
  const said = [];
  let socket = null;
  await page.routeWebSocket(/visit$/, (one) => {
    socket = one;
    one.onMessage((text) => said.push(JSON.parse(String(text))));
    one.send(JSON.stringify({ type: 'waiting', place: 3, of: 7, seconds: 130 }));
  });
  const tell = (message) => socket.send(JSON.stringify(message));
  const answers = () => said.filter(({ type }) => type === 'presence').length;
  const asked = (shown) => page.waitForFunction((wanted) =>
    document.getElementById('presence').hidden !== wanted, shown);
  await page.goto(server.url);
  await page.waitForFunction(() =>
    /number 3 of 7.*About 2 minutes/.test(document.getElementById('veil-text').textContent));
  tell({ type: 'idle', state: 'asked', seconds: 60 });
  await asked(true);
  await page.keyboard.press('ArrowUp');
  await asked(false);
  assert.equal(answers(), 1);
  assert.ok(!said.some(({ type }) => type === 'input'), 'the key was the answer, not a step');
  tell({ type: 'idle', state: 'paused' });
  await asked(true);
  assert.match(await page.textContent('#presence-text'), /where you were/);
  await page.click('#presence-back');
  for (let k = 0; k < 100 && answers() < 2; k++) await page.waitForTimeout(50);
  assert.equal(answers(), 2);
  await close(page, 'modest-resting');
});

test('without WebGL the kiosk\'s well is a still picture, and its book opens', { skip },
    async () => {
      const page = await open(() => {
        const get = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
          return /webgl/.test(kind) ? null : get.call(this, kind, ...rest);
        };
        delete /** @type {any} */ (Navigator.prototype).gpu;
      }, '/kiosk');
      await page.waitForSelector('body.still-water');
      await page.waitForFunction(() => document.getElementById('title').textContent);
      await page.click('#open-book');
      await page.waitForSelector('#book:not([hidden]) .page:not([hidden])');
      assert.deepEqual(page.problems, []);
      await close(page, 'modest-kiosk');
    });
