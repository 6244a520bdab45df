// SPDX-License-Identifier: Apache-2.0
// What stands on the pages of the book: made from the exhibit's `book`, its stories and its tours.
// A page is {chapter, make()}; make() gives its content anew each time.
import { draw_preview } from '../collection/preview.js';
import { element } from '../element.js';
import { kiosk_word, local } from './words.js';

// about: what the server says of the exhibit. can: {tell, tour, walk} whether there is such a
// thing. wide: two pages lie side by side. heard: ids of the stories that this
// guest knows. orders: {go(chapter), watch(presentation), story(id), tour(id), walk(),
// call(), map()}.
export function make_pages({ about, lang, wide, heard, orders }) {
  const word = (name) => kiosk_word(lang, name), text = (one) => local(one, lang);
  const book = { topics: [], partners: [], presentations: [], ...about.book };
  const stories = about.stories ?? [], tours = about.tours ?? [];
  const pages = [], starts = new Map();
  const add = (chapter, make) => {
    if (!starts.has(chapter)) starts.set(chapter, pages.length);
    pages.push({ chapter, make });
  };
  // A new chapter of two facing pages begins on the left.
  const face = () => {
    if (wide && pages.length % 2) pages.push({ chapter: pages.at(-1).chapter, make: () => [] });
  };
  const heading = (name) => element('h2', { textContent: name });
  const picture = (one) => (one.image
    ? element('figure', {},
        element('img', { src: one.image, alt: text(one.alt), draggable: false }),
        one.credit ? element('figcaption', { textContent: text(one.credit) }) : null)
    : null);
  const paragraphs = (list) => (list ?? []).map((one) => element('p', { textContent: text(one) }));
  const entry = (title, detail, onclick, image) => element('button.entry',
      { type: 'button', onclick },
      image ? element('img', { src: image, alt: '', draggable: false }) : null,
      element('span', {}, element('b', { textContent: title }),
          detail ? element('small', { textContent: detail }) : null));
  const list = (entries) => element('div.entries', {}, ...entries);

  add('title', () => [element('div.plate', {},
      element('p.sign', { ariaHidden: 'true', textContent: '❦' }),
      element('h1', { textContent: text(about.title) }),
      element('p', { textContent: text(about.description) }))]);
  add('contents', () => [heading(word('contents')),
    ...[['topics', book.topics, (one) => [text(one.title), '', () => orders.go(`topic ${one.id}`)]],
      ['presentations', book.presentations,
        (one) => [text(one.title), '', () => orders.watch(one)]],
    ].flatMap(([chapter, all, of]) => (all.length
      ? [element('h3', { textContent: word(chapter) }), list(all.map((one) => entry(...of(one))))]
      : [])),
    element('h3', { textContent: word('museum') }),
    list([entry(word('museum'), '', () => orders.go('museum')),
      ...(about.collection
        ? [entry(text(about.collection), '', () => orders.go('collection'))] : []),
      ...(book.partners.length
        ? [entry(word('partners'), '', () => orders.go('partners'))] : [])])]);

  for (const topic of book.topics) {
    const chapter = `topic ${topic.id}`;
    if (wide && topic.image) {
      face();
      add(chapter, () => [picture(topic)]);
      add(chapter, () => [heading(text(topic.title)), ...paragraphs(topic.text)]);
    } else {
      add(chapter,
          () => [heading(text(topic.title)), picture(topic), ...paragraphs(topic.text)]);
    }
  }
  if (book.presentations.length) {
    face();
    add('presentations', () => [heading(word('presentations')),
      list(book.presentations.map((one) => entry(text(one.title),
          kiosk_word(lang, 'pictures', { n: one.slides.length }), () => orders.watch(one),
          one.slides.find((slide) => slide.image)?.image)))]);
  }
  if (about.collection) {
    const preview = () => {
      const canvas = element('canvas', { role: 'img', ariaLabel: text(about.collection) });
      draw_preview(canvas, about.id);
      return element('figure.map-preview', { onclick: orders.map }, canvas);
    };
    const open = () => [element('p', { textContent: word('map_about') }),
      list([entry(word('map_open'), '', orders.map)])];
    const title = () => heading(text(about.collection));
    face();
    if (wide) add('collection', () => [preview()]);
    add('collection', () => (wide ? [title(), ...open()] : [title(), preview(), ...open()]));
  }
  face();
  add('museum', () => [heading(word('museum')),
    element('p', { textContent: text(about.description) }),
    list([entry(word('walk'), '', orders.walk),
      ...tours.map((tour) => entry(text(tour.title), '', () => orders.tour(tour.id))),
      ...(stories.length ? [entry(word('tell_me'), '', () => orders.go('museum stories')),
        entry(word('call'), '', orders.call)] : [])])]);
  if (stories.length)
    add('museum stories', () => [heading(word('tell_me')),
      list(stories.map((story) => entry(text(story.title),
          heard.includes(story.id) ? word('heard') : '', () => orders.story(story.id))))]);
  if (book.partners.length) {
    face();
    add('partners', () => [heading(word('partners')), ...book.partners.flatMap((one) => [
      element('section.partner', {}, picture(one), element('h3', { textContent: text(one.title) }),
          ...paragraphs(one.text),
          one.link ? element('p.link', { textContent: one.link.replace(/^https:\/\//, '') })
            : null)])]);
  }
  return { pages, starts };
}
