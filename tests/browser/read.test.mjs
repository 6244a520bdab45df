// SPDX-License-Identifier: Apache-2.0
// The page of texts: all that is told, in the visitor's language, and whose models are shown.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { make_two_exhibits } from '../scripted/pyramid.mjs';
import { little_light, start_server } from '../server.mjs';
import { launch, skip } from './chromium.mjs';

const folder = mkdtempSync(join(tmpdir(), 'wellspring-read-'));

let server, browser;
before(async () => {
  if (skip) return;
  const content = await make_two_exhibits(folder);
  server = await start_server(['--cache', join(folder, 'cache'), ...little_light], { content });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
  rmSync(folder, { recursive: true, force: true });
});

async function open(path, locale = 'en-GB', route = async () => {}) {
  const context = await browser.newContext({ locale }), page = await context.newPage();
  page.problems = [];
  page.on('pageerror', (error) => page.problems.push(String(error)));
  await route(page);
  await page.goto(server.url + path);
  return page;
}
async function close(page) {
  assert.deepEqual(page.problems, []);
  await page.context().close();
}
const told = (id) => fetch(`${server.url}/api/v1/exhibits/${id}/transcript`)
    .then((answer) => answer.json());

test('every sentence of every story and tour is there, in each language', { skip }, async () => {
  const { stories, tours } = await told('castle');
  assert.ok(stories.length >= 3 && tours.length >= 1);
  const page = await open('/read?exhibit=castle', 'de-DE');
  await page.waitForSelector('#stories article');
  for (const [lang, name] of [['de', 'Deutsch'], ['sk', 'Slovenčina'], ['en', 'English']]) {
    await page.click(`#languages button:text("${name}")`);
    await page.waitForFunction((tag) => document.documentElement.lang === tag, lang);
    const text = await page.textContent('main');
    const all = [...stories, ...tours.flatMap(({ stops }) => stops)];
    for (const one of all)
      for (const sentence of [...one.text[lang] ?? [], ...one.way_text?.[lang] ?? []])
        assert.ok(text.includes(sentence), `${lang}: ${sentence}`);
    for (const { id, title } of stories)
      assert.equal(await page.textContent(`#story-${id} h3`), title[lang]);
  }
  assert.equal(await page.title(), 'Falconwell Castle – Read along');
  // The choice is kept.
  await page.reload();
  await page.waitForSelector('#languages [aria-pressed=true]:text("English")');
  await close(page);
});

test('a language that nobody speaks gets its own words, and texts of another', { skip },
    async () => {
      const page = await open('/read?exhibit=castle', 'fr-FR');
      await page.waitForSelector('#story-well p');
      assert.equal(await page.textContent('.kind'), 'À lire');
      assert.equal(await page.getAttribute('#story-well h3', 'lang'), 'en');
      await page.click('#languages button:text("Deutsch")');
      await page.waitForFunction(() => document.documentElement.lang === 'de');
      assert.equal(await page.getAttribute('#story-well h3', 'lang'), null);
      await close(page);
    });

test('an address leads to a story, and the visit leads there and back', { skip }, async () => {
  const page = await open('/read?exhibit=castle#story-crown');
  await page.waitForFunction(() => {
    const top = document.getElementById('story-crown')?.getBoundingClientRect().top;
    return top > -200 && top < 200;
  });
  await page.click('#back');
  await page.waitForURL('**/e/castle');
  await page.waitForFunction(() => Number(document.getElementById('picture').dataset.frame) > 1);
  await page.click('#menu-button');
  const links = { menu: await page.getAttribute('#read-link', 'href') };
  await page.click('#objects [data-object=crown]');
  await page.waitForSelector('#card-read:not([hidden])');
  links.card = await page.getAttribute('#card-read', 'href');
  assert.equal(links.menu, 'read?exhibit=castle&lang=en-GB');
  assert.match(links.card, /^read\?exhibit=castle&lang=en-GB#story-\w+$/);
  await page.click('#card-read');
  await page.waitForSelector(new URL(links.card, server.url).hash);
  await close(page);
});

test('whose models they are is told, and only addresses of the web are links', { skip },
    async () => {
      const page = await open('/read?exhibit=giza');
      await page.waitForSelector('#credits-list li');
      const text = await page.textContent('#credits');
      for (const part of ['Pyramid', 'A. Mason', 'CC0', '2024 A. Mason'])
        assert.ok(text.includes(part), part);
      assert.equal(await page.getAttribute('#credits a', 'href'), 'https://example.org');
      assert.equal(await page.textContent('#problem'), 'Nothing is told here yet.');
      await close(page);
      const credits = [{ file: 'x.glb', title: null, author: '<b>Eve</b> https://eve.example/a)',
        license: null, source: 'javascript:alert(1)', copyright: '' }];
      const bad = await open('/read?exhibit=giza', 'en-GB', (one) =>
        one.route('**/api/v1/exhibits', async (route) => {
          const answer = await route.fetch(), { exhibits } = await answer.json();
          await route.fulfill({ json: { exhibits: exhibits.map((x) => ({ ...x, credits })) } });
        }));
      await bad.waitForSelector('#credits-list li');
      assert.equal(await bad.textContent('#credits h3'), 'x.glb');
      assert.equal(await bad.locator('#credits b').count(), 0);
      assert.deepEqual(await bad.$$eval('#credits a', (all) => all.map((one) => one.href)),
          ['https://eve.example/a']);
      await close(bad);
    });

test('where none was asked for, or none that is here, all can be chosen', { skip }, async () => {
  const page = await open('/read');
  await page.waitForSelector('#exhibits a >> nth=1');
  assert.ok(await page.isHidden('#problem'));
  await page.click('#exhibits a:text("Falconwell Castle")');
  await page.waitForSelector('#story-well');
  await close(page);
  const lost = await open('/read?exhibit=atlantis&lang=sk');
  await lost.waitForSelector('#exhibits a >> nth=1');
  assert.match(await lost.textContent('#problem'), /„atlantis“ tu nie je/);
  await lost.click('#exhibits a:text("Hrad")');
  await lost.waitForSelector('#story-well');
  assert.equal(await lost.getAttribute('html', 'lang'), 'sk');
  await close(lost);
});

test('on paper it is black on white, without what is pressed', { skip }, async () => {
  const page = await open('/read?exhibit=castle');
  await page.waitForSelector('#story-well p');
  await page.emulateMedia({ media: 'print' });
  const colours = await page.evaluate(() => {
    const { color } = getComputedStyle(document.querySelector('#story-well p:not(.by)'));
    return [color, getComputedStyle(document.body).backgroundColor];
  });
  assert.deepEqual(colours, ['rgb(0, 0, 0)', 'rgb(255, 255, 255)']);
  for (const gone of ['#languages', '#contents', '#back'])
    assert.ok(await page.isHidden(gone), gone);
  assert.ok((await page.pdf()).length > 10000);
  await close(page);
});
