// SPDX-License-Identifier: Apache-2.0
// The elements of the map's page: its head with the trail, the map with its tools, what stands
// beside it.
import { element } from '../element.js';

const icons = {
  back: 'M15 5l-7 7 7 7', close: 'M6 6l12 12M18 6L6 18', larger: 'M12 5v14M5 12h14',
  smaller: 'M5 12h14', whole: 'M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5',
};
function icon(name) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(svg.namespaceURI, 'path');
  path.setAttribute('d', icons[name]);
  svg.append(path);
  return svg;
}
const round = (name, onclick) =>
  element(`button.round.${name}`, { type: 'button', onclick }, icon(name));

// orders: {back(), close() or null, zoom(factor), whole(), radius(share), dive(), again(),
// crumb(depth)}. parts: {details, groups, list}: elements.
export function make_frame(orders, { details, groups, list }) {
  const back = round('back', orders.back), close = round('close', () => orders.close?.());
  close.hidden = !orders.close;
  const title = element('h1', { id: 'collection-name' }), crumbs = element('ol');
  const trail = element('nav.trail', {}, crumbs);
  const canvas = element('canvas', { tabIndex: 0, role: 'application' });
  const hint = element('p.hint'), keys = element('p.unseen', { id: 'collection-keys' });
  canvas.setAttribute('aria-describedby', keys.id);
  const larger = round('larger', () => orders.zoom(1.5));
  const smaller = round('smaller', () => orders.zoom(1 / 1.5));
  const whole = round('whole', orders.whole);
  const slider = element('input', { type: 'range', min: '0', max: '1', step: '0.001',
    oninput: () => orders.radius(Number(slider.value)) });
  const inside = element('output'), dive = element('button.dive', { type: 'button',
    onclick: orders.dive });
  const circle = element('div.circle', { role: 'group', hidden: true }, slider, inside, dive);
  const again = element('button', { type: 'button', onclick: orders.again, hidden: true });
  const state_text = element('span');
  const state = element('p.state', { role: 'status' }, state_text, again);
  const about = element('div.about'), about_title = element('h2');
  const groups_title = element('h2'), list_title = element('h2', { id: 'collection-in-view' });
  const legend = element('p.legend');
  const live = element('p.unseen');
  live.setAttribute('aria-live', 'polite');
  const root = element('div.collection', {},
      element('header', {}, back, element('div.names', {}, title, trail), close),
      element('div.plane', {}, canvas, hint, keys,
          element('div.tools', {}, larger, smaller, whole), circle, state),
      element('div.side', {}, details,
          element('section', {}, groups_title, groups),
          element('section', {}, about_title, about, legend),
          element('section.in-view', {}, list_title, list)),
      live);

  return {
    root, canvas, title, hint, live, circle, slider, inside, dive, about, list_title, back,
    // word(name) -> text.
    label(word) {
      back.title = back.ariaLabel = word('back');
      close.title = close.ariaLabel = word('close');
      larger.title = larger.ariaLabel = word('larger');
      smaller.title = smaller.ariaLabel = word('smaller');
      whole.title = whole.ariaLabel = word('whole');
      trail.ariaLabel = word('trail');
      canvas.ariaLabel = word('map');
      keys.textContent = word('map_keys');
      hint.textContent = word('hint');
      circle.ariaLabel = word('circle');
      slider.ariaLabel = word('radius');
      dive.textContent = word('dive');
      again.textContent = word('again');
      groups_title.textContent = word('groups');
      about_title.textContent = word('map');
      legend.textContent = word('legend');
      list_title.textContent = word('list');
    },
    // names: of the steps from everything on; all: that of everything.
    trail(names, all) {
      const last = names.length;
      crumbs.replaceChildren(...[all, ...names].map((name, depth) => {
        const button = element('button', { type: 'button', textContent: name || '…',
          onclick: () => orders.crumb(depth), disabled: depth === last });
        if (depth === last) button.setAttribute('aria-current', 'step');
        return element('li', {}, button);
      }));
      crumbs.lastElementChild.scrollIntoView({ block: 'nearest', inline: 'end' });
      back.disabled = last === 0;
    },
    // Says why there is no map; an empty text: there is one.
    say_state(text, may_try_again = false) {
      state_text.textContent = text;
      again.hidden = !may_try_again;
      state.hidden = !text;
      root.setAttribute('aria-busy', String(Boolean(text) && !may_try_again));
    },
  };
}
