// SPDX-License-Identifier: Apache-2.0
// A scanned volume, as a visitor uses it: presets, turntable, unwrapping, cuts, the glass. It is a
// flat green shell, hollow, with a red ball in it.
import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { little_light, source, start_server, until } from '../server.mjs';
import { launch, pictures, skip } from './chromium.mjs';
import { difference, look } from './pixels.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-volume-'));
const room = join(folder, 'content', 'room');
const side = 32;

// Returns an NRRD file of a shell of value 100, half as deep as wide, around a ball of value 200.
function make_scan() {
  const samples = Buffer.alloc(side ** 3), middle = (side - 1) / 2;
  let i = 0;
  for (let z = 0; z < side; z++)
    for (let y = 0; y < side; y++)
      for (let x = 0; x < side; x++, i++) {
        const [a, b, c] = [x - middle, y - middle, z - middle];
        const shell = Math.hypot(a / 15, b / 9, c / 15), ball = Math.hypot(a, b, c);
        samples[i] = ball < 5 ? 200 : shell < 1 && shell > 0.75 ? 100 : 0;
      }
  const header = ['NRRD0004', 'type: uint8', 'dimension: 3', `sizes: ${side} ${side} ${side}`,
    'spacings: 1 1 1', 'encoding: raw', '', ''].join('\n');
  return Buffer.concat([Buffer.from(header), samples]);
}
const green = [0.05, 0.6, 0.05], red = [0.7, 0.03, 0.03];
const point = (value, color, density) => ({ value, color, density });
const presets = [
  { id: 'shell', label: { en: 'The shell' }, mode: 'density',
    points: [point(30, green, 0), point(60, green, 8), point(140, green, 8), point(160, red, 8)] },
  { id: 'core', label: { en: 'The core' }, text: { en: 'It is red.' }, mode: 'surface',
    points: [point(150, red, 8)] },
];

let server, browser, page;
const problems = [];
before(async () => {
  if (skip) return;
  cpSync(join(source, 'content', 'first-room'), room, { recursive: true });
  const exhibit = JSON.parse(readFileSync(join(room, 'exhibit.json'), 'utf8'));
  exhibit.id = 'room';
  writeFileSync(join(room, 'ball.nrrd'), make_scan());
  exhibit.pieces = [{ id: 'ball', kind: 'volume', source: 'ball.nrrd', size_m: 0.8, presets,
    place: { position: [0.6, 0.95, 0], yaw_deg: 135 }, label: { en: 'The ball' } }];
  exhibit.start = 'vase';
  writeFileSync(join(room, 'exhibit.json'), JSON.stringify(exhibit));
  server = await start_server(['--exhibit', 'room', ...little_light],
      { content: join(folder, 'content') });
  browser = await launch();
  page = await browser.newPage({ viewport: { width: 1024, height: 576 } });
  page.on('pageerror', (error) => problems.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') problems.push(message.text());
  });
  await page.goto(`${server.url}/?exhibit=room&display=server&lang=en`);
  await page.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 2);
  await page.click('#menu-button');
  await page.click('#objects button:has-text("The ball")');
  await page.waitForFunction(() => !document.getElementById('card').hidden);
  if (!await page.locator('#menu').isHidden()) await page.click('#menu-button');
});
after(async () => {
  await browser?.close();
  if (server) assert.equal(await server.stop(), 0);
  rmSync(folder, { recursive: true, force: true });
});

// The colour in the middle of the museum's picture.
async function middle() {
  const seen = await look(page, 1, 1, { x: 504, y: 280, width: 16, height: 16 });
  return seen.slice(0, 3);
}
// The colour in the middle of the glass.
const under_glass = () => page.evaluate(() => {
  const glass = /** @type {any} */ (document.querySelector('.glass'));
  const context = glass.getContext('2d');
  return [...context.getImageData(glass.width / 2, glass.height / 2, 1, 1).data].slice(0, 3);
});
const is_green = ([r, g, b]) => g > 1.5 * r && g > 1.5 * b;
const is_no_shell = (color) => !is_green(color);
const is_red = ([r, g, b]) => r > 1.5 * g && r > 1.5 * b;
const sees = (holds, what) => until(async () => holds(await middle()),
    async () => `${what}: ${await middle()}`);
