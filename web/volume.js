// SPDX-License-Identifier: Apache-2.0
// Offers on the card of a scanned volume all that can be done with it: another preset, one that is
// unwrapped to another, a turntable, cuts from three sides, a glass that shows another preset or
// cuts into it. A scanned place is neither unwrapped nor turned; its layers are looks.
import { element } from './element.js';
import { make_choice, make_slider } from './piece_choice.js';
import { say_length } from './ruler.js';
import { word } from './words.js';

const key_turn = 10;          // degrees a press of an arrow key, 1 with Shift
const most_tilt = 75;         // degrees
const most_cut = 0.95;        // share of it that a slider cuts away: something is left to be seen
const first_depth = 0.35;     // share of it that a glass cuts away at first
const keys = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 };

export const as_at_first = { over: '', by: 'none', share: 0.5, turn: 0, low: [0, 0, 0],
  high: [1, 1, 1], plane: [0, 0, 0, 0], tilt: 0 };

// Whether the window has room for the cuts at first.
const is_roomy = () => innerHeight > 760 && innerWidth > 640;
const within_turn = (degrees) => ((degrees % 360) + 360) % 360;
const percent = (share) => `${Math.round(100 * share)} %`;

// Makes a slider with its value beside it. say(value): that, as text.
function make_valued(label, most, step, value, say, on_value) {
  const output = element('output', { textContent: say(value) });
  const slider = make_slider(label, most, step, value, (now) => on_value(put(now)));
  function put(now) {
    slider.value = String(now);
    output.textContent = say(now);
    slider.setAttribute('aria-valuetext', say(now));
    return now;
  }
  put(value);
  return { slider, put, row: element('label.valued', {},
      element('span', { textContent: label }), slider, output) };
}

