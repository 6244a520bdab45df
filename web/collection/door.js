// SPDX-License-Identifier: Apache-2.0
// The door from the visitor's page to the map of the exhibit's collection. The map's scripts are
// loaded when it is opened first.
import { by_id, element } from '../element.js';

// Parts of the page that stay in reach while the map lies over it.
const over_all = ['announcement', 'presence'];

const tell_again = 20000;  // milliseconds after which the server hears again that somebody is there

// orders: {there(object): walks there, covered(yes): the museum's picture is not seen, here():
// somebody is at the map, leave_menu()}.
export function make_door(orders) {
  const button = by_id('collection-open');
  let exhibit = '', lang = 'en', map = null, place = null, told_at = 0;
  let behind = /** @type {any[]} */ ([]);

  function load_style() {
    if (document.querySelector('link[href="collection/collection.css"]')) return null;
    const link = element('link', { rel: 'stylesheet', href: 'collection/collection.css' });
    const ready = new Promise((resolve) => { link.onload = link.onerror = resolve; });
    document.head.append(link);
    return ready;
  }

  function close() {
    if (!place) return;
    map?.close();
    map = null;
    place.remove();
    place = null;
    for (const one of behind) one.inert = false;
    behind = [];
    orders.covered(false);
    by_id('menu-button').focus();
  }

  function touched() {
    if (performance.now() - told_at < tell_again) return;
    told_at = performance.now();
    orders.here();
  }

  async function open() {
    if (place) return;
    const mine = place = element('div.collection-place', { role: 'dialog', ariaModal: 'true' });
    place.setAttribute('aria-labelledby', 'collection-name');
    behind = /** @type {any[]} */ ([...document.body.children])
        .filter((one) => !over_all.includes(one.id) && !one.inert);
    try {
      const [{ make_collection }] = await Promise.all([import('./collection.js'), load_style()]);
      if (mine !== place) return;
      document.body.append(place);
      for (const one of behind) one.inert = true;
      orders.covered(true);
      map = make_collection({ exhibit, lang, place,
        orders: { close, touched, there(object) { close(); orders.there(object); } } });
      map.open();
    } catch (problem) {
      console.warn(`collection: ${problem}`);
      place = null;
    }
  }
  button.addEventListener('click', () => { orders.leave_menu(); open(); });

  return {
    is_open: () => place !== null,
    welcome(message) {
      if (place && (message.exhibit !== exhibit || !message.collection)) close();
      ({ exhibit, lang } = message);
      by_id('collection-section').hidden = !message.collection;
      button.textContent = message.collection ?? '';
    },
  };
}
