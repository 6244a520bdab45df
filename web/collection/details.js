// SPDX-License-Identifier: Apache-2.0
// The card of an object on the map: its names, picture and colours, how true its place is, where
// it is told of, and the way to it if it stands in the exhibit.
import { element } from '../element.js';
import { color_of } from './plane.js';
import { place_truth, untruth } from './truth.js';

// orders: {there(object), close()}; word(name) -> text; outside: whether links may leave the page.
export function make_details(word, orders, outside) {
  const card = element('section.details', { hidden: true });
  let shown = null;
  card.setAttribute('aria-labelledby', 'collection-title');

  function picture_of(item) {
    if (!item.picture) return null;
    const image = element('img', { alt: '', decoding: 'async', src: item.picture });
    image.addEventListener('error', () => image.remove());
    return image;
  }
  function colors_of(item) {
    if (!item.colors?.length) return null;
    return element('div.colors', { ariaHidden: 'true' }, ...item.colors.map((color) => {
      const one = element('i');
      one.style.background = color;
      return one;
    }));
  }

  return {
    element: card,
    item: () => shown,
    // group: {name, number}; of_map: the map's stress.
    show(item, group, of_map) {
      shown = item;
      const meter = element('span.meter', { ariaHidden: 'true' }, element('i'));
      meter.firstChild.style.width = `${Math.round(100 * untruth(item.stress, of_map))}%`;
      const dot = element('i', { ariaHidden: 'true' });
      dot.style.background = color_of(group.number);
      card.replaceChildren(
          element('button.round', { type: 'button', title: word('close_card'),
            ariaLabel: word('close_card'), onclick: () => orders.close(), textContent: '×' }),
          element('h2', { id: 'collection-title', tabIndex: -1, textContent: item.title }),
          ...[picture_of(item)].filter(Boolean),
          element('p.by', { textContent: [item.maker, item.date].filter(Boolean).join(' · ') }),
          ...[colors_of(item)].filter(Boolean),
          element('p.group', {}, dot, group.name || word('mixed')),
          element('p.truth', {}, meter, word(`truth_${place_truth(item.stress, of_map)}`)),
          ...(item.object ? [element('button.there', { type: 'button',
            textContent: word('there'), onclick: () => orders.there(item.object) })] : []),
          ...(item.link && outside ? [element('a', { href: item.link, target: '_blank',
            rel: 'noopener noreferrer', textContent: word('page') })] : []));
      card.hidden = false;
      card.scrollTop = 0;
    },
    hide() {
      shown = null;
      card.hidden = true;
    },
  };
}