// piece: as the welcome says; name: its object's. choice(): what is seen of it. orders:
// {change(fields), say(layer)}. kept: {unwrap_to: id of a preset, cuts_open}, which the card
// remembers between two calls. Returns elements.
export function make_volume({ piece, name, lang, choice, orders, glass, kept }) {
  const layer_of = (id) => piece.layers.find((layer) => layer.id === id) ?? piece.layers[0];
  const others = () => piece.layers.filter(({ id }) => id !== choice().layer)
      .map(({ id, label }) => [id, label]);
  const { size } = piece.volume ?? piece.scan;
  const deepest = Math.max(size[0], size[2]);
  const depth_step = 10 ** Math.floor(Math.log10(deepest)) / 20;  // of round numbers
  const in_steps = (metres) => Number((depth_step * Math.ceil(metres / depth_step)).toFixed(6));

  function make_turntable() {
    const { slider, put, row } = make_valued(word(lang, 'turntable'), 360, 1,
        Math.round(within_turn(choice().turn)), (degrees) => `${degrees}°`,
        (turn) => orders.change({ turn }));
    slider.addEventListener('keydown', (event) => {
      const way = keys[event.key];
      if (!way) return;
      event.preventDefault();
      const step = way * (event.shiftKey ? 1 : key_turn);
      orders.change({ turn: put(within_turn(Number(slider.value) + step)) });
    });
    row.classList.add('turntable');
    return row;
  }

  // A mixture of nothing is none: then the preset alone is drawn.
  function make_unwrap() {
    const now = choice();
    const seen = now.by === 'fade' && now.over !== now.layer;
    const ids = others().map(([id]) => id);
    if (seen) kept.unwrap_to = now.over;
    if (!ids.includes(kept.unwrap_to)) {
      const index = piece.layers.findIndex(({ id }) => id === now.layer);
      kept.unwrap_to = (piece.layers[index + 1] ?? piece.layers[0]).id;
    }
    const slider = make_slider(word(lang, 'unwrap'), 1, 0.01, seen ? now.share : 0, mix);
    function mix(share) {
      slider.setAttribute('aria-valuetext', percent(share));
      orders.change(share > 0 ? { over: kept.unwrap_to, by: 'fade', share }
        : { over: '', by: 'none', share: 0.5 });
    }
    slider.setAttribute('aria-valuetext', percent(Number(slider.value)));
    const list = make_choice(word(lang, 'unwrap'), others(), kept.unwrap_to, (id) => {
      kept.unwrap_to = id;
      orders.say(layer_of(id));
      mix(Number(slider.value));
    });
    return element('div.unwrap', {}, list, slider);
  }

  function make_cuts() {
    const cut = (label, axis, from_low) => {
      const { low, high } = choice();
      const gone = from_low ? low[axis] : 1 - high[axis];
      return make_valued(word(lang, label), most_cut, 0.01, gone, percent, (share) => {
        const side = [...choice()[from_low ? 'low' : 'high']];
        side[axis] = from_low ? share : 1 - share;
        orders.change({ [from_low ? 'low' : 'high']: side });
      });
    };
    const all = [cut('from_left', 0, true), cut('from_above', 1, false),
      cut('from_front', 2, false)];
    const used = all.some(({ slider }) => Number(slider.value) > 0);
    kept.cuts_open ??= used || is_roomy();
    return element('details.cuts', { open: kept.cuts_open,
      ontoggle: ({ target }) => { kept.cuts_open = target.open; } },
        element('summary', { textContent: word(lang, 'cut_away') }), ...all.map(({ row }) => row));
  }

  function make_glass_choice() {
    const options = [['', word(lang, 'no_glass')], ['cut', word(lang, 'glass_cuts')],
      ['larger', word(lang, 'larger')], ...others().map(([id, label]) => [`layer ${id}`, label])];
    const held = glass.held();
    let kind = !held ? '' : held.name ? `layer ${held.layer}` : held.depth ? 'cut' : 'larger';
    const { row, put } = make_valued(word(lang, 'glass_depth'), in_steps(deepest), depth_step,
        held?.depth ?? 0, (metres) => say_length(metres, lang), (metres) => hold(metres));
    row.hidden = !kind || kind === 'larger';
    function hold(metres) {
      const id = kind.split(' ')[1], zoom = glass.held()?.zoom ?? 1;
      const label = options.find(([one]) => one === kind)[1];
      if (kind === 'larger') glass.hold({ zoom: 2.5 }, label);
      else glass.hold({ zoom, depth: metres, ...(id && { name: piece.id, layer: id }) },
          `${name}: ${label}`);
    }
    const list = make_choice(word(lang, 'glass'), options, kind, (value) => {
      kind = value;
      row.hidden = !kind || kind === 'larger';
      if (!kind) return glass.put_down();
      const id = kind.split(' ')[1];
      orders.say(id ? layer_of(id) : null);
      glass.put_down();
      hold(put(kind === 'cut' ? in_steps(first_depth * deepest) : 0));
    });
    return element('div.glass-choice', {}, list, row);
  }

  // A nebula has a slider for how its axis leans to the eye; at first it is as it was found.
  function make_tilt() {
    const tilt = piece.volume?.tilt;
    if (tilt === undefined) return null;
    return make_valued(word(lang, 'tilt'), most_tilt, 1,
        Math.round(choice().tilt || Math.abs(tilt)), (degrees) => `${degrees}°`,
        (degrees) => orders.change({ tilt: Math.max(1, degrees) })).row;
  }

  // Says what the colours of a comparison with a model mean.
  function make_scale() {
    const { scale } = layer_of(choice().layer);
    if (!scale) return element('figure.scale', { hidden: true });
    const number = new Intl.NumberFormat(lang, { signDisplay: 'exceptZero' });
    return element('figure.scale', {},
        element('i', { style: `background: linear-gradient(90deg, ${scale.colors.join(', ')})` }),
        element('div', {}, ...scale.ticks.map(({ value, at }) => element('span',
            { textContent: number.format(value), style: `left: ${100 * at}%` }))),
        element('figcaption', { textContent: word(lang, 'scale').replace('{unit}', scale.unit)
            .replace('{mean}', say_length(scale.mean / 1000, lang)) }));
  }

  let unwrap = make_unwrap(), glass_choice = make_glass_choice(), scale = make_scale();
  const layers = make_choice(word(lang, 'preset'), piece.layers.map(({ id, label }) => [id, label]),
      choice().layer, (layer) => {
        orders.say(layer_of(layer));
        orders.change({ layer, over: '', by: 'none', share: 0.5 });
        unwrap.replaceWith(unwrap = make_unwrap());
        glass_choice.replaceWith(glass_choice = make_glass_choice());
        scale.replaceWith(scale = make_scale());
      });
  const several = piece.layers.length > 1, { volume } = piece;
  return [several ? layers : null, scale, volume ? make_turntable() : null, make_tilt(),
    several && volume ? unwrap : null, make_cuts(), glass_choice].filter(Boolean);
}
