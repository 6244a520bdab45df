// SPDX-License-Identifier: Apache-2.0
// A curator's page in headless Chromium: it comes back at the same place, shows mistakes, and
// copies a viewpoint that exhibit.json takes.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { run, start_server } from '../server.mjs';
import { launch, pictures, skip } from './chromium.mjs';
import { write_pyramid } from '../scripted/pyramid.mjs';


const folder = mkdtempSync(join(tmpdir(), 'wellspring-curators-page-'));
const content = join(folder, 'content'), model = write_pyramid(folder);
const file = join(content, 'giza', 'exhibit.json');
let server, browser;
before(async () => {
  if (skip) return;
  await run('wellspring_new', ['giza', model, '--content', content]);
  server = await start_server(['--exhibit', 'giza', '--watch'], { content });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
  rmSync(folder, { recursive: true, force: true });
});

async function open() {
  const context = await browser.newContext({ viewport: { width: 960, height: 540 },
    permissions: ['clipboard-read', 'clipboard-write'] });
  const page = await context.newPage();
  await page.goto(server.url);
  await page.waitForFunction(() =>
    Number(document.getElementById('picture').dataset.frame) > 3);
  return page;
}
async function copied(page) {
  await page.click('#menu-button');
  await page.click('#copy-viewpoint');
  await page.waitForFunction(() => document.getElementById('notice').textContent);
  await page.click('#menu-close');
  return JSON.parse(await page.evaluate(() => navigator.clipboard.readText()));
}

test('the place is copied, pasted, and kept over changes', { skip }, async () => {
  const page = await open(), text = readFileSync(file, 'utf8');
  await page.keyboard.down('ArrowLeft');
  await page.waitForTimeout(600);
  await page.keyboard.up('ArrowLeft');
  await page.waitForTimeout(900);
  const place = await copied(page);
  assert.deepEqual(Object.keys(place),
      ['name', 'title', 'position', 'yaw_deg', 'pitch_deg', 'fov_deg']);
  const exhibit = JSON.parse(text);
  exhibit.viewpoints.push(place);
  writeFileSync(file, JSON.stringify(exhibit));
  await page.waitForSelector(`#places [data-viewpoint="${place.name}"]`);
  await page.waitForTimeout(1500);
  const { name, ...later } = await copied(page), { name: before_name, ...now } = place;
  assert.notEqual(name, before_name, 'that name is taken by now');
  assert.deepEqual({ ...later, title: 0 }, { ...now, title: 0 }, 'the same place');
  await page.context().close();
});

test('mistakes stand over the picture until they are mended', { skip }, async () => {
  const page = await open(), text = readFileSync(file, 'utf8');
  assert.equal(await page.locator('#problems').count(), 0);
  writeFileSync(file, text.replace('"viewpoints"', '"vewpoints"'));
  await page.waitForSelector('#problems');
  const words = await page.textContent('#problems');
  assert.match(words, /exhibit\.json/);
  assert.match(words, /did you mean 'viewpoints'\?/);
  if (pictures) await page.screenshot({ path: join(pictures, 'watch_problems.png') });
  writeFileSync(file, text);
  await page.waitForSelector('#problems', { state: 'detached' });
  await page.context().close();
});
