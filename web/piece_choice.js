// SPDX-License-Identifier: Apache-2.0
// Lists and sliders with labels, of which the cards of pieces are made.
import { element } from './element.js';

// Makes a list of choices with a label before it.
export function make_choice(label, options, chosen, on_choice) {
  const select = element('select', { onchange: () => on_choice(select.value) },
      ...options.map(([value, textContent]) =>
        element('option', { value, textContent, selected: value === chosen })));
  return element('label', {}, `${label} `, select);
}

export function make_slider(label, most, step, value, on_value) {
  const slider = element('input', { type: 'range', min: '0', max: String(most), step: String(step),
    ariaLabel: label, oninput: () => on_value(Number(slider.value)) });
  slider.value = String(value);
  return slider;
}
