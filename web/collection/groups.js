// SPDX-License-Identifier: Apache-2.0
// The groups of a map as filters: each with its colour, what its objects have in common, and their
// years. Those that are pressed stay bright, and can be looked at alone.
import { element } from '../element.js';
import { color_of } from './plane.js';

// Says from when to when, as "1450–1612", "1210" or "100 BC–1462".
function say_years({ from, to }, word) {
  if (from === undefined) return '';
  const year = (number) => (number < 0 ? word('bc', { n: -number }) : String(number));
  return from === to ? year(from) : `${year(from)}–${year(to)}`;
}
export const name_of = (group) => group.terms.join(', ');

// orders: {changed(numbers), alone(numbers)}; word(name, values) -> text.
export function make_groups(word, orders) {
  const list = element('div.group-list', { role: 'group' });
  const alone = element('button.alone', { type: 'button', hidden: true,
    onclick: () => orders.alone([...pressed]) });
  let pressed = new Set(), buttons = [];

  function show() {
    buttons.forEach((button, i) => button.setAttribute('aria-pressed', String(pressed.has(i))));
    alone.hidden = pressed.size === 0 || pressed.size === buttons.length;
    alone.textContent = word('alone');
  }
  function toggle(number) {
    if (!(number in buttons)) return;
    if (!pressed.delete(number)) pressed.add(number);
    show();
    orders.changed([...pressed]);
  }

  return {
    element: element('div.groups', {}, list, alone),
    fill(groups) {
      pressed = new Set();
      list.ariaLabel = word('groups');
      buttons = groups.map((group, i) => {
        const dot = element('i', { ariaHidden: 'true' });
        dot.style.background = color_of(i);
        const button = element('button', { type: 'button', onclick: () => toggle(i) }, dot,
            element('span', {}, element('b', { textContent: name_of(group) || word('mixed') }),
                element('small', { textContent: [say_years(group, word),
                  word('objects_count', { n: group.count })].filter(Boolean).join(' · ') })));
        return button;
      });
      list.replaceChildren(...buttons);
      show();
    },
    toggle,
    pressed: () => pressed,
  };
}