const slider = (name) => page.getByRole('slider', { name });

test('the card offers the presets, and one is chosen', { skip }, async () => {
  await sees(is_green, 'the shell');
  const list = page.getByRole('combobox', { name: 'Show' });
  assert.deepEqual(await list.locator('option').allTextContents(), ['The shell', 'The core']);
  await list.selectOption('core');
  await sees(is_red, 'the core');
  assert.equal(await page.textContent('#card-piece-text'), 'It is red.');
  await list.selectOption('shell');
  await sees(is_green, 'the shell again');
  if (pictures) await page.screenshot({ path: join(pictures, 'volume.png') });
});

test('the turntable turns it, also by arrow keys, and goes round', { skip }, async () => {
  const around = { x: 300, y: 60, width: 424, height: 400 };
  const before = await look(page, 24, 24, around);
  await slider('Turn').fill('90');
  await until(async () => difference(before, await look(page, 24, 24, around)) > 4,
      'it is narrow from its side');
  await slider('Turn').focus();
  await page.keyboard.press('ArrowRight');
  assert.equal(await slider('Turn').inputValue(), '100');
  assert.equal(await slider('Turn').getAttribute('aria-valuetext'), '100°');
  await page.keyboard.press('Shift+ArrowLeft');
  assert.equal(await slider('Turn').inputValue(), '99');
  await slider('Turn').fill('0');
  await page.keyboard.press('ArrowLeft');
  assert.equal(await slider('Turn').inputValue(), '350');
  assert(await slider('Turn').evaluate((one) => one === document.activeElement), 'focus stays');
});

test('it is unwrapped by a slider, and wrapped again', { skip }, async () => {
  await slider('Unwrap to').fill('1');
  await sees(is_red, 'unwrapped');
  await slider('Unwrap to').fill('0');
  await sees(is_green, 'wrapped');
});

test('a cut from the front shows the inside, and all is as at first', { skip }, async () => {
  if (!await slider('from the front').isVisible()) await page.click('.cuts summary');
  await slider('from the front').fill('0.5');
  await sees(is_no_shell, 'cut open');
  assert.equal(await slider('from the front').getAttribute('aria-valuetext'), '50 %');
  const asked = page.waitForRequest(/still\.jpg/);
  await page.route(/still\.jpg/, (route) => route.abort());
  await page.evaluate(() => document.getElementById('share-postcard').click());
  const query = new URL((await asked).url()).searchParams;
  assert.equal(query.get('pieces'), 'ball:shell::::350:0;0;0:1;1;0.5', 'postcards show it so');
  await page.unroute(/still\.jpg/);
  await page.getByRole('button', { name: 'As at first' }).click();
  await sees(is_green, 'whole');
  assert.equal(await slider('from the front').inputValue(), '0');
  assert.equal(await slider('Turn').inputValue(), '0');
});

test('the glass shows another preset, cuts, and is put down', { skip }, async () => {
  const list = page.getByRole('combobox', { name: 'A glass over it' });
  await list.selectOption('layer core');
  await page.waitForSelector('.glass:not([hidden])');
  await until(async () => is_red(await under_glass()), 'the core under the glass');
  await list.selectOption('cut');
  await page.waitForSelector('.glass:not([hidden])');
  await slider('How deep').fill('0.4');
  await until(async () => is_no_shell(await under_glass()), 'cut to its middle');
  await slider('How deep').fill('0');
  await until(async () => is_green(await under_glass()), 'not cut');
  assert.match(await page.getAttribute('.glass', 'aria-label'), /The ball: cuts into it\. Drag it/);
  await page.focus('.glass');
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => !document.querySelector('.glass'));
  await until(async () => await list.inputValue() === '', 'the card says so');
  assert.equal(await page.isHidden('#card'), false);
});

test('all is there in a narrow window, and nothing has failed', { skip }, async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  for (const name of ['Turn', 'Unwrap to']) {
    await slider(name).scrollIntoViewIfNeeded();
    const box = await slider(name).boundingBox();
    assert(box.height >= 44 && box.x >= 0 && box.x + box.width <= 390, `${name}: large enough`);
  }
  assert.deepEqual(problems.filter((text) => !text.includes('ERR_FAILED')), []);
});
