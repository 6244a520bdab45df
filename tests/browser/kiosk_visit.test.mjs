// SPDX-License-Identifier: Apache-2.0
// A visitor who only touches, before the real programs: the camera wakes the well, and a finger
// finds its way through a story, a presentation and the tour; then the house is as it was.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { data, source, start_server } from '../server.mjs';
import { launch, skip } from './chromium.mjs';

test('from sleep to farewell by touch alone', { skip }, async (context) => {
  // The castle, whose kiosk does not wait long for somebody who has gone.
  const content = mkdtempSync(join(tmpdir(), 'wellspring-visit-'));
  context.after(() => rmSync(content, { recursive: true }));
  cpSync(join(source, 'content/castle'), join(content, 'castle'), { recursive: true });
  const file = join(content, 'castle/exhibit.json');
  const exhibit = JSON.parse(readFileSync(file, 'utf8'));
  exhibit.kiosks = [{ name: 'hall', times: { leave_untouched: 20, leave_playing: 30, farewell: 3,
    sleep_after: 3, sleep_latest: 5 } }];
  writeFileSync(file, JSON.stringify(exhibit));
  const server = await start_server([], { content });
  context.after(() => server.stop());
  const browser = await launch(['--disable-gpu', '--disable-3d-apis']);
  context.after(() => browser.close());
  const page = await browser.newPage({ viewport: { width: 1080, height: 1920 } });
  const problems = [];
  page.on('pageerror', (error) => problems.push(String(error)));
  await page.goto(`${server.url}/kiosk?kiosk=hall&lang=en`);
  const stage_is = (...stages) => page.waitForFunction(
      (wanted) => wanted.includes(document.body.dataset.stage), stages);
  const view_is = (view) => page.waitForFunction(
      (wanted) => document.body.dataset.view === wanted, view);

  // The camera sees a filmed man, or one who comes, stands for ten seconds, and goes again.
  const film = join(data, '5_faces', 'headtrackr', 'capture4.mp4');
  const camera = spawn(join(process.env.WELLSPRING_BIN, 'wellspring_kiosk'), ['--camera',
    ...(existsSync(film) ? [film] : ['synthetic', '--width', '320', '--rate', '10']),
    '--name', 'hall', '--server', server.ws],
  { stdio: 'ignore' });
  const camera_ended = new Promise((resolve) => camera.on('close', resolve));
  context.after(() => { camera.kill('SIGTERM'); return camera_ended; });
  await stage_is('person', 'engaged');
  await page.waitForFunction(() => !document.getElementById('subtitle').hidden);  // a greeting

  await page.mouse.click(540, 1300);
  await page.mouse.click(544, 1304);
  await view_is('book');
  await page.waitForFunction(() => !document.getElementById('book').hidden);
  await stage_is('engaged');
  const museum = async (name) => {
    await page.locator('.tabs [data-chapter=museum]').click();
    await page.locator('.entry', { hasText: name }).first().click();
  };
  await museum('Let her tell');
  const story = page.locator('#book .entry').first(), title = await story.textContent();
  await story.click();
  await view_is('museum');
  await page.waitForFunction(() => !document.getElementById('player').hidden);
  assert.equal(await page.textContent('#player-title'), title);
  await page.locator('#player-skip').click();
  await page.locator('#player-stop').click();
  await view_is('book');

  await page.locator('.tabs [data-chapter=presentations]').click();
  await page.locator('#book .entry').first().click();
  await view_is('slides');
  const slides = await page.locator('#slides .progress span').count();
  assert.ok(slides >= 5, `${slides} slides`);
  for (let i = 0; i < slides; i++) {
    const broken = await page.evaluate(() => [...document.querySelectorAll('#slides img')]
        .filter((image) => image.complete && image.naturalWidth === 0).length);
    assert.equal(broken, 0, `slide ${i} shows its picture`);
    await page.locator('#slides [data-action=forward]').click();
  }
  await view_is('book');

  await page.locator('.tabs [data-chapter=museum]').click();
  await page.locator('#book .entry', { hasText: exhibit.tours[0].title.en }).click();
  await view_is('museum');
  await page.waitForFunction(() => !document.getElementById('player').hidden);
  await page.locator('#to-book').click();
  await view_is('book');

  // Nobody touches any more, and nobody stands there any more.
  camera.kill('SIGTERM');
  await camera_ended;
  await stage_is('farewell');
  await view_is('well');
  assert.match(await page.textContent('#notice'), /Goodbye/);
  // No camera is left, so the well stays awake for who passes by.
  await stage_is('awake', 'sleep');
  await page.waitForFunction(() => document.getElementById('player').hidden);
  assert.deepEqual(problems, []);
});
