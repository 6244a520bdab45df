// SPDX-License-Identifier: Apache-2.0
// The page's own words. The exhibit's words come from the server.
import { all } from './element.js';
import { kept } from './kept.js';
import de from './words/de.js';
import en from './words/en.js';
import es from './words/es.js';
import fr from './words/fr.js';
import sk from './words/sk.js';

export const words = { en, de, sk, fr, es };
export const language_names = {
  en: 'English', de: 'Deutsch', sk: 'Slovenčina', fr: 'Français', es: 'Español', cs: 'Čeština',
  pl: 'Polski', hu: 'Magyar', it: 'Italiano',
};

export function word(lang, name) {
  return (words[lang] ?? words[lang?.split('-')[0]] ?? words.en)[name] ?? words.en[name] ?? name;
}

// Fills every element that carries data-word, or data-word-title, -label or -hint.
export function translate_page(lang) {
  document.documentElement.lang = lang;
  for (const element of all('[data-word]'))
    element.textContent = word(lang, element.dataset.word);
  for (const element of all('[data-word-title]'))
    element.title = word(lang, element.dataset.wordTitle);
  for (const element of all('[data-word-label]'))
    element.setAttribute('aria-label', word(lang, element.dataset.wordLabel));
  for (const element of all('[data-word-hint]'))
    element.placeholder = word(lang, element.dataset.wordHint);
}

// Returns the language that the address asks for; null: none.
export const asked_language = () => new URLSearchParams(location.search).get('lang');

// Returns a language that the text has: `lang`, else the first of the `spoken` ones; undefined:
// none.
export const tag_in = (text, lang, spoken) =>
  [lang, lang.split('-')[0], ...spoken].find((one) => text?.[one]);

// Returns the text in that language.
export const text_in = (text, lang, spoken) => text?.[tag_in(text, lang, spoken)] ?? '';

// Says whether one of the `spoken` languages is that one, whatever its country.
export const knows = (tag, spoken) =>
  spoken.some((one) => one.split('-')[0] === tag.toLowerCase().split('-')[0]);

// Returns the visitor's language: asked for in the address, chosen before, or the browser's.
export function first_language() {
  return asked_language() ?? kept.get('lang') ?? navigator.language ?? 'en';
}
