// SPDX-License-Identifier: Apache-2.0
// Offers on the card of a very large picture all that can be done with it: the year of a map,
// another layer, two of them compared, a glass over it.
import { by_id, element } from './element.js';
import { word } from './words.js';

const blends = ['curtain', 'fade', 'difference'];

// Makes a list of choices with a label before it.
function make_choice(label, options, chosen, on_choice) {
  const select = element('select', { onchange: () => on_choice(select.value) },
      ...options.map(([value, textContent]) =>
        element('option', { value, textContent, selected: value === chosen })));
  return element('label', {}, `${label} `, select);
}

function make_slider(label, most, step, value, on_value) {
  const slider = element('input', { type: 'range', min: '0', max: String(most), step: String(step),
    ariaLabel: label, oninput: () => on_value(Number(slider.value)) });
  slider.value = String(value);
  return slider;
}

// orders: {piece({name, layer, over, by, share})}; glass, ruler: as of make_glass(), make_ruler().
export function make_pieces(orders, glass, ruler) {
  const room = by_id('card-piece');
  let pieces = [], lang = 'en', shown = null, choice = null, name = '', seen = '';

  const first = () => shown.layers[0];
  const dated = () => shown.layers.every((layer) => layer.year !== undefined);
  const title = (layer) => (layer === first() && !dated() ? word(lang, 'as_it_is') : layer.label);
  const layer_of = (id) => shown.layers.find((layer) => layer.id === id) ?? first();
  const titles = (without) => shown.layers.filter((layer) => layer !== without)
      .map((layer) => [layer.id, title(layer)]);

  function change(fields) {
    choice = { ...choice, ...fields };
    orders.piece({ name: shown.id, ...choice });
  }

  function make_dial() {
    const years = [...shown.layers].sort((a, b) => a.year - b.year);
    const at = Math.max(0, years.findIndex((layer) => layer.id === choice.layer));
    const value = element('output', { textContent: years[at].label });
    const dial = make_slider(word(lang, 'year'), years.length - 1, 1, at, (index) => {
      value.textContent = years[index].label;
      dial.setAttribute('aria-valuetext', years[index].label);
      say(years[index]);
      change({ layer: years[index].id });
    });
    dial.setAttribute('aria-valuetext', years[at].label);
    return element('div.dial', {}, value, dial);
  }

  function say(layer) { by_id('card-piece-text').textContent = layer?.text ?? ''; }

  function make_comparison() {
    const other = choice.by === 'none' ? '' : choice.over;
    const parts = [make_choice(word(lang, 'compare_with'),
        [['', word(lang, 'nothing')], ...titles(layer_of(choice.layer))], other, (over) => {
          change(over ? { over, by: choice.by === 'none' ? 'curtain' : choice.by }
            : { over: '', by: 'none' });
          fill();
        })];
    if (!other) return parts;
    parts.push(make_choice(word(lang, 'compare_by'),
        blends.map((blend) => [blend, word(lang, blend)]), choice.by, (by) => {
          change({ by });
          fill();
        }));
    if (choice.by !== 'difference')
      parts.push(make_slider(word(lang, choice.by), 1, 0.01, choice.share,
          (share) => change({ share })));
    return parts;
  }

  // Offers all that the glass may show: the same larger, another layer, how one differs.
  function make_glass_choice() {
    const options = [['', word(lang, 'no_glass')], ['larger', word(lang, 'larger')],
      ['closest', word(lang, 'closest')],
      ...titles(null).map(([id, text]) => [`layer ${id}`, text]),
      ...titles(layer_of(choice.layer)).map(([id, text]) =>
        [`difference ${id}`, word(lang, 'difference_to').replace('{layer}', text)])];
    const held = glass.held();
    const now = !held ? '' : !held.name ? (held.zoom ? 'larger' : 'closest')
      : `${held.difference ? 'difference' : 'layer'} ${held.layer}`;
    return make_choice(word(lang, 'glass'), options, now, (value) => {
      if (!value) return glass.put_down();
      const [kind, id] = value.split(' ');
      const label = options.find(([one]) => one === value)[1];
      say(id ? layer_of(id) : null);
      // 0: the picture's own texels become pixels.
      if (!id) glass.hold({ zoom: kind === 'larger' ? 4 : 0 }, label);
      else glass.hold({ zoom: 1, name: shown.id, layer: id, difference: kind === 'difference' },
          `${name}: ${label}`);
    });
  }

  function make_ruler_button() {
    const button = element('button', { type: 'button', textContent: word(lang, 'ruler'),
      ariaPressed: String(ruler.used()), onclick() {
        ruler.use(!ruler.used());
        button.ariaPressed = String(ruler.used());
        say({ text: ruler.used() ? word(lang, 'ruler_hint') : '' });
      } });
    return button;
  }

  function fill() {
    room.replaceChildren();
    room.hidden = !shown;
    if (!shown) return;
    if (dated()) room.append(make_dial());
    else room.append(make_choice(word(lang, 'layer'), titles(null), choice.layer, (layer) => {
      say(layer_of(layer));
      change({ layer });
      fill();
    }));
    room.append(...make_comparison(), make_glass_choice(), make_ruler_button());
  }

  return {
    welcome(message) {
      ({ pieces, lang } = message);
      if (shown) shown = pieces.find(({ id }) => id === shown.id) ?? null;
      if (shown) fill();
    },
    state(message) {
      const view = JSON.stringify([message.position, message.yaw, message.pitch, message.fov]);
      if (shown && view !== seen) ruler.scale(true);
      seen = view;
      if (!shown || room.contains(document.activeElement)) return;
      const told = message.pieces?.[shown.id];
      if (!told || JSON.stringify(told) === JSON.stringify(choice)) return;
      choice = told;
      fill();
    },
    // As still.jpg asks for them.
    looks(state) {
      const chosen = Object.entries(state?.pieces ?? {}).map(([id, { layer, over, by, share }]) =>
        [id, layer, ...(by === 'none' ? [] : [over, by, share])].join(':'));
      return chosen.length ? { pieces: chosen.join(',') } : {};
    },
    // The card of an object was opened; null: closed.
    show(object, state) {
      shown = pieces.find(({ id }) => id === object?.id) ?? null;
      name = object?.title ?? '';
      say(null);
      choice = shown && (state?.pieces?.[shown.id]
        ?? { layer: first().id, over: '', by: 'none', share: 0.5 });
      glass.put_down();
      ruler.use(false);
      seen = '';
      ruler.scale(shown !== null);
      fill();
    },
  };
}
