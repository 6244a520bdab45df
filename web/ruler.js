// SPDX-License-Identifier: Apache-2.0
// A ruler over the picture: the visitor draws a line, by a pointer or by keys, and the server says
// how long that is in the world. A scale bar says the same of a round number of centimetres before
// the picture's middle.
import { element } from './element.js';
import { place_in_picture } from './pointers.js';
import { word } from './words.js';

const bar_share = 0.12;  // of the picture's width: the longest bar
const round_numbers = [1, 2, 5];
const key_step = 10;     // pixels a press of an arrow key, 1 with Shift
const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

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
  const layer = element('div.ruler', { hidden: true, tabIndex: 0, role: 'group' });
  const line = element('i'), cross = element('b', { hidden: true }), text = element('output');
  const bar = element('div.scale-bar', { hidden: true });
  layer.append(line, cross, text);
  canvas.parentElement.append(layer, bar);
  const asked = new Map();  // id -> what takes the answer
  let id = 0, began = null;
  let cursor = null;  // where keys have moved it, {x, y} of the page

  function measure(from, to, take) {
    asked.clear();
    asked.set(++id, take);
    send({ type: 'measure', id, from, to });
  }
  const place_at = ({ x, y }) => place_in_picture(canvas, { clientX: x, clientY: y });
  // Says the length, and where in a scan's own coordinates the line ends.
  function tell(metres, scan) {
    const number = new Intl.NumberFormat(lang(), { maximumFractionDigits: 2 });
    text.textContent = [say_length(metres, lang()),
      ...(scan ? [scan.to.map((one) => number.format(one)).join('  ')] : [])].join('\n');
  }
  function draw_to(end) {
    const dx = end.x - began.x, dy = end.y - began.y;
    line.style.width = `${Math.hypot(dx, dy)}px`;
    line.style.transform = `translate(${began.x}px, ${began.y}px) rotate(${Math.atan2(dy, dx)}rad)`;
    text.style.translate = `${end.x + 14}px ${end.y + 14}px`;
    measure(place_at(began), place_at(end), tell);
  }
  layer.addEventListener('pointerdown', (event) => {
    layer.setPointerCapture(event.pointerId);
    began = { x: event.clientX, y: event.clientY };
    cross.hidden = true;
    text.textContent = '';
  });
  layer.addEventListener('pointermove', (event) => {
    if (began && cross.hidden) draw_to({ x: event.clientX, y: event.clientY });
  });
  for (const end of ['pointerup', 'pointercancel'])
    layer.addEventListener(end, () => { began = null; });
  // Arrow keys move a cross, Enter begins a line there and ends it.
  layer.addEventListener('keydown', (event) => {
    const way = steps[event.key];
    if (!way && event.key !== 'Enter') return;
    event.preventDefault();
    event.stopPropagation();
    const box = canvas.getBoundingClientRect(), step = event.shiftKey ? 1 : key_step;
    cursor ??= { x: box.left + box.width / 2, y: box.top + box.height / 2 };
    if (way) cursor = { x: cursor.x + step * way[0], y: cursor.y + step * way[1] };
    else began = began ? null : cursor;
    cross.hidden = false;
    cross.style.translate = `${cursor.x}px ${cursor.y}px`;
    if (began) draw_to(cursor);
  });

  return {
    // on: lines are drawn instead of looking around.
    use(on) {
      layer.hidden = !on;
      line.style.width = '0';
      cross.hidden = true;
      began = cursor = null;
      layer.ariaLabel = word(lang(), 'ruler_hint');
      if (on) layer.focus({ preventScroll: true });
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
      asked.get(message.id)?.(message.metres, message.scan);
      asked.delete(message.id);
    },
  };
}
