// SPDX-License-Identifier: Apache-2.0
// The pages' words: every language has every key, and each that the pages ask for is there.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

const web = join(process.env.WELLSPRING_SOURCE, 'web');
const { words } = await import(join(web, 'words.js'));
const { words: kiosk_words } = await import(join(web, 'kiosk/words.js'));
const { words: map_words } = await import(join(web, 'collection/words.js'));
const languages = ['de', 'en', 'es', 'fr', 'sk'];
const blanks = (text) => (text.match(/\{\w+\}/g) ?? []).sort();

for (const [name, all] of [['the page', words], ['the kiosk', kiosk_words],
  ["a collection's map", map_words]])
  test(`${name} has all words in all languages`, () => {
    assert.deepEqual(Object.keys(all).sort(), languages);
    const keys = Object.keys(all.en).sort();
    for (const [lang, own] of Object.entries(all)) {
      assert.deepEqual(Object.keys(own).sort(), keys, lang);
      for (const key of keys) {
        assert.ok(own[key].trim(), `${lang}: ${key} is empty`);
        assert.deepEqual(blanks(own[key]), blanks(all.en[key]), `${lang}: what ${key} leaves open`);
      }
    }
    const same = (lang) => keys.filter((key) => all[lang][key] === all.en[key]).length;
    for (const lang of languages.filter((one) => one !== 'en'))
      assert.ok(same(lang) < keys.length / 8, `${same(lang)} words of ${lang} are English`);
  });

test('the page asks for no word that is not there', () => {
  const files = readdirSync(web).filter((name) => /\.(js|html)$/.test(name));
  const found = files.flatMap((name) => [...readFileSync(join(web, name), 'utf8')
      .matchAll(/data-word(?:-\w+)?="(\w+)"|\bword\(lang, '(\w+)'\)/g)]
      .map(([, page, code]) => [name, page ?? code]));
  assert.ok(found.length > 60, `${found.length} words`);
  for (const [file, key] of found) assert.ok(key in words.en, `${file}: ${key}`);
});

test("a collection's map asks for no word that is not there, and has none too many", () => {
  const folder = join(web, 'collection');
  const files = readdirSync(folder).filter((name) => name.endsWith('.js') && name !== 'words.js');
  const code = files.map((name) => readFileSync(join(folder, name), 'utf8')).join('\n');
  const asked = [...code.matchAll(/\b(?:map_word\(\w[^']*|word\()[^')]*'(\w+)'(?: : '(\w+)')?/g)]
      .flatMap(([, one, other]) => [one, other]).filter(Boolean);
  assert.ok(asked.length > 30, `${asked.length} words`);
  for (const key of asked) assert.ok(key in map_words.en, key);
  // Some names end with a number.
  const numbered = /^(?:truth|stress)_\d$/;
  assert.deepEqual(Object.keys(map_words.en)
      .filter((key) => !asked.includes(key) && !numbered.test(key)), []);
});
