// SPDX-License-Identifier: Apache-2.0
// The pages in Firefox, headless, by WebDriver BiDi: https://www.w3.org/TR/webdriver-bidi/.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { WebSocket, sleep, start_server } from '../server.mjs';
import { difference, hide_in_page, shrink_in_page } from './pixels.mjs';

const executable = ['/usr/bin/firefox-esr', '/usr/bin/firefox'].find(existsSync);
const skip = !executable && 'no Firefox on this machine (Debian package firefox-esr)';
const pictures = process.env.WELLSPRING_PICTURES;
const folder = mkdtempSync(join(tmpdir(), 'wellspring-firefox-'));
const profile = join(folder, 'profile');
const arrow_left = '\uE012';  // as WebDriver names the key

// Starts the browser: {child, address} once it says where it listens.
function start_firefox() {
  const child = spawn(executable, ['--headless', '--no-remote', '--remote-debugging-port=0',
    '--profile', profile], { stdio: ['ignore', 'ignore', 'pipe'],
    env: { ...process.env, HOME: folder, MOZ_CRASHREPORTER_DISABLE: '1' } });
  return new Promise((resolve, reject) => {
    let log = '';
    child.on('close', (status) => reject(new Error(`Firefox ended with ${status}\n${log}`)));
    child.stderr.on('data', (chunk) => {
      log += chunk;
      const found = /WebDriver BiDi listening on (ws:\S+)/.exec(log);
      if (found) resolve({ child, address: found[1] });
    });
  });
}

// Commands to the browser, and what it writes to its console meanwhile.
async function connect(address) {
  const socket = new WebSocket(`${address}/session`), waiting = new Map();
  await new Promise((resolve, reject) => { socket.on('open', resolve).on('error', reject); });
  const errors = [];
  let last = 0;
  socket.on('message', (bytes) => {
    const message = JSON.parse(String(bytes));
    if (message.method === 'log.entryAdded' && message.params.level === 'error')
      errors.push(message.params.text);
    const answer = waiting.get(message.id);
    waiting.delete(message.id);
    if (message.type === 'success') answer?.resolve(message.result);
    else answer?.reject(new Error(`${message.error}: ${message.message}`));
  });
  const ask = (method, params = {}) => new Promise((resolve, reject) => {
    waiting.set(++last, { resolve, reject });
    socket.send(JSON.stringify({ id: last, method, params }));
  });
  return { ask, errors, close: () => socket.close() };
}

let server, firefox, driver, context;
before(async () => {
  if (skip) return;
  mkdirSync(profile);
  [server, firefox] = await Promise.all(
      [start_server(['--cache', join(folder, 'cache'), '--no-bake']), start_firefox()]);
  driver = await connect(firefox.address);
  await driver.ask('session.new', { capabilities: {} });
  await driver.ask('session.subscribe', { events: ['log.entryAdded'] });
  ({ context } = await driver.ask('browsingContext.create', { type: 'tab' }));
  await driver.ask('browsingContext.setViewport',
      { context, viewport: { width: 960, height: 540 } });
});
after(async () => {
  driver?.close();
  if (firefox) {
    const ended = new Promise((resolve) => firefox.child.once('exit', resolve));
    firefox.child.kill('SIGTERM');
    await Promise.race([ended, sleep(8000).then(() => firefox.child.kill('SIGKILL'))]);
  }
  await server?.stop();
  rmSync(folder, { recursive: true, force: true, maxRetries: 5 });
});

async function open(path) {
  driver.errors.length = 0;
  await driver.ask('browsingContext.navigate',
      { context, url: server.url + path, wait: 'complete' });
}
// The value of an expression in the page.
async function evaluate(expression) {
  const { result, exceptionDetails } = await driver.ask('script.evaluate', { expression,
    target: { context }, awaitPromise: true });
  assert.ok(!exceptionDetails, `${expression}: ${exceptionDetails?.text}`);
  return result.value;
}
async function until(expression) {
  for (const end = performance.now() + 60000; performance.now() < end; await sleep(100))
    if (await evaluate(`!!(${expression})`)) return;
  assert.fail(`never: ${expression}`);
}
const keys = (actions) => driver.ask('input.performActions',
    { context, actions: [{ type: 'key', id: 'keys', actions }] });
async function shot(name) {
  if (!pictures) return;
  await sleep(1000);
  const { data } = await driver.ask('browsingContext.captureScreenshot', { context });
  writeFileSync(join(pictures, `firefox-${name}.png`), Buffer.from(data, 'base64'));
}
// Mean colours of a grid of cells of the picture.
async function look() {
  await evaluate(`(${hide_in_page})(true)`);
  const { data } = await driver.ask('browsingContext.captureScreenshot', { context });
  await evaluate(`(${hide_in_page})(false)`);
  return JSON.parse(await evaluate(
      `(${shrink_in_page})(${JSON.stringify([data, 24, 14])}).then(JSON.stringify)`));
}

test('Firefox shows the pictures, turns by a key, opens the menu and hears a story', { skip },
    async () => {
      await open('/');
      await until('Number(document.getElementById("picture").dataset.frame) > 5');
      const before_key = await look();
      await keys([{ type: 'keyDown', value: arrow_left }, { type: 'pause', duration: 700 },
        { type: 'keyUp', value: arrow_left }]);
      for (const end = performance.now() + 30000; ; await sleep(200)) {
        const change = difference(before_key, await look());
        if (change > 8) break;
        assert.ok(performance.now() < end, `turning changed the picture by ${change}`);
      }
      await evaluate('document.getElementById("menu-button").click()');
      await until('!document.getElementById("menu").hidden');
      await shot('menu');
      await evaluate('document.querySelector("#stories button").click()');
      await until('!document.getElementById("subtitle").hidden');
      await shot('story');
      assert.deepEqual(driver.errors, []);
    });

test('Firefox shows all texts, the kiosk and the status', { skip }, async () => {
  await open('/read');
  await until('document.querySelector("#story-well p")');
  await shot('read');
  assert.deepEqual(driver.errors, []);
  await open('/kiosk');
  await until('Number(document.getElementById("picture").dataset.frame) > 0');
  await evaluate('document.getElementById("open-book").click()');
  await until('document.querySelector("#book:not([hidden]) .page:not([hidden])")');
  await shot('kiosk');
  assert.deepEqual(driver.errors, []);
  await open('/status');
  await until('document.querySelector("#server td")');
  assert.deepEqual(driver.errors, []);
});
