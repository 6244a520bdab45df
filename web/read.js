// SPDX-License-Identifier: Apache-2.0
// All that an exhibit tells, to be read and printed, and whose models it is made of.
import { asked_exhibit } from './address.js';
import { by_id, element } from './element.js';
import { kept } from './kept.js';
import { asked_language, first_language, language_names, tag_in, text_in, translate_page, word }
  from './words.js';

const api = 'api/v1/exhibits';
const link_pattern = /(https?:\/\/[^\s<>()"']*[^\s<>()"'.,;:])/;
let lang = first_language(), all = [], exhibit = null, told = null;

const local = (text) => text_in(text, lang, exhibit.languages);

// An element with a text in the visitor's language, or in the one that the text has.
function spoken(name, text, properties = {}) {
  const made = element(name, { textContent: local(text), ...properties });
  const tag = tag_in(text, lang, exhibit.languages);
  if (tag && tag !== lang) made.lang = tag;
  return made;
}

// Sentences as one paragraph; null: there are none.
function paragraph(text, class_name = '') {
  const tag = tag_in(text, lang, exhibit.languages), sentences = tag ? text[tag] : [];
  if (sentences.length === 0) return null;
  const made = element('p', { textContent: sentences.join(' '), className: class_name });
  if (tag !== lang) made.lang = tag;
  return made;
}

function story_article(story) {
  const title = spoken('h3', story.title), teller = story.teller && local(story.teller);
  return element('article', { id: `story-${story.id}` }, title,
      teller ? element('p.by', { textContent: word(lang, 'told_by').replace('{name}', teller) })
        : null,
      paragraph(story.text));
}

function tour_article(tour) {
  const stops = tour.stops.map((stop) => element('li', {}, spoken('h4', stop.title),
      paragraph(stop.way_text, 'on-the-way'), paragraph(stop.text)));
  return element('article', { id: `tour-${tour.id}` }, spoken('h3', tour.title),
      element('ol.stops', {}, ...stops));
}

// Makes an article about an object: it tells its text, its layers and its years.
function seen_article(object) {
  const layers = (object.layers ?? []).map((layer) =>
    element('li', {}, spoken('strong', layer.label), layer.text ? spoken('p', layer.text) : null));
  return element('article', { id: `seen-${object.id}` }, spoken('h3', object.title),
      spoken('p', object.text), layers.length ? element('ul', {}, ...layers) : null);
}

// A text whose addresses are links; others than of the web stay words.
function with_links(text) {
  return text.split(link_pattern).filter(Boolean).map((part) => (link_pattern.test(part)
    ? element('a', { href: part, textContent: part, rel: 'noopener noreferrer' }) : part));
}

function credit_item({ file, title, author, license, source, copyright }) {
  const rows = [['dc_creator', author], ['dc_rights', copyright], ['licence', license],
    ['dc_source', source]].filter(([, text]) => text?.trim());
  const facts = rows.flatMap(([name, text]) =>
    [element('dt', { textContent: word(lang, name) }), element('dd', {}, ...with_links(text))]);
  return element('li', {}, element('h3', { textContent: title || file }),
      element('dl', {}, ...facts));
}

function link_to(article) {
  const title = article.querySelector('h3');
  return element('li', {},
      element('a', { href: `#${article.id}`, textContent: title.textContent, lang: title.lang }));
}

// Fills a section: its heading stays, the rest is put anew.
function fill(section, children) {
  section.replaceChildren(section.firstElementChild, ...children);
  section.hidden = children.length === 0;
}

function show_exhibit() {
  const title = local(exhibit.title);
  document.title = `${title} – ${word(lang, 'read')}`;
  by_id('title').textContent = title;
  by_id('about').textContent = local(exhibit.description);
  by_id('back').href = all.length > 1 ? `e/${encodeURIComponent(exhibit.id)}` : './';
  by_id('back').hidden = false;
  const stories = told.stories.map(story_article), tours = told.tours.map(tour_article);
  fill(by_id('stories'), stories);
  fill(by_id('tours'), tours);
  const seen = exhibit.objects.filter(({ title, text }) => title && text).map(seen_article);
  fill(by_id('seen'), seen);
  const articles = [...stories, ...tours, ...seen];
  by_id('contents-list').replaceChildren(...articles.map(link_to));
  by_id('contents').hidden = articles.length < 2;
  by_id('credits-list').replaceChildren(...exhibit.credits.map(credit_item));
  by_id('credits').hidden = exhibit.credits.length === 0;
  if (articles.length === 0) say('read_nothing');
}

function show_languages(tags) {
  by_id('languages').replaceChildren(...tags.map((tag) => {
    const button = element('button', { type: 'button', lang: tag, onclick: () => speak(tag),
      textContent: language_names[tag] ?? tag });
    button.setAttribute('aria-pressed', String(tag === lang || tag === lang.split('-')[0]));
    return button;
  }));
  by_id('languages').hidden = tags.length < 2;
}

function speak(tag) {
  lang = tag;
  kept.set('lang', tag);
  if (asked_language()) {
    const url = new URL(location.href);
    url.searchParams.set('lang', tag);
    history.replaceState(null, '', url);
  }
  show();
  const chosen = [...by_id('languages').children].find((one) => one.lang === tag);
  chosen?.focus();
}

function say(name) {
  by_id('problem').textContent = word(lang, name).replace('{asked}', asked_exhibit);
  by_id('problem').hidden = false;
}

// No exhibit was asked for, or none that is here.
function show_doors() {
  by_id('title').textContent = word(lang, 'read_which');
  document.title = word(lang, 'read');
  if (asked_exhibit) say('read_unknown');
  by_id('exhibits').replaceChildren(...all.map(({ id, title, languages }) => {
    const asked = new URLSearchParams({ exhibit: id, ...(asked_language() && { lang }) });
    return element('li', {},
        element('a', { href: `read?${asked}`, textContent: text_in(title, lang, languages) }));
  }));
  by_id('exhibits').hidden = false;
}

function show() {
  translate_page(lang);
  by_id('problem').hidden = true;
  show_languages(exhibit?.languages ?? [...new Set(all.flatMap(({ languages }) => languages))]);
  if (exhibit) show_exhibit(); else show_doors();
}

async function get(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
  return answer.json();
}

translate_page(lang);
document.body.classList.add('runs');
try {
  ({ exhibits: all } = await get(api));
  exhibit = asked_exhibit || all.length > 1
    ? all.find(({ id }) => id === asked_exhibit) : all[0];
  if (exhibit) told = await get(`${api}/${encodeURIComponent(exhibit.id)}/transcript`);
  show();
  // The browser looked for the place before it was there.
  if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
} catch {
  say('lost');
  setTimeout(() => location.reload(), 5000);
}
