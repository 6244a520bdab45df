// SPDX-License-Identifier: Apache-2.0
// The technician's page in headless Chromium: what is wrong in words, tables, and the chart of
// speed against error.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { Visitor, run, sleep, start_server } from '../server.mjs';
import { launch, pictures, skip } from './chromium.mjs';
import { write_pyramid } from '../scripted/pyramid.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-status-'));
const bench = join(folder, 'last.json');
const weights = process.env.WELLSPRING_WEIGHTS;
const token = 'the token of the house';

let server, browser;
before(async () => {
  if (skip) return;
  delete process.env.WELLSPRING_WEIGHTS;
  const content = join(folder, 'content');
  await run('wellspring_new', ['giza', write_pyramid(folder), '--content', content]);
  process.env.WELLSPRING_ADMIN_TOKEN = token;
  server = await start_server(['--sums', join(folder, 'sums.sqlite'), '--bench', bench],
      { content });
  delete process.env.WELLSPRING_ADMIN_TOKEN;
  if (weights) process.env.WELLSPRING_WEIGHTS = weights;
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
  rmSync(folder, { recursive: true, force: true });
});

const sizes = [{ width: 1280, height: 720 }, { width: 390, height: 844 }];
async function open(viewport = sizes[0]) {
  const page = await browser.newPage({ viewport }), problems = [];
  page.on('pageerror', (error) => problems.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') problems.push(message.text());
  });
  await page.goto(`${server.url}/status`);
  await page.waitForFunction(() =>
    document.getElementById('verdict').dataset.state !== 'waiting');
  return { page, problems };
}
async function shots(name) {
  if (!pictures) return;
  for (const size of sizes) {
    const { page } = await open(size);
    await sleep(1500);
    await page.screenshot({ path: join(pictures, `${name}_${size.width}.png`), fullPage: true });
    await page.close();
  }
}
const says = (page, id, words) => page.waitForFunction(([where, part]) =>
  document.getElementById(where).textContent.includes(part), [id, words]);

test('what is missing is said, with what to do, and figures', { skip }, async () => {
  const { page, problems } = await open();
  await says(page, 'verdict', 'Guests are well; something could be better');
  await says(page, 'findings', 'Pictures at rest take longer to become fine since ');
  await says(page, 'findings', "Start the server once by './wellspring run'");
  await says(page, 'server', 'Memory');
  await says(page, 'speeds-about', 'Nothing has been measured on this machine yet');
  assert.ok(await page.isHidden('#kiosks-section'));
  assert.deepEqual(problems, []);
  await page.close();
});

test('a kiosk without its camera, until the camera is back', { skip }, async () => {
  const { page, problems } = await open();
  const look = async () => {
    const camera = new Visitor(server, { path: '/api/v1/eye', protocol: [] });
    await camera.opened;
    const say = (camera_state) => camera.send({ type: 'observation', time: 1, presence: false,
      camera_name: 'hall, left', kiosk: 'hall', camera_state });
    say('dark');
    return { camera, say };
  };
  const { camera } = await look();
  await says(page, 'cameras', 'hall, left');
  await says(page, 'cameras', 'sees only black');
  await camera.close();
  await says(page, 'findings', "No camera at kiosk 'hall' since ");
  await says(page, 'findings', "Check its cable and the program 'wellspring kiosk'.");
  assert.equal(await page.getAttribute('#verdict', 'data-state'), 'bad');
  await shots('status_bad');
  const back = await look(), timer = setInterval(() => back.say('good'), 500);
  await page.waitForFunction(() =>
    !document.getElementById('findings').textContent.includes('No camera'));
  clearInterval(timer);
  assert.deepEqual(problems, []);
  await page.close();
  await back.camera.close();
});

test('speed against error is a chart and a table, scene by scene', { skip }, async () => {
  const results = [];
  for (const [scene, share] of [['cornell_box', 1], ['castle', 2]])
    for (const [technique, factor] of [['path', 1], ['gather', 0.6], ['instant_radiosity', 0.4]])
      for (const spp of [1, 2, 4, 8, 16])
        results.push({ report: 'light.error', name: `light.${technique}.flip`, scene, technique,
          spp, cpu_seconds: 0.08 * spp * share, value: 0.5 * factor / Math.sqrt(spp) });
  writeFileSync(bench, JSON.stringify({ run: { date: '2026-11-02', commit: 'abc' },
    machine: { cpu: 'a processor', cores: 2 }, results }));
  const { page, problems } = await open();
  await page.waitForSelector('#chart svg circle');
  assert.equal(await page.locator('#chart circle').count(), 15);
  assert.equal(await page.locator('#legend li').count(), 3);
  assert.equal(await page.locator('#speeds-table tbody tr').count(), 15);
  // Twice the time lies to the right, less error lies lower.
  const [first, second] = await page.$$eval('#chart circle[data-technique="path"]',
      (dots) => dots.slice(0, 2).map((dot) => [dot.cx.baseVal.value, dot.cy.baseVal.value]));
  assert.ok(second[0] > first[0] && second[1] > first[1], `${first} ${second}`);
  await page.selectOption('#scene', 'castle');
  const moved = await page.$eval('#chart circle[data-technique="path"]',
      (dot) => dot.cx.baseVal.value);
  assert.notEqual(moved, first[0]);
  assert.deepEqual(problems, []);
  await page.close();
  await shots('status_speeds');
});

test('on a phone nothing is wider than the screen, and sums are linked', { skip }, async () => {
  const { page, problems } = await open(sizes[1]);
  await page.waitForSelector('#chart svg circle');
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(width <= 390, `${width} pixels`);
  const [download] = await Promise.all([page.waitForEvent('download'),
    page.click('#sums-link')]);
  assert.equal(download.suggestedFilename(), 'sums.csv');
  assert.deepEqual(problems, []);
  await page.close();
});

test('from another machine the page asks for the token, once', { skip }, async () => {
  const context = await browser.newContext({ viewport: sizes[1],
    extraHTTPHeaders: { 'X-Forwarded-For': '192.0.2.7' } });
  const page = await context.newPage();
  await page.goto(`${server.url}/status`);
  await says(page, 'verdict', 'The server tells this to who has its admin token');
  assert.ok(await page.isHidden('#server'));
  const sign_in = async (text) => {
    await page.fill('#token', text);
    await page.click('#sign-in button');
  };
  await sign_in('a token of somebody else');
  await says(page, 'verdict', 'The server does not know this token');
  assert.ok(await page.isHidden('#server'));
  await sign_in(token);
  await says(page, 'server', 'Memory');
  assert.ok(await page.isHidden('#sign-in'));
  await page.waitForSelector('#chart svg circle');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#sums-link')]);
  assert.equal(download.suggestedFilename(), 'sums.csv');
  await page.reload();
  await says(page, 'server', 'Memory');
  await context.close();
});

test('a server that is gone is said', { skip }, async () => {
  const { page } = await open();
  await page.route('**/api/v1/status', (route) => route.abort());
  await says(page, 'verdict', 'The server does not answer');
  await page.unroute('**/api/v1/status');
  await page.waitForFunction(() => /wrong|well|fine/.test(
      document.getElementById('verdict-word').textContent));
  await page.close();
});
