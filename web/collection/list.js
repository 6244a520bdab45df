// SPDX-License-Identifier: Apache-2.0
// The list of the objects in view, by their titles: what the map shows, for who cannot see it, and
// for who looks for a name. One stop of the Tab key; arrow keys go through it.
import { element } from '../element.js';
import { color_of } from './plane.js';

// orders: {choose(index), open(index)}. lang: by which titles are sorted.
export function make_list(lang, orders) {
  const box = element('div.rows', { role: 'listbox', tabIndex: 0, id: 'collection-list' });
  let rows = [], chosen = -1, told = '';

  function mark() {
    for (const row of rows) row.setAttribute('aria-selected', String(index_of(row) === chosen));
    const row = rows.find((one) => index_of(one) === chosen);
    if (row) box.setAttribute('aria-activedescendant', row.id);
    else box.removeAttribute('aria-activedescendant');
    if (row && document.activeElement === box) row.scrollIntoView({ block: 'nearest' });
  }
  const index_of = (row) => Number(row.dataset.item);

  box.addEventListener('keydown', (event) => {
    const at = rows.findIndex((row) => index_of(row) === chosen);
    const to = { ArrowDown: at + 1, ArrowUp: Math.max(0, at - 1), Home: 0, End: rows.length - 1,
      PageDown: at + 10, PageUp: Math.max(0, at - 10) }[event.key];
    if (event.key === 'Enter' || event.key === ' ') {
      if (at >= 0) orders.open(chosen);
    } else if (to !== undefined && rows.length) {
      orders.choose(index_of(rows[Math.min(rows.length - 1, to)]));
    } else return;
    event.preventDefault();
  });
  box.addEventListener('click', (event) => {
    const row = event.target.closest('[role=option]');
    if (row) orders.open(index_of(row));
  });

  return {
    element: box,
    // items: [{index, title, text, group, dim}], as they are in view. label: name of the list.
    fill(items, label) {
      box.ariaLabel = label;
      const { compare } = new Intl.Collator(lang, { numeric: true });
      const sorted = items.slice().sort((a, b) => compare(a.title, b.title));
      const now = sorted.map(({ index }) => index).join();
      if (now !== told) {
        told = now;
        rows = sorted.map(({ index, title, text, group }) => {
          const dot = element('i', { ariaHidden: 'true' });
          dot.style.background = color_of(group);
          return element('div', { role: 'option', id: `collection-item-${index}`,
            dataset: { item: index } }, dot, element('span', { textContent: title }),
              text ? element('small', { textContent: text }) : null);
        });
        box.replaceChildren(...rows);
      }
      mark();
    },
    choose(index) { chosen = index; mark(); },
    // Another map has other objects.
    clear() { told = ''; },
  };
}
