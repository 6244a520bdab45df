// SPDX-License-Identifier: Apache-2.0
// The side menu: made from what the server says there is.
import { read_address } from './address.js';
import { by_id } from './element.js';
import { make_hour } from './hour.js';
import { kept } from './kept.js';
import { follow_lamps, show_lamps } from './lamps.js';
import { language_names, translate_page, word } from './words.js';

function button(text, on_click) {
  const element = document.createElement('button');
  element.type = 'button';
  element.textContent = text;
  element.addEventListener('click', on_click);
  return element;
}

// orders: {viewpoint(name), object(id), tour(action, id), story(id), storyteller(fields),
// lamp(name, on, light), hour(hour), lang(tag), subtitles(on), attention(share)}
export function make_menu(orders) {
  const menu = by_id('menu'), opener = by_id('menu-button');
  let lang = 'en', before = opener;  // before: what had the focus when it was opened
  const open = (yes) => {
    if (yes) {
      const focused = document.activeElement;
      before = !focused || focused === document.body ? opener : focused;
    }
    menu.hidden = !yes;
    opener.setAttribute('aria-expanded', String(yes));
    if (yes) by_id('menu-close').focus();
    else (before.isConnected && !before.closest('[hidden]') ? before : opener).focus();
  };
  opener.addEventListener('click', () => open(menu.hidden));
  by_id('menu-close').addEventListener('click', () => open(false));
  addEventListener('keydown',
      (event) => { if (event.key === 'Escape' && !menu.hidden) open(false); });

  by_id('storyteller-visible').addEventListener('change',
      (event) => orders.storyteller({ visible: event.target.checked }));
  by_id('storyteller-humanlike').addEventListener('change',
      (event) => orders.storyteller({ humanlike: event.target.checked }));
  by_id('subtitles-on').addEventListener('change',
      (event) => orders.subtitles(event.target.checked));

  const attention = by_id('attention'), chosen = kept.get('attention');
  if (chosen !== null && Number(chosen) >= 0 && Number(chosen) <= 1) attention.value = chosen;
  const tell_attention = () => {
    const side = attention.value < 0.4 ? 'eye' : attention.value > 0.6 ? 'look' : 'both';
    attention.setAttribute('aria-valuetext', word(lang, `attention_${side}`));
  };
  attention.addEventListener('input', tell_attention);
  attention.addEventListener('change', () => orders.attention(Number(attention.value)));

  const hour = make_hour(orders.hour);
  return {
    // Returns what the visitor chose, now or earlier; null: never.
    attention: () => (kept.get('attention') === null ? null : Number(attention.value)),
    welcome(message) {
      lang = message.lang;
      translate_page(lang);
      tell_attention();
      document.title = message.title;
      by_id('title').textContent = message.title;
      by_id('title').hidden = false;
      by_id('description').textContent = message.description;
      by_id('objects').replaceChildren(...message.objects.map(({ id, title }) => {
        const element = button(title, () => { open(false); orders.object(id); });
        element.dataset.object = id;
        return element;
      }));
      by_id('objects-section').hidden = message.objects.length === 0;
      by_id('tours').replaceChildren(...message.tours.map((tour) => button(tour.title, () => {
        orders.tour('play', tour.id);
        open(false);
      })));
      by_id('tours-section').hidden = message.tours.length === 0;
      by_id('stories').replaceChildren(...message.stories.map((story) => {
        const element = button(story.title, () => { orders.story(story.id); open(false); });
        element.dataset.story = story.id;
        return element;
      }));
      by_id('stories-section').hidden = message.stories.length === 0 || !message.storyteller;
      by_id('read-link').href = read_address(message.exhibit, lang);
      by_id('storyteller-section').hidden = !message.storyteller;
      by_id('tellers').replaceChildren(...message.storytellers.map(({ id, name, viewpoint }) => {
        const element = button(name || id, () => {
          orders.storyteller({ teller: id });
          orders.viewpoint(viewpoint);
          open(false);
        });
        element.dataset.teller = id;
        return element;
      }));
      by_id('tellers').hidden = message.storytellers.length < 2;
      show_lamps(by_id('lamps'), message.lamps, orders.lamp);
      by_id('lamps-section').hidden = message.lamps.length === 0;
      hour.welcome(message);
      by_id('languages').replaceChildren(...message.languages.map((tag) => {
        const element = button(language_names[tag] ?? tag, () => orders.lang(tag));
        element.setAttribute('aria-pressed', String(tag === lang || tag === lang.split('-')[0]));
        return element;
      }));
    },
    state(message) {
      follow_lamps(by_id('lamps'), message);
      hour.state(message);
    },
    agent(message) {
      by_id('storyteller-visible').checked = message.visible;
      by_id('storyteller-humanlike').checked = message.humanlike;
      for (const element of by_id('tellers').children)
        element.setAttribute('aria-pressed', String(element.dataset.teller === message.teller));
      for (const element of by_id('stories').children)
        element.setAttribute('aria-pressed', String(element.dataset.story === message.story));
    },
    figures(text) { if (!menu.hidden) by_id('figures').textContent = text; },
    is_open: () => !menu.hidden,
    toggle: () => open(menu.hidden),
    // Moves the focus to the next control, or the one before, for visitors without pointer and
    // keys.
    step(by) {
      const all = [...menu.querySelectorAll('button, input')]
          .filter((element) => !element.closest('[hidden]'));
      const at = all.indexOf(document.activeElement);
      all[(at + by + all.length) % all.length]?.focus();
    },
  };
}
