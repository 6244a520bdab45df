// SPDX-License-Identifier: Apache-2.0
// The row of places: a picture of each, which scrolls by wheel and touch.
import { by_id } from './element.js';

const picture = { width: '192', height: '108', spp: '4' };  // cheap ones: the visit itself goes on
const patience = 3000;  // milliseconds before the first of them is asked for

// go(name): when a place is chosen. wanted(): false while pictures are not to be loaded.
export function make_places(go, wanted) {
  const row = by_id('places');
  let places = [], exhibit = '', timer = 0;
  row.addEventListener('wheel', (event) => {
    row.scrollLeft += Math.abs(event.deltaX) > Math.abs(event.deltaY) ? event.deltaX : event.deltaY;
    event.preventDefault();
  }, { passive: false });

  function button({ name, title }) {
    const element = document.createElement('button'), words = document.createElement('span'),
        image = document.createElement('img');
    element.type = 'button';
    element.dataset.viewpoint = name;
    element.title = title;
    image.alt = '';
    image.hidden = true;
    Object.assign(image, { width: picture.width, height: picture.height });
    words.textContent = title;
    element.append(image, words);
    element.addEventListener('click', () => go(name));
    return element;
  }

  // One after the other: each takes cores from everybody's pictures for a moment.
  function load_next() {
    const image = [...row.querySelectorAll('img:not([src])')][0];
    if (!image || !wanted()) return;
    const query = new URLSearchParams(
        { viewpoint: image.parentElement.dataset.viewpoint, ...picture });
    image.onload = () => { image.hidden = false; load_next(); };
    image.onerror = load_next;
    image.src = `api/v1/exhibits/${encodeURIComponent(exhibit)}/still.jpg?${query}`;
  }

  return {
    welcome(message) {
      exhibit = message.exhibit;
      const loaded = new Map([...row.querySelectorAll('img[src]')]
          .map((image) => [image.parentElement.dataset.viewpoint, image]));
      places = message.viewpoints;
      row.replaceChildren(...places.map((place) => {
        const element = button(place), image = loaded.get(place.name);
        if (image) element.firstChild.replaceWith(image);
        return element;
      }));
      clearTimeout(timer);
      timer = setTimeout(load_next, patience);
    },
    state({ viewpoint }) {
      for (const element of row.children) {
        const is_here = String(element.dataset.viewpoint === viewpoint);
        if (element.getAttribute('aria-current') === is_here) continue;
        element.setAttribute('aria-current', is_here);
        if (is_here === 'true') element.scrollIntoView({ block: 'nearest', inline: 'nearest' });
      }
    },
    load: load_next,
    name: (index) => places[index]?.name,
    // The one after the one where the visitor is, or was last.
    after: (viewpoint) =>
      places[(places.findIndex(({ name }) => name === viewpoint) + 1) % places.length]?.name,
  };
}
