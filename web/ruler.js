// SPDX-License-Identifier: Apache-2.0
// A ruler over the picture: the visitor draws a line, and the server says how long that is in the
// world. A scale bar says the same of a round number of centimetres before the picture's middle.
import { element } from './element.js';
import { place_in_picture } from './pointers.js';

const bar_share = 0.12;  // of the picture's width: the longest bar
const round_numbers = [1, 2, 5];

// Says a length as people do: 3.2 mm, 14.5 cm, 2.30 m.
export function say_length(metres, lang) {
  const [unit, factor] = metres < 0.01 ? ['millimeter', 1000] : metres < 1 ? ['centimeter', 100]
    : ['meter', 1];
  return new Intl.NumberFormat(lang, { style: 'unit', unit, maximumSignificantDigits: 3 })
      .format(metres * factor);
}

// Returns the longest of 1, 2, 5, 10, 20, 50 ... millimetres that is no longer.
export function round_length(metres) {
  const power = 10 ** Math.floor(Math.log10(metres));
  return power * round_numbers.filter((one) => one * power <= metres * 1.0001).at(-1);
}

// canvas: that of the picture. send(message): to the server. lang(): of the page.
export function make_ruler(canvas, send, lang) {
  const layer = element('div.ruler', { hidden: true });
  const line = element('i'), text = element('output');
  const bar = element('div.scale-bar', { hidden: true });
  layer.append(line, text);
  canvas.parentElement.append(layer, bar);
  const asked = new Map();  // id -> what takes the answer
  let id = 0, began = null;

  function measure(from, to, take) {
    asked.clear();
    asked.set(++id, take);
    send({ type: 'measure', id, from, to });
  }
  layer.addEventListener('pointerdown', (event) => {
    layer.setPointerCapture(event.pointerId);
    began = { x: event.clientX, y: event.clientY, place: place_in_picture(canvas, event) };
    text.textContent = '';
  });
  layer.addEventListener('pointermove', (event) => {
    if (!began) return;
    const dx = event.clientX - began.x, dy = event.clientY - began.y;
    line.style.width = `${Math.hypot(dx, dy)}px`;
    line.style.transform = `translate(${began.x}px, ${began.y}px) rotate(${Math.atan2(dy, dx)}rad)`;
    text.style.translate = `${event.clientX + 14}px ${event.clientY + 14}px`;
    measure(began.place, place_in_picture(canvas, event),
        (metres) => { text.textContent = say_length(metres, lang()); });
  });
  for (const end of ['pointerup', 'pointercancel'])
    layer.addEventListener(end, () => { began = null; });

  return {
    // on: lines are drawn instead of looking around.
    use(on) {
      layer.hidden = !on;
      line.style.width = '0';
      text.textContent = '';
    },
    used: () => !layer.hidden,
    // Shows the bar for the picture as it is now; false: none.
    scale(on) {
      bar.hidden = true;
      if (!on) return;
      const half = bar_share / 2;
      measure([0.5 - half, 0.5], [0.5 + half, 0.5], (metres) => {
        const length = round_length(metres);
        const box = canvas.getBoundingClientRect();
        const width = canvas.width * Math.max(box.width / canvas.width, box.height / canvas.height);
        bar.style.width = `${width * bar_share * length / metres}px`;
        bar.textContent = say_length(length, lang());
        bar.hidden = false;
      });
    },
    measured(message) {
      asked.get(message.id)?.(message.metres);
      asked.delete(message.id);
    },
  };
}
